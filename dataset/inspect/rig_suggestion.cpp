#include "dataset/inspect/rig_suggestion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

/// Stamps farther from the receive time than any latency: the driver's clock is another one.
constexpr double kOtherClock_s = 10;
const std::string kCompressed = "/compressed";

std::string describe(const CameraImage& image) {
  return fmt::format("{}x{} pixels, {}", image.image.cols, image.image.rows,
                     image.image.channels() == 1 ? "grey" : "colour");
}

std::string describe(const LidarPacket& packet) {
  if (packet.returns.empty()) return fmt::format("no echo among {} points", packet.dropped);
  const auto [first, last] =
      std::minmax_element(packet.returns.begin(), packet.returns.end(),
                          [](const LidarReturn& a, const LidarReturn& b) { return a.t_ns < b.t_ns; });
  return fmt::format("{} points from {:+.4f} to {:+.4f} s of the stamp, {} without echo or out of range",
                     packet.returns.size(), to_seconds(first->t_ns - packet.t_ns),
                     to_seconds(last->t_ns - packet.t_ns), packet.dropped);
}

std::string describe(const AttitudeSample& sample) {
  const Eigen::Quaterniond& q = sample.q_world_imu;
  return fmt::format("w {:.3f}, x {:.3f}, y {:.3f}, z {:.3f}", q.w(), q.x(), q.y(), q.z());
}

std::string describe(const PositionSample& sample) {
  if (const auto* p = std::get_if<Eigen::Vector3d>(&sample.position))
    return fmt::format("x {:.2f}, y {:.2f}, z {:.2f} m", p->x(), p->y(), p->z());
  const auto& fix = std::get<GeodeticPosition>(sample.position);
  return fmt::format("latitude {:.6f}, longitude {:.6f} deg, altitude {:.1f} m", fix.latitude_deg,
                     fix.longitude_deg, fix.altitude_m);
}

std::string describe(const HeightSample& sample) { return fmt::format("{:.2f} m", sample.height_m); }

const char* lens_name(DistortionModel model) {
  if (model == DistortionModel::kNone) return "none";
  return model == DistortionModel::kRadtan ? "radtan" : "equidistant";
}

std::string describe(const CameraDescription& description) {
  const PinholeIntrinsics& k = description.camera.intrinsics;
  return fmt::format("{}x{} pixels, f {:.2f} {:.2f}, c {:.2f} {:.2f} px, {}", k.width_px, k.height_px,
                     k.fx_px, k.fy_px, k.cx_px, k.cy_px, lens_name(description.camera.distortion_model));
}

std::vector<const TopicReport*> serving(const BagReport& report, LogRole role) {
  std::vector<const TopicReport*> topics;
  for (const TopicReport& topic : report.topics) {
    if (topic.serves_as(role) != nullptr) topics.push_back(&topic);
  }
  return topics;
}

/// The topic whose type comes first in the table of decoders, of those the one with most messages.
const TopicReport* best(const BagReport& report, LogRole role) {
  for (const Decoder& decoder : decoders()) {
    const TopicReport* chosen = nullptr;
    if (decoder.role != role) continue;
    for (const TopicReport* topic : serving(report, role)) {
      const bool streams = topic->messages > 1;  // static transforms come once
      if (streams && topic->type == decoder.type && (chosen == nullptr || topic->messages > chosen->messages))
        chosen = topic;
    }
    if (chosen != nullptr) return chosen;
  }
  return nullptr;
}

std::string without_compressed(const std::string& topic) {
  const bool ends = topic.size() > kCompressed.size() &&
                    topic.compare(topic.size() - kCompressed.size(), kCompressed.size(), kCompressed) == 0;
  return ends ? topic.substr(0, topic.size() - kCompressed.size()) : topic;
}

struct Cameras {
  const TopicReport* cam0 = nullptr;
  const TopicReport* cam1 = nullptr;
};

/// A pair of names that tells left from right, else the first camera alone.
Cameras choose_cameras(const BagReport& report) {
  constexpr std::array<std::array<const char*, 2>, 5> kNames = {{{"left", "right"},
                                                                 {"cam0", "cam1"},
                                                                 {"image_0", "image_1"},
                                                                 {"camera_0", "camera_1"},
                                                                 {"/0/", "/1/"}}};
  const auto images = serving(report, LogRole::kImage);
  for (const auto& [left, right] : kNames) {
    for (const TopicReport* image : images) {
      std::string twin = image->topic;
      const std::size_t at = twin.find(left);
      if (at == std::string::npos) continue;
      twin.replace(at, std::string(left).size(), right);
      for (const TopicReport* other : images) {
        if (other->topic == twin) return {image, other};
      }
    }
  }
  return {images.empty() ? nullptr : images.front(), nullptr};
}

std::string_view without_slash(const std::string& topic) {
  return std::string_view(topic).substr(!topic.empty() && topic.front() == '/' ? 1 : 0);
}

