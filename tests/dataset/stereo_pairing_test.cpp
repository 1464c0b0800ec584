#include "dataset/stereo_pairing.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

CameraImage image_at(std::int64_t t_ns) {
  return {t_ns, cv::Mat(1, 1, CV_8UC1, cv::Scalar(static_cast<double>(t_ns % 256)))};
}

TEST(StereoPairer, PairsWithinTheToleranceAndKeepsTheLeftTime) {
  StereoPairer pairer(10);
  EXPECT_FALSE(pairer.add_left(image_at(100)));
  const auto frame = pairer.add_right(image_at(110));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->t_ns, 100);
  EXPECT_EQ(frame->left.at<std::uint8_t>(0, 0), 100);
  EXPECT_EQ(frame->right.at<std::uint8_t>(0, 0), 110);
  EXPECT_EQ(pairer.unpaired(), 0);
}

TEST(StereoPairer, RightMayComeFirstAndLate) {
  StereoPairer pairer(0);
  EXPECT_FALSE(pairer.add_right(image_at(1)));
  EXPECT_FALSE(pairer.add_right(image_at(2)));
  ASSERT_TRUE(pairer.add_left(image_at(1)));
  ASSERT_TRUE(pairer.add_left(image_at(2)));
}

TEST(StereoPairer, CountsWhatHasNoPartner) {
  StereoPairer pairer(10);
  pairer.add_left(image_at(100));
  EXPECT_FALSE(pairer.add_right(image_at(111)));  // one beyond the tolerance: left 100 is lost
  EXPECT_EQ(pairer.unpaired(), 1);
  EXPECT_EQ(pairer.waiting(), 1);
  ASSERT_TRUE(pairer.add_left(image_at(112)));
  EXPECT_EQ(pairer.waiting(), 0);
}

TEST(StereoPairer, ADeadEyeDoesNotFillTheMemory) {
  StereoPairer pairer(10);
  for (int i = 0; i < 1000; ++i) pairer.add_left(image_at(i * 100));
  EXPECT_LE(pairer.waiting(), 100);
  EXPECT_EQ(pairer.waiting() + pairer.unpaired(), 1000);
}

}  // namespace
}  // namespace alight
