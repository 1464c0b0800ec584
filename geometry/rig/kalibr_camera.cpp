#include "geometry/rig/kalibr_camera.hpp"

#include "foundation/config_reader.hpp"
#include "geometry/rig/transform_form.hpp"

namespace alight {
namespace {

bool coefficient_count_fits(const KalibrCamera& c) {
  const std::size_t n = c.distortion_coeffs.size();
  if (c.distortion_model == "radtan") return n == 4 || n == 5 || n == 8;
  if (c.distortion_model == "equidistant") return n == 4;
  return n == 0;
}

void bind_lens(Binder& b, KalibrCamera& c) {
  b.required("camera_model", c.camera_model, "lens model: pinhole");
  b.check("camera_model", c.camera_model == "pinhole", "expected pinhole (others are not supported)");
  b.required("intrinsics", c.intrinsics, "[fx, fy, cx, cy] in pixels");
  b.check("intrinsics", c.intrinsics.size() == 4 && c.intrinsics[0] > 0 && c.intrinsics[1] > 0,
          "expected [fx, fy, cx, cy] with positive focal lengths");
  b.field("distortion_model", c.distortion_model, "radtan | equidistant | none");
  const bool model_known =
      c.distortion_model == "radtan" || c.distortion_model == "equidistant" || c.distortion_model == "none";
  b.check("distortion_model", model_known, "expected radtan, equidistant or none");
  b.field("distortion_coeffs", c.distortion_coeffs,
          "radtan: k1 k2 p1 p2 [k3 [k4 k5 k6]]; equidistant: k1 k2 k3 k4");
  b.check("distortion_coeffs", !model_known || coefficient_count_fits(c),
          "expected 4, 5 or 8 coefficients for radtan, 4 for equidistant, none for none");
  b.required("resolution", c.resolution, "[width, height] in pixels", at_least(1));
  b.check("resolution", c.resolution.size() == 2, "expected [width, height]");
}

}  // namespace

void bind(Binder& b, KalibrCamera& c) {
  if (b.loading()) {
    b.field("calibration_file", c.calibration_file, "file of another program that holds the lens");
    b.field("calibration_entry", c.calibration_entry, "the camera in that file: cam0, cam1, left, right");
  }
  if (c.calibration_file) {
    b.field("resolution", c.resolution, "[width, height] in pixels, where the file has several", at_least(1));
    b.check("resolution", c.resolution.empty() || c.resolution.size() == 2, "expected [width, height]");
  } else {
    bind_lens(b, c);
  }
  bind_transform(b, "T_cn_cnm1", "T_cnm1_cn", c.T_cn_cnm1,
                 "4x4, this camera from the one before it (cam0 -> cam1)");
  bind_transform(b, "T_cam_imu", "T_imu_cam", c.T_cam_imu, "4x4, this camera from the IMU");
  b.field("timeshift_cam_imu", c.timeshift_cam_imu, "seconds; t_imu = t_cam + timeshift");
  bind_stamp(b, "stamp", c.stamp);
  b.field("rostopic", c.rostopic, "topic of the images");
  b.ignore("cam_overlaps");
}

Camera lens_of(const KalibrCamera& yaml) {
  Camera camera;
  camera.intrinsics = {yaml.intrinsics[0], yaml.intrinsics[1], yaml.intrinsics[2],
                       yaml.intrinsics[3], yaml.resolution[0], yaml.resolution[1]};
  camera.distortion_model = yaml.distortion_model == "radtan"        ? DistortionModel::kRadtan
                            : yaml.distortion_model == "equidistant" ? DistortionModel::kEquidistant
                                                                     : DistortionModel::kNone;
  camera.distortion_coeffs = yaml.distortion_coeffs;
  return camera;
}

void set_lens(const Camera& camera, KalibrCamera& yaml) {
  const PinholeIntrinsics& k = camera.intrinsics;
  yaml.intrinsics = {k.fx_px, k.fy_px, k.cx_px, k.cy_px};
  yaml.resolution = {k.width_px, k.height_px};
  const DistortionModel model = camera.distortion_model;
  yaml.distortion_model = model == DistortionModel::kRadtan        ? "radtan"
                          : model == DistortionModel::kEquidistant ? "equidistant"
                                                                   : "none";
  yaml.distortion_coeffs = camera.distortion_coeffs;
}

}  // namespace alight
