#pragma once

#include <chrono>
#include <filesystem>

#include <ros/callback_queue.h>
#include <ros/init.h>

#include "tests/support/programs.hpp"
#include "tests/support/reserved_port.hpp"

namespace alight::test {

/// Whether a ROS master and rosbag's player are installed.
bool ros_is_installed();

/// A ROS master of its own on a loopback port that the kernel gave; this process becomes a node of it.
class RosSession {
 public:
  explicit RosSession(const std::filesystem::path& folder);
  ~RosSession();
  RosSession(const RosSession&) = delete;
  RosSession& operator=(const RosSession&) = delete;

 private:
  ReservedPort port_;
  Program master_;
};

/// Waits for a condition, serving ROS's callbacks. @returns whether it came true
template <class Condition>
bool wait_for(const Condition& condition, double timeout_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
  }
  return true;
}

}  // namespace alight::test
