#include "tests/ros/ros_session.hpp"

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <ros/master.h>
#include <ros/node_handle.h>

namespace alight::test {
namespace fs = std::filesystem;
namespace {

constexpr double kMasterTimeout_s = 60;

/// The environment that every program of the session inherits.
void prepare_environment(const fs::path& folder, const std::string& port) {
  setenv("ROS_MASTER_URI", ("http://127.0.0.1:" + port).c_str(), 1);
  setenv("ROS_IP", "127.0.0.1", 1);
  unsetenv("ROS_HOSTNAME");
  unsetenv("ROS_NAMESPACE");
  setenv("ROS_HOME", folder.c_str(), 1);
  setenv("ROS_LOG_DIR", (folder / "log").c_str(), 1);
}

std::vector<std::string> master_command(const fs::path& folder, const ReservedPort& port) {
  prepare_environment(folder, std::to_string(port.number()));
  return {"/usr/bin/roscore", "-p", std::to_string(port.number())};
}

}  // namespace

bool ros_is_installed() {
  return fs::exists("/usr/bin/roscore") && fs::exists("/usr/bin/rosmaster") && fs::exists("/usr/bin/rosbag");
}

RosSession::RosSession(const fs::path& folder)
    : master_(master_command(folder, port_), folder / "roscore.log") {
  int argc = 0;
  ros::init(argc, nullptr, "alight_test", ros::init_options::NoSigintHandler);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kMasterTimeout_s);
  while (!ros::master::check()) {
    if (std::chrono::steady_clock::now() > end || !master_.running())
      throw std::runtime_error("roscore does not start: " + master_.said());
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

RosSession::~RosSession() { ros::shutdown(); }

}  // namespace alight::test
