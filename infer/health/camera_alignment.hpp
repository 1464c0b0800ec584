#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "geometry/rig/stereo_rectification.hpp"
#include "infer/health/symptom.hpp"

namespace alight {

/// Where the right camera shows what the left one shows, over the middle of the image.
struct StereoShift {
  cv::Point2d shift_px;  ///< right less left; (-disparity, 0) for a healthy pair
  double response = 0;   ///< of the phase correlation, 0 to 1; 0 without texture
};

/// How alike the two images' middles are where the right one is moved by `shift_px` onto the left one: 1 is the same picture but
/// for brightness and contrast, 0 another one. @param left, right, window_px as of stereo_shift
double likeness(const cv::Mat& left, const cv::Mat& right, const cv::Point2d& shift_px, int window_px);

/// @param left, right rectified, one size, CV_8UC1 or CV_8UC3. @param window_px side of the square that is compared
StereoShift stereo_shift(const cv::Mat& left, const cv::Mat& right, int window_px);

/// Whether the two cameras belong together: one exposure, each on its own side. The distance of the ground says by how much
/// the right image has to be shifted; swapped cameras are shifted the other way, and cameras of different moments by the
/// vehicle's motion between them, up and down too. The shift is measured by phase, in which fine noise weighs as much as the
/// ground; so a shift is believed only where the images are clearly more alike there than where they should be. Over smooth
/// ground they are alike everywhere, and nothing is said. What both cameras show at the same pixels (dust on the lenses, a
/// vignette, a sensor's fixed pattern) is no ground. A hovering vehicle hides a shift in time, and loses nothing by it.
class CameraAlignment {
 public:
  CameraAlignment(const HealthConfig& config, const RectifiedRig& rig);

  /// Whether a pair is to be compared now, which costs some milliseconds.
  bool due(std::int64_t t_ns) const;
  /// @param left, right rectified. @param distance_m plane depth of the ground, as well as it is known
  void add(std::int64_t t_ns, const cv::Mat& left, const cv::Mat& right, std::optional<double> distance_m);

  /// Neither confirmed nor suspected: the right camera may be used.
  bool usable() const { return !swapped_.present() && !misaligned_.present() && !suspected(); }
  void report(std::vector<HealthFinding>& findings) const;

 private:
  bool suspected() const { return swapped_.suspected() || misaligned_.suspected(); }

  HealthConfig config_;
  double focal_baseline_px_m_;
  std::optional<std::int64_t> last_ns_;
  Symptom swapped_;
  Symptom misaligned_;
};

}  // namespace alight
