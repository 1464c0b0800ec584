#include "geometry/rig/calibration_file.hpp"

#include <fstream>
#include <optional>

#include <yaml-cpp/yaml.h>

#include "foundation/config_reader.hpp"
#include "foundation/file_content.hpp"
#include "geometry/frames.hpp"
#include "geometry/rig/kalibr_camera.hpp"
#include "geometry/rig/ros_lens.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

/// Reads values out of a file whose other keys are none of our business.
class ForeignFile {
 public:
  explicit ForeignFile(fs::path path) : path_(std::move(path)) {
    std::optional<std::string> content = file_content(path_);
    if (!content) fail("cannot be opened; check calibration_file of the rig");
    std::string& yaml = *content;
    // OpenCV writes a version with a colon, which no YAML has; a comment keeps the lines where they are.
    if (yaml.rfind("%YAML:", 0) == 0) yaml[0] = '#';
    root_ = config_detail::parse_text(yaml, path_.string()).yaml();
    if (!root_.IsMap()) fail("holds no keys and values");
  }

  const YAML::Node& root() const { return root_; }
  bool has(const std::string& key) const { return at(root_, key).IsDefined(); }

  [[noreturn]] void fail(const std::string& problem) const {
    throw ConfigError(path_.string() + ": " + problem);
  }

  template <class T>
  T value(const YAML::Node& map, const std::string& key) const {
    const YAML::Node node = at(map, key);
    if (!node.IsDefined()) fail("has no " + key);
    T value{};
    if (const std::string expected = config_detail::read(node, value, {}); !expected.empty())
      fail("line " + std::to_string(node.Mark().line + 1) + ": " + key + ": expected " + expected);
    return value;
  }

  /// A list of numbers, or the `data` of a matrix. @param count of them, 0: any
  std::vector<double> numbers(const YAML::Node& map, const std::string& key, std::size_t count = 0) const {
    const YAML::Node node = at(map, key);
    const auto values = node.IsDefined() && node.IsMap() ? value<std::vector<double>>(node, "data")
                                                         : value<std::vector<double>>(map, key);
    if (count != 0 && values.size() != count)
      fail(key + ": expected " + std::to_string(count) + " numbers, got " + std::to_string(values.size()));
    return values;
  }

