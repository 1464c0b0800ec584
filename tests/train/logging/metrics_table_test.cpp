#include "train/logging/metrics_table.hpp"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class MetricsTableTest : public testing::Test {
 protected:
  MetricsTable read(const std::string& content) const {
    std::ofstream(file_) << content;
    return read_metrics(file_);
  }
  void expect_refused(const std::string& content, const std::string& place, const std::string& cause) const {
    try {
      read(content);
      ADD_FAILURE() << "expected a DataError: " << cause;
    } catch (const DataError& e) {
      EXPECT_THAT(e.what(), HasSubstr(file_.string() + place));
      EXPECT_THAT(e.what(), HasSubstr(cause));
    }
  }
  const test::ScratchFolder folder_;
  const fs::path file_ = folder_ / "metrics.csv";
};

TEST_F(MetricsTableTest, ReadsColumns) {
  const MetricsTable table = read("epoch,total,rmse_mm_P=0\n1,0.5,nan\n2,2.5e-1,-nan\n");
  EXPECT_THAT(table.columns, ElementsAre("epoch", "total", "rmse_mm_P=0"));
  EXPECT_THAT(table.at("epoch"), ElementsAre(1, 2));
  EXPECT_THAT(table.at("total"), ElementsAre(0.5, 0.25));
  EXPECT_TRUE(std::isnan(table.at("rmse_mm_P=0")[0]));
  EXPECT_TRUE(std::isnan(table.at("rmse_mm_P=0")[1]));
  EXPECT_FALSE(table.has("learning_rate"));
  EXPECT_THROW(table.at("learning_rate"), std::invalid_argument);
}

TEST_F(MetricsTableTest, DamageIsNamedWithItsLine) {
  expect_refused("epoch,total\n1,0.5\n2,0.x\n", ":3", "total");
  expect_refused("epoch,total\n1,0.5\n2\n", ":3", "ends early");
  expect_refused("epoch,total\n1,0.5,7\n", ":2", "more columns");
  expect_refused("epoch,total\n1,0.5\n\n2,0.4\n", ":3", "epoch");
  expect_refused("epoch,total,total\n", ":1", "twice");
  expect_refused("step,total\n1,1\n", ":1", "no column \"epoch\"");
  expect_refused("epoch,total\n", "", "no rows");
  expect_refused("", "", "not found or empty");
}

TEST_F(MetricsTableTest, MissingFileIsNamed) { EXPECT_THROW(read_metrics("nowhere/metrics.csv"), DataError); }

}  // namespace
}  // namespace alight
