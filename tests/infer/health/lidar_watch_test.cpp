#include "infer/health/lidar_watch.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kScanHeight_m = 20;

Eigen::Isometry3d T_imu_lidar() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();  // boresight down, up = forward
  T.linear() << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  return T;
}

/// A LiDAR at 20 m that flies east, at 3 m/s if nothing else is said, over level ground with a house (5 m high) every 12 m, to the left of the way.
class Flight {
 public:
  /// @param drift_mps by which the trajectory's height is off more and more
  explicit Flight(unsigned seed = 1, double speed_mps = 3, double drift_mps = 0)
      : speed_mps_(speed_mps), random_(seed), trajectory_(0.1) {
    for (int i = 0; i <= 600; ++i) {
      trajectory_.add_attitude(at(0.01 * i), Eigen::Quaterniond::Identity());
      trajectory_.add_position(
          at(0.01 * i), Eigen::Vector3d(speed_mps_ * 0.01 * i, 0, kScanHeight_m + drift_mps * 0.01 * i));
    }
  }
  static std::int64_t at(double s) { return to_nanoseconds(s); }
  const Trajectory& trajectory() const { return trajectory_; }

  LidarPacket packet(int k, int count = 10000) {
    std::normal_distribution<double> noise(0, 0.02);
    LidarPacket packet;
    packet.t_ns = at(0.1 * k);
    for (int i = 0; i < count; ++i) {
      LidarReturn echo;
      echo.t_ns = packet.t_ns + (i + 1) * 10'000;
      const Eigen::Vector3d p_world_lidar(speed_mps_ * to_seconds(echo.t_ns), 0, kScanHeight_m);
      // A rosette: neighbouring shots are neighbours on the ground.
      const double shot = 10000.0 * k + i;
      const double left = 0.3 * std::sin(0.0076 * shot) * std::cos(0.00231 * shot);
      const double ahead = 0.3 * std::sin(0.0076 * shot) * std::sin(0.00231 * shot);
      const double x_m = p_world_lidar.x() + ahead * kScanHeight_m;
      const double y_m = left * kScanHeight_m;
      const bool house = y_m > 1 && std::fmod(x_m + 1200, 12) < 5;
      const double range_m = kScanHeight_m - (house ? 5 : 0) + noise(random_);
      echo.p_lidar = (range_m * Eigen::Vector3d(1, left, ahead)).cast<float>();
      packet.returns.push_back(echo);
    }
    return packet;
  }

 private:
  double speed_mps_;
  std::mt19937 random_;
  Trajectory trajectory_;
};

/// 2 s of healthy packets, then 1 s of what `damage` makes of them. @returns the fault at the end; "" for none
std::string fault_after(const std::function<void(LidarPacket&)>& damage) {
  Flight flight;
  LidarWatch watch({}, T_imu_lidar());
  for (int k = 0; k < 20; ++k) EXPECT_TRUE(watch.add(flight.packet(k), flight.trajectory())) << k;
  for (int k = 20; k < 30; ++k) {
    LidarPacket packet = flight.packet(k);
    damage(packet);
    watch.add(packet, flight.trajectory());
  }
  std::vector<HealthFinding> findings;
  watch.report(findings);
  return findings.empty() ? "" : findings.front().fault;
}

TEST(LidarWatch, HealthyPacketsAreUsed) {
  EXPECT_EQ(fault_after([](LidarPacket&) {}), "");
}

TEST(LidarWatch, MirroredEchoesMeetTheGroundOnTheOtherSide) {
  EXPECT_EQ(fault_after([](LidarPacket& p) {
              for (LidarReturn& echo : p.returns) echo.p_lidar.y() *= -1;
            }),
            "mirrored");
}

