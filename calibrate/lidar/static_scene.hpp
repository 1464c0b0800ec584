#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "foundation/errors.hpp"
#include "geometry/rig/rig.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// What is accumulated of a recording.
struct StaticSceneConfig {
  double max_duration_s = 10;  ///< of the recording's beginning
  int min_images = 3;
  int min_points = 20000;
};
void bind(Binder& b, StaticSceneConfig& c);

/// One recording of sensors and surroundings that stand still, accumulated.
struct StaticScene {
  std::string name;                 ///< of the log, without folder and .bag
  cv::Mat image;                    ///< CV_8UC1, mean of the left camera's images: noise averages out
  cv::Mat first_third;              ///< CV_8UC1, of the first third of the images
  cv::Mat last_third;               ///< CV_8UC1, and of the last
  std::vector<LidarReturn> points;  ///< in the order of time
  int images = 0;
  double duration_s = 0;  ///< from the first to the last point
};

/// @throws DataError naming log and topic: missing, too short, no reflectivity. @throws ConfigError for a rig without
/// LiDAR or topics
StaticScene read_static_scene(const std::filesystem::path& log, const Rig& rig,
                              const StaticSceneConfig& config);

}  // namespace alight
