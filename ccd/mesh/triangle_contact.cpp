#include "ccd/mesh/triangle_contact.hpp"

#include "ccd/mesh/exact_triangles.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kairos::ccd {
namespace {

/// Turns the corners of a triangle so that the first one is alone on its side.
void lone_corner_first(Corners& t, const std::array<int, 3>& side, int& lone_side) {
  const std::size_t lone = side[1] == side[2] ? 0 : (side[0] == side[2] ? 1 : 2);
  std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(lone), t.end());
  lone_side = side[lone];
}

struct PlaneSides {
  std::array<int, 3> side{};
  bool known = true;  ///< none is hidden by rounding

  PlaneSides(const Corners& plane, const Corners& other, double bound) {
    const Vector3 normal = (plane[1] - plane[0]).cross(plane[2] - plane[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const double volume = normal.dot(other[i] - plane[0]);
      side[i] = volume > bound ? 1 : (volume < -bound ? -1 : 0);
      known = known && side[i] != 0;
    }
  }
  [[nodiscard]] bool apart() const { return std::abs(side[0] + side[1] + side[2]) == 3; }
};

double extent_of(const Corners& a, const Corners& b) {
  Vector3 least = a[0];
  Vector3 greatest = a[0];
  for (const Vector3& v : {a[1], a[2], b[0], b[1], b[2]}) {
    least = least.cwiseMin(v);
    greatest = greatest.cwiseMax(v);
  }
  return (greatest - least).maxCoeff();
}

}  // namespace

double orientation_error(double extent, double error) {
  constexpr double smallest = 1e-90;  // nothing underflows above
  if (!(extent > smallest) || !(error <= 0x1p-20 * extent)) {
    return infinity;
  }
  return extent * extent * (40.0 * error + 64.0 * unit_roundoff * extent);
}

FloatVerdict float_triangles_touch(const Corners& a, const Corners& b, double error) {
  const double bound = orientation_error(extent_of(a, b), error);
  const PlaneSides of_b(a, b, bound);
  if (of_b.apart()) {
    return FloatVerdict::apart;
  }
  const PlaneSides of_a(b, a, bound);
  if (of_a.apart()) {
    return FloatVerdict::apart;
  }
  if (!of_a.known || !of_b.known) {
    return FloatVerdict::unknown;
  }
  Corners p = a;
  Corners q = b;
  int side_p = 0;
  int side_q = 0;
  lone_corner_first(p, of_a.side, side_p);
  lone_corner_first(q, of_b.side, side_q);
  if (side_p < 0) {
    std::swap(q[1], q[2]);
  }
  if (side_q < 0) {
    std::swap(p[1], p[2]);
  }
  const int first = float_orientation(p[0], p[1], q[0], q[1], bound);
  const int second = float_orientation(p[0], p[2], q[2], q[0], bound);
  if (first > 0 || second > 0) {
    return FloatVerdict::apart;
  }
  return first < 0 && second < 0 ? FloatVerdict::touching : FloatVerdict::unknown;
}

bool triangles_touch(const MeshPair& pair, std::uint32_t triangle_a, std::uint32_t triangle_b,
                     std::int64_t& exact) {
  const FloatVerdict verdict =
      float_triangles_touch(pair.corners_a(triangle_a), pair.corners_b(triangle_b), pair.error());
  if (verdict != FloatVerdict::unknown) {
    return verdict == FloatVerdict::touching;
  }
  ++exact;
  ExactCorners a;
  ExactCorners b;
  pair.exact_corners(triangle_a, triangle_b, a, b);
  return exact_triangles_touch(a, b);
}

}  // namespace kairos::ccd
