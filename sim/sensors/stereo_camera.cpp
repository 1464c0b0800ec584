#include "sim/sensors/stereo_camera.hpp"

#include "geometry/frames.hpp"
#include "sim/sensors/camera_noise.hpp"

namespace alight::sim {

StereoCamera::StereoCamera(const Renderer& renderer, const Motion& vehicle, const RectifiedRig& rig,
                           const CameraConfig& config, std::uint64_t seed)
    : renderer_(renderer),
      vehicle_(vehicle),
      rig_(rig),
      config_(config),
      left_random_(seed, RandomStream::kLeftImage),
      right_random_(seed, RandomStream::kRightImage) {}

std::int64_t StereoCamera::time_ns(std::int64_t frame) const {
  return to_nanoseconds(config_.phase_s + static_cast<double>(frame) / config_.rate_hz);
}

StereoExposure StereoCamera::expose_frame(std::int64_t frame, bool with_depth) const {
  const double t_s = to_seconds(time_ns(frame));
  StereoExposure exposure;
  exposure.T_world_camera = vehicle_.T_world_imu(t_s) * rig_.T_camera_imu.inverse();
  const Eigen::Isometry3d T_world_right = exposure.T_world_camera * rig_.T_right_camera().inverse();
  View left = renderer_.render_camera(rig_.intrinsics, exposure.T_world_camera, with_depth, t_s);
  View right = renderer_.render_camera(rig_.intrinsics, T_world_right, false, t_s);
  const double gain = brightness(config_, t_s);
  expose(left.image, config_, gain, left_random_.child(static_cast<std::uint64_t>(frame)));
  expose(right.image, config_, gain, right_random_.child(static_cast<std::uint64_t>(frame)));
  exposure.left = left.image;
  exposure.right = right.image;
  exposure.depth_m = left.depth_m;
  return exposure;
}

}  // namespace alight::sim
