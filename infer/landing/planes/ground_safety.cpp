#include "infer/landing/planes/ground_safety.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "infer/landing/ground/free_radius.hpp"

namespace alight {
namespace {

cv::Mat disc_mask(int reach) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * reach + 1, 2 * reach + 1});
}

int cells(double length_m, double cell_m) { return static_cast<int>(std::ceil(length_m / cell_m - 1e-9)); }

/// Lowest height within reach of every cell; unknown cells do not count.
cv::Mat lowest_nearby(const ElevationRaster& raster, int reach) {
  cv::Mat heights = raster.bottom_m.clone();
  heights.setTo(std::numeric_limits<float>::max(), ~raster.known);
  cv::Mat lowest;
  cv::erode(heights, lowest, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8UC1), {-1, -1}, 1,
            cv::BORDER_CONSTANT, cv::Scalar(std::numeric_limits<float>::max()));
  return lowest;
}

/// Takes out patches of flat ground most of whose border falls away. A border cell counts where the ground beyond it is
/// known: at the edge of the view nobody knows how the ground goes on.
void remove_platforms(const ElevationRaster& raster, const PlaneFitConfig& config, cv::Mat& safe) {
  struct Border {
    int seen = 0;
    int falling = 0;
  };
  cv::Mat labels;
  const int count = cv::connectedComponents(safe, labels, 4, CV_32S);
  if (count <= 1) return;
  // From the last flat cell its disc reaches to the edge or to the parapet; beyond that it goes down.
  constexpr double kParapet_m = 1.0;
  const int reach = cells(config.radius_m + kParapet_m, raster.cell_m);
  const cv::Mat lowest_m = lowest_nearby(raster, reach);
  cv::Mat all_known;  // within reach: behind an edge lies what the edge hides
  cv::erode(raster.known, all_known, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8UC1), {-1, -1}, 1,
            cv::BORDER_CONSTANT, cv::Scalar(0));
  std::vector<Border> borders(static_cast<std::size_t>(count));
  for (int row = 1; row + 1 < safe.rows; ++row) {
    const int* label = labels.ptr<int>(row);
    for (int column = 1; column + 1 < safe.cols; ++column) {
      if (label[column] == 0) continue;
      bool border = false;
      for (const cv::Point step : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)})
        border = border || safe.at<std::uint8_t>(cv::Point(column, row) + step) == 0;
      if (!border) continue;
      Border& b = borders[static_cast<std::size_t>(label[column])];
      const double drop_m =
          static_cast<double>(raster.mean_m.at<float>(row, column) - lowest_m.at<float>(row, column));
      const bool falling = drop_m > config.platform_height_m;
      b.falling += falling ? 1 : 0;
      // A drop that is seen counts even beside the unknown.
      b.seen += falling || all_known.at<std::uint8_t>(row, column) != 0 ? 1 : 0;
    }
  }
  for (int row = 0; row < safe.rows; ++row) {
    for (int column = 0; column < safe.cols; ++column) {
      const Border& b = borders[static_cast<std::size_t>(labels.at<int>(row, column))];
      if (b.falling > 0 && b.falling >= config.platform_border * b.seen)
        safe.at<std::uint8_t>(row, column) = 0;
    }
  }
}

}  // namespace

GroundMap judge_ground(ElevationRaster raster, GroundShape shape, const cv::Mat& hazards,
                       const PlaneFitConfig& config, double max_slope_rad) {
  if (!hazards.empty() && (hazards.type() != CV_8UC1 || hazards.size() != raster.size()))
    throw std::invalid_argument("judge_ground: hazards must be CV_8UC1 of the raster's size");
  GroundMap ground;
  ground.raster = std::move(raster);
  if (ground.empty()) return ground;
  ground.shape = std::move(shape);
  cv::Mat flat = (ground.shape.gradient < std::tan(max_slope_rad)) &
                 (ground.shape.residual_m < config.max_residual_m) & ground.shape.known;
  if (config.platform_height_m > 0) remove_platforms(ground.raster, config, flat);
  cv::Mat hazard = ground.shape.known & ~flat;
  if (!hazards.empty()) hazard |= hazards != 0;
  const int guard = cells(config.guard_m, ground.raster.cell_m);
  if (guard > 0)
    cv::dilate(hazard, hazard, disc_mask(guard), {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  ground.safe = flat & ~hazard;
  if (!ground.raster.column_seen.empty()) ground.safe &= ground.raster.column_seen;
  ground.radius_m = free_radius(ground.safe, ground.raster.cell_m);
  return ground;
}

}  // namespace alight
