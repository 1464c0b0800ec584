#include "train/evaluation/methods/triangulation.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace alight {
namespace {

constexpr int kMaxCoordinate = 8191;  // the in-circle test then stays below 2^61

/// Directed edges in twin pairs (2k, 2k + 1), each in the ring of edges around its origin.
class EdgeRings {
 public:
  explicit EdgeRings(std::size_t points) {
    origin_.reserve(6 * points);
    next_.reserve(6 * points);
    previous_.reserve(6 * points);
  }

  static int twin(int e) { return e ^ 1; }
  int count() const { return static_cast<int>(origin_.size()); }
  bool exists(int e) const { return at(origin_, e) >= 0; }
  int origin(int e) const { return at(origin_, e); }
  int target(int e) const { return origin(twin(e)); }
  /// Counter-clockwise around the origin, and clockwise.
  int next(int e) const { return at(next_, e); }
  int previous(int e) const { return at(previous_, e); }
  /// The edge that follows around the face on the left.
  int along_left(int e) const { return previous(twin(e)); }

  int make(int from, int to) {
    const int e = count();
    for (const int half : {e, e + 1}) {
      origin_.push_back(half == e ? from : to);
      next_.push_back(half);
      previous_.push_back(half);
    }
    return e;
  }
  /// From a's target to b's origin, so that all three have the same face on the left.
  int connect(int a, int b) {
    const int e = make(target(a), origin(b));
    splice(e, along_left(a));
    splice(twin(e), b);
    return e;
  }
  void remove(int e) {
    for (const int half : {e, twin(e)}) {
      splice(half, previous(half));
      at(origin_, half) = -1;
    }
  }
  /// Joins two rings, or parts one in two.
  void splice(int a, int b) {
    const int after_a = next(a);
    const int after_b = next(b);
    link(a, after_b);
    link(b, after_a);
  }

 private:
  static int at(const std::vector<int>& list, int e) { return list[static_cast<std::size_t>(e)]; }
  static int& at(std::vector<int>& list, int e) { return list[static_cast<std::size_t>(e)]; }
  void link(int e, int after) {
    at(next_, e) = after;
    at(previous_, after) = e;
  }

  std::vector<int> origin_;  // -1: removed
  std::vector<int> next_;
  std::vector<int> previous_;
};

/// Points sorted by x, then y, all different.
class Triangulator {
 public:
  explicit Triangulator(const std::vector<cv::Point>& sorted) : points_(sorted), edges_(sorted.size()) {
    if (sorted.size() >= 2) divide(0, static_cast<int>(sorted.size()));
  }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> found;
    std::vector<bool> seen(static_cast<std::size_t>(edges_.count()), false);
    for (int a = 0; a < edges_.count(); ++a) {
      if (!edges_.exists(a) || seen[static_cast<std::size_t>(a)]) continue;
      const int b = edges_.along_left(a);
      const int c = edges_.along_left(b);
      const Triangle triangle{edges_.origin(a), edges_.origin(b), edges_.origin(c)};
      // The face around the outside may have three corners, too, but runs clockwise.
      if (edges_.along_left(c) != a || !turns_left(triangle[0], triangle[1], triangle[2])) continue;
      for (const int e : {a, b, c}) seen[static_cast<std::size_t>(e)] = true;
      found.push_back(triangle);
    }
    return found;
  }

 private:
  /// The hull's edges out of the first point counter-clockwise, out of the last clockwise.
  struct Ends {
    int first;
    int last;
  };

  const cv::Point& point(int index) const { return points_[static_cast<std::size_t>(index)]; }

  bool turns_left(int a, int b, int c) const {
    const cv::Point ab = point(b) - point(a);
    const cv::Point ac = point(c) - point(a);
    return static_cast<std::int64_t>(ab.x) * ac.y > static_cast<std::int64_t>(ab.y) * ac.x;
  }
  bool is_left(int p, int e) const { return turns_left(p, edges_.origin(e), edges_.target(e)); }
  bool is_right(int p, int e) const { return turns_left(p, edges_.target(e), edges_.origin(e)); }

  /// Whether d lies inside the circle through a, b, c (counter-clockwise).
  bool in_circle(int a, int b, int c, int d) const {
    const auto relative = [&](int p) {
      const std::int64_t x = point(p).x - point(d).x;
      const std::int64_t y = point(p).y - point(d).y;
      return std::array<std::int64_t, 3>{x, y, x * x + y * y};
    };
    const auto [ax, ay, aa] = relative(a);
    const auto [bx, by, bb] = relative(b);
    const auto [cx, cy, cc] = relative(c);
    return aa * (bx * cy - cx * by) - bb * (ax * cy - cx * ay) + cc * (ax * by - bx * ay) > 0;
  }

