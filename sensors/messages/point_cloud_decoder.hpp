#pragma once

#include <optional>

#include "sensors/messages/decoders.hpp"

namespace alight {

/// sensor_msgs/PointCloud2 with x, y, z and, where there are, intensity or reflectivity and a time of each point, in
/// whatever order, type and byte order.
std::optional<DecodedMessage> decode_point_cloud(const RawMessage& message, const DecodeOptions& options);

}  // namespace alight
