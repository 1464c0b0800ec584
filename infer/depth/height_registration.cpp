#include "infer/depth/height_registration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace alight {
namespace {

constexpr std::size_t kComparedPoints = 4000;
constexpr double kMemory_s = 1.0;
constexpr double kCell_m = 0.25;
constexpr int kMinCells = 10;        // from 2.5 m up the LiDAR covers two dozen of them
constexpr double kFarthest_m = 0.5;  // between two packets; more is no drift

LidarHealthConfig memory() {
  LidarHealthConfig config;
  config.memory_s = kMemory_s;
  config.cell_m = kCell_m;
  return config;
}

}  // namespace

HeightRegistration::HeightRegistration() : ground_(memory()) {}

double HeightRegistration::add(const WorldPacket& packet) {
  const std::size_t step = std::max<std::size_t>(1, packet.points.size() / kComparedPoints);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < packet.points.size(); i += step) points.push_back(packet.points[i].p_world);
  const auto lower = [&](double by_m) {
    for (Eigen::Vector3d& p_world : points) p_world.z() -= by_m;
  };
  lower(shift_m_);
  const GroundFit fit = ground_.fit(points);
  if (fit.cells >= kMinCells) {
    if (std::abs(fit.offset_m) > kFarthest_m) {
      forget();
    } else {
      lower(fit.offset_m);
      shift_m_ += fit.offset_m;
    }
  }
  ground_.add(packet.end_ns, points);
  return shift_m_;
}

}  // namespace alight
