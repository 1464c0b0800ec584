#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sim/objects/triangle_mesh.hpp"

namespace alight::sim {

/// The bare ground: heights on a grid that is fine inside the detailed square and grows coarse beyond it, and
/// a cover map that says what lies on the ground.
class Terrain {
 public:
  static constexpr double kCell_m = 0.4;       ///< of the heights, inside the square
  static constexpr double kCoverCell_m = 0.1;  ///< of the cover map
  static constexpr double kApron_m = 150.0;    ///< how far the ground runs on beyond the square

  /// Level ground with one cover everywhere.
  Terrain(double size_m, std::uint16_t cover_surface);

  int grid_size() const { return static_cast<int>(axis_m_.size()); }
  /// Coordinate of a grid line (the same for x and y).
  double axis_m(int i) const { return axis_m_[static_cast<std::size_t>(i)]; }
  float& vertex_height_m(int row, int column) { return heights_m_[index(row, column)]; }
  float vertex_height_m(int row, int column) const { return heights_m_[index(row, column)]; }

  /// Height of the mesh's triangle below (x, y); at the rim's height beyond the apron.
  double height_m(double x_m, double y_m) const;

  /// Surface index of the cover at (x, y); the border's beyond the square.
  std::uint16_t cover(double x_m, double y_m) const;
  /// True where another cover is less than a cover cell away. Valid after find_cover_borders().
  bool is_cover_border(double x_m, double y_m) const { return cover_border_[cover_index(x_m, y_m)] != 0; }
  /// To be called once the cover cells are painted.
  void find_cover_borders();
  int cover_size() const { return cover_size_; }
  /// Centre of a cover cell along either axis.
  double cover_axis_m(int i) const { return -0.5 * size_m_ + (i + 0.5) * kCoverCell_m; }
  std::uint16_t& cover_cell(int row, int column) {
    return cover_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cover_size_) +
                  static_cast<std::size_t>(column)];
  }

  /// Triangles with smooth normals; all of surface kGroundCover.
  TriangleMesh mesh() const;

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * axis_m_.size() + static_cast<std::size_t>(column);
  }
  std::size_t cover_index(double x_m, double y_m) const;
  int cell_below(double coordinate_m) const;

  double size_m_;
  std::vector<double> axis_m_;
  std::vector<float> heights_m_;
  int cover_size_ = 0;
  std::vector<std::uint16_t> cover_;
  std::vector<std::uint8_t> cover_border_;
};

}  // namespace alight::sim
