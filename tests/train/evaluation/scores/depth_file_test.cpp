#include "train/evaluation/scores/depth_file.hpp"

#include <fstream>
#include <limits>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

template <class T>
cv::Mat row_of(const std::vector<T>& values) {
  return cv::Mat(values, /*copyData=*/true).reshape(1, 1);
}

class DepthFile : public ::testing::Test {
 protected:
  std::string mistake(const fs::path& path) {
    try {
      read_depth_file(path);
    } catch (const DataError& error) {
      return error.what();
    }
    return "none";
  }

  const test::ScratchFolder dir_;
};

TEST_F(DepthFile, PngIsInSteps) {
  cv::imwrite((dir_ / "d.png").string(), row_of<std::uint16_t>({0, 256, 2816}));
  const cv::Mat depth_m = read_depth_file(dir_ / "d.png");
  EXPECT_EQ(cv::norm(depth_m, row_of<float>({0, 1, 11}), cv::NORM_INF), 0);
}

TEST_F(DepthFile, TiffIsInMetresAndNonsenseIsMissing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  cv::imwrite((dir_ / "d.tiff").string(), row_of<float>({12.34F, nan, -1, infinite}));
  const cv::Mat depth_m = read_depth_file(dir_ / "d.tiff");
  EXPECT_EQ(cv::norm(depth_m, row_of<float>({12.34F, 0, 0, 0}), cv::NORM_INF), 0);
}

TEST_F(DepthFile, OtherPixelsAreRefused) {
  cv::imwrite((dir_ / "grey.png").string(), cv::Mat::ones(2, 2, CV_8UC1));
  EXPECT_THAT(mistake(dir_ / "grey.png"), HasSubstr("grey.png: is no depth map"));
  std::ofstream(dir_ / "text.png") << "no image";
  EXPECT_THAT(mistake(dir_ / "text.png"), HasSubstr("text.png: is no image"));
  EXPECT_THAT(mistake(dir_ / "nowhere.png"), HasSubstr("nowhere.png: there is no such file"));
}

}  // namespace
}  // namespace alight
