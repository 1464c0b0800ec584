#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// A rigid transform in a file, in whichever form its calibration came: 4 rows of 4 numbers, or a section with
/// `matrix`, or with `xyz` and one of `rotation` (9 numbers by rows), `quaternion_xyzw`, `rpy_deg`, `rpy_rad` (about the
/// fixed axes x, y, z in this order, as URDF has it), each with `length_unit: m | mm`.
/// `T_a_b` stays empty where neither `key` nor `inverse_key` is there; under `inverse_key` stands T_b_a.
void bind_transform(Binder& b, const std::string& key, const std::string& inverse_key,
                    std::optional<Eigen::Isometry3d>& T_a_b, const std::string& help);

/// 4x4 row-major nested list <-> transform.
std::vector<std::vector<double>> matrix_rows(const Eigen::Isometry3d& T);
/// Empty if `rows` is no 4x4 matrix whose upper left is a rotation.
std::optional<Eigen::Isometry3d> isometry_from_rows(const std::vector<std::vector<double>>& rows);

}  // namespace alight
