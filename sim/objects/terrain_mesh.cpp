#include "sim/objects/terrain_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace alight::sim {
namespace {

// Lines every kCell_m inside, then ever farther apart: seen under a flat angle, far cells look small.
std::vector<double> grid_axis(double size_m) {
  constexpr double kGrowth = 1.25;
  const double half_m = 0.5 * size_m;
  std::vector<double> outer;
  double step_m = Terrain::kCell_m;
  for (double at_m = half_m + step_m; at_m < half_m + Terrain::kApron_m; step_m *= kGrowth, at_m += step_m) {
    outer.push_back(at_m);
  }
  std::vector<double> axis;
  for (auto it = outer.rbegin(); it != outer.rend(); ++it) axis.push_back(-*it);
  const int cells = std::max(1, static_cast<int>(std::lround(size_m / Terrain::kCell_m)));
  for (int i = 0; i <= cells; ++i) axis.push_back(-half_m + size_m * i / cells);
  axis.insert(axis.end(), outer.begin(), outer.end());
  return axis;
}

}  // namespace

Terrain::Terrain(double size_m, std::uint16_t cover_surface)
    : size_m_(size_m),
      axis_m_(grid_axis(size_m)),
      heights_m_(axis_m_.size() * axis_m_.size(), 0.F),
      cover_size_(static_cast<int>(std::ceil(size_m / kCoverCell_m))),
      cover_(static_cast<std::size_t>(cover_size_) * static_cast<std::size_t>(cover_size_), cover_surface),
      cover_border_(cover_.size(), 0) {}

int Terrain::cell_below(double coordinate_m) const {
  const auto above = std::upper_bound(axis_m_.begin(), axis_m_.end(), coordinate_m);
  return std::clamp(static_cast<int>(above - axis_m_.begin()) - 1, 0, grid_size() - 2);
}

double Terrain::height_m(double x_m, double y_m) const {
  const int column = cell_below(x_m);
  const int row = cell_below(y_m);
  const double u = std::clamp((x_m - axis_m(column)) / (axis_m(column + 1) - axis_m(column)), 0.0, 1.0);
  const double v = std::clamp((y_m - axis_m(row)) / (axis_m(row + 1) - axis_m(row)), 0.0, 1.0);
  const double z00 = vertex_height_m(row, column);
  const double z11 = vertex_height_m(row + 1, column + 1);
  // The mesh splits a cell along the diagonal from its lower left to its upper right corner.
  if (u >= v) {
    const double z01 = vertex_height_m(row, column + 1);
    return z00 + u * (z01 - z00) + v * (z11 - z01);
  }
  const double z10 = vertex_height_m(row + 1, column);
  return z00 + v * (z10 - z00) + u * (z11 - z10);
}

std::size_t Terrain::cover_index(double x_m, double y_m) const {
  const auto cell = [&](double coordinate_m) {
    const int i = static_cast<int>((coordinate_m + 0.5 * size_m_) * (1.0 / kCoverCell_m));
    return static_cast<std::size_t>(std::clamp(i, 0, cover_size_ - 1));
  };
  return cell(y_m) * static_cast<std::size_t>(cover_size_) + cell(x_m);
}

std::uint16_t Terrain::cover(double x_m, double y_m) const { return cover_[cover_index(x_m, y_m)]; }

void Terrain::find_cover_borders() {
  const auto n = static_cast<std::size_t>(cover_size_);
  cover_border_.assign(cover_.size(), 0);
  const auto compare = [&](std::size_t a, std::size_t b) {
    if (cover_[a] != cover_[b]) cover_border_[a] = cover_border_[b] = 1;
  };
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) {
      const std::size_t here = row * n + column;
      if (column + 1 < n) compare(here, here + 1);
      if (row + 1 < n) compare(here, here + n);
      if (column + 1 < n && row + 1 < n) compare(here, here + n + 1);
      if (column > 0 && row + 1 < n) compare(here, here + n - 1);
    }
  }
}

TriangleMesh Terrain::mesh() const {
  const int n = grid_size();
  TriangleMesh mesh;
  mesh.vertices.reserve(heights_m_.size());
  mesh.normals.reserve(heights_m_.size());
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      const int left = std::max(column - 1, 0);
      const int right = std::min(column + 1, n - 1);
      const int below = std::max(row - 1, 0);
      const int above = std::min(row + 1, n - 1);
      const double slope_x =
          (vertex_height_m(row, right) - vertex_height_m(row, left)) / (axis_m(right) - axis_m(left));
      const double slope_y =
          (vertex_height_m(above, column) - vertex_height_m(below, column)) / (axis_m(above) - axis_m(below));
      mesh.vertices.push_back(
          Eigen::Vector3d(axis_m(column), axis_m(row), vertex_height_m(row, column)).cast<float>());
      mesh.normals.push_back(Eigen::Vector3d(-slope_x, -slope_y, 1).normalized().cast<float>());
    }
  }
  const auto vertex = [n](int row, int column) { return static_cast<std::uint32_t>(row * n + column); };
  for (int row = 0; row + 1 < n; ++row) {
    for (int column = 0; column + 1 < n; ++column) {
      mesh.triangles.push_back({vertex(row, column), vertex(row, column + 1), vertex(row + 1, column + 1)});
      mesh.triangles.push_back({vertex(row, column), vertex(row + 1, column + 1), vertex(row + 1, column)});
    }
  }
  mesh.triangle_surfaces.assign(mesh.triangles.size(), TriangleMesh::kGroundCover);
  return mesh;
}

}  // namespace alight::sim
