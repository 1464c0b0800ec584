#include "calibrate/clocks/edge_agreement.hpp"

#include <numeric>
#include <random>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "calibrate/clocks/flight_views.hpp"
#include "geometry/frames.hpp"
#include "sensors/poses/alignment.hpp"

namespace alight {
namespace {

const PinholeIntrinsics kIntrinsics{200, 200, 99.5, 79.5, 200, 160};
const cv::Rect kSquare(70, 50, 60, 50);
constexpr double kDepth_m = 10;

cv::Mat square_image() {
  cv::Mat image(kIntrinsics.size(), CV_8UC1, cv::Scalar(90));
  cv::rectangle(image, kSquare, 160, cv::FILLED);
  return image;
}

/// The square's outline in space; pixel centres are integers, so that its border lies half a pixel out.
std::vector<SeenPoint> outline() {
  std::vector<SeenPoint> points;
  const auto add = [&](double u, double v) {
    SeenPoint point;
    point.p_own = kDepth_m * kIntrinsics.ray(u, v);
    points.push_back(point);
  };
  for (int i = 0; i < kSquare.width; ++i) {
    add(kSquare.x + i, kSquare.y - 0.5);
    add(kSquare.x + i, kSquare.y + kSquare.height - 0.5);
  }
  for (int i = 0; i < kSquare.height; ++i) {
    add(kSquare.x - 0.5, kSquare.y + i);
    add(kSquare.x + kSquare.width - 0.5, kSquare.y + i);
  }
  return points;
}

double score(const EdgeAgreement& agreement, const Eigen::Isometry3d& motion) {
  const std::vector<double> parts = agreement.scores(motion);
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

Eigen::Isometry3d shift(double x_m, double y_m) {
  return Eigen::Isometry3d(Eigen::Translation3d(x_m, y_m, 0));
}

TEST(EdgeAgreement, IsBestWhereEdgesMeet) {
  EdgeAgreement agreement(kIntrinsics, 10);
  agreement.add_view(edge_strength(square_image()), outline());
  EXPECT_EQ(agreement.points(), outline().size());
  const double best = score(agreement, Eigen::Isometry3d::Identity());
  EXPECT_GT(best, 3);
  const double pixel_m = kDepth_m / kIntrinsics.fx_px;
  double before = best;
  for (const double off_px : {1.0, 2.0, 3.0}) {
    const double both = score(agreement, shift(off_px * pixel_m, off_px * pixel_m));
    EXPECT_NEAR(both, score(agreement, shift(-off_px * pixel_m, -off_px * pixel_m)), 0.05) << off_px;
    EXPECT_LT(both, before) << off_px;
    before = both;
  }
}

TEST(EdgeAgreement, FollowsTheVehiclesMotion) {
  // The camera moved by 0.5 m to the right between point and image: at the point's own time the square was 10 px right.
  std::vector<SeenPoint> points = outline();
  for (SeenPoint& point : points) {
    point.p_own.x() += 0.5;
    point.T_view_own = shift(-0.5, 0);
  }
  EdgeAgreement moved(kIntrinsics, 10);
  moved.add_view(edge_strength(square_image()), points);
  EdgeAgreement still(kIntrinsics, 10);
  still.add_view(edge_strength(square_image()), outline());
  EXPECT_NEAR(score(moved, Eigen::Isometry3d::Identity()), score(still, Eigen::Isometry3d::Identity()), 1e-9);
}

TEST(EdgeAgreement, ChanceIsOneInEvenTexture) {
  cv::Mat noise(kIntrinsics.size(), CV_8UC1);
  cv::RNG random(4);
  random.fill(noise, cv::RNG::NORMAL, 128, 40);
  EdgeAgreement agreement(kIntrinsics, 10);
  agreement.add_view(edge_strength(noise), outline());
  EXPECT_NEAR(score(agreement, Eigen::Isometry3d::Identity()), 1, 0.15);
}

TEST(EdgeAgreement, LeavesOutWhatTheImageDoesNotHold) {
  std::vector<SeenPoint> points = outline();
  for (SeenPoint& point : points) point.p_own.x() -= 3;  // 60 px: the left part falls into the margin
  EdgeAgreement agreement(kIntrinsics, 20);
  agreement.add_view(edge_strength(square_image()), points);
  EXPECT_LT(agreement.points(), points.size());
  for (SeenPoint& point : points) point.p_own = -point.p_own;  // behind the camera
  EdgeAgreement behind(kIntrinsics, 20);
  behind.add_view(edge_strength(square_image()), points);
  EXPECT_EQ(behind.points(), 0u);
}

TEST(EdgeStrength, IsTheSameInBrightAndDimLight) {
  cv::Mat dim;
  cv::Mat bright = square_image();
  cv::randu(bright, 40, 200);
  cv::GaussianBlur(bright, bright, {}, 2);
  bright.convertTo(dim, CV_8U, 0.5);
  const double ratio = cv::mean(edge_strength(dim))[0] / cv::mean(edge_strength(bright))[0];
  EXPECT_GT(ratio, 0.75);
  EXPECT_LE(ratio, 1.0);
}

/// A camera that looks along the vehicle's x axis, 1 m/s forward.
FlightViews forward_flight() {
  FlightViews flight;
  flight.rig.intrinsics = kIntrinsics;
  Eigen::Matrix3d R_camera_imu;
  R_camera_imu << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  flight.rig.T_camera_imu.linear() = R_camera_imu;
  flight.rig.T_camera_lidar = flight.rig.T_camera_imu;  // the LiDAR sits at the IMU
  for (int i = 0; i <= 20; ++i) {
    const std::int64_t t_ns = kNanosecondsPerSecond * i / 10;
    flight.trajectory.add_attitude(t_ns, Eigen::Quaterniond::Identity());
    flight.trajectory.add_position(t_ns, {to_seconds(t_ns), 0, 0});
  }
  return flight;
}

TEST(SeenFrom, CarriesPointsAlongAndKeepsToTheWindow) {
  const FlightViews flight = forward_flight();
  ExposureView view;
  view.t_ns = kNanosecondsPerSecond;
  std::vector<LidarReturn> returns;
  for (const double t_s : {0.5, 0.9, 1.1, 1.5}) {
    LidarReturn point;
    point.t_ns = to_nanoseconds(t_s);
    point.p_lidar = {10, 0, 0};
    returns.push_back(point);
  }
  const std::vector<SeenPoint> seen = seen_from(flight, view, returns, 0.5);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_TRUE(seen[0].p_own.isApprox(Eigen::Vector3d(0, 0, 10), 1e-6));
  EXPECT_NEAR((seen[0].T_view_own * seen[0].p_own).z(), 9.9, 1e-6);   // measured 0.1 s before, 0.1 m behind
  EXPECT_NEAR((seen[1].T_view_own * seen[1].p_own).z(), 10.1, 1e-6);  // and after
  // A LiDAR clock that is 0.2 s early: the points were truly taken later.
  const std::vector<SeenPoint> later = seen_from(flight, view, returns, 0.5, to_nanoseconds(0.2));
  ASSERT_EQ(later.size(), 2u);
  EXPECT_NEAR((later[0].T_view_own * later[0].p_own).z(), 10.1, 1e-6);
  EXPECT_NEAR((later[1].T_view_own * later[1].p_own).z(), 10.3, 1e-6);
}

TEST(SeenFrom, NothingIsSeenWithoutAPose) {
  FlightViews flight = forward_flight();
  ExposureView view;
  view.t_ns = 3 * kNanosecondsPerSecond;
  LidarReturn point;
  point.t_ns = view.t_ns;
  point.p_lidar = {10, 0, 0};
  EXPECT_TRUE(seen_from(flight, view, {point}, 0.5).empty());
}

}  // namespace
}  // namespace alight
