#include "sensors/messages/point_cloud_decoder.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sensors/messages/lidar_points.hpp"
#include "sensors/messages/point_times.hpp"

namespace alight {
namespace {

/// sensor_msgs/PointField's constants.
enum class FieldType : std::uint8_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kFloat32 = 7,
  kFloat64 = 8
};
constexpr std::array<std::size_t, 9> kFieldBytes = {0, 1, 1, 2, 2, 4, 4, 4, 8};

struct CloudField {
  std::string name;
  std::uint32_t offset = 0;
  FieldType type = FieldType::kFloat32;

  std::size_t bytes() const { return kFieldBytes[static_cast<std::size_t>(type)]; }
  TimeNumber time_number() const {
    if (type == FieldType::kFloat64) return TimeNumber::kDouble;
    return type == FieldType::kFloat32 ? TimeNumber::kSingle : TimeNumber::kWhole;
  }
};

template <class Number>
double number_at(const std::uint8_t* at, bool big_endian) {
  std::array<std::uint8_t, sizeof(Number)> bytes;
  std::copy_n(at, sizeof(Number), bytes.begin());
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  Number number;
  std::memcpy(&number, bytes.data(), sizeof(Number));
  return static_cast<double>(number);
}

double value_at(const std::uint8_t* point, const CloudField& field, bool big_endian) {
  const std::uint8_t* at = point + field.offset;
  switch (field.type) {
    case FieldType::kInt8:
      return number_at<std::int8_t>(at, big_endian);
    case FieldType::kUint8:
      return number_at<std::uint8_t>(at, big_endian);
    case FieldType::kInt16:
      return number_at<std::int16_t>(at, big_endian);
    case FieldType::kUint16:
      return number_at<std::uint16_t>(at, big_endian);
    case FieldType::kInt32:
      return number_at<std::int32_t>(at, big_endian);
    case FieldType::kUint32:
      return number_at<std::uint32_t>(at, big_endian);
    case FieldType::kFloat32:
      return number_at<float>(at, big_endian);
    case FieldType::kFloat64:
      break;
  }
  return number_at<double>(at, big_endian);
}

/// What precedes the points, and where they are. Every size is checked against the bytes that are there.
struct Cloud {
  ScanStamp stamp;
  std::string frame_id;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<CloudField> fields;
  bool big_endian = false;
  std::uint32_t point_step = 0;
  std::uint64_t row_step = 0;
  const std::uint8_t* data = nullptr;

  std::size_t count() const { return std::size_t{height} * width; }
  const std::uint8_t* point(std::size_t i) const {
    return data + (i / width) * row_step + (i % width) * point_step;
  }
  std::string names() const {
    std::string names;
    for (const CloudField& field : fields) names += (names.empty() ? "" : ", ") + field.name;
    return names;
  }
  const CloudField* find(const std::string& name) const {
    for (const CloudField& field : fields) {
      if (field.name == name) return &field;
    }
    return nullptr;
  }
  const CloudField* find_first(std::initializer_list<const char*> candidates) const {
    for (const char* name : candidates) {
      if (const CloudField* field = find(name)) return field;
    }
    return nullptr;
  }
  const CloudField& require(const std::string& name, const std::string& hint = "") const {
    const CloudField* field = find(name);
    if (field == nullptr) throw DecodeError("no field " + name + " among " + names().substr(0, 200) + hint);
    return *field;
  }
};

std::vector<CloudField> read_fields(ByteReader& reader) {
  const auto count = reader.read<std::uint32_t>();
  std::vector<CloudField> fields;
  for (std::uint32_t i = 0; i < count; ++i) {
    CloudField field;
    field.name = std::string(reader.read_string());
    field.offset = reader.read<std::uint32_t>();
    const auto type = reader.read<std::uint8_t>();
    reader.read<std::uint32_t>();  // count: of arrays the first element is what the name means
    if (type == 0 || type >= kFieldBytes.size()) {
      throw DecodeError("field " + field.name.substr(0, 40) + " of the unknown type " + std::to_string(type));
    }
    field.type = static_cast<FieldType>(type);
    fields.push_back(std::move(field));
  }
  return fields;
}

void check_layout(const Cloud& cloud, std::uint64_t bytes) {
  for (const CloudField& field : cloud.fields) {
    if (std::uint64_t{field.offset} + field.bytes() > cloud.point_step) {
      throw DecodeError("field " + field.name.substr(0, 40) + " ends behind its point of " +
                        std::to_string(cloud.point_step) + " bytes");
    }
  }
  const std::uint64_t row_bytes = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.row_step < row_bytes || cloud.row_step * cloud.height != bytes) {
    throw DecodeError("cloud of " + std::to_string(bytes) + " bytes, but " + std::to_string(cloud.height) +
                      " rows of " + std::to_string(cloud.row_step) + " (" + std::to_string(cloud.width) +
                      " points of " + std::to_string(cloud.point_step) + ")");
  }
}

