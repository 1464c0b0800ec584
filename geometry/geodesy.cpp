#include "geometry/geodesy.hpp"

#include <GeographicLib/LocalCartesian.hpp>

namespace alight {

struct LocalEnu::Impl {
  GeographicLib::LocalCartesian local;
};

LocalEnu::LocalEnu(double latitude_deg, double longitude_deg, double height_m)
    : impl_(std::make_unique<Impl>(Impl{{latitude_deg, longitude_deg, height_m}})) {}
LocalEnu::~LocalEnu() = default;
LocalEnu::LocalEnu(LocalEnu&&) noexcept = default;
LocalEnu& LocalEnu::operator=(LocalEnu&&) noexcept = default;

Eigen::Vector3d LocalEnu::to_world(double latitude_deg, double longitude_deg, double height_m) const {
  Eigen::Vector3d p_world;
  impl_->local.Forward(latitude_deg, longitude_deg, height_m, p_world.x(), p_world.y(), p_world.z());
  return p_world;
}

Eigen::Vector3d LocalEnu::to_geodetic(const Eigen::Vector3d& p_world) const {
  Eigen::Vector3d geodetic;
  impl_->local.Reverse(p_world.x(), p_world.y(), p_world.z(), geodetic.x(), geodetic.y(), geodetic.z());
  return geodetic;
}

}  // namespace alight
