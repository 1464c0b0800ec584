// The table of scripts/bench/rig_check.sh: simulated flights, checked with the true rig and with rigs that are turned.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>

#include "calibrate/check/rig_check.hpp"
#include "foundation/command_line.hpp"
#include "foundation/errors.hpp"
#include "foundation/shipped_files.hpp"
#include "geometry/frames.hpp"

namespace {

namespace fs = std::filesystem;
using alight::RigVerdict;

constexpr std::array<double, 5> kLidarTurns_deg = {0.15, 0.2, 0.3, 0.4, 0.5};
constexpr double kCameraTurn_deg = 0.1;
constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

struct Options {
  fs::path logs;
  std::string rig = "configs/rigs/paper.yaml";
  alight::ConfigOptions config;
};

std::vector<fs::path> bags_of(const fs::path& folder) {
  std::vector<fs::path> bags;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".bag") bags.push_back(entry.path());
  }
  if (bags.empty()) throw alight::DataError(folder.string() + ": holds no .bag; record some with alight-sim");
  std::sort(bags.begin(), bags.end());
  return bags;
}

/// What became of checks that ought to come out alike.
struct Tally {
  int checks = 0;
  int moved = 0;
  int cannot_tell = 0;
  double worst_deg = 0;  // suggested against true turn, of those that say moved

  void add(RigVerdict verdict) {
    ++checks;
    moved += verdict == RigVerdict::kMoved ? 1 : 0;
    cannot_tell += verdict == RigVerdict::kCannotTell ? 1 : 0;
  }
  void print(const std::string& name) const {
    std::printf("| %s | %d | %d | %d | %d | %.3f |\n", name.c_str(), checks, checks - moved - cannot_tell,
                moved, cannot_tell, worst_deg);
  }
};

Eigen::Isometry3d turned(const Eigen::Isometry3d& T, int axis, double deg) {
  return alight::motion_of(alight::to_radians(deg) * Eigen::Vector3d::Unit(axis), Eigen::Vector3d::Zero()) *
         T;
}

class Bench {
 public:
  Bench(const Options& options, const alight::RigCheckConfig& config)
      : bags_(bags_of(options.logs)),
        rig_(alight::load_rig(alight::input_file(options.rig))),
        config_(config) {}

  void run() {
    std::printf(
        "| flight | depth edges | verdict | stands out | turn x y z [deg] | shift x y z [m] "
        "|\n|---|---:|---|---:|---|---|\n");
    for (std::size_t i = 0; i < bags_.size(); ++i) check(bags_[i], i % 2 == 0 ? 1 : -1);
    std::printf(
        "\n| rig | checks | good | moved | cannot tell | error of the suggested turn, worst [deg] "
        "|\n|---|---:|---:|---:|---:|---:|\n");
    truth_.print("true");
    for (const auto& [key, tally] : lidar_)
      tally.print(std::string("LiDAR turned by ") + std::to_string(key.second).substr(0, 4) + " deg about " +
                  kAxes[static_cast<std::size_t>(key.first)]);
    for (const auto& [axis, tally] : camera_)
      tally.print(std::string("right camera turned by ") + std::to_string(kCameraTurn_deg).substr(0, 4) +
                  " deg about " + kAxes[static_cast<std::size_t>(axis)]);
  }

 private:
  void check(const fs::path& bag, int sign) {
    alight::FlightViews flight = read(bag, rig_);
    const alight::RigCheck good = alight::check_rig(flight, config_);
    print_flight(bag.stem().string(), good);
    truth_.add(good.verdict);
    const Eigen::Isometry3d T_camera_lidar = flight.rig.T_camera_lidar;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double deg : kLidarTurns_deg) {
        flight.rig.T_camera_lidar = turned(T_camera_lidar, axis, sign * deg);
        record(lidar_[{axis, deg}], alight::check_rig(flight, config_), axis, sign * deg);
      }
      alight::Rig rig = rig_;
      rig.T_cam1_cam0 = turned(rig_.T_cam1_cam0, axis, sign * kCameraTurn_deg);
      record(camera_[axis], alight::check_rig(read(bag, rig), config_), 6 + axis, sign * kCameraTurn_deg);
    }
  }

  alight::FlightViews read(const fs::path& bag, const alight::Rig& rig) const {
    return alight::read_flight_views(bag, rig, config_.log, config_.views);
  }

  static void record(Tally& tally, const alight::RigCheck& check, int axis, double turn_deg) {
    tally.add(check.verdict);
    if (check.verdict != RigVerdict::kMoved) return;
    tally.worst_deg =
        std::max(tally.worst_deg, std::abs(check.axes[static_cast<std::size_t>(axis)].by + turn_deg));
  }

  static void print_flight(const std::string& name, const alight::RigCheck& c) {
    std::printf("| %s | %d | %s | %.1f |", name.c_str(), c.edges.edges, alight::name(c.verdict),
                c.edges.stands_out);
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == 3) std::printf(" |");
      if (c.axes[i].found) std::printf(" %+.3f", c.axes[i].by);
    }
    std::printf(" |\n");
    std::fflush(stdout);
  }

  std::vector<fs::path> bags_;
  alight::Rig rig_;
  alight::RigCheckConfig config_;
  Tally truth_;
  std::map<std::pair<int, double>, Tally> lidar_;
  std::map<int, Tally> camera_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures what alight-calibrate check notices, on simulated flights", "rig_check_bench");
  app.footer("Examples:\n  rig_check_bench --logs logs/rig_check");
  Options options;
  alight::add_config_options(app, options.config);
  app.add_option("--logs", options.logs, "Folder with the flights' bags");
  app.add_option("--rig", options.rig, "Their true rig")->capture_default_str();
  return alight::run_tool(app, argc, argv, [&] {
    const auto config = alight::load<alight::RigCheckConfig>(options.config);
    if (alight::print_if_asked(options.config, config)) return alight::kExitOk;
    if (options.logs.empty()) throw alight::ConfigError("--logs: is missing; name a folder with flights");
    Bench(options, config).run();
    return alight::kExitOk;
  });
}
