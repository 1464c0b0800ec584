#include "infer/shipped_model.hpp"

#include <fstream>

#include <gtest/gtest.h>

namespace alight {
namespace {

namespace fs = std::filesystem;

class ShippedModel : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(root_); }
  void TearDown() override { fs::remove_all(root_); }
  fs::path touch(const fs::path& name) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << "weights";
    return root_ / name;
  }
  const fs::path root_ = fs::path(testing::TempDir()) / "alight_shipped_model";
};

TEST_F(ShippedModel, IsFoundFromTheBuildFolder) {
  const fs::path model = touch("tree/models/shipped/default.pt");
  EXPECT_EQ(find_shipped_model(root_ / "tree/build/release/bin/alight-infer"), model);
}

TEST_F(ShippedModel, IsFoundWhereItIsInstalled) {
  const fs::path model = touch("usr/share/alight/models/default.pt");
  EXPECT_EQ(find_shipped_model(root_ / "usr/bin/alight-infer"), model);
}

TEST_F(ShippedModel, NoneIsNone) { EXPECT_FALSE(find_shipped_model(root_ / "usr/bin/alight-infer")); }

TEST(ThisExecutable, IsAFile) { EXPECT_TRUE(fs::is_regular_file(this_executable())); }

}  // namespace
}  // namespace alight
