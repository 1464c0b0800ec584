#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace alight {

/// Positions in the list of points; counter-clockwise with x to the right and y *up*.
using Triangle = std::array<int, 3>;

/// Delaunay triangulation of points with integer coordinates, by divide and conquer (Guibas and Stolfi, "Primitives for
/// the Manipulation of General Subdivisions", 1985): O(n log n), and exact, since all predicates are integers. Of
/// points at the same place one is used. Fewer than three points, or all on a line: no triangle.
/// @throws std::invalid_argument for coordinates beyond +-8191, for which the predicates would overflow
std::vector<Triangle> triangulate(const std::vector<cv::Point>& points);

}  // namespace alight
