#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "sim/counter_random.hpp"
#include "sim/sensors/sensor_config.hpp"

namespace alight::sim {

/// Relative brightness at a time: 1 without drift.
double brightness(const CameraConfig& config, double t_s);

/// Scales the image by `gain` and adds shot and read noise to every channel of every pixel: variance =
/// read_noise^2 + shot_noise * grey level. With no noise and gain 1 the image stays as it is.
/// @param image CV_8UC3 or CV_8UC1, changed in place
void expose(cv::Mat& image, const CameraConfig& config, double gain, const CounterRandom& random);

}  // namespace alight::sim
