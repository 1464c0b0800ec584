#include "geometry/crop.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(Crop, PrincipalPointMovesAlongSoThatRaysStay) {
  const PinholeIntrinsics k{440, 441, 319.5, 199.5, 640, 400};
  const cv::Rect rect = centre_crop(k.size(), {352, 351});
  EXPECT_EQ(rect, cv::Rect(144, 24, 352, 351));
  const PinholeIntrinsics cropped = crop(k, rect);
  EXPECT_EQ(cropped.width_px, 352);
  EXPECT_EQ(cropped.height_px, 351);
  EXPECT_TRUE(cropped.ray(10, 20).isApprox(k.ray(10 + rect.x, 20 + rect.y)));
}

TEST(Crop, TooLargeIsACallersMistake) {
  EXPECT_THROW(centre_crop({640, 400}, {352, 401}), std::invalid_argument);
  EXPECT_THROW(centre_crop({640, 400}, {0, 10}), std::invalid_argument);
  EXPECT_EQ(centre_crop({640, 400}, {640, 400}), cv::Rect(0, 0, 640, 400));
}

}  // namespace
}  // namespace alight
