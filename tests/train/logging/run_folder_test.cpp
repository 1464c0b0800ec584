#include "train/logging/run_folder.hpp"

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;

class RunFolderTest : public testing::Test {
 protected:
  std::string text(const std::string& name) const { return test::file_text(path_ / name); }
  const test::ScratchFolder scratch_;
  const fs::path path_ = scratch_ / "run";
};

TEST_F(RunFolderTest, WritesFilesAndMetrics) {
  RunFolder folder(path_);
  folder.write("config.yaml", "seed: 1\n");
  folder.append_metrics({"epoch", "total"});
  folder.append_metrics({"1", "0.5"});
  EXPECT_EQ(text("config.yaml"), "seed: 1\n");
  EXPECT_EQ(text("metrics.csv"), "epoch,total\n1,0.5\n");
}

TEST_F(RunFolderTest, RefusesAnEarlierRun) {
  {
    RunFolder(path_).write("config.yaml", "seed: 1\n");
  }
  EXPECT_THROW(RunFolder{path_}, DataError);
  EXPECT_EQ(text("config.yaml"), "seed: 1\n");
}

TEST_F(RunFolderTest, OpensAnEarlierRunWhereAskedTo) {
  {
    RunFolder(path_).write("config.yaml", "seed: 1\n");
  }
  EXPECT_TRUE(RunFolder(path_, RunFolder::Open::kExisting).has("config.yaml"));
  EXPECT_THROW(RunFolder(path_ / "absent", RunFolder::Open::kExisting), DataError);
}

TEST_F(RunFolderTest, KeepsTheRowsOfFinishedEpochs) {
  RunFolder folder(path_);
  for (const char* epoch : {"epoch", "1", "2", "3"}) folder.append_metrics({epoch, "x"});
  folder.keep_metrics(2);
  folder.append_metrics({"3", "y"});
  EXPECT_EQ(text("metrics.csv"), "epoch,x\n1,x\n2,x\n3,y\n");
  folder.keep_metrics(0);
  EXPECT_EQ(text("metrics.csv"), "");
}

TEST_F(RunFolderTest, TakesAnEmptyFolder) {
  fs::create_directories(path_);
  EXPECT_NO_THROW(RunFolder{path_});
}

}  // namespace
}  // namespace alight
