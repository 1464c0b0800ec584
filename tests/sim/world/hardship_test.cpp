#include "sim/spec/hardship.hpp"

#include <opencv2/imgproc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"
#include "sim/truth/surface_truth.hpp"
#include "tests/sim/test_worlds.hpp"

namespace alight::sim {
namespace {

/// A place with and without hardships, seen from above.
struct Place {
  explicit Place(Look look, const std::vector<std::string>& hard)
      : world(config(look, hard)), renderer(world), truth(renderer) {}
  static WorldConfig config(Look look, const std::vector<std::string>& hard) {
    WorldConfig config;
    config.look = look;
    config.seed = 7;
    config.size_m = 80;
    config.hard.names = hard;
    return config;
  }
  double safe_share() const {
    return cv::countNonZero(truth.safe()) / static_cast<double>(truth.safe().total());
  }
  cv::Mat image() const {
    return renderer.render_camera(test::intrinsics(), test::camera_above(0, 0, 25), false).image;
  }

  World world;
  Renderer renderer;
  SurfaceTruth truth;
};

double mean_of(const cv::Mat& image) { return cv::mean(cv::mean(image)).val[0]; }

/// Standard deviation of brightness within small neighbourhoods: texture, without shadows and borders.
double texture_of(const cv::Mat& image) {
  cv::Mat grey, mean, squares;
  image.convertTo(grey, CV_32FC3);
  cv::transform(grey, grey, cv::Matx13f(1.F / 3, 1.F / 3, 1.F / 3));
  cv::blur(grey, mean, {5, 5});
  cv::blur(grey.mul(grey), squares, {5, 5});
  cv::Mat variance = squares - mean.mul(mean);
  variance = variance.reshape(1, 1);
  cv::sort(variance, variance, cv::SORT_ASCENDING);
  return std::sqrt(std::max(0.F, variance.at<float>(variance.cols / 2)));
}

TEST(Hardship, ThoseThatStandOnTheGroundTakeSafeGroundAway) {
  const Place plain(Look::kVillage, {});
  for (const char* hard : {"stones", "kerbs"}) {
    const Place harder(Look::kVillage, {hard});
    EXPECT_LT(harder.safe_share(), 0.98 * plain.safe_share()) << hard;
    EXPECT_GT(harder.safe_share(), 0.1 * plain.safe_share()) << hard;
    // Only what was put there is higher.
    const cv::Mat rise = harder.truth.elevation_m() - plain.truth.elevation_m();
    double most = 0;
    cv::minMaxLoc(rise, nullptr, &most);
    EXPECT_GT(most, 0.09) << hard;
    EXPECT_LT(most, 0.36) << hard;
  }
}

TEST(Hardship, WiresHangOverOpenGround) {
  const Place plain(Look::kFarmland, {});
  const Place harder(Look::kFarmland, {"wires"});
  const cv::Mat rise = harder.truth.elevation_m() - plain.truth.elevation_m();
  EXPECT_GT(cv::countNonZero(rise > 6), 100);
  EXPECT_LT(cv::countNonZero(rise > 0.01), 0.02 * static_cast<double>(rise.total()));
}

TEST(Hardship, SlopesAreThoseThatAVehicleHardlyStandsOn) {
  const auto share_between = [](const Place& place, double low_deg, double high_deg) {
    const cv::Mat& slope = place.truth.slope_rad();
    return cv::countNonZero((slope > to_radians(low_deg)) & (slope < to_radians(high_deg))) /
           static_cast<double>(slope.total());
  };
  const Place plain(Look::kUrban, {});  // level but for its clearings
  const Place harder(Look::kUrban, {"slopes"});
  EXPECT_GT(share_between(harder, 6, 14), share_between(plain, 6, 14) + 0.01);
}

TEST(Hardship, SmallClearingsLeaveSmallerCircles) {
  const Place plain(Look::kForest, {});
  const Place harder(Look::kForest, {"clearings"});
  EXPECT_LT(harder.truth.largest_safe_circle(30).radius_m, plain.truth.largest_safe_circle(30).radius_m);
  EXPECT_GT(harder.truth.largest_safe_circle(30).radius_m, 1.0);
}

TEST(Hardship, SnowIsBrightAndPlain) {
  const Place plain(Look::kVillage, {});
  const Place snow(Look::kVillage, {"snow"});
  EXPECT_GT(mean_of(snow.image()), 1.3 * mean_of(plain.image()));
  EXPECT_LT(texture_of(snow.image()) / mean_of(snow.image()),
            0.5 * texture_of(plain.image()) / mean_of(plain.image()));
  EXPECT_EQ(cv::norm(snow.truth.elevation_m(), plain.truth.elevation_m(), cv::NORM_INF),
            0);  // the ground is the same
}

TEST(Hardship, DuskIsDark) {
  const Place plain(Look::kVillage, {});
  const Place dusk(Look::kVillage, {"dusk"});
  EXPECT_LT(mean_of(dusk.image()), 0.6 * mean_of(plain.image()));
  EXPECT_LT(dusk.world.sun_direction().z(), std::sin(to_radians(9.1)));
}

TEST(Hardship, NamesAreCheckedAndListed) {
  try {
    parse_config<WorldConfig>("hard: [stones, quicksand]", "w.yaml");
    FAIL() << "accepted";
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), ::testing::AllOf(::testing::HasSubstr("quicksand"), ::testing::HasSubstr("kerbs")));
  }
  for (const Hardship hardship : all_hardships()) {
    Hardships hard{{to_string(hardship)}};
    EXPECT_TRUE(hard.has(hardship));
    EXPECT_EQ(hard.unknown(), "");
  }
}

}  // namespace
}  // namespace alight::sim
