#include "tests/ros/ros_session.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <ros/master.h>
#include <ros/node_handle.h>
#include <sys/wait.h>
#include <unistd.h>

namespace alight::test {
namespace fs = std::filesystem;
namespace {

constexpr double kMasterTimeout_s = 60;
constexpr double kEndTimeout_s = 20;

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

Program::Program(const std::vector<std::string>& command, fs::path log) : log_(std::move(log)) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ == 0) {
    setpgid(0, 0);
    const int file = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, 0);
    dup2(file, 1);
    dup2(file, 2);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  setpgid(pid_, pid_);
}

Program::~Program() {
  if (!running()) return;
  kill(-pid_, SIGINT);
  wait(kEndTimeout_s);
}

bool Program::running() {
  int status = 0;
  if (pid_ < 0) return false;
  if (waitpid(pid_, &status, WNOHANG) == 0) return true;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  pid_ = -1;
  return false;
}

int Program::wait(double timeout_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (running()) {
    if (std::chrono::steady_clock::now() > end) {
      kill(-pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
      pid_ = -1;
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return exit_code_;
}

std::string Program::said() const {
  std::ostringstream text;
  text << std::ifstream(log_).rdbuf();
  return text.str();
}

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
