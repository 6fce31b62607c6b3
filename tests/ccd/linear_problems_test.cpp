// Vertex and face, edge and edge, on straight lines: problems whose exact answer is known.
#include "ccd/linear/linear_impact.hpp"
#include "core/error.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <limits>

using namespace kairos;
using namespace kairos::ccd;

namespace {

/// A point and the triangle (0,0,0), (1,0,0), (0,1,0).
FourPoints over_triangle(const Vector3& p) {
  return {p, Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
}

/// The point falls from z0 while the corner (1,0,0) falls to z = -2: the volume is a quadratic,
/// z0 - t + t^2 with roots (1 -+ sqrt(1 - 4 z0))/2, up to a factor.
LinearImpact falling_corner(double z0) {
  const FourPoints start = over_triangle({0.125, 0.25, z0});
  FourPoints end = over_triangle({0.625, 0.25, z0 - 1.25});
  end[2].z() = -2.0;
  return vertex_face(start, end);
}

FourPoints on_the_x_axis(double a, double b, double c, double d) {
  return {Vector3(a, 0, 0), Vector3(b, 0, 0), Vector3(c, 0, 0), Vector3(d, 0, 0)};
}

void check_exactly(const LinearImpact& impact, double t) {
  CHECK(impact.hit);
  CHECK(impact.t_lo == t);
  CHECK(impact.t_hi == t);
}
void check_none(const LinearImpact& impact) {
  CHECK_FALSE(impact.hit);
  CHECK(impact.t_lo == LinearImpact::never);
  CHECK(impact.t_hi == LinearImpact::never);
}
/// The answer is no double: it is strictly between two that are adjacent.
void check_between(const LinearImpact& impact, long double t) {
  CHECK(impact.hit);
  CHECK(static_cast<long double>(impact.t_lo) < t);
  CHECK(t < static_cast<long double>(impact.t_hi));
  CHECK(std::nextafter(impact.t_lo, 2.0) == impact.t_hi);
}

}  // namespace

TEST_CASE("linear 1: two roots, the first is the answer", "[ccd][linear]") {
  check_exactly(falling_corner(3.0 / 16.0), 0.25);
}

TEST_CASE("linear 2: a double root is a contact", "[ccd][linear]") {
  check_exactly(falling_corner(0.25), 0.5);
}

TEST_CASE("linear 3: a miss by 2^-50 is none", "[ccd][linear]") {
  check_none(falling_corner(0.25 + 0x1p-50));
}

TEST_CASE("linear 4: a hit by 2^-50 is one, 2^-25 before the double root", "[ccd][linear]") {
  check_exactly(falling_corner(0.25 - 0x1p-50), 0.5 - 0x1p-25);
}

TEST_CASE("linear 5: a point that moves within the plane of the triangle", "[ccd][linear]") {
  check_exactly(vertex_face(over_triangle({2, 0.25, 0}), over_triangle({0, 0.25, 0})), 0.625);
}

TEST_CASE("linear 6: two edges on one line", "[ccd][linear]") {
  const FourPoints start = on_the_x_axis(0, 1, 2, 3);
  check_exactly(edge_edge(start, on_the_x_axis(0, 1, 0, 1)), 0.5);
  check_exactly(edge_edge(start, on_the_x_axis(0, 1, 1, 2)), 1.0);
}

TEST_CASE("linear 7: a separation of 0.1", "[ccd][linear]") {
  const LinearImpact impact = vertex_face(over_triangle({0.25, 0.25, 1}),
                                          over_triangle({0.25, 0.25, -1}), {.separation = 0.1});
  check_between(impact, (1.0L - static_cast<long double>(0.1)) / 2.0L);
  CHECK(impact.t_hi == 0.45);
}

TEST_CASE("linear 8: two edges on one line that stop an ulp before they meet", "[ccd][linear]") {
  check_none(edge_edge(on_the_x_axis(0, 1, 2, 3), on_the_x_axis(0, 1, 1 + 0x1p-52, 2)));
}

TEST_CASE("linear 9: two edges cross at heights of 1e-300", "[ccd][linear]") {
  const auto at_height = [](double z) {
    return FourPoints{Vector3(-1, 0, z), Vector3(1, 0, z), Vector3(0, -1, 0), Vector3(0, 1, 0)};
  };
  check_exactly(edge_edge(at_height(1e-300), at_height(-1e-300)), 0.5);
  check_none(edge_edge(at_height(1e-300), at_height(1e-300)));
}

TEST_CASE("linear 10: a cubic, t^3 = 1/2", "[ccd][linear]") {
  // x = (t, -1, 0), y = (0, t, -1), z = (-1/2, 0, t) from the vertex: the determinant is t^3 - 1/2.
  const FourPoints start{Vector3(0, 0, 0), Vector3(0, -1, 0), Vector3(0, 0, -1),
                         Vector3(-0.5, 0, 0)};
  const FourPoints end{Vector3(0, 0, 0), Vector3(1, -1, 0), Vector3(0, 1, -1), Vector3(-0.5, 0, 1)};
  const LinearImpact impact = vertex_face(start, end);
  check_between(impact, std::cbrt(0.5L));
  CHECK(impact.t_lo == Approx(0.7937005259840997).epsilon(1e-15));  // roundoff
}

TEST_CASE("linear: what does not move meets at the start or never", "[ccd][linear]") {
  const FourPoints inside = over_triangle({0.25, 0.25, 0});
  check_exactly(vertex_face(inside, inside), 0.0);
  const FourPoints corner = over_triangle({1, 0, 0});
  check_exactly(vertex_face(corner, corner), 0.0);
  const FourPoints edge = over_triangle({0.5, 0.5, 0});
  check_exactly(vertex_face(edge, edge), 0.0);
  const FourPoints outside = over_triangle({0.5, 0.5 + 0x1p-53, 0});
  check_none(vertex_face(outside, outside));
}

TEST_CASE("linear: a face that is a segment, or a point", "[ccd][linear]") {
  // From its point of view the vertex comes down on the x axis at 1/2.
  const FourPoints start{Vector3(0.5, 0, 1), Vector3(0, 0, 0), Vector3(1, 0, 0),
                         Vector3(0.25, 0, 0)};
  FourPoints end = start;
  end[0].z() = -3.0;
  check_exactly(vertex_face(start, end), 0.25);
  end[0].y() = 0x1p-1000;
  check_none(vertex_face(start, end));
  const FourPoints point{Vector3(0, 0, 1), Vector3(0, 0, 0), Vector3(0, 0, 0), Vector3(0, 0, 0)};
  FourPoints through = point;
  through[0].z() = -1.0;
  check_exactly(vertex_face(point, through), 0.5);
}

TEST_CASE("linear: a face that turns inside out through a segment", "[ccd][linear]") {
  // The corner (0,1,0) moves to (0,-1,0) through the edge; the vertex waits on that edge's line.
  FourPoints start = over_triangle({0.75, 0, 0});
  FourPoints end = start;
  end[3].y() = -1.0;
  check_exactly(vertex_face(start, end), 0.0);
  start[0] = end[0] = Vector3(0.75, -0.125, 0);
  // Inside when the lower side from (1,0) to (0,y) passes below it: -1/8 = y/4, y = -1/2.
  check_exactly(vertex_face(start, end), 0.75);
}

TEST_CASE("linear: parallel edges in one plane do not meet", "[ccd][linear]") {
  const FourPoints start{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(1, 1, 0)};
  FourPoints end = start;
  end[2].y() = end[3].y() = 0x1p-1074;
  check_none(edge_edge(start, end));
  end[2].y() = end[3].y() = 0.0;
  check_exactly(edge_edge(start, end), 1.0);
}

TEST_CASE("linear: a time below all normal doubles", "[ccd][linear]") {
  // Height 2^-1074 at the start, -1 at the end: the root 2^-1074/(1 + 2^-1074) is no double.
  const LinearImpact impact =
      vertex_face(over_triangle({0.25, 0.25, 0x1p-1074}), over_triangle({0.25, 0.25, -1}));
  CHECK(impact.hit);
  CHECK(impact.t_lo == 0.0);
  CHECK(impact.t_hi == 0x1p-1074);
}

TEST_CASE("linear: numbers near the largest double", "[ccd][linear]") {
  const double most = std::numeric_limits<double>::max();
  const auto at = [most](double z) {
    return FourPoints{Vector3(0, 0, z), Vector3(-most, -most, 0), Vector3(most, -most, 0),
                      Vector3(0, most, 0)};
  };
  check_exactly(vertex_face(at(most), at(-most)), 0.5);
  check_none(vertex_face(at(most), at(most / 2)));
}

TEST_CASE("linear: numbers that make no sense are refused", "[ccd][linear]") {
  const FourPoints good = over_triangle({0.25, 0.25, 1});
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) {
        FourPoints points = good;
        points[i][k] = bad;
        CHECK_THROWS_AS(vertex_face(points, good), InputError);
        CHECK_THROWS_AS(edge_edge(good, points), InputError);
      }
    }
    CHECK_THROWS_AS(vertex_face(good, good, {.separation = bad}), InputError);
  }
  CHECK_THROWS_AS(edge_edge(good, good, {.separation = -1.0}), InputError);
}
