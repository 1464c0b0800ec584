#include "geometry/rig.hpp"

#include "geometry/frames.hpp"

namespace alight {
namespace {

using Rows = std::vector<std::vector<double>>;

/// The YAML of one camera, in Kalibr's keys.
struct CameraYaml {
  std::string camera_model = "pinhole";
  std::vector<double> intrinsics;
  std::string distortion_model = "none";
  std::vector<double> distortion_coeffs;
  std::vector<int> resolution;
  std::optional<Rows> T_cn_cnm1;
  std::optional<Rows> T_cam_imu;
  double timeshift_cam_imu = 0;
  StampSource stamp = StampSource::kHeader;
  std::string rostopic;
};

struct LidarYaml {
  Rows T_cam_lidar;
  double timeshift = 0;
  StampSource stamp = StampSource::kHeader;
  PointTiming points;
  double reflectivity_scale = 1;
  std::string rostopic;
};

struct RigYaml {
  CameraYaml cam0;
  std::optional<CameraYaml> cam1;
  std::optional<LidarYaml> lidar0;
};

void check_transform(Binder& b, const std::string& key, const std::optional<Rows>& rows) {
  b.check(key, !rows || isometry_from_rows(*rows).has_value(),
          "is no rigid transform: expected 4 rows of 4 numbers, the upper left "
          "3x3 a rotation (R^T R = I, "
          "det R = +1), "
          "the last row 0 0 0 1");
}

bool coefficient_count_fits(const CameraYaml& c) {
  const std::size_t n = c.distortion_coeffs.size();
  if (c.distortion_model == "radtan") return n == 4 || n == 5 || n == 8;
  if (c.distortion_model == "equidistant") return n == 4;
  return n == 0;
}

void bind(Binder& b, CameraYaml& c) {
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
          "expected 4, 5 or 8 coefficients for radtan, 4 for equidistant, none "
          "for none");
  b.required("resolution", c.resolution, "[width, height] in pixels", at_least(1));
  b.check("resolution", c.resolution.size() == 2, "expected [width, height]");
  b.field("T_cn_cnm1", c.T_cn_cnm1, "4x4, this camera from the one before it (cam0 -> cam1)");
  check_transform(b, "T_cn_cnm1", c.T_cn_cnm1);
  b.field("T_cam_imu", c.T_cam_imu, "4x4, this camera from the IMU");
  check_transform(b, "T_cam_imu", c.T_cam_imu);
  b.field("timeshift_cam_imu", c.timeshift_cam_imu, "seconds; t_imu = t_cam + timeshift");
  bind_stamp(b, "stamp", c.stamp);
  b.field("rostopic", c.rostopic, "topic of the images");
  b.ignore("cam_overlaps");
}

void bind(Binder& b, LidarYaml& c) {
  b.required("T_cam_lidar", c.T_cam_lidar, "4x4, cam0 from the LiDAR");
  check_transform(b, "T_cam_lidar", c.T_cam_lidar);
  b.field("timeshift", c.timeshift, "seconds; t_imu = t_lidar + timeshift");
  bind_stamp(b, "stamp", c.stamp);
  bind_point_timing(b, c.points);
  b.field("reflectivity_scale", c.reflectivity_scale, "from the driver's intensity to 0 .. 255", positive());
  b.field("rostopic", c.rostopic, "topic of the points");
}

void bind(Binder& b, RigYaml& c) {
  b.section("cam0", c.cam0, "left camera, in Kalibr's camchain keys");
  b.section("cam1", c.cam1, "right camera; absent for a mono rig");
  b.check("cam1", !c.cam1 || c.cam1->T_cn_cnm1.has_value(), "T_cn_cnm1 is missing (cam0 -> cam1)");
  b.section("lidar0", c.lidar0, "LiDAR");
}

DistortionModel distortion_model(const std::string& name) {
  if (name == "radtan") return DistortionModel::kRadtan;
  return name == "equidistant" ? DistortionModel::kEquidistant : DistortionModel::kNone;
}

RigCamera to_camera(const CameraYaml& yaml) {
  RigCamera camera;
  camera.camera.intrinsics = {yaml.intrinsics[0], yaml.intrinsics[1], yaml.intrinsics[2],
                              yaml.intrinsics[3], yaml.resolution[0], yaml.resolution[1]};
  camera.camera.distortion_model = distortion_model(yaml.distortion_model);
  camera.camera.distortion_coeffs = yaml.distortion_coeffs;
  if (yaml.T_cam_imu) camera.T_camera_imu = isometry_from_rows(*yaml.T_cam_imu);
  camera.timeshift_cam_imu_s = yaml.timeshift_cam_imu;
  camera.stamp = yaml.stamp;
  camera.topic = yaml.rostopic;
  return camera;
}

RigLidar to_lidar(const LidarYaml& yaml) {
  return {*isometry_from_rows(yaml.T_cam_lidar),
          yaml.timeshift,
          yaml.stamp,
          yaml.points,
          yaml.reflectivity_scale,
          yaml.rostopic};
}

Rig to_rig(const RigYaml& yaml) {
  Rig rig;
  rig.cam0 = to_camera(yaml.cam0);
  if (yaml.cam1) {
    rig.cam1 = to_camera(*yaml.cam1);
    rig.T_cam1_cam0 = *isometry_from_rows(*yaml.cam1->T_cn_cnm1);
  }
  if (yaml.lidar0) {
    rig.lidar0 = to_lidar(*yaml.lidar0);
  }
  return rig;
}

CameraYaml to_yaml(const RigCamera& camera) {
  CameraYaml yaml;
  const PinholeIntrinsics& k = camera.camera.intrinsics;
  yaml.intrinsics = {k.fx_px, k.fy_px, k.cx_px, k.cy_px};
  yaml.resolution = {k.width_px, k.height_px};
  const DistortionModel model = camera.camera.distortion_model;
  yaml.distortion_model = model == DistortionModel::kRadtan        ? "radtan"
                          : model == DistortionModel::kEquidistant ? "equidistant"
                                                                   : "none";
  yaml.distortion_coeffs = camera.camera.distortion_coeffs;
  if (camera.T_camera_imu) yaml.T_cam_imu = matrix_rows(*camera.T_camera_imu);
  yaml.timeshift_cam_imu = camera.timeshift_cam_imu_s;
  yaml.stamp = camera.stamp;
  yaml.rostopic = camera.topic;
  return yaml;
}

}  // namespace

