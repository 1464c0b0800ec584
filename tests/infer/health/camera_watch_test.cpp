#include "infer/health/camera_watch.hpp"

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

cv::Mat noise(std::uint64_t seed, int low = 40, int high = 200) {
  cv::Mat image(120, 160, CV_8UC3);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, low, high);
  return image;
}

/// Shows `image(i)` at 20 Hz. @returns the fault at the end; "" for none
std::string fault_of_watch(const std::function<cv::Mat(int)>& image, double speed_mps = 0) {
  CameraWatch watch({}, "left camera");
  for (int i = 0; i < 20; ++i) {
    const double t_s = 0.05 * i;
    watch.add(to_nanoseconds(t_s), image(i), Eigen::Vector3d(speed_mps * t_s, 0, 0));
  }
  std::vector<HealthFinding> findings;
  watch.report(findings);
  EXPECT_EQ(watch.usable(), findings.empty());
  return findings.empty() ? "" : findings.front().fault;
}

TEST(CameraWatch, PicturesThatVaryAreUsable) {
  EXPECT_EQ(fault_of_watch([](int i) { return noise(static_cast<std::uint64_t>(i) + 1); }, 3), "");
}

TEST(CameraWatch, NamesWhatIsNoPicture) {
  EXPECT_EQ(fault_of_watch([](int i) { return noise(static_cast<std::uint64_t>(i) + 1, 0, 10); }), "black");
  EXPECT_EQ(fault_of_watch([](int i) { return noise(static_cast<std::uint64_t>(i) + 1, 251, 256); }),
            "over-exposed");
  EXPECT_EQ(fault_of_watch([](int) { return cv::Mat(); }), "lost");
  EXPECT_EQ(fault_of_watch([](int i) { return noise(static_cast<std::uint64_t>(std::min(i, 9)) + 1); }),
            "frozen");
}

TEST(CameraWatch, AStillSceneWithoutNoiseIsFrozenOnlyIfTheVehicleMoves) {
  EXPECT_EQ(fault_of_watch([](int) { return noise(1); }, 0), "");
  EXPECT_EQ(fault_of_watch([](int) { return noise(1); }, 3), "frozen");
}

TEST(CameraWatch, TheFirstBadPictureIsNotUsedAndIsNoFinding) {
  CameraWatch watch({}, "right camera");
  EXPECT_TRUE(watch.add(0, noise(1), {}));
  EXPECT_FALSE(watch.add(50'000'000, cv::Mat::zeros(120, 160, CV_8UC1), {}));
  EXPECT_TRUE(watch.usable());
  EXPECT_TRUE(watch.add(100'000'000, noise(2), {}));
}

}  // namespace
}  // namespace alight
