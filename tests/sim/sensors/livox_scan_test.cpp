#include "sim/sensors/livox_scan.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

/// float32 [rows, 2] of a version 1 .npy file.
std::vector<float> read_npy(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string start(10, '\0');
  stream.read(start.data(), 10);
  const auto header_bytes =
      static_cast<unsigned char>(start[8]) + 256U * static_cast<unsigned char>(start[9]);
  std::string header(header_bytes, '\0');
  stream.read(header.data(), static_cast<std::streamsize>(header_bytes));
  EXPECT_EQ(start.substr(1, 5), "NUMPY");
  EXPECT_NE(header.find("'<f4'"), std::string::npos);
  std::vector<float> values(800'000);
  stream.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(float)));
  EXPECT_TRUE(stream);
  return values;
}

double azimuth_rad(const Eigen::Vector3d& d) { return std::atan2(d.y(), d.x()); }
double elevation_rad(const Eigen::Vector3d& d) { return std::asin(d.z()); }

/// Share of the cells of a 0.26 deg azimuth and elevation grid inside the 19.17 deg disc that are hit.
double coverage(double duration_s) {
  constexpr double kCell_deg = 0.26;
  constexpr double kDisc_deg = 19.17;
  constexpr int kReach = 74;
  std::set<std::pair<int, int>> hit;
  const auto shots = static_cast<std::int64_t>(std::llround(duration_s * 1e5));
  for (std::int64_t shot = 0; shot < shots; ++shot) {
    const Eigen::Vector3d d = livox_direction(shot);
    hit.emplace(static_cast<int>(std::floor(to_degrees(azimuth_rad(d)) / kCell_deg)),
                static_cast<int>(std::floor(to_degrees(elevation_rad(d)) / kCell_deg)));
  }
  int cells = 0;
  int covered = 0;
  for (int i = -kReach; i < kReach; ++i) {
    for (int j = -kReach; j < kReach; ++j) {
      if (std::hypot((i + 0.5) * kCell_deg, (j + 0.5) * kCell_deg) > kDisc_deg) continue;
      ++cells;
      covered += static_cast<int>(hit.count({i, j}));
    }
  }
  return 100.0 * covered / cells;
}

TEST(LivoxScan, DirectionsHaveUnitLengthAndStayInsideTheFieldOfView) {
  double widest_rad = 0;
  for (std::int64_t shot = 0; shot < 300'000; ++shot) {
    const Eigen::Vector3d d = livox_direction(shot);
    ASSERT_NEAR(d.norm(), 1.0, 1e-12);
    widest_rad = std::max(widest_rad, std::acos(d.x()));
  }
  EXPECT_LE(widest_rad, kLivoxHalfFov_rad);
  EXPECT_NEAR(to_degrees(widest_rad), 19.174, 0.002);
}

TEST(LivoxScan, ClosesAfterThirtySecondsAndNotBefore) {
  for (const std::int64_t shot : {0, 1, 12'345, 2'999'999}) {
    EXPECT_EQ(livox_direction(shot), livox_direction(shot + kLivoxPatternShots));
    EXPECT_EQ(livox_direction(shot), livox_direction(shot + 1000 * kLivoxPatternShots));
    EXPECT_GT((livox_direction(shot) - livox_direction(shot + kLivoxPatternShots / 2)).norm(), 1e-3);
    EXPECT_GT((livox_direction(shot) - livox_direction(shot + kLivoxPatternShots / 3)).norm(), 1e-3);
  }
}

TEST(LivoxScan, PrismsInLineAddUpAndOpposedCancel) {
  // At t = 0 both wedges bend the beam the same way, to the rim. They turn against each other with 7294 +
  // 4664 rpm: half a relative turn, 60 s / 11958 / 2 = 2.509 ms, later they cancel.
  EXPECT_NEAR(to_degrees(std::acos(livox_direction(0).x())), 19.174, 0.002);
  EXPECT_LT(to_degrees(std::acos(livox_direction(250).x())), 0.2);
}

TEST(LivoxScan, AgreesWithThePublishedTable) {
  const std::filesystem::path path =
      std::filesystem::path(ALIGHT_SOURCE_DIR) / "../shared/data/livox_mid40_scan_table/mid40.npy";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const std::vector<float> table = read_npy(path);
  double worst_rad = 0;
  for (std::size_t row = 0; row < table.size() / 2; ++row) {
    const Eigen::Vector3d d = livox_direction(static_cast<std::int64_t>(row));
    const auto azimuth = static_cast<double>(table[2 * row]);
    const auto elevation = static_cast<double>(table[2 * row + 1]);
    const Eigen::Vector3d expected(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    worst_rad = std::max(worst_rad, d.cross(expected).norm());
  }
  EXPECT_LE(to_degrees(worst_rad), 0.002);
}

struct Coverage {
  double duration_s;
  double percent;
};
class LivoxScanCoverage : public testing::TestWithParam<Coverage> {};

TEST_P(LivoxScanCoverage, GrowsAsPublished) {
  EXPECT_NEAR(coverage(GetParam().duration_s), GetParam().percent, 1.5);
}

INSTANTIATE_TEST_SUITE_P(Table, LivoxScanCoverage,
                         testing::Values(Coverage{0.1, 18.9}, Coverage{0.2, 34.5}, Coverage{0.3, 47.6},
                                         Coverage{0.5, 68.0}, Coverage{0.7, 79.9}, Coverage{1.0, 92.3},
                                         Coverage{1.4, 98.9}));

}  // namespace
}  // namespace alight::sim
