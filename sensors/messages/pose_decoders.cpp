#include "sensors/messages/pose_decoders.hpp"

#include "sensors/messages/pose_reading.hpp"

/// Messages that carry a pose: attitude and position are read of them separately, so that one topic may serve as either
/// or as both. A position is taken even where its message has no attitude.
namespace alight {
namespace {

/// As in the message: `q` need not have length 1.
struct StampedPose {
  std::int64_t t_ns = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

DecodedMessage attitude_of(const StampedPose& pose) {
  return AttitudeSample{pose.t_ns, unit_quaternion(pose.q)};
}

DecodedMessage position_of(const StampedPose& pose) {
  if (!pose.p.allFinite()) throw DecodeError("position is not finite");
  return PositionSample{pose.t_ns, pose.p};
}

StampedPose read_pose(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  StampedPose pose;
  pose.t_ns = read_stamp(reader, message, options);
  pose.p = read_vector(reader);
  pose.q = read_quaternion(reader);
  reader.expect_end();
  return pose;
}

StampedPose read_odometry(const RawMessage& message, const DecodeOptions& options) {
  constexpr std::size_t kCovarianceBytes = 36 * sizeof(double);
  constexpr std::size_t kTwistBytes = 6 * sizeof(double) + kCovarianceBytes;
  ByteReader reader(message);
  StampedPose pose;
  pose.t_ns = read_stamp(reader, message, options);
  reader.read_string();  // child_frame_id
  pose.p = read_vector(reader);
  pose.q = read_quaternion(reader);
  reader.take(kCovarianceBytes + kTwistBytes);
  reader.expect_end();
  return pose;
}

struct NamedTransform {
  std::string_view parent;
  std::string_view child;
  StampedPose pose;  ///< of the child in the parent
};

NamedTransform read_named_transform(ByteReader& reader, const RawMessage& message,
                                    const DecodeOptions& options) {
  NamedTransform transform;
  const MessageHeader header = reader.read_header();
  transform.parent = header.frame_id;
  transform.pose.t_ns = options.stamp == StampSource::kHeader ? header.stamp_ns : message.receive_ns;
  transform.child = reader.read_string();
  transform.pose.p = read_vector(reader);
  transform.pose.q = read_quaternion(reader);
  return transform;
}

StampedPose read_transform(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  const NamedTransform transform = read_named_transform(reader, message, options);
  reader.expect_end();
  return transform.pose;
}

/// Old and new drivers name the same frame with and without a slash before it.
bool same_frame(std::string_view a, std::string_view b) {
  if (!a.empty() && a.front() == '/') a.remove_prefix(1);
  if (!b.empty() && b.front() == '/') b.remove_prefix(1);
  return a == b;
}

StampedPose inverse(const StampedPose& pose) {
  const Eigen::Quaterniond q = unit_quaternion(pose.q).conjugate();
  return {pose.t_ns, -(q * pose.p), q};
}

/// Of several transforms between the two frames in one message the last one.
std::optional<StampedPose> read_tf(const RawMessage& message, const DecodeOptions& options) {
  const auto& [world, body] = options.frames;
  if (world.empty() || body.empty())
    throw DecodeError("transforms between which frames? Set log.tf_world_frame and log.tf_body_frame");
  ByteReader reader(message);
  const auto count = reader.read<std::uint32_t>();
  std::optional<StampedPose> found;
  for (std::uint32_t i = 0; i < count; ++i) {
    const NamedTransform transform = read_named_transform(reader, message, options);
    if (same_frame(transform.parent, world) && same_frame(transform.child, body)) found = transform.pose;
    if (same_frame(transform.parent, body) && same_frame(transform.child, world))
      found = inverse(transform.pose);
  }
  reader.expect_end();
  return found;
}

}  // namespace

std::optional<DecodedMessage> decode_point(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  StampedPose pose;
  pose.t_ns = read_stamp(reader, message, options);
  pose.p = read_vector(reader);
  reader.expect_end();
  return position_of(pose);
}

std::optional<DecodedMessage> decode_pose_attitude(const RawMessage& message, const DecodeOptions& options) {
  return attitude_of(read_pose(message, options));
}
std::optional<DecodedMessage> decode_pose_position(const RawMessage& message, const DecodeOptions& options) {
  return position_of(read_pose(message, options));
}

std::optional<DecodedMessage> decode_odometry_attitude(const RawMessage& message,
                                                       const DecodeOptions& options) {
  return attitude_of(read_odometry(message, options));
}
std::optional<DecodedMessage> decode_odometry_position(const RawMessage& message,
                                                       const DecodeOptions& options) {
  return position_of(read_odometry(message, options));
}

std::optional<DecodedMessage> decode_transform_attitude(const RawMessage& message,
                                                        const DecodeOptions& options) {
  return attitude_of(read_transform(message, options));
}
std::optional<DecodedMessage> decode_transform_position(const RawMessage& message,
                                                        const DecodeOptions& options) {
  return position_of(read_transform(message, options));
}

std::vector<std::pair<std::string, std::string>> transform_frames(const RawMessage& message) {
  ByteReader reader(message);
  const auto count = reader.read<std::uint32_t>();
  std::vector<std::pair<std::string, std::string>> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    const NamedTransform transform = read_named_transform(reader, message, {});
    frames.emplace_back(transform.parent, transform.child);
  }
  reader.expect_end();
  return frames;
}

std::optional<DecodedMessage> decode_tf_attitude(const RawMessage& message, const DecodeOptions& options) {
  const std::optional<StampedPose> pose = read_tf(message, options);
  if (!pose) return std::nullopt;
  return attitude_of(*pose);
}
std::optional<DecodedMessage> decode_tf_position(const RawMessage& message, const DecodeOptions& options) {
  const std::optional<StampedPose> pose = read_tf(message, options);
  if (!pose) return std::nullopt;
  return position_of(*pose);
}

}  // namespace alight
