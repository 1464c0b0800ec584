#pragma once

#include <cstdint>

#include "foundation/binder_fwd.hpp"

namespace alight::sim {

enum class ImageFormat { kJpeg, kRaw };

/// Stereo camera. Noise in grey levels of the 8-bit image.
struct CameraConfig {
  double rate_hz = 20;
  double phase_s = 0.013;      ///< first exposure after the flight's start: real clocks do not tick together
  double transport_s = 0.015;  ///< from the exposure to the computer
  double clock_offset_s = 0;   ///< stamp - true time
  ImageFormat format = ImageFormat::kJpeg;
  int jpeg_quality = 92;
  double read_noise = 1.0;         ///< 1 sigma of a black pixel
  double shot_noise = 0.03;        ///< variance per grey level
  double brightness_drift = 0.06;  ///< relative, as clouds pass
  double brightness_period_s = 17;
};
void bind(Binder& b, CameraConfig& c);

/// Livox Mid-40 (METHOD, "Sensors of the paper's rig").
struct LidarConfig {
  double packet_s = 0.1;
  double transport_s = 0.002;  ///< after the last point
  double clock_offset_s = 0;
  double range_noise_m = 0.02;
  double min_range_m = 1.0;
  double range_at_80_percent_m = 260;
  double dark_reflectivity = 0.1;  ///< below it returns get lost at random ...
  double dark_loss = 0.3;          ///< ... up to this share on black
  double range_offset_m = 0;       ///< systematic error of every range of this recording
  double reflectivity_noise = 0;   ///< 1 sigma, in the sensor's levels (150 = white)
  /// Full widths of the beam; a wide beam blurs reflectivity edges and mixes ranges at depth edges. The Mid-40's are
  /// 0.28 (up) and 0.03 (across).
  double divergence_up_deg = 0;
  double divergence_across_deg = 0;
  /// Largest error of the reported beam directions, which changes smoothly over the field of view and belongs to the
  /// one sensor that `sensor_seed` stands for.
  double angle_error_deg = 0;
  std::int64_t sensor_seed = 1;
};
void bind(Binder& b, LidarConfig& c);

/// The flight controller's attitude.
struct AttitudeConfig {
  double rate_hz = 100;
  double noise_deg = 0.05;  ///< 1 sigma about each body axis
};
void bind(Binder& b, AttitudeConfig& c);

/// Accelerometer and gyroscope; the biases are drawn once a flight.
struct ImuConfig {
  double rate_hz = 200;
  double accelerometer_noise_mps2 = 0.05;
  double accelerometer_bias_mps2 = 0.02;
  double gyroscope_noise_radps = 0.003;
  double gyroscope_bias_radps = 0.002;
};
void bind(Binder& b, ImuConfig& c);

/// How a position drifts (gps_drift.hpp).
enum class DriftKind {
  kRough,   ///< Ornstein-Uhlenbeck: 5 cm in a second; harsher than a flight controller's position
  kSmooth,  ///< with a velocity, as a filter of IMU and satellites gives it
};

/// Satellite position, smoothed by the flight controller: a slow drift and a little white noise.
struct GpsConfig {
  double rate_hz = 50;
  DriftKind drift_kind = DriftKind::kRough;
  double drift_m = 0.3;      ///< 1 sigma an axis once it has settled; 0 at the first fix
  double drift_time_s = 60;  ///< after which its correlation has fallen to 1/e
  double noise_m = 0.005;
  double latitude_deg = 30.27415;  ///< of the take-off place
  double longitude_deg = 120.15515;
  double altitude_m = 41;  ///< over the ellipsoid
};
void bind(Binder& b, GpsConfig& c);

/// Height above the take-off place.
struct HeightConfig {
  double rate_hz = 50;
  double noise_m = 0.05;
};
void bind(Binder& b, HeightConfig& c);

enum class Noise { kOn, kOff };

/// All sensors of a flight.
struct SensorsConfig {
  Noise noise = Noise::kOn;
  std::int64_t start_time_s = 1'700'000'000;  ///< since 1970: the stamps' base, never the wall clock
  double pose_clock_offset_s = 0;             ///< attitude, IMU and GPS share the flight controller's clock
  double pose_transport_s = 0.003;
  CameraConfig camera;
  LidarConfig lidar;
  AttitudeConfig attitude;
  ImuConfig imu;
  GpsConfig gps;
  HeightConfig height;
};
void bind(Binder& b, SensorsConfig& c);

/// The settings that hold: with `noise: off` every noise, bias, drift and random loss is zero.
SensorsConfig effective(const SensorsConfig& config);

}  // namespace alight::sim
