#include "foundation/output_folder.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "foundation/file_content.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {
namespace fs = std::filesystem;

class OutputFolderTest : public ::testing::Test {
 protected:
  const test::ScratchFolder scratch_;
  const fs::path root_ = scratch_.path();
};

TEST_F(OutputFolderTest, AppearsOnCommitOnly) {
  const fs::path path = root_ / "out";
  {
    OutputFolder folder(path);
    std::ofstream(folder.partial() / "file") << "content";
    EXPECT_FALSE(fs::exists(path));
    folder.commit();
  }
  EXPECT_TRUE(fs::exists(path / "file"));
  EXPECT_FALSE(fs::exists(root_ / "out.partial"));
}

TEST_F(OutputFolderTest, LeavesNothingWithoutCommit) {
  {
    OutputFolder folder(root_ / "out/");
    std::ofstream(folder.partial() / "file") << "content";
  }
  EXPECT_TRUE(fs::is_empty(root_));
}

TEST_F(OutputFolderTest, RefusesWhatAUserHas) {
  fs::create_directories(root_ / "out");
  std::ofstream(root_ / "out" / "mine") << "precious";
  EXPECT_THROW(OutputFolder(root_ / "out"), DataError);
  EXPECT_TRUE(fs::exists(root_ / "out" / "mine"));
}

TEST_F(OutputFolderTest, ReplacesTheLeftoverOfAKilledRun) {
  fs::create_directories(root_ / "out.partial");
  std::ofstream(root_ / "out.partial" / "stale") << "x";
  OutputFolder folder(root_ / "out");
  EXPECT_FALSE(fs::exists(folder.partial() / "stale"));
}

TEST_F(OutputFolderTest, AtomicWriteReplacesWhole) {
  write_file_atomically(root_ / "f", "one");
  write_file_atomically(root_ / "f", "two");
  std::ifstream stream(root_ / "f");
  std::string text;
  stream >> text;
  EXPECT_EQ(text, "two");
  EXPECT_THROW(write_file_atomically(root_ / "missing" / "f", "x"), DataError);
}

TEST_F(OutputFolderTest, AFilesContentIsEveryByteAndNoneOfWhatCannotBeRead) {
  const std::string bytes("a\0\r\n\n", 5);
  write_file_atomically(root_ / "file", bytes);
  EXPECT_EQ(file_content(root_ / "file"), bytes);
  write_file_atomically(root_ / "empty", "");
  EXPECT_EQ(file_content(root_ / "empty"), "");
  EXPECT_FALSE(file_content(root_ / "absent"));
  EXPECT_FALSE(file_content(root_)) << "a folder";
}

}  // namespace
}  // namespace alight
