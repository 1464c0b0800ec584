#include "tests/sensors/messages/cloud_message.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "tests/sensors/test_flight.hpp"

namespace alight::testing {
namespace {

using sensor_msgs::PointField;

template <class Number>
void put(std::uint8_t* at, double value, bool big_endian) {
  const auto number = static_cast<Number>(value);
  std::memcpy(at, &number, sizeof(Number));
  if (big_endian) std::reverse(at, at + sizeof(Number));
}

void put(std::uint8_t* at, std::uint8_t type, double value, bool big_endian) {
  switch (type) {
    case PointField::INT8:
      return put<std::int8_t>(at, value, big_endian);
    case PointField::UINT8:
      return put<std::uint8_t>(at, value, big_endian);
    case PointField::INT16:
      return put<std::int16_t>(at, value, big_endian);
    case PointField::UINT16:
      return put<std::uint16_t>(at, value, big_endian);
    case PointField::INT32:
      return put<std::int32_t>(at, value, big_endian);
    case PointField::UINT32:
      return put<std::uint32_t>(at, value, big_endian);
    case PointField::FLOAT32:
      return put<float>(at, value, big_endian);
    case PointField::FLOAT64:
      return put<double>(at, value, big_endian);
    default:
      throw std::invalid_argument("no such field type");
  }
}

}  // namespace

CloudLayout livox_layout() {
  return {{{"x", PointField::FLOAT32, 0},
           {"y", PointField::FLOAT32, 4},
           {"z", PointField::FLOAT32, 8},
           {"intensity", PointField::FLOAT32, 12},
           {"tag", PointField::UINT8, 16},
           {"line", PointField::UINT8, 17}},
          18};
}

CloudLayout velodyne_layout() {
  CloudLayout layout = kitti_layout();
  layout.fields.push_back({"time", PointField::FLOAT32, 18});
  layout.point_step = 22;
  return layout;
}

CloudLayout kitti_layout() {
  return {{{"x", PointField::FLOAT32, 0},
           {"y", PointField::FLOAT32, 4},
           {"z", PointField::FLOAT32, 8},
           {"intensity", PointField::FLOAT32, 12},
           {"ring", PointField::UINT16, 16}},
          18};
}

sensor_msgs::PointCloud2 cloud_message(std::int64_t t_ns, const CloudLayout& layout,
                                       const std::vector<std::vector<double>>& points) {
  sensor_msgs::PointCloud2 message;
  message.header = header_at(t_ns);
  message.height = 1;
  message.width = static_cast<std::uint32_t>(points.size());
  message.is_bigendian = layout.big_endian ? 1 : 0;
  message.point_step = layout.point_step;
  message.row_step = message.width * layout.point_step;
  for (const CloudLayout::Field& field : layout.fields) {
    PointField description;
    description.name = field.name;
    description.offset = field.offset;
    description.datatype = field.type;
    description.count = 1;
    message.fields.push_back(description);
  }
  message.data.resize(std::size_t{message.row_step}, 0xA5);  // gaps between fields hold anything
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t f = 0; f < layout.fields.size(); ++f) {
      const CloudLayout::Field& field = layout.fields[f];
      put(&message.data[i * layout.point_step + field.offset], field.type, points[i].at(f),
          layout.big_endian);
    }
  }
  return message;
}

}  // namespace alight::testing
