#include "geometry/rig/ros_lens.hpp"

#include <algorithm>

namespace alight {

std::string set_ros_distortion(const std::string& model, const std::vector<double>& coefficients,
                               Camera& camera) {
  const std::size_t count = coefficients.size();
  const bool zero = std::all_of(coefficients.begin(), coefficients.end(), [](double k) { return k == 0; });
  if (zero) {
    camera.distortion_model = DistortionModel::kNone;
    camera.distortion_coeffs.clear();
    return {};
  }
  const bool radtan = model == "plumb_bob" || model == "rational_polynomial" || model == "radtan";
  const bool equidistant = model == "equidistant" || model == "fisheye";
  if (!radtan && !equidistant) {
    return "distortion model \"" + model.substr(0, 40) +
           "\" is none of plumb_bob, rational_polynomial, equidistant";
  }
  if (radtan ? count != 4 && count != 5 && count != 8 : count != 4) {
    return std::to_string(count) + " coefficients of " + model + " (4, 5 or 8 of plumb_bob and " +
           "rational_polynomial, 4 of equidistant are known)";
  }
  camera.distortion_model = radtan ? DistortionModel::kRadtan : DistortionModel::kEquidistant;
  camera.distortion_coeffs = coefficients;
  return {};
}

}  // namespace alight
