#include "geometry/rig/rig.hpp"

#include "foundation/config_reader.hpp"
#include "geometry/rig/calibration_file.hpp"
#include "geometry/rig/kalibr_camera.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;

struct LidarYaml {
  std::optional<Eigen::Isometry3d> T_cam_lidar;
  std::optional<Eigen::Isometry3d> T_imu_lidar;
  double timeshift = 0;
  StampSource stamp = StampSource::kHeader;
  PointTiming points;
  double reflectivity_scale = 1;
  std::optional<int> lidar_id;
  NoisePoints noise_points = NoisePoints::kDropLikely;
  std::string rostopic;
};

struct RigYaml {
  KalibrCamera cam0;
  std::optional<KalibrCamera> cam1;
  std::optional<LidarYaml> lidar0;
};

void bind(Binder& b, LidarYaml& c) {
  bind_transform(b, "T_cam_lidar", "T_lidar_cam", c.T_cam_lidar, "4x4, cam0 from the LiDAR");
  if (b.loading())
    bind_transform(b, "T_imu_lidar", "T_lidar_imu", c.T_imu_lidar, "4x4, the IMU from the LiDAR");
  b.field("timeshift", c.timeshift, "seconds; t_imu = t_lidar + timeshift");
  bind_stamp(b, "stamp", c.stamp);
  bind_point_timing(b, c.points);
  b.field("reflectivity_scale", c.reflectivity_scale, "from the driver's intensity to 0 .. 255", positive());
  b.field("lidar_id", c.lidar_id, "which LiDAR of a topic on which a Livox driver publishes several",
          between(0, 255));
  bind_noise_points(b, "noise_points", c.noise_points);
  b.field("rostopic", c.rostopic, "topic of the points");
}

void bind(Binder& b, RigYaml& c) {
  b.section("cam0", c.cam0, "left camera, in Kalibr's camchain keys");
  b.section("cam1", c.cam1, "right camera; absent for a mono rig");
  b.section("lidar0", c.lidar0, "LiDAR");
}

RigCamera to_camera(const KalibrCamera& yaml) {
  RigCamera camera;
  camera.camera = lens_of(yaml);
  camera.T_camera_imu = yaml.T_cam_imu;
  camera.timeshift_cam_imu_s = yaml.timeshift_cam_imu;
  camera.stamp = yaml.stamp;
  camera.topic = yaml.rostopic;
  return camera;
}

/// Takes the lens from the calibration file, if one is named, and what else is there and not given in the rig.
void complete_from_file(const fs::path& rig_file, KalibrCamera& yaml) {
  if (!yaml.calibration_file) return;
  std::optional<cv::Size> resolution;
  if (yaml.resolution.size() == 2) resolution = cv::Size(yaml.resolution[0], yaml.resolution[1]);
  const CalibratedCamera calibrated = read_calibration_file(rig_file.parent_path() / *yaml.calibration_file,
                                                            yaml.calibration_entry, resolution);
  set_lens(calibrated.camera, yaml);
  if (!yaml.T_cn_cnm1) yaml.T_cn_cnm1 = calibrated.T_camera_previous;
  if (!yaml.T_cam_imu) yaml.T_cam_imu = calibrated.T_camera_imu;
  if (yaml.timeshift_cam_imu == 0) yaml.timeshift_cam_imu = calibrated.timeshift_cam_imu_s;
}

/// Of the mountings camera-IMU, camera-LiDAR and LiDAR-IMU two tell the third.
void complete_mountings(const std::string& name, RigYaml& yaml) {
  LidarYaml& lidar = *yaml.lidar0;
  std::optional<Eigen::Isometry3d>& T_cam_imu = yaml.cam0.T_cam_imu;
  if (lidar.T_cam_lidar && lidar.T_imu_lidar && T_cam_imu) {
    throw ConfigError(
        name +
        ": lidar0: T_cam_lidar, T_imu_lidar and cam0's T_cam_imu are one too many; leave out one, "
        "so that they cannot disagree");
  }
  if (!lidar.T_cam_lidar && lidar.T_imu_lidar && T_cam_imu)
    lidar.T_cam_lidar = *T_cam_imu * *lidar.T_imu_lidar;
  if (lidar.T_cam_lidar && lidar.T_imu_lidar && !T_cam_imu)
    T_cam_imu = *lidar.T_cam_lidar * lidar.T_imu_lidar->inverse();
  if (!lidar.T_cam_lidar) {
    throw ConfigError(
        name +
        ": lidar0.T_cam_lidar: is missing (4x4, cam0 from the LiDAR; or T_imu_lidar, where cam0 has "
        "T_cam_imu)");
  }
}

Eigen::Isometry3d right_from_left(const std::string& name, const RigYaml& yaml) {
  if (yaml.cam1->T_cn_cnm1) return *yaml.cam1->T_cn_cnm1;
  if (yaml.cam1->T_cam_imu && yaml.cam0.T_cam_imu)
    return *yaml.cam1->T_cam_imu * yaml.cam0.T_cam_imu->inverse();
  throw ConfigError(name +
                    ": cam1: T_cn_cnm1 is missing (cam0 -> cam1; or T_cam_imu of both cameras, or a "
                    "calibration_file that has it)");
}

RigLidar to_lidar(const LidarYaml& yaml) {
  return {*yaml.T_cam_lidar,       yaml.timeshift, yaml.stamp,        yaml.points,
          yaml.reflectivity_scale, yaml.lidar_id,  yaml.noise_points, yaml.rostopic};
}

Rig to_rig(const std::string& name, RigYaml yaml) {
  complete_from_file(name, yaml.cam0);
  if (yaml.cam1) complete_from_file(name, *yaml.cam1);
  if (yaml.lidar0) complete_mountings(name, yaml);
  Rig rig;
  rig.cam0 = to_camera(yaml.cam0);
  if (yaml.cam1) {
    rig.cam1 = to_camera(*yaml.cam1);
    rig.T_cam1_cam0 = right_from_left(name, yaml);
  }
  if (yaml.lidar0) rig.lidar0 = to_lidar(*yaml.lidar0);
  return rig;
}

KalibrCamera to_yaml(const RigCamera& camera) {
  KalibrCamera yaml;
  set_lens(camera.camera, yaml);
  yaml.T_cam_imu = camera.T_camera_imu;
  yaml.timeshift_cam_imu = camera.timeshift_cam_imu_s;
  yaml.stamp = camera.stamp;
  yaml.rostopic = camera.topic;
  return yaml;
}

}  // namespace

Rig load_rig(const fs::path& path) { return to_rig(path.string(), load_config<RigYaml>(path)); }

Rig parse_rig(const std::string& text, const std::string& name) {
  return to_rig(name, parse_config<RigYaml>(text, name));
}

std::string format_rig(const Rig& rig) {
  RigYaml yaml;
  yaml.cam0 = to_yaml(rig.cam0);
  if (rig.cam1) {
    yaml.cam1 = to_yaml(*rig.cam1);
    yaml.cam1->T_cn_cnm1 = rig.T_cam1_cam0;
  }
  if (rig.lidar0) {
    const RigLidar& lidar = *rig.lidar0;
    yaml.lidar0 =
        LidarYaml{lidar.T_camera_lidar,     std::nullopt,   lidar.timeshift_s,  lidar.stamp, lidar.points,
                  lidar.reflectivity_scale, lidar.lidar_id, lidar.noise_points, lidar.topic};
  }
  return print_config(yaml);
}

}  // namespace alight
