#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sensor_msgs/PointCloud2.h>

namespace alight::testing {

/// How the points of a cloud lie in its bytes.
struct CloudLayout {
  struct Field {
    std::string name;
    std::uint8_t type = sensor_msgs::PointField::FLOAT32;
    std::uint32_t offset = 0;
  };
  std::vector<Field> fields;
  std::uint32_t point_step = 0;
  bool big_endian = false;
};

/// x y z intensity tag line: 18 bytes, no time (Livox).
CloudLayout livox_layout();
/// x y z intensity ring time: 22 bytes, seconds since the begin of the scan (Velodyne).
CloudLayout velodyne_layout();
/// x y z intensity ring: 18 bytes, no time (KITTI as bags have it).
CloudLayout kitti_layout();

/// One row of points, each with a value a field of the layout.
sensor_msgs::PointCloud2 cloud_message(std::int64_t t_ns, const CloudLayout& layout,
                                       const std::vector<std::vector<double>>& points);

}  // namespace alight::testing
