#include "dataset/inspect/sample_picture.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

Sample picture_sample(bool with_dense) {
  Sample sample;
  sample.left = cv::Mat(20, 30, CV_8UC1, cv::Scalar(100));
  sample.sparse = SparseDepth::empty({30, 20});
  sample.sparse.depth_m.at<float>(10, 10) = 5;
  sample.sparse.offset_us.at<std::int32_t>(10, 10) = 1000;
  if (with_dense) sample.dense_m = cv::Mat(20, 30, CV_32FC1, cv::Scalar(5));
  return sample;
}

TEST(DrawSample, HasAPanelForEverythingThatIsThere) {
  const cv::Mat three = draw_sample(picture_sample(false), "flight 0");
  const cv::Mat four = draw_sample(picture_sample(true), "flight 0");
  EXPECT_EQ(three.type(), CV_8UC3);
  EXPECT_EQ(three.cols * 4, four.cols * 3);
  EXPECT_EQ(three.rows, four.rows);
}

TEST(DrawSample, ASampleWithoutPointsIsDrawnToo) {
  Sample sample = picture_sample(false);
  sample.sparse = SparseDepth::empty({30, 20});
  EXPECT_FALSE(draw_sample(sample, "flight 0").empty());
}

}  // namespace
}  // namespace alight
