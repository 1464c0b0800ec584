#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sensors/messages/message_types.hpp"

namespace alight {

/// Holds a topic to one LiDAR. Drivers may publish several under one name, told apart by lidar_id or frame_id alone; each
/// hangs elsewhere, so that one rig file is wrong for the others.
class OneSensor {
 public:
  /// @param lidar_id the one that is calibrated; none: the topic may hold one only
  explicit OneSensor(std::optional<int> lidar_id) : lidar_id_(lidar_id) {}

  /// @returns false: of another LiDAR than the chosen one, to be left out. @throws DecodeError where none was chosen and
  /// this is not the sensor of the messages before
  bool wanted(const LidarPacket& packet);

 private:
  std::optional<int> lidar_id_;
  std::optional<int> first_id_;
  std::optional<std::string> first_frame_;
};

}  // namespace alight
