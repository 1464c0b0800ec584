#include "dataset/store/dataset_info.hpp"

#include <fstream>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "dataset/store/flight_section.hpp"
#include "foundation/config_reader.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

struct RigSection {
  PinholeIntrinsics intrinsics;
  double baseline_m = 0;
  std::vector<std::vector<double>> T_camera_lidar = matrix_rows(Eigen::Isometry3d::Identity());
  std::vector<std::vector<double>> T_camera_imu = matrix_rows(Eigen::Isometry3d::Identity());
};

/// dataset.yaml as it stands in the file.
struct InfoFile {
  int format_version = 0;
  double depth_scale = 0;
  double window_before_s = 0;
  double window_after_s = 0;
  RigSection rig;
  std::vector<FlightSection> flights;
  std::string config;
  bool with_config = true;
};

void bind_transform(Binder& b, const std::string& key, std::vector<std::vector<double>>& rows,
                    const std::string& help) {
  b.required(key, rows, help);
  b.check(key, isometry_from_rows(rows).has_value(), "is no 4x4 rigid transform");
}

void bind(Binder& b, RigSection& c) {
  b.required("fx_px", c.intrinsics.fx_px, "focal length", positive());
  b.required("fy_px", c.intrinsics.fy_px, "focal length", positive());
  b.required("cx_px", c.intrinsics.cx_px, "principal point, 0 = centre of the left-most pixel");
  b.required("cy_px", c.intrinsics.cy_px, "principal point, 0 = centre of the top pixel");
  b.required("width_px", c.intrinsics.width_px, "image size", at_least(1));
  b.required("height_px", c.intrinsics.height_px, "image size", at_least(1));
  b.required("baseline_m", c.baseline_m, "right camera's distance, 0: mono", at_least(0));
  bind_transform(b, "T_camera_lidar", c.T_camera_lidar, "maps LiDAR to rectified left camera coordinates");
  bind_transform(b, "T_camera_imu", c.T_camera_imu, "maps IMU to rectified left camera coordinates");
}

void bind(Binder& b, InfoFile& c) {
  b.required("format_version", c.format_version, "of this folder", at_least(1));
  b.required("depth_scale", c.depth_scale, "file value = depth_scale * metres", positive());
  b.required("window_before_s", c.window_before_s, "points measured up to this long before the image",
             at_least(0));
  b.required("window_after_s", c.window_after_s, "and after it", at_least(0));
  b.section("rig", c.rig, "of the rectified, cropped images");
  b.list("flights", c.flights, "one a log");
  if (c.with_config) b.field("config", c.config, "the configuration that built it");
}

InfoFile to_file(const DatasetInfo& info) {
  InfoFile file{
      info.format_version, info.depth_scale, info.window_before_s, info.window_after_s, {}, {}, {}, false};
  file.rig = {info.rig.intrinsics, info.rig.baseline_m, matrix_rows(info.rig.T_camera_lidar),
              matrix_rows(info.rig.T_camera_imu)};
  for (const FlightEntry& flight : info.flights) file.flights.push_back(to_section(flight));
  return file;
}

DatasetInfo from_file(const InfoFile& file) {
  DatasetInfo info;
  info.format_version = file.format_version;
  info.depth_scale = file.depth_scale;
  info.window_before_s = file.window_before_s;
  info.window_after_s = file.window_after_s;
  info.accumulation_s = file.window_before_s + file.window_after_s;
  info.rig = {file.rig.intrinsics, file.rig.baseline_m, *isometry_from_rows(file.rig.T_camera_lidar),
              *isometry_from_rows(file.rig.T_camera_imu)};
  for (const FlightSection& section : file.flights) info.flights.push_back(from_section(section));
  info.config = file.config;
  return info;
}

std::string indented(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) out += "  " + line + "\n";
  return out;
}

/// A newer version may have any keys, so the version is looked at before anything else.
void check_version(const YAML::Node& document, const fs::path& path) {
  const YAML::Node node = document.IsMap() ? document["format_version"] : YAML::Node();
  int version = 0;
  if (!node.IsDefined() || !YAML::convert<int>::decode(node, version)) {
    throw DataError(path.string() + ": has no format_version; it is no data set of alight-dataset build");
  }
  if (version > kDatasetFormatVersion) {
    throw DataError(path.string() + ": format version " + std::to_string(version) +
                    " is newer than this program, " + "which reads up to " +
                    std::to_string(kDatasetFormatVersion) + "; update Alight");
  }
}

}  // namespace

void write_dataset_info(const fs::path& dir, const DatasetInfo& info) {
  const fs::path path = dir / "dataset.yaml";
  std::ofstream stream(path, std::ios::binary);
  stream << print_config(to_file(info));
  if (!info.config.empty())
    stream << "config: |  # the configuration that built it\n" << indented(info.config);
  stream.flush();
  if (!stream) throw DataError(path.string() + ": cannot be written; check the free space");
}

DatasetInfo read_dataset_info(const fs::path& dir) {
  const fs::path path = dir / "dataset.yaml";
  std::error_code code;
  if (!fs::is_regular_file(path, code)) {
    throw DataError(path.string() + ": is missing; " + dir.string() +
                    " is no data set (make one with alight-dataset build)");
  }
  try {
    const YAML::Node document = config_detail::parse_file(path).yaml();
    check_version(document, path);
    return from_file(bind_node<InfoFile>(document, path.string()));
  } catch (const ConfigError& e) {
    throw DataError(e.what());
  }
}

}  // namespace alight
