#include "accuracy/safe_mask_score.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "foundation/parallel_rows.hpp"
#include "geometry/frames.hpp"
#include "infer/landing/ground/free_radius.hpp"
#include "sim/random.hpp"

namespace alight::bench {

PerfectDepth perfect_depth(const sim::Renderer& renderer, const PinholeIntrinsics& k,
                           const Eigen::Isometry3d& T_world_camera) {
  PerfectDepth out{cv::Mat::zeros(k.size(), CV_32FC1), cv::Mat::zeros(k.size(), CV_8UC1)};
  const auto columns = static_cast<std::size_t>(k.width_px);
  const std::vector<Eigen::Vector3d> origins(columns, T_world_camera.translation());
  sim::parallel_rows(1, k.height_px, [&](int v) {
    std::vector<Eigen::Vector3d> directions(columns);
    for (int u = 0; u < k.width_px; ++u)
      directions[static_cast<std::size_t>(u)] = T_world_camera.linear() * k.ray(u, v);
    std::vector<sim::Hit> hits;
    renderer.cast_many(origins, directions, hits);
    for (int u = 0; u < k.width_px; ++u) {
      const sim::Hit& hit = hits[static_cast<std::size_t>(u)];
      if (!hit.hit || hit.reflectivity <= 0) continue;
      out.depth_m.at<float>(v, u) = static_cast<float>(hit.range_m / k.ray(u, v).norm());
      out.material.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(hit.material);
    }
  });
  return out;
}

cv::Mat level_material(const cv::Mat& material, const PinholeIntrinsics& k,
                       const Eigen::Matrix3d& R_level_camera) {
  cv::Mat out(material.size(), CV_8UC1, cv::Scalar(255));
  for (int v = 0; v < out.rows; ++v) {
    for (int u = 0; u < out.cols; ++u) {
      const Eigen::Vector3d ray = R_level_camera.transpose() * k.ray(u, v);
      if (ray.z() <= 0) continue;
      const Eigen::Vector2d px = k.project(ray);
      if (!k.contains(px.x(), px.y())) continue;
      out.at<std::uint8_t>(v, u) =
          material.at<std::uint8_t>(static_cast<int>(px.y() + 0.5), static_cast<int>(px.x() + 0.5));
    }
  }
  return out;
}

namespace {

/// Cells of the truth some cell of whose disc has its top surface outside the image.
cv::Mat hidden_cells(const sim::SurfaceTruth& truth, const sim::SurfaceTruthConfig& config,
                     const cv::Mat& material, const PinholeIntrinsics& k,
                     const Eigen::Isometry3d& T_world_level) {
  const cv::Mat& elevation_m = truth.elevation_m();
  const double min_m = -0.5 * config.cell_m * elevation_m.cols;
  const Eigen::Isometry3d T_level_world = T_world_level.inverse();
  cv::Mat outside(elevation_m.size(), CV_8UC1, cv::Scalar(255));
  for (int row = 0; row < outside.rows; ++row) {
    for (int column = 0; column < outside.cols; ++column) {
      const Eigen::Vector3d p =
          T_level_world * Eigen::Vector3d(min_m + (column + 0.5) * config.cell_m,
                                          min_m + (row + 0.5) * config.cell_m,
                                          static_cast<double>(elevation_m.at<float>(row, column)));
      if (!(p.z() > 0)) continue;
      const Eigen::Vector2d px = k.project(p);
      if (!k.contains(px.x(), px.y())) continue;
      const bool seen =
          material.at<std::uint8_t>(static_cast<int>(px.y() + 0.5), static_cast<int>(px.x() + 0.5)) != 255;
      if (seen) outside.at<std::uint8_t>(row, column) = 0;
    }
  }
  const int reach = static_cast<int>(config.radius_m / config.cell_m + 1e-9);
  const cv::Mat disc = cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * reach + 1, 2 * reach + 1});
  cv::dilate(outside, outside, disc);
  return outside;
}

}  // namespace