  static YAML::Node at(const YAML::Node& map, const std::string& key) {
    if (!map.IsDefined() || !map.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    return map[key];
  }

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  YAML::Node root_;
};

void apply_lens(const ForeignFile& file, const std::string& model, const std::vector<double>& coefficients,
                Camera& camera) {
  if (const std::string problem = set_ros_distortion(model, coefficients, camera); !problem.empty())
    file.fail(problem);
}

/// ROS's camera_info and OpenCV's calibration program use the same keys; the latter names no model.
CalibratedCamera read_camera_matrix(const ForeignFile& file) {
  const YAML::Node& root = file.root();
  const std::vector<double> K = file.numbers(root, "camera_matrix", 9);
  CalibratedCamera calibrated;
  calibrated.camera.intrinsics = {
      K[0], K[4], K[2], K[5], file.value<int>(root, "image_width"), file.value<int>(root, "image_height")};
  const bool fisheye = file.has("fisheye_model") && file.value<int>(root, "fisheye_model") != 0;
  const std::string model = file.has("distortion_model") ? file.value<std::string>(root, "distortion_model")
                                                         : (fisheye ? "equidistant" : "plumb_bob");
  apply_lens(file, model, file.numbers(root, "distortion_coefficients"), calibrated.camera);
  return calibrated;
}

std::string size_text(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// The block of the wanted resolution, or the only one.
YAML::Node mynteye_block(const ForeignFile& file, const std::optional<cv::Size>& resolution) {
  const YAML::Node blocks = ForeignFile::at(file.root(), "img_params");
  if (!blocks.IsSequence() || blocks.size() == 0) file.fail("img_params: expected a list of resolutions");
  std::string known;
  for (const YAML::Node& block : blocks) {
    const cv::Size size(file.value<int>(block, "width"), file.value<int>(block, "height"));
    if (resolution ? size == *resolution : blocks.size() == 1) return block;
    known += (known.empty() ? "" : ", ") + size_text(size);
  }
  file.fail((resolution
                 ? "has no calibration for " + size_text(*resolution) + " pixels"
                 : std::string("has calibrations for several resolutions; set resolution in the rig")) +
            " (it has " + known + ")");
}

Camera mynteye_eye(const ForeignFile& file, const YAML::Node& block, const std::string& entry) {
  const YAML::Node eye = ForeignFile::at(block, "in_" + entry);
  if (!eye.IsDefined()) file.fail("has no in_" + entry);
  Camera camera;
  PinholeIntrinsics& k = camera.intrinsics;
  k.width_px = file.value<int>(block, "width");
  k.height_px = file.value<int>(block, "height");
  const int model = file.value<int>(block, "model");
  if (model == 0) {  // pinhole: k1, k2, p1, p2, k3
    k.fx_px = file.value<double>(eye, "fx");
    k.fy_px = file.value<double>(eye, "fy");
    k.cx_px = file.value<double>(eye, "cx");
    k.cy_px = file.value<double>(eye, "cy");
    apply_lens(file, "plumb_bob", file.numbers(eye, "coeffs", 5), camera);
  } else if (model == 1) {  // Kannala-Brandt: k2, k3, k4, k5, mu, mv, u0, v0
    const std::vector<double> c = file.numbers(eye, "coeffs", 8);
    k.fx_px = c[4];
    k.fy_px = c[5];
    k.cx_px = c[6];
    k.cy_px = c[7];
    apply_lens(file, "equidistant", {c[0], c[1], c[2], c[3]}, camera);
  } else {
    file.fail("camera model " + std::to_string(model) + " is neither 0 (pinhole) nor 1 (Kannala-Brandt)");
  }
  return camera;
}

/// `ex_right_to_left` holds, in spite of its name, what cv::stereoRectify takes: p_right = R p_left + t, in millimetres.
/// The right eye is to the right, so t points to -x; where it does not, the file means the other direction.
Eigen::Isometry3d mynteye_right_from_left(const ForeignFile& file, const YAML::Node& block) {
  const YAML::Node node = ForeignFile::at(block, "ex_right_to_left");
  const std::vector<double> r = file.numbers(node, "rotation", 9);
  const std::vector<double> t = file.numbers(node, "translation", 3);
  Eigen::Matrix3d R;
  R << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  if (!is_rotation(R)) file.fail("ex_right_to_left: rotation is no rotation (R^T R = I, det R = +1)");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = nearest_rotation(R);
  T.translation() = Eigen::Vector3d(t[0], t[1], t[2]) * 1e-3;
  return T.translation().x() < 0 ? T : T.inverse();
}

CalibratedCamera read_mynteye(const ForeignFile& file, const std::string& entry,
                              const std::optional<cv::Size>& resolution) {
  if (entry != "left" && entry != "right") file.fail("calibration_entry: expected left or right");
  const YAML::Node block = mynteye_block(file, resolution);
  CalibratedCamera calibrated;
  calibrated.camera = mynteye_eye(file, block, entry);
  if (entry == "right") calibrated.T_camera_previous = mynteye_right_from_left(file, block);
  return calibrated;
}

CalibratedCamera read_kalibr(const ForeignFile& file, const std::string& entry) {
  if (!file.has(entry)) file.fail("has no entry " + entry + "; check calibration_entry of the rig");
  const auto yaml = bind_node<KalibrCamera>(ForeignFile::at(file.root(), entry), file.path().string());
  if (yaml.calibration_file) file.fail("refers to another calibration_file; name that one in the rig");
  return {lens_of(yaml), yaml.T_cn_cnm1, yaml.T_cam_imu, yaml.timeshift_cam_imu};
}

}  // namespace

CalibratedCamera read_calibration_file(const fs::path& path, const std::string& entry,
                                       const std::optional<cv::Size>& resolution) {
  const ForeignFile file(path);
  CalibratedCamera calibrated;
  if (file.has("img_params")) {
    calibrated = read_mynteye(file, entry, resolution);
  } else if (file.has("camera_matrix")) {
    calibrated = read_camera_matrix(file);
  } else if (file.has("cam0") || file.has("cam1")) {
    calibrated = read_kalibr(file, entry.empty() ? "cam0" : entry);
  } else {
    file.fail(
        "is no calibration that is known: Kalibr (cam0), ROS or OpenCV (camera_matrix), MYNT EYE "
        "(img_params)");
  }
  const PinholeIntrinsics& k = calibrated.camera.intrinsics;
  if (!(k.fx_px > 0 && k.fy_px > 0 && k.width_px > 0 && k.height_px > 0))
    file.fail("focal lengths and image size must be positive");
  if (resolution && k.size() != *resolution)
    file.fail("is for " + size_text(k.size()) + " pixels, but the rig says " + size_text(*resolution));
  return calibrated;
}

}  // namespace alight
