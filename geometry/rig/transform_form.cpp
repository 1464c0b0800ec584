#include "geometry/rig/transform_form.hpp"

#include <cmath>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using Rows = std::vector<std::vector<double>>;

enum class LengthUnit { kMetres, kMillimetres };

/// The section's keys.
struct TransformForm {
  std::optional<Rows> matrix;
  std::optional<std::vector<double>> rotation;
  std::optional<std::vector<double>> quaternion_xyzw;
  std::optional<std::vector<double>> rpy_deg;
  std::optional<std::vector<double>> rpy_rad;
  std::optional<std::vector<double>> xyz;
  LengthUnit unit = LengthUnit::kMetres;
};

constexpr const char* kNoRigidTransform =
    "is no rigid transform: expected 4 rows of 4 numbers, the upper left 3x3 a rotation (R^T R = I, "
    "det R = +1), "
    "the last row 0 0 0 1";

void check_length(Binder& b, const std::string& key, const std::optional<std::vector<double>>& values,
                  std::size_t length) {
  b.check(key, !values || values->size() == length, "expected " + std::to_string(length) + " numbers");
}

Eigen::Matrix3d rotation_of(const std::vector<double>& by_rows) {
  Eigen::Matrix3d R;
  R << by_rows[0], by_rows[1], by_rows[2], by_rows[3], by_rows[4], by_rows[5], by_rows[6], by_rows[7],
      by_rows[8];
  return R;
}

bool is_unit_quaternion(const std::vector<double>& xyzw) {
  return std::abs(Eigen::Map<const Eigen::Vector4d>(xyzw.data()).norm() - 1) < 1e-3;
}

void bind(Binder& b, TransformForm& f) {
  b.field("matrix", f.matrix, "4 rows of 4");
  b.field("xyz", f.xyz, "translation");
  b.field("rotation", f.rotation, "3x3 by rows");
  b.field("quaternion_xyzw", f.quaternion_xyzw, "x y z w");
  b.field("rpy_deg", f.rpy_deg, "roll, pitch, yaw");
  b.field("rpy_rad", f.rpy_rad, "roll, pitch, yaw");
  b.choice("length_unit", f.unit, {{"m", LengthUnit::kMetres}, {"mm", LengthUnit::kMillimetres}},
           "of the translation");
  check_length(b, "xyz", f.xyz, 3);
  check_length(b, "rotation", f.rotation, 9);
  check_length(b, "quaternion_xyzw", f.quaternion_xyzw, 4);
  check_length(b, "rpy_deg", f.rpy_deg, 3);
  check_length(b, "rpy_rad", f.rpy_rad, 3);
  b.check("matrix", !f.matrix || isometry_from_rows(*f.matrix).has_value(), kNoRigidTransform);
  b.check("rotation", !f.rotation || f.rotation->size() != 9 || is_rotation(rotation_of(*f.rotation)),
          "is no rotation (R^T R = I, det R = +1)");
  b.check("quaternion_xyzw",
          !f.quaternion_xyzw || f.quaternion_xyzw->size() != 4 || is_unit_quaternion(*f.quaternion_xyzw),
          "does not have length 1");
  const int rotations = int{f.rotation.has_value()} + int{f.quaternion_xyzw.has_value()} +
                        int{f.rpy_deg.has_value()} + int{f.rpy_rad.has_value()};
  b.check("xyz", f.matrix ? !f.xyz && rotations == 0 : f.xyz.has_value() && rotations == 1,
          "give either matrix, or xyz and one of rotation, quaternion_xyzw, rpy_deg, rpy_rad");
}

Eigen::Matrix3d rotation_of_rpy(double roll_rad, double pitch_rad, double yaw_rad) {
  return (Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// Of a form that passed its checks.
Eigen::Isometry3d transform_of(const TransformForm& f) {
  Eigen::Isometry3d T = f.matrix ? *isometry_from_rows(*f.matrix) : Eigen::Isometry3d::Identity();
  if (f.xyz) T.translation() = Eigen::Map<const Eigen::Vector3d>(f.xyz->data());
  if (f.rotation) T.linear() = nearest_rotation(rotation_of(*f.rotation));
  if (f.quaternion_xyzw) {
    const auto& q = *f.quaternion_xyzw;
    T.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
  }
  if (f.rpy_deg) {
    const auto& a = *f.rpy_deg;
    T.linear() = rotation_of_rpy(to_radians(a[0]), to_radians(a[1]), to_radians(a[2]));
  }
  if (f.rpy_rad) T.linear() = rotation_of_rpy((*f.rpy_rad)[0], (*f.rpy_rad)[1], (*f.rpy_rad)[2]);
  if (f.unit == LengthUnit::kMillimetres) T.translation() *= 1e-3;
  return T;
}

std::optional<Eigen::Isometry3d> load_transform(Binder& b, const std::string& key, const std::string& help) {
  if (b.is_section(key)) {
    TransformForm form;
    const std::size_t mistakes = b.mistakes();
    b.section(key, form, help);
    return b.mistakes() == mistakes ? std::optional<Eigen::Isometry3d>(transform_of(form)) : std::nullopt;
  }
  std::optional<Rows> rows;
  b.field(key, rows, help);
  b.check(key, !rows || isometry_from_rows(*rows).has_value(), kNoRigidTransform);
  return rows ? isometry_from_rows(*rows) : std::nullopt;
}

}  // namespace

void bind_transform(Binder& b, const std::string& key, const std::string& inverse_key,
                    std::optional<Eigen::Isometry3d>& T_a_b, const std::string& help) {
  if (!b.loading()) {
    std::optional<Rows> rows;
    if (T_a_b) rows = matrix_rows(*T_a_b);
    return b.field(key, rows, help);
  }
  T_a_b = load_transform(b, key, help);
  const std::optional<Eigen::Isometry3d> T_b_a = load_transform(b, inverse_key, "the inverse of " + key);
  b.check(inverse_key, !T_a_b || !T_b_a, "is the inverse of " + key + ", which is given, too: give one");
  if (T_b_a) T_a_b = T_b_a->inverse();
}

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
  // A rounded matrix is made orthonormal; an exact one stays as it is, bit for bit.
  T.linear() = is_rotation(R, 1e-12) ? R : nearest_rotation(R);
  T.translation() = M.topRightCorner<3, 1>();
  return T;
}

}  // namespace alight
