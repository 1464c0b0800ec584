#pragma once

#include <memory>

#include <Eigen/Core>

namespace alight {

/// WGS84 geodetic coordinates to the local East-North-Up frame of a first fix
/// (GeographicLib::LocalCartesian).
class LocalEnu {
 public:
  /// Latitude and longitude in degrees, height over the ellipsoid in metres: the origin of `world`.
  LocalEnu(double latitude_deg, double longitude_deg, double height_m);
  ~LocalEnu();
  LocalEnu(LocalEnu&&) noexcept;
  LocalEnu& operator=(LocalEnu&&) noexcept;

  Eigen::Vector3d to_world(double latitude_deg, double longitude_deg, double height_m) const;
  /// (latitude_deg, longitude_deg, height_m)
  Eigen::Vector3d to_geodetic(const Eigen::Vector3d& p_world) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace alight
