#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "infer/health/symptom.hpp"

namespace alight {

/// Whether one camera delivers pictures of what lies before it: not black, not over-exposed, not the same one again.
class CameraWatch {
 public:
  /// @param sensor "left camera" or "right camera"
  CameraWatch(const HealthConfig& config, const std::string& sensor);

  /// @param image CV_8UC1 or CV_8UC3; empty: the camera is missing. @param p_world where the vehicle is, if known
  /// @returns whether this very picture may be used
  bool add(std::int64_t t_ns, const cv::Mat& image, const std::optional<Eigen::Vector3d>& p_world);

  /// No confirmed fault.
  bool usable() const;
  void report(std::vector<HealthFinding>& findings) const;

 private:
  bool is_frozen(const std::vector<std::uint8_t>& sample, const std::optional<Eigen::Vector3d>& p_world);

  HealthConfig config_;
  Symptom missing_;
  Symptom black_;
  Symptom over_exposed_;
  Symptom frozen_;
  std::vector<std::uint8_t> last_sample_;
  std::optional<Eigen::Vector3d> p_last_change_;
  bool varied_ = false;
};

}  // namespace alight
