#include "foundation/shipped_files.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// A folder of the user's as the working directory. The shipped files are those of the build tree of this test.
class ShippedFiles : public testing::Test {
 protected:
  void SetUp() override { fs::current_path(root_); }
  void TearDown() override { fs::current_path(before_); }
  fs::path touch(const fs::path& name) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << "x";
    return root_ / name;
  }
  const fs::path before_ = fs::current_path();
  const test::ScratchFolder scratch_;
  const fs::path root_ = fs::canonical(scratch_.path());
};

TEST_F(ShippedFiles, AreFoundFromTheBuildTreeThroughItsLinks) {
  EXPECT_EQ(input_file("configs/rigs/paper.yaml"),
            fs::canonical(ALIGHT_SOURCE_DIR "/configs/rigs/paper.yaml"));
  EXPECT_EQ(shipped_file("models/weights/default.pt"),
            fs::canonical(ALIGHT_SOURCE_DIR "/models/weights/default.pt"));
}

TEST_F(ShippedFiles, AreFoundWhereverThePrefixIs) {
  touch("usr/share/alight/configs/rigs/paper.yaml");
  EXPECT_EQ(shipped_folder(root_ / "usr/bin/alight-infer"), std::nullopt);  // bin is not there
  touch("usr/bin/alight-infer");
  EXPECT_EQ(shipped_folder(root_ / "usr/bin/alight-infer"), root_ / "usr/share/alight");
  fs::rename(root_ / "usr", root_ / "moved");
  EXPECT_EQ(shipped_folder(root_ / "moved/bin/alight-infer"), root_ / "moved/share/alight");
}

TEST_F(ShippedFiles, AFolderOfThatNameWithoutConfigurationsIsNone) {
  touch("usr/bin/alight-infer");
  touch("usr/share/alight/notes.txt");
  EXPECT_EQ(shipped_folder(root_ / "usr/bin/alight-infer"), std::nullopt);
}

TEST_F(ShippedFiles, TheUsersFileOfTheSameNameWins) {
  touch("configs/rigs/paper.yaml");
  EXPECT_EQ(input_file("configs/rigs/paper.yaml"), "configs/rigs/paper.yaml");
}

TEST_F(ShippedFiles, NothingOfTheUsersStandsInForTheProgramsOwn) {
  touch("models/weights/default.pt");
  EXPECT_EQ(shipped_file("models/weights/default.pt"),
            fs::canonical(ALIGHT_SOURCE_DIR "/models/weights/default.pt"));
}

TEST_F(ShippedFiles, OtherNamesStayAsTheyAre) {
  for (const char* name :
       {"paper.yaml", "rigs/paper.yaml", "../configs/rigs/paper.yaml", "/no/such/file.yaml", ""})
    EXPECT_EQ(input_file(name), name);
}

TEST_F(ShippedFiles, AMissingOneNamesBothPlaces) {
  try {
    input_file("configs/rigs/nowhere.yaml");
    FAIL() << "found";
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("configs/rigs/nowhere.yaml: is not in " + root_.string()),
                                HasSubstr("share/alight; check the path")));
  }
}

TEST(ThisExecutable, IsAFile) { EXPECT_TRUE(fs::is_regular_file(this_executable())); }

}  // namespace
}  // namespace alight
