#include "calibrate/lidar/static_scene.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "calibrate/clocks/grey_image.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "geometry/frames.hpp"
#include "sensors/stream/flight_log.hpp"

namespace alight {
namespace {

constexpr int kLivoxWhiteLevels = 3;  // fewer different values than this are no reflectivity

cv::Mat mean_image(const std::vector<cv::Mat>& images, std::size_t begin, std::size_t end) {
  cv::Mat sum = cv::Mat::zeros(images.front().size(), CV_32FC1);
  for (std::size_t i = begin; i < end; ++i) cv::accumulate(images[i], sum);
  cv::Mat mean;
  sum.convertTo(mean, CV_8UC1, 1.0 / static_cast<double>(end - begin));
  return mean;
}

/// The left camera and the LiDAR of a rig alone: a recording on a stand has neither poses nor needs the right camera.
Rig left_and_lidar(const Rig& rig) {
  if (!rig.lidar0) {
    throw ConfigError(
        "rig: has no lidar0; add one with the LiDAR's rostopic (T_cam_lidar: any rigid transform, it is not "
        "used)");
  }
  Rig result = rig;
  result.cam1.reset();
  return result;
}

std::vector<SensorTopic> left_and_lidar_topics(const Rig& rig, const LogConfig& config) {
  std::vector<SensorTopic> topics = sensor_topics(rig, config);
  topics.erase(std::remove_if(topics.begin(), topics.end(),
                              [](const SensorTopic& t) {
                                return t.sensor != Sensor::kLeft && t.sensor != Sensor::kLidar;
                              }),
               topics.end());
  return topics;
}

void check_reflectivity(const StaticScene& scene, const std::string& place, const std::string& topic) {
  std::array<bool, 256> seen{};
  for (const LidarReturn& point : scene.points) seen[point.reflectivity] = true;
  if (std::count(seen.begin(), seen.end(), true) >= kLivoxWhiteLevels) return;
  throw DataError(
      place + ": topic " + topic +
      ": the points have no reflectivity (all alike), so that the LiDAR cannot see the print; record "
      "livox_ros_driver/CustomMsg with the driver's reflectivity");
}

}  // namespace

void bind(Binder& b, StaticSceneConfig& c) {
  b.field("max_duration_s", c.max_duration_s, "of a recording, from its beginning, that is used",
          between(0.5, 600));
  b.field("min_images", c.min_images, "a recording with fewer images is refused", between(3, 1000));
  b.field("min_points", c.min_points, "and one with fewer LiDAR points", between(100, 1e9));
}

StaticScene read_static_scene(const std::filesystem::path& log, const Rig& rig,
                              const StaticSceneConfig& config) {
  const Rig used = left_and_lidar(rig);
  FlightLog reader(log, used, LogConfig(), left_and_lidar_topics(used, LogConfig()));
  StaticScene scene;
  scene.name = log.stem().string();
  std::vector<cv::Mat> images;
  LogMessage message;
  while (reader.next(message)) {
    if (to_seconds(reader.receive_ns() - reader.summary().begin_ns) > config.max_duration_s) break;
    if (auto* frame = std::get_if<StereoFrame>(&message)) images.push_back(to_grey(frame->left));
    if (auto* packet = std::get_if<LidarPacket>(&message))
      scene.points.insert(scene.points.end(), packet->returns.begin(), packet->returns.end());
  }
  scene.images = static_cast<int>(images.size());
  if (scene.images < config.min_images) {
    throw DataError(log.string() + ": has " + std::to_string(scene.images) + " usable images on " +
                    used.cam0.topic + ", " + std::to_string(config.min_images) +
                    " are needed; record longer");
  }
  if (static_cast<int>(scene.points.size()) < config.min_points) {
    throw DataError(log.string() + ": has " + std::to_string(scene.points.size()) + " LiDAR points on " +
                    used.lidar0->topic + ", " + std::to_string(config.min_points) +
                    " are needed; let the LiDAR look for 3 s or more");
  }
  check_reflectivity(scene, log.string(), used.lidar0->topic);
  scene.duration_s = to_seconds(scene.points.back().t_ns - scene.points.front().t_ns);
  const std::size_t third = std::max<std::size_t>(1, images.size() / 3);
  scene.image = mean_image(images, 0, images.size());
  scene.first_third = mean_image(images, 0, third);
  scene.last_third = mean_image(images, images.size() - third, images.size());
  return scene;
}

}  // namespace alight
