#include "sim/sensors/sensor_config.hpp"

#include "foundation/config_reader.hpp"

namespace alight::sim {
namespace {

void bind_clock(Binder& b, double& offset_s, const char* whose) {
  b.field("clock_offset_s", offset_s, std::string("stamp minus true time of the ") + whose, between(-10, 10));
}

}  // namespace

void bind(Binder& b, CameraConfig& c) {
  b.field("rate_hz", c.rate_hz, "stereo frames a second", between(0.1, 1000));
  b.field("phase_s", c.phase_s, "first exposure after the start of the flight", between(0, 10));
  b.field("transport_s", c.transport_s, "from the exposure to the computer", between(0, 10));
  bind_clock(b, c.clock_offset_s, "cameras");
  b.choice("format", c.format, {{"jpeg", ImageFormat::kJpeg}, {"raw", ImageFormat::kRaw}},
           "how images are logged");
  b.field("jpeg_quality", c.jpeg_quality, "of sensor_msgs/CompressedImage", between(1, 100));
  b.field("read_noise", c.read_noise, "noise of a black pixel, grey levels (1 sigma)", between(0, 100));
  b.field("shot_noise", c.shot_noise, "variance per grey level of brightness", between(0, 100));
  b.field("brightness_drift", c.brightness_drift, "slow relative change of brightness", between(0, 0.9));
  b.field("brightness_period_s", c.brightness_period_s, "period of that change", positive());
}

void bind(Binder& b, LidarConfig& c) {
  b.field("packet_s", c.packet_s, "points of this time make a message", between(0.001, 10));
  b.field("transport_s", c.transport_s, "from a message's last point to the computer", between(0, 10));
  bind_clock(b, c.clock_offset_s, "LiDAR");
  b.field("range_noise_m", c.range_noise_m, "1 sigma along the beam", between(0, 10));
  b.field("min_range_m", c.min_range_m, "nearer surfaces give no return", at_least(0));
  b.field("range_at_80_percent_m", c.range_at_80_percent_m, "range on a surface of reflectivity 0.8",
          positive());
  b.field("dark_reflectivity", c.dark_reflectivity, "below it returns get lost at random", between(0, 1));
  b.field("dark_loss", c.dark_loss, "share of the returns lost on black", between(0, 1));
  b.field("range_offset_m", c.range_offset_m, "systematic error of every range", between(-10, 10));
  b.field("reflectivity_noise", c.reflectivity_noise, "1 sigma in levels (150 = white)", between(0, 100));
  b.field("divergence_up_deg", c.divergence_up_deg, "full width of the beam along the sensor's z",
          between(0, 5));
  b.field("divergence_across_deg", c.divergence_across_deg, "full width of the beam across", between(0, 5));
  b.field("angle_error_deg", c.angle_error_deg, "largest systematic error of the reported directions",
          between(0, 5));
  b.field("sensor_seed", c.sensor_seed, "which sensor it is, for the pattern of that error", at_least(0));
}

void bind(Binder& b, AttitudeConfig& c) {
  b.field("rate_hz", c.rate_hz, "messages a second", between(0.1, 10000));
  b.field("noise_deg", c.noise_deg, "1 sigma about each body axis", between(0, 90));
}

void bind(Binder& b, ImuConfig& c) {
  b.field("rate_hz", c.rate_hz, "messages a second", between(0.1, 10000));
  b.field("accelerometer_noise_mps2", c.accelerometer_noise_mps2, "1 sigma an axis", between(0, 100));
  b.field("accelerometer_bias_mps2", c.accelerometer_bias_mps2, "1 sigma an axis, constant in a flight",
          between(0, 100));
  b.field("gyroscope_noise_radps", c.gyroscope_noise_radps, "1 sigma an axis", between(0, 10));
  b.field("gyroscope_bias_radps", c.gyroscope_bias_radps, "1 sigma an axis, constant in a flight",
          between(0, 10));
}

void bind(Binder& b, GpsConfig& c) {
  b.field("rate_hz", c.rate_hz, "fixes a second", between(0.1, 10000));
  b.choice("drift_kind", c.drift_kind, {{"rough", DriftKind::kRough}, {"smooth", DriftKind::kSmooth}},
           "rough: Ornstein-Uhlenbeck, steps within a second; smooth: as an autopilot's filter gives it");
  b.field("drift_m", c.drift_m, "1 sigma an axis of the slow drift, which starts at 0", between(0, 1000));
  b.field("drift_time_s", c.drift_time_s, "after which the correlation of the drift has fallen to 1/e",
          positive());
  b.field("noise_m", c.noise_m, "white noise, 1 sigma an axis", between(0, 1000));
  b.field("latitude_deg", c.latitude_deg, "of the take-off place", between(-89, 89));
  b.field("longitude_deg", c.longitude_deg, "of the take-off place", between(-180, 180));
  b.field("altitude_m", c.altitude_m, "of the take-off place over the ellipsoid", between(-1000, 9000));
}

void bind(Binder& b, HeightConfig& c) {
  b.field("rate_hz", c.rate_hz, "messages a second", between(0.1, 10000));
  b.field("noise_m", c.noise_m, "1 sigma", between(0, 1000));
}

void bind(Binder& b, SensorsConfig& c) {
  b.choice("noise", c.noise, {{"on", Noise::kOn}, {"off", Noise::kOff}},
           "off: every noise, bias, drift and random loss below is zero");
  b.field("start_time_s", c.start_time_s, "stamp of the flight's first moment, seconds since 1970",
          between(1, 4294960000.0));
  b.field("pose_clock_offset_s", c.pose_clock_offset_s, "stamp minus true time of attitude, IMU and GPS",
          between(-10, 10));
  b.field("pose_transport_s", c.pose_transport_s, "from a pose measurement to the computer", between(0, 10));
  b.section("camera", c.camera, "stereo camera");
  b.section("lidar", c.lidar, "Livox Mid-40");
  b.section("attitude", c.attitude, "attitude of the flight controller");
  b.section("imu", c.imu, "accelerometer and gyroscope");
  b.section("gps", c.gps, "satellite position");
  b.section("height", c.height, "height above the take-off place");
}

SensorsConfig effective(const SensorsConfig& config) {
  SensorsConfig c = config;
  if (config.noise == Noise::kOn) return c;
  c.camera.read_noise = c.camera.shot_noise = c.camera.brightness_drift = 0;
  c.lidar.range_noise_m = c.lidar.dark_loss = c.lidar.range_offset_m = c.lidar.reflectivity_noise = 0;
  c.lidar.angle_error_deg = 0;
  c.attitude.noise_deg = 0;
  c.imu.accelerometer_noise_mps2 = c.imu.accelerometer_bias_mps2 = 0;
  c.imu.gyroscope_noise_radps = c.imu.gyroscope_bias_radps = 0;
  c.gps.drift_m = c.gps.noise_m = 0;
  c.height.noise_m = 0;
  return c;
}

}  // namespace alight::sim
