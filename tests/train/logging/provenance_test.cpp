#include "train/logging/provenance.hpp"

#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class DataHash : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* flight : {"a", "b"}) fs::create_directories(folder_ / flight / "left");
    write("dataset.yaml", "format_version: 1\n");
    write("a/samples.csv", "index\n0\n");
    write("b/samples.csv", "index\n1\n");
    write("a/left/000000.png", "pixels");
    write("b/left/000000.png", "others");
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  const test::ScratchFolder scratch_;
  const fs::path folder_ = scratch_ / "data";
};

/// The same files and rule, worked out with Python's xxhash.
TEST_F(DataHash, IsTheStatedFunction) { EXPECT_EQ(data_hash(folder_), "ad1b47c2c1ef8b9345feecb4934e3cc3"); }

TEST_F(DataHash, ChangesWithEverythingListed) {
  std::set<std::string> hashes{data_hash(folder_)};
  const auto expect_new = [&](const std::string& what) {
    EXPECT_TRUE(hashes.insert(data_hash(folder_)).second) << what;
  };
  write("dataset.yaml", "format_version: 2\n");
  expect_new("content of dataset.yaml");
  write("b/samples.csv", "index\n2\n");
  expect_new("content of a flight's samples.csv");
  write("a/left/000000.png", "pixels!");
  expect_new("size of a picture");
  fs::rename(folder_ / "a/left/000000.png", folder_ / "a/left/000001.png");
  expect_new("name of a picture");
  write("a/left/000002.png", "");
  expect_new("an empty picture more");
  fs::remove_all(folder_ / "b");
  expect_new("a flight less");
}

TEST_F(DataHash, DoesNotDependOnWhereTheDataLies) {
  const std::string before = data_hash(folder_);
  const fs::path moved = folder_.parent_path() / "moved";
  fs::rename(folder_, moved);
  EXPECT_EQ(data_hash(moved), before);
  EXPECT_EQ(data_hash(moved.string() + "/"), before);
  fs::create_directory_symlink(moved, folder_);
  EXPECT_EQ(data_hash(folder_), before);
}

TEST_F(DataHash, FolderThatIsNoDataSetIsNamed) {
  fs::remove(folder_ / "dataset.yaml");
  try {
    data_hash(folder_);
    FAIL() << "expected a DataError";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr((folder_ / "dataset.yaml").string()));
  }
}

/// What it says is git_revision_test.sh's matter: this program may be older than the last commit.
TEST(GitRevision, IsACommitOrUnknown) {
  EXPECT_THAT(git_revision(), testing::MatchesRegex("[0-9a-f]{40}(-dirty)?|unknown"));
}

}  // namespace
}  // namespace alight