TruthView truth_view(const sim::SurfaceTruth& truth, const sim::SurfaceTruthConfig& config,
                     const cv::Mat& level_depth_m, const cv::Mat& material, const PinholeIntrinsics& k,
                     const Eigen::Isometry3d& T_world_level, double clearance_m) {
  constexpr double kSlopeBand_deg = 0.5;
  constexpr double kResidualBand_m = 0.01;
  TruthView view;
  view.safe = truth.safe_mask(level_depth_m, k, T_world_level);
  view.roomy = cv::Mat::zeros(k.size(), CV_8UC1);
  view.at_limit = cv::Mat::zeros(k.size(), CV_8UC1);
  view.hidden = cv::Mat::zeros(k.size(), CV_8UC1);
  const cv::Mat hidden = hidden_cells(truth, config, material, k, T_world_level);
  view.area_m2 = cv::Mat::zeros(k.size(), CV_32FC1);
  const cv::Mat inside_px = free_radius(material != 255);
  const double min_m = -0.5 * config.cell_m * truth.safe().cols;
  for (int v = 0; v < k.height_px; ++v) {
    for (int u = 0; u < k.width_px; ++u) {
      const double z_m = static_cast<double>(level_depth_m.at<float>(v, u));
      if (z_m <= 0) continue;
      const Eigen::Vector3d p = T_world_level * (k.ray(u, v) * z_m);
      const double c = std::floor((p.x() - min_m) / config.cell_m);
      const double r = std::floor((p.y() - min_m) / config.cell_m);
      if (!(c >= 0 && r >= 0 && c < truth.safe().cols && r < truth.safe().rows)) continue;
      view.hidden.at<std::uint8_t>(v, u) = hidden.at<std::uint8_t>(static_cast<int>(r), static_cast<int>(c));
      view.area_m2.at<float>(v, u) = static_cast<float>(z_m * z_m / (k.fx_px * k.fy_px));
      const double slope_deg = to_degrees(
          static_cast<double>(truth.slope_rad().at<float>(static_cast<int>(r), static_cast<int>(c))));
      const double residual_m =
          static_cast<double>(truth.residual_m().at<float>(static_cast<int>(r), static_cast<int>(c)));
      const bool slope_near = std::abs(slope_deg - config.max_slope_deg) < kSlopeBand_deg;
      const bool residual_near = std::abs(residual_m - config.max_residual_m) < kResidualBand_m;
      const bool slope_far = slope_deg >= config.max_slope_deg + kSlopeBand_deg;
      const bool residual_far = !(residual_m < config.max_residual_m + kResidualBand_m);
      if ((slope_near || residual_near) && !slope_far && !residual_far)
        view.at_limit.at<std::uint8_t>(v, u) = 255;
      const double inside_m = static_cast<double>(inside_px.at<float>(v, u)) * z_m / k.fx_px;
      if (view.safe.at<std::uint8_t>(v, u) != 0 && inside_m >= clearance_m &&
          truth.clearance_m(p.x(), p.y()) >= clearance_m) {
        view.roomy.at<std::uint8_t>(v, u) = 255;
      }
    }
  }
  return view;
}

void MaskScore::add(const MaskScore& o) {
  called_safe_m2 += o.called_safe_m2;
  rightly_m2 += o.rightly_m2;
  wrongly_hidden_m2 += o.wrongly_hidden_m2;
  wrongly_at_limit_m2 += o.wrongly_at_limit_m2;
  roomy_m2 += o.roomy_m2;
  found_m2 += o.found_m2;
  for (const auto& [material, area_m2] : o.wrong_by_material_m2) wrong_by_material_m2[material] += area_m2;
}

MaskScore score_mask(const cv::Mat& safe, const TruthView& truth, const cv::Mat& material) {
  MaskScore score;
  for (int v = 0; v < safe.rows; ++v) {
    for (int u = 0; u < safe.cols; ++u) {
      const double area_m2 = static_cast<double>(truth.area_m2.at<float>(v, u));
      if (area_m2 <= 0) continue;
      const bool called = safe.at<std::uint8_t>(v, u) != 0;
      if (truth.roomy.at<std::uint8_t>(v, u) != 0) {
        score.roomy_m2 += area_m2;
        score.found_m2 += called ? area_m2 : 0;
      }
      if (!called) continue;
      score.called_safe_m2 += area_m2;
      if (truth.safe.at<std::uint8_t>(v, u) != 0) {
        score.rightly_m2 += area_m2;
        continue;
      }
      if (truth.hidden.at<std::uint8_t>(v, u) != 0) {
        score.wrongly_hidden_m2 += area_m2;
        continue;
      }
      if (truth.at_limit.at<std::uint8_t>(v, u) != 0) score.wrongly_at_limit_m2 += area_m2;
      const auto kind = static_cast<sim::Material>(material.at<std::uint8_t>(v, u));
      score.wrong_by_material_m2[sim::properties(kind).name] += area_m2;
    }
  }
  return score;
}

std::vector<Station> stations(const sim::World& world, const sim::SurfaceTruth& truth, double height_m,
                              int count, double max_tilt_deg, std::uint64_t seed) {
  constexpr double kAir_m = 2.5;
  constexpr double kWidestView = 0.85;  // tangent of half the image's diagonal and the tilt
  constexpr int kAttempts = 200;
  sim::Random random(seed, 900 + static_cast<std::uint64_t>(height_m));
  const double half_m = 0.5 * world.size_m() - kWidestView * height_m - 1;
  std::vector<Station> found;
  for (int i = 0; i < kAttempts && static_cast<int>(found.size()) < count; ++i) {
    const double x_m = random.uniform(-half_m, half_m);
    const double y_m = random.uniform(-half_m, half_m);
    const double roll = to_radians(random.uniform(-max_tilt_deg, max_tilt_deg));
    const double pitch = to_radians(random.uniform(-max_tilt_deg, max_tilt_deg));
    const double yaw = random.uniform(0, 6.283185307179586);
    const double z_m = world.ground_height_m(x_m, y_m) + height_m;
    bool air = true;
    for (const double dx : {-1.5, 0.0, 1.5}) {
      for (const double dy : {-1.5, 0.0, 1.5})
        air = air && truth.elevation_m(x_m + dx, y_m + dy) + kAir_m < z_m;
    }
    if (!air) continue;
    Station station;
    station.height_m = height_m;
    Eigen::Matrix3d R_world_down;
    R_world_down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    station.T_world_camera.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                                      R_world_down *
                                      Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix() *
                                      Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix();
    station.T_world_camera.translation() = Eigen::Vector3d(x_m, y_m, z_m);
    found.push_back(station);
  }
  return found;
}

}  // namespace alight::bench