/// 2 s of healthy packets, 1 s of mirrored ones, then `after_s` of others. @returns whether the LiDAR is used again
bool used_after_mirror(Flight flight, double after_s, bool still_mirrored) {
  LidarWatch watch({}, T_imu_lidar());
  const auto mirror = [](LidarPacket& packet) {
    for (LidarReturn& echo : packet.returns) echo.p_lidar.y() *= -1;
  };
  int k = 0;
  for (; k < 20; ++k) EXPECT_TRUE(watch.add(flight.packet(k), flight.trajectory())) << k;
  for (; k < 30; ++k) {
    LidarPacket packet = flight.packet(k);
    mirror(packet);
    EXPECT_FALSE(watch.add(packet, flight.trajectory())) << k;
  }
  EXPECT_FALSE(watch.usable());
  for (const int end = k + static_cast<int>(10 * after_s); k < end; ++k) {
    LidarPacket packet = flight.packet(k);
    if (still_mirrored) mirror(packet);
    watch.add(packet, flight.trajectory());
  }
  return watch.usable();
}

TEST(LidarWatch, AMirrorThatIsGoneIsForgottenWhereTheGroundFromBeforeShowsIt) {
  EXPECT_FALSE(used_after_mirror(Flight(1, 0.5), 0.9, false));  // not before recover_s
  EXPECT_TRUE(used_after_mirror(Flight(1, 0.5), 1.5, false));
  EXPECT_FALSE(used_after_mirror(Flight(1, 0.5), 2.5, true));
}

TEST(LidarWatch, AMirrorIsNotForgottenOverOtherGround) {
  // 12 m farther, houses stand the same way again; but nothing of it was seen before the mirror came.
  EXPECT_FALSE(used_after_mirror(Flight(1, 12), 2.5, false));
}

TEST(LidarWatch, AMirrorIsForgottenThoughTheHeightHasDrifted) {
  EXPECT_TRUE(used_after_mirror(Flight(1, 0.5, 0.1), 2.5, false));
}

TEST(LidarWatch, SingleEchoesInTheAirAreNoise) {
  EXPECT_EQ(fault_after([](LidarPacket& p) {
              for (std::size_t i = 0; i < p.returns.size(); i += 20) p.returns[i].p_lidar *= 0.2F;
            }),
            "noise");
}

TEST(LidarWatch, HalfThePointsAreMissedAndTheOthersUsed) {
  Flight flight;
  LidarWatch watch({}, T_imu_lidar());
  for (int k = 0; k < 20; ++k) watch.add(flight.packet(k), flight.trajectory());
  for (int k = 20; k < 30; ++k) EXPECT_TRUE(watch.add(flight.packet(k, 5000), flight.trajectory()));
  std::vector<HealthFinding> findings;
  watch.report(findings);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.front().fault, "points missing");
}

TEST(LidarWatch, TheSameEchoesAgainAreFrozen) {
  Flight flight;
  LidarWatch watch({}, T_imu_lidar());
  for (int k = 0; k < 20; ++k) watch.add(flight.packet(k), flight.trajectory());
  LidarPacket last = flight.packet(20);
  EXPECT_TRUE(watch.add(last, flight.trajectory()));
  for (int k = 21; k < 24; ++k) {
    for (LidarReturn& echo : last.returns) echo.t_ns += 100'000'000;
    last.t_ns += 100'000'000;
    EXPECT_FALSE(watch.add(last, flight.trajectory())) << k;
  }
  EXPECT_FALSE(watch.usable());
}

TEST(LidarWatch, GroundThatLiftsContradictsThePoseUntilItStaysAgain) {
  Flight flight;
  LidarWatch watch({}, T_imu_lidar());
  for (int k = 0; k < 20; ++k) watch.add(flight.packet(k), flight.trajectory());
  bool contradicted = false;
  bool recovered = false;
  for (int k = 20; k < 50; ++k) {
    LidarPacket packet = flight.packet(k);
    for (LidarReturn& echo : packet.returns) echo.p_lidar *= 0.9F;
    watch.add(packet, flight.trajectory());
    contradicted = contradicted || !watch.usable();
    recovered = contradicted && watch.usable();
  }
  EXPECT_TRUE(contradicted);
  EXPECT_TRUE(recovered);
}

}  // namespace
}  // namespace alight