Cloud read_cloud(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  Cloud cloud;
  const MessageHeader header = reader.read_header();
  cloud.stamp.header_ns = header.stamp_ns;
  cloud.frame_id = header.frame_id;
  cloud.stamp.is_header = options.stamp == StampSource::kHeader;
  cloud.stamp.chosen_ns = cloud.stamp.is_header ? cloud.stamp.header_ns : message.receive_ns;
  cloud.height = reader.read<std::uint32_t>();
  cloud.width = reader.read<std::uint32_t>();
  cloud.fields = read_fields(reader);
  cloud.big_endian = reader.read<std::uint8_t>() != 0;
  cloud.point_step = reader.read<std::uint32_t>();
  cloud.row_step = reader.read<std::uint32_t>();
  const auto bytes = reader.read<std::uint32_t>();
  if (cloud.height <= 1) {
    cloud.row_step = std::uint64_t{cloud.width} * cloud.point_step;  // of one row drivers forget it
  }
  cloud.data = reader.take(bytes);
  reader.read<std::uint8_t>();  // is_dense: points are judged one by one
  reader.expect_end();
  check_layout(cloud, bytes);
  return cloud;
}

const CloudField* time_field(const Cloud& cloud, const PointTiming& timing) {
  if (timing.field == "none") return nullptr;
  if (timing.field == "auto")
    return cloud.find_first({"t", "time", "timestamp", "offset_time", "time_stamp"});
  return &cloud.require(timing.field, "; check point_time of the rig's lidar0");
}

/// Seconds and nanoseconds of a time in two fields (Luminar), together in nanoseconds.
struct SplitTime {
  const CloudField* seconds = nullptr;
  const CloudField* nanoseconds = nullptr;
};
std::optional<SplitTime> split_time(const Cloud& cloud, const PointTiming& timing) {
  const SplitTime split{cloud.find("time_sec"), cloud.find("time_nsec")};
  const bool there = split.seconds != nullptr && split.nanoseconds != nullptr;
  return there && timing.field == "auto" ? std::optional<SplitTime>(split) : std::nullopt;
}

std::vector<double> values_of(const Cloud& cloud, const CloudField& field) {
  std::vector<double> values;
  values.reserve(cloud.count());
  for (std::size_t i = 0; i < cloud.count(); ++i)
    values.push_back(value_at(cloud.point(i), field, cloud.big_endian));
  return values;
}

std::vector<Eigen::Vector3f> positions_of(const Cloud& cloud) {
  const CloudField& x = cloud.require("x");
  const CloudField& y = cloud.require("y");
  const CloudField& z = cloud.require("z");
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(cloud.count());
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    const std::uint8_t* point = cloud.point(i);
    positions.emplace_back(static_cast<float>(value_at(point, x, cloud.big_endian)),
                           static_cast<float>(value_at(point, y, cloud.big_endian)),
                           static_cast<float>(value_at(point, z, cloud.big_endian)));
  }
  return positions;
}

/// Of points without echo drivers write whatever they like.
void leave_out_without_echo(const std::vector<Eigen::Vector3f>& positions, const DecodeOptions& options,
                            std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_echo(positions[i], options)) values[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

std::vector<std::int64_t> times_of(const Cloud& cloud, const std::vector<Eigen::Vector3f>& positions,
                                   const DecodeOptions& options) {
  const PointTiming& timing = options.points;
  if (const auto split = split_time(cloud, timing)) {
    std::vector<double> values_ns = values_of(cloud, *split->nanoseconds);
    const std::vector<double> seconds = values_of(cloud, *split->seconds);
    for (std::size_t i = 0; i < values_ns.size(); ++i) values_ns[i] += seconds[i] * 1e9;
    leave_out_without_echo(positions, options, values_ns);
    PointTiming in_ns = timing;
    in_ns.unit = PointTiming::Unit::kNanoseconds;
    return times_of_values(values_ns, TimeNumber::kDouble, in_ns, cloud.stamp, options.point_times);
  }
  const CloudField* time = time_field(cloud, timing);
  if (time == nullptr) return spread_times(positions, timing, cloud.stamp);
  std::vector<double> values = values_of(cloud, *time);
  leave_out_without_echo(positions, options, values);
  return times_of_values(values, time->time_number(), timing, cloud.stamp, options.point_times);
}

}  // namespace

std::optional<DecodedMessage> decode_point_cloud(const RawMessage& message, const DecodeOptions& options) {
  const Cloud cloud = read_cloud(message, options);
  const std::vector<Eigen::Vector3f> positions = positions_of(cloud);
  const CloudField* reflectivity = cloud.find_first({"reflectivity", "intensity", "i"});
  LidarPacket out;
  out.t_ns = cloud.stamp.chosen_ns;
  out.frame_id = cloud.frame_id;
  if (positions.empty()) return out;
  const std::vector<std::int64_t> times_ns = times_of(cloud, positions, options);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (times_ns[i] == kNoTime_ns || !is_echo(positions[i], options)) continue;
    LidarReturn point{times_ns[i], positions[i], 0};
    if (reflectivity != nullptr) {
      point.reflectivity = scaled_reflectivity(value_at(cloud.point(i), *reflectivity, cloud.big_endian),
                                               options.reflectivity_scale);
    }
    out.returns.push_back(point);
  }
  out.dropped = static_cast<std::int64_t>(positions.size() - out.returns.size());
  return out;
}

}  // namespace alight
