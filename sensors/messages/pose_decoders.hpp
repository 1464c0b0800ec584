#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sensors/messages/decoders.hpp"

namespace alight {

/// geometry_msgs/PointStamped: metres.
std::optional<DecodedMessage> decode_point(const RawMessage& message, const DecodeOptions& options);
/// geometry_msgs/PoseStamped, nav_msgs/Odometry, geometry_msgs/TransformStamped (whatever its frames) and
/// tf2_msgs/TFMessage (empty where `options.frames` are not in it; a transform the other way round is inverted).
std::optional<DecodedMessage> decode_pose_attitude(const RawMessage& message, const DecodeOptions& options);
std::optional<DecodedMessage> decode_pose_position(const RawMessage& message, const DecodeOptions& options);
std::optional<DecodedMessage> decode_odometry_attitude(const RawMessage& message,
                                                       const DecodeOptions& options);
std::optional<DecodedMessage> decode_odometry_position(const RawMessage& message,
                                                       const DecodeOptions& options);
std::optional<DecodedMessage> decode_transform_attitude(const RawMessage& message,
                                                        const DecodeOptions& options);
std::optional<DecodedMessage> decode_transform_position(const RawMessage& message,
                                                        const DecodeOptions& options);
std::optional<DecodedMessage> decode_tf_attitude(const RawMessage& message, const DecodeOptions& options);
std::optional<DecodedMessage> decode_tf_position(const RawMessage& message, const DecodeOptions& options);
/// (parent, child) of the transforms of a tf2_msgs/TFMessage. @throws DecodeError
std::vector<std::pair<std::string, std::string>> transform_frames(const RawMessage& message);

}  // namespace alight