  Ends divide(int begin, int end) {
    if (end - begin == 2) {
      const int e = edges_.make(begin, begin + 1);
      return {e, EdgeRings::twin(e)};
    }
    if (end - begin == 3) return three(begin);
    const int middle = begin + (end - begin) / 2;
    const Ends left = divide(begin, middle);
    const Ends right = divide(middle, end);
    return merge(left, right);
  }

  Ends three(int begin) {
    const int a = edges_.make(begin, begin + 1);
    const int b = edges_.make(begin + 1, begin + 2);
    edges_.splice(EdgeRings::twin(a), b);
    if (turns_left(begin, begin + 1, begin + 2)) {
      edges_.connect(b, a);
    } else if (turns_left(begin, begin + 2, begin + 1)) {
      const int c = edges_.connect(b, a);
      return {EdgeRings::twin(c), c};
    }
    return {a, EdgeRings::twin(b)};
  }

  /// The lower common tangent of two hulls, from the right one to the left one.
  int tangent(int& left, int& right) {
    while (true) {
      if (is_left(edges_.origin(right), left)) {
        left = edges_.along_left(left);
      } else if (is_right(edges_.origin(left), right)) {
        right = edges_.next(EdgeRings::twin(right));
      } else {
        return edges_.connect(EdgeRings::twin(right), left);
      }
    }
  }

  /// Zips two halves together, from the bottom upwards.
  Ends merge(Ends left, Ends right) {
    int left_inner = left.last;
    int right_inner = right.first;
    int base = tangent(left_inner, right_inner);
    if (edges_.origin(left_inner) == edges_.origin(left.first)) left.first = EdgeRings::twin(base);
    if (edges_.origin(right_inner) == edges_.origin(right.last)) right.last = base;
    while (true) {
      const int l = candidate(base, edges_.next(EdgeRings::twin(base)), /*counter_clockwise=*/true);
      const int r = candidate(base, edges_.previous(base), /*counter_clockwise=*/false);
      const bool left_ok = is_right(edges_.target(l), base);
      const bool right_ok = is_right(edges_.target(r), base);
      if (!left_ok && !right_ok) return {left.first, right.last};
      const bool take_right = !left_ok || (right_ok && in_circle(edges_.target(l), edges_.origin(l),
                                                                 edges_.origin(r), edges_.target(r)));
      base = take_right ? edges_.connect(r, EdgeRings::twin(base))
                        : edges_.connect(EdgeRings::twin(base), EdgeRings::twin(l));
    }
  }

  /// The edge at one end of `base` that the next triangle may use; those before it are in its circle and go.
  int candidate(int base, int e, bool counter_clockwise) {
    if (!is_right(edges_.target(e), base)) return e;
    while (true) {
      const int behind = counter_clockwise ? edges_.next(e) : edges_.previous(e);
      if (!in_circle(edges_.target(base), edges_.origin(base), edges_.target(e), edges_.target(behind)))
        return e;
      edges_.remove(e);
      e = behind;
    }
  }

  const std::vector<cv::Point>& points_;
  EdgeRings edges_;
};

}  // namespace

std::vector<Triangle> triangulate(const std::vector<cv::Point>& points) {
  const auto place = [&](int i) {
    const cv::Point& p = points[static_cast<std::size_t>(i)];
    return std::make_pair(p.x, p.y);
  };
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::make_pair(place(a), a) < std::make_pair(place(b), b); });
  order.erase(std::unique(order.begin(), order.end(), [&](int a, int b) { return place(a) == place(b); }),
              order.end());
  std::vector<cv::Point> sorted;
  for (const int i : order) {
    const cv::Point& p = points[static_cast<std::size_t>(i)];
    if (std::abs(p.x) > kMaxCoordinate || std::abs(p.y) > kMaxCoordinate) {
      throw std::invalid_argument("triangulate: coordinates must lie within +-8191");
    }
    sorted.push_back(p);
  }
  std::vector<Triangle> triangles = Triangulator(sorted).triangles();
  for (Triangle& triangle : triangles) {
    for (int& corner : triangle) corner = order[static_cast<std::size_t>(corner)];
  }
  return triangles;
}

}  // namespace alight
