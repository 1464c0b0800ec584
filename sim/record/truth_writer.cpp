#include "sim/record/truth_writer.hpp"

#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"
#include "geometry/depth_map.hpp"
#include "geometry/frames.hpp"
#include "pictures/picture_file.hpp"

namespace alight::sim {
namespace fs = std::filesystem;
namespace {

constexpr int kFormatVersion = 1;

void create_folder(const fs::path& path) {
  std::error_code code;
  fs::create_directories(path, code);
  if (code) throw DataError(path.string() + ": cannot be created: " + code.message());
}

std::string indented(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += line.empty() ? "\n" : "  " + line + "\n";
  return result;
}

}  // namespace

TruthWriter::TruthWriter(const fs::path& folder, int png_level) : folder_(folder), png_level_(png_level) {
  create_folder(folder_ / "depth");
  create_folder(folder_ / "safe");
}

void TruthWriter::write_frame(std::int64_t stamp_ns, const cv::Mat& depth_m, const cv::Mat& safe) const {
  const std::string name = std::to_string(stamp_ns) + ".png";
  write_picture(folder_ / "depth" / name, encode_depth(depth_m), png_level_);
  write_picture(folder_ / "safe" / name, safe, png_level_);
}

void TruthWriter::write_trajectory(const SimulatedFlight& flight, double rate_hz,
                                   std::int64_t start_ns) const {
  std::string text = "t_ns,x_m,y_m,z_m,qw,qx,qy,qz\n";
  const std::int64_t end_ns = to_nanoseconds(flight.vehicle().duration_s());
  for (std::int64_t k = 0;; ++k) {
    const std::int64_t t_ns = to_nanoseconds(static_cast<double>(k) / rate_hz);
    if (t_ns > end_ns) break;
    const Eigen::Isometry3d T = flight.T_world_imu(to_seconds(t_ns));
    Eigen::Quaterniond q(T.linear());
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    text += fmt::format("{},{:.9f},{:.9f},{:.9f},{:.12f},{:.12f},{:.12f},{:.12f}\n", start_ns + t_ns,
                        T.translation().x(), T.translation().y(), T.translation().z(), q.w(), q.x(), q.y(),
                        q.z());
  }
  write_file_atomically(folder_ / "trajectory.csv", text);
}

void TruthWriter::write_description(const SimConfig& config, const FlightConfig& flight, const Rig& rig,
                                    std::int64_t frames) const {
  SimConfig resolved = config;
  resolved.flights = {flight};
  const std::string rig_text = format_rig(rig);
  std::string text = "format_version: " + std::to_string(kFormatVersion) + "\n";
  text += "flight: " + flight.name + "\n";
  text += "look: " + to_string(flight.world.look) + "\n";
  text += "seed: " + std::to_string(flight.seed) + "\n";
  text += "world_seed: " + std::to_string(flight.world.seed) + "\n";
  text += "frames: " + std::to_string(frames) + "\n";
  text += "config:\n" + indented(print_config(resolved));
  text += "rig:\n" + indented(rig_text);
  write_file_atomically(folder_ / "truth.yaml", text);
  write_file_atomically(folder_ / "rig.yaml", rig_text);
}

}  // namespace alight::sim