Rows matrix_rows(const Eigen::Isometry3d& T) {
  Rows rows(4, std::vector<double>(4));
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c)
      rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = T.matrix()(r, c);
  }
  return rows;
}

std::optional<Eigen::Isometry3d> isometry_from_rows(const Rows& rows) {
  if (rows.size() != 4) return std::nullopt;
  Eigen::Matrix4d M;
  for (int r = 0; r < 4; ++r) {
    const std::vector<double>& row = rows[static_cast<std::size_t>(r)];
    if (row.size() != 4) return std::nullopt;
    M.row(r) = Eigen::Map<const Eigen::RowVector4d>(row.data());
  }
  if (!M.allFinite() || M.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) return std::nullopt;
  if (!is_rotation(M.topLeftCorner<3, 3>())) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const Eigen::Matrix3d R = M.topLeftCorner<3, 3>();
  // A rounded matrix is made orthonormal; an exact one stays as it is, bit for
  // bit.
  T.linear() = is_rotation(R, 1e-12) ? R : nearest_rotation(R);
  T.translation() = M.topRightCorner<3, 1>();
  return T;
}

Rig load_rig(const std::filesystem::path& path) { return to_rig(load_config<RigYaml>(path)); }

Rig parse_rig(const std::string& text, const std::string& name) {
  return to_rig(parse_config<RigYaml>(text, name));
}

std::string format_rig(const Rig& rig) {
  RigYaml yaml;
  yaml.cam0 = to_yaml(rig.cam0);
  if (rig.cam1) {
    yaml.cam1 = to_yaml(*rig.cam1);
    yaml.cam1->T_cn_cnm1 = matrix_rows(rig.T_cam1_cam0);
  }
  if (rig.lidar0) {
    const RigLidar& lidar = *rig.lidar0;
    yaml.lidar0 = LidarYaml{matrix_rows(lidar.T_camera_lidar), lidar.timeshift_s, lidar.stamp, lidar.points,
                            lidar.reflectivity_scale,          lidar.topic};
  }
  return print_config(yaml);
}

}  // namespace alight
