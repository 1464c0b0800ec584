#include "dataset/inspect/dataset_statistics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/sensors/test_flight.hpp"

namespace alight::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Left part of the image with a depth, measured `offset_s` after it.
Sample sample_of(int columns, double offset_s) {
  Sample sample;
  sample.left = cv::Mat(8, 16, CV_8UC1, cv::Scalar(90));
  sample.sparse = SparseDepth::empty(sample.left.size());
  sample.sparse.depth_m.colRange(0, columns) = 10;
  sample.sparse.offset_us.colRange(0, columns) = 1e6 * offset_s;
  return sample;
}

/// Three samples: half of the image 0.05 s after it, a quarter 0.25 s after it, a quarter 0.05 s before it.
class DatasetStatisticsTest : public ::testing::Test {
 protected:
  DatasetStatisticsTest() {
    info_.rig.intrinsics = {440, 440, 7.5, 3.5, 16, 8};
    info_.window_before_s = 0.5;
    info_.window_after_s = 0.5;
    FlightEntry flight;
    flight.name = "a";
    flight.samples = 3;
    info_.flights = {flight};
    create_flight_folders(dir_.path(), flight);
    std::vector<SampleRow> rows(3);
    for (int i = 0; i < 3; ++i) {
      rows[static_cast<std::size_t>(i)].index = i;
      rows[static_cast<std::size_t>(i)].t_ns = kStart_ns + i;
    }
    rows[0].height_m = 3;
    rows[1].height_m = 12;  // the third is unknown
    write_samples(dir_.path(), "a", rows);
    write_sample(dir_.path(), flight, 0, sample_of(8, 0.05), 1);
    write_sample(dir_.path(), flight, 1, sample_of(4, 0.25), 1);
    write_sample(dir_.path(), flight, 2, sample_of(4, -0.05), 1);
  }

  ScratchFolder dir_;
  DatasetInfo info_;
};

TEST_F(DatasetStatisticsTest, CountsHeights) {
  const DatasetStatistics s = measure_dataset(dir_.path(), info_);
  EXPECT_EQ(s.samples, 3);
  EXPECT_THAT(s.heights, ElementsAre(1, 0, 1));
  EXPECT_EQ(s.unknown_heights, 1);
}

TEST_F(DatasetStatisticsTest, DensityGrowsWithTheAccumulationTime) {
  const DatasetStatistics s = measure_dataset(dir_.path(), info_);
  ASSERT_EQ(s.density.size(), 4u);  // 0.1 0.2 0.3 0.5: none beyond the window
  EXPECT_NEAR(s.density[0].second, 0.5 / 3, 1e-9);
  EXPECT_NEAR(s.density[1].second, 0.5 / 3, 1e-9);
  EXPECT_NEAR(s.density[2].second, 0.75 / 3, 1e-9);
  EXPECT_EQ(s.density[3].first, 0.5);
  EXPECT_NEAR(s.density[3].second, 0.75 / 3, 1e-9);
}

TEST_F(DatasetStatisticsTest, CoverageIsOfTheWholeWindow) {
  const DatasetStatistics s = measure_dataset(dir_.path(), info_);
  EXPECT_NEAR(s.covered_median, 0.25, 1e-9);
  EXPECT_NEAR(s.coverage.at<float>(3, 1), 1, 1e-6);
  EXPECT_NEAR(s.coverage.at<float>(3, 6), 1.0 / 3, 1e-6);
  EXPECT_EQ(s.coverage.at<float>(3, 12), 0);
}

TEST_F(DatasetStatisticsTest, LooksIntoNoMoreMapsThanAsked) {
  const DatasetStatistics s = measure_dataset(dir_.path(), info_, 2);
  EXPECT_LE(s.measured, 2);
  EXPECT_EQ(s.samples, 3);
  EXPECT_THAT(format_statistics(s), HasSubstr("of 3 samples"));
}

TEST_F(DatasetStatisticsTest, AreTabulatedAndDrawn) {
  const DatasetStatistics s = measure_dataset(dir_.path(), info_);
  const std::string text = format_statistics(s);
  EXPECT_THAT(text, HasSubstr("unknown"));
  EXPECT_THAT(text, HasSubstr("25.00 % in the median sample"));
  EXPECT_EQ(draw_statistics(s).type(), CV_8UC3);
  EXPECT_FALSE(draw_statistics({}).empty());
}

TEST_F(DatasetStatisticsTest, NameADepthMapThatIsMissing) {
  std::filesystem::remove(dir_.path() / "a" / "depth" / "000001.png");
  EXPECT_THAT(message_of<DataError>([&] { measure_dataset(dir_.path(), info_); }), HasSubstr("000001.png"));
}

}  // namespace
}  // namespace alight::testing