/// The CameraInfo whose name begins as the image's does for longest; null if there is none.
const TopicReport* info_of(const BagReport& report, const TopicReport& image) {
  const std::string_view wanted = without_slash(image.topic);
  const TopicReport* chosen = nullptr;
  std::ptrdiff_t longest = 0;
  for (const TopicReport* info : serving(report, LogRole::kCameraInfo)) {
    const std::string_view topic = without_slash(info->topic);
    const auto same = std::mismatch(wanted.begin(), wanted.end(), topic.begin(), topic.end()).first;
    if (same - wanted.begin() > longest) {
      longest = same - wanted.begin();
      chosen = info;
    }
  }
  return chosen;
}

/// As YAML takes it back, whatever characters a damaged bag's topic holds.
std::string quoted(const std::string& topic) { return config_detail::write(topic); }

std::string stamp_line(const TopicReport& topic, const std::string& key) {
  if (!topic.offset || std::abs(topic.offset->median_s) < kOtherClock_s) return "";
  return key +
         fmt::format(": receive  # stamps are {:.1f} s from the receive times\n", -topic.offset->median_s);
}

std::string camera_lines(const BagReport& report, const TopicReport& image, bool right) {
  std::string text = right ? "cam1:\n" : "cam0:\n";
  text += "  camera_model: pinhole\n";
  const TopicReport* info = info_of(report, image);
  if (info != nullptr) {
    const auto& camera = std::get<CameraDescription>(*info->serves_as(LogRole::kCameraInfo)->example).camera;
    const PinholeIntrinsics& k = camera.intrinsics;
    text += "  intrinsics: " + config_detail::write(std::vector<double>{k.fx_px, k.fy_px, k.cx_px, k.cy_px}) +
            "  # from " + quoted(info->topic) +
            "\n  distortion_model: " + lens_name(camera.distortion_model) +
            "\n  distortion_coeffs: " + config_detail::write(camera.distortion_coeffs) + "\n";
  } else {
    text += "  intrinsics: FILL_IN\n  distortion_model: FILL_IN\n  distortion_coeffs: FILL_IN\n";
  }
  const cv::Mat& picture = std::get<CameraImage>(*image.serves_as(LogRole::kImage)->example).image;
  text += "  resolution: " + config_detail::write(std::vector<int>{picture.cols, picture.rows}) + "\n";
  text += right ? "  T_cn_cnm1: FILL_IN  # cam0 -> cam1\n" : "  T_cam_imu: FILL_IN  # imu -> cam0\n";
  text += stamp_line(image, "  stamp");
  return text + "  rostopic: " + quoted(without_compressed(image.topic)) + "\n";
}

std::string lidar_lines(const TopicReport& lidar) {
  std::string text = "lidar0:\n  T_cam_lidar: FILL_IN  # lidar -> cam0\n";
  if (lidar.serves_as(LogRole::kLidar)->needs_scan_period) {
    text +=
        fmt::format("  scan_period_s: {:.4g}  # points have no time; the period is that of the messages\n",
                    lidar.rate_hz() > 0 ? 1 / lidar.rate_hz() : 0.0);
  }
  return text + stamp_line(lidar, "  stamp") + "  rostopic: " + quoted(lidar.topic) + "\n";
}

std::string log_lines(const BagReport& report) {
  const TopicReport* attitude = best(report, LogRole::kAttitude);
  const TopicReport* position = best(report, LogRole::kPosition);
  const TopicReport* height = best(report, LogRole::kHeight);
  std::string text = "log:\n";
  text += "  attitude_topic: " + (attitude != nullptr ? quoted(attitude->topic) : "FILL_IN") + "\n";
  text += "  position_topic: " + (position != nullptr ? quoted(position->topic) : "FILL_IN") + "\n";
  const bool named = height != nullptr && height->topic.find("height") != std::string::npos;
  text += "  height_topic: " + (named ? quoted(height->topic) : "none") + "\n";
  if (attitude != nullptr) text += stamp_line(*attitude, "  attitude_stamp");
  if (position != nullptr) text += stamp_line(*position, "  position_stamp");
  const bool tree = (attitude != nullptr && !attitude->frames.empty()) ||
                    (position != nullptr && !position->frames.empty());
  if (tree) text += "  tf_world_frame: FILL_IN\n  tf_body_frame: FILL_IN\n";
  return text;
}

}  // namespace

std::string describe(const DecodedMessage& message) {
  return std::visit([](const auto& typed) { return describe(typed); }, message);
}

std::string suggest_configuration(const BagReport& report) {
  const Cameras cameras = choose_cameras(report);
  const TopicReport* lidar = best(report, LogRole::kLidar);
  const bool poses =
      best(report, LogRole::kAttitude) != nullptr || best(report, LogRole::kPosition) != nullptr;
  std::string text;
  if (cameras.cam0 != nullptr || lidar != nullptr) text += "# Suggested rig file:\n";
  if (cameras.cam0 != nullptr) text += camera_lines(report, *cameras.cam0, false);
  if (cameras.cam1 != nullptr) text += camera_lines(report, *cameras.cam1, true);
  if (lidar != nullptr) text += lidar_lines(*lidar);
  if (poses) text += "# Suggested lines of the configuration that names the rig:\n" + log_lines(report);
  return text;
}

}  // namespace alight
