// Any points: refused with a reason, or their hull: no point beyond a face, exactly; closed, by
// Euler's formula; its corners are points that were told, bit for bit.
#include "core/polytope.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <vector>

using namespace kairos;
using kairos::fuzz::require;

namespace {

constexpr std::size_t most_points = 64;  // every point is held against every face

/// The first byte chooses: whole numbers of one byte, of which many are in one plane or the same;
/// the same a little off; or any doubles.
std::vector<Vector3> points_of(const std::uint8_t* data, std::size_t size) {
  std::vector<Vector3> points;
  if (size == 0) {
    return points;
  }
  const std::uint8_t kind = data[0] % 3;
  const std::size_t width = kind == 2 ? sizeof(double) : 1;
  std::vector<double> numbers;
  for (std::size_t at = 1; at + width <= size && numbers.size() < 3 * most_points; at += width) {
    if (kind == 2) {
      double x = 0.0;
      std::memcpy(&x, data + at, sizeof x);
      // Predicates are exact where no difference of coordinates over- or underflows.
      const bool told = std::isfinite(x) && std::abs(x) < 1e60 && std::abs(x) > 1e-60;
      numbers.push_back(told || !std::isfinite(x) ? x : 0.0);
    } else {
      const auto whole = static_cast<double>(static_cast<std::int8_t>(data[at]));
      numbers.push_back(kind == 0 ? whole / 16.0 : whole / 16.0 + whole * whole * 0x1p-48);
    }
  }
  for (std::size_t k = 0; k + 3 <= numbers.size(); k += 3) {
    points.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
  }
  return points;
}

void check(const std::vector<Vector3>& points, const Polytope& hull) {
  for (const Vector3& vertex : hull.vertices) {
    require(std::find(points.begin(), points.end(), vertex) != points.end(),
            "a corner of the hull is none of the points");
  }
  require(hull.vertices.size() + hull.faces.size() == hull.edges.size() + 2,
          "the surface of a hull is not closed");
  require(hull.volume > 0.0 && std::isfinite(hull.volume), "a hull has no volume");
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const auto corners = hull.faces[f];
    require(corners.size() >= 3, "a face has no three corners");
    for (const Vector3& x : points) {
      require(side_of_plane(hull.vertices[corners[0]], hull.vertices[corners[1]],
                            hull.vertices[corners[2]], x) <= 0,
              "a point is outside the hull of all points");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<Vector3> points = points_of(data, size);
  try {
    check(points, *hull_in_place(points));
  } catch (const std::exception& error) {
    require(error.what()[0] != '\0', "points are refused without a reason");
  }
  return 0;
}
