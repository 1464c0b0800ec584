#pragma once

#include <string>
#include <vector>

#include "geometry/camera.hpp"

namespace alight {

/// Sets the distortion of `camera` from ROS's names (sensor_msgs/distortion_models.h: plumb_bob, rational_polynomial,
/// equidistant; also fisheye, radtan) and coefficients. @returns why it cannot be; empty: done
std::string set_ros_distortion(const std::string& model, const std::vector<double>& coefficients,
                               Camera& camera);

}  // namespace alight
