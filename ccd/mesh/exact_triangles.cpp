#include "ccd/mesh/exact_triangles.hpp"

#include <algorithm>
#include <cstdlib>

namespace kairos::ccd {
namespace {

ExactPoint operator-(const ExactPoint& a, const ExactPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
ExactPoint cross(const ExactPoint& a, const ExactPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
int dot_sign(const ExactPoint& a, const ExactPoint& b) {
  return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).sign();
}
bool is_zero(const ExactPoint& v) { return v[0].is_zero() && v[1].is_zero() && v[2].is_zero(); }
bool equal(const ExactPoint& a, const ExactPoint& b) { return is_zero(a - b); }
/// An axis along which a vector is not zero; 3 if there is none.
std::size_t some_axis(const ExactPoint& v) {
  std::size_t k = 0;
  while (k < 3 && v[k].is_zero()) {
    ++k;
  }
  return k;
}

/// The sign of the turn a, b, c in the projection along axis k.
int turn(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, std::size_t k) {
  const std::size_t i = (k + 1) % 3;
  const std::size_t j = (k + 2) % 3;
  return ((b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i])).sign();
}

bool less(const ExactInteger& a, const ExactInteger& b) { return (a - b).sign() < 0; }

/// Of segments on one line: they meet if they do on every axis.
bool boxes_touch(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r,
                 const ExactPoint& s) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low_1, high_1] = std::minmax(p[k], q[k], less);
    const auto [low_2, high_2] = std::minmax(r[k], s[k], less);
    if (less(high_1, low_2) || less(high_2, low_1)) {
      return false;
    }
  }
  return true;
}

/// Whether a point of the plane of a triangle is in it; along k it has an area.
bool covers(const ExactCorners& t, const ExactPoint& p, std::size_t k) {
  const int s0 = turn(t[0], t[1], p, k);
  const int s1 = turn(t[1], t[2], p, k);
  const int s2 = turn(t[2], t[0], p, k);
  return std::min({s0, s1, s2}) >= 0 || std::max({s0, s1, s2}) <= 0;
}

bool touches_an_edge(const ExactPoint& p, const ExactPoint& q, const ExactCorners& t) {
  return exact_segments_touch(p, q, t[0], t[1]) || exact_segments_touch(p, q, t[1], t[2]) ||
         exact_segments_touch(p, q, t[2], t[0]);
}

/// The same with the normal of the triangle at hand, and the sides of p and q.
bool segment_touches(const ExactPoint& p, const ExactPoint& q, const ExactCorners& t,
                     const ExactPoint& normal, int side_p, int side_q) {
  const std::size_t k = some_axis(normal);
  if (k == 3) {
    return touches_an_edge(p, q, t);
  }
  if (side_p * side_q > 0) {
    return false;
  }
  if (side_p == 0 && side_q == 0) {
    return covers(t, p, k) || covers(t, q, k) || touches_an_edge(p, q, t);
  }
  const int s0 = exact_orientation(p, q, t[0], t[1]);
  const int s1 = exact_orientation(p, q, t[1], t[2]);
  const int s2 = exact_orientation(p, q, t[2], t[0]);
  return std::min({s0, s1, s2}) >= 0 || std::max({s0, s1, s2}) <= 0;
}

ExactPoint normal_of(const ExactCorners& t) { return cross(t[1] - t[0], t[2] - t[0]); }

struct Sides {
  ExactPoint normal;
  std::array<int, 3> side;  ///< of the corners of another triangle

  Sides(const ExactCorners& plane, const ExactCorners& other) : normal(normal_of(plane)) {
    for (std::size_t i = 0; i < 3; ++i) {
      side[i] = dot_sign(normal, other[i] - plane[0]);
    }
  }
  [[nodiscard]] bool apart() const { return std::abs(side[0] + side[1] + side[2]) == 3; }
};

bool an_edge_touches(const ExactCorners& edges, const ExactCorners& t, const Sides& sides) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (segment_touches(edges[i], edges[j], t, sides.normal, sides.side[i], sides.side[j])) {
      return true;
    }
  }
  return false;
}

}  // namespace

int exact_orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                      const ExactPoint& d) {
  return dot_sign(b - a, cross(c - a, d - a));
}

bool exact_segments_touch(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r,
                          const ExactPoint& s) {
  const ExactPoint first = q - p;
  const ExactPoint second = s - r;
  const ExactPoint between = r - p;
  const ExactPoint normal = cross(first, second);
  if (dot_sign(normal, between) != 0) {
    return false;
  }
  const std::size_t k = some_axis(normal);
  if (k < 3) {
    return turn(p, q, r, k) * turn(p, q, s, k) <= 0 && turn(r, s, p, k) * turn(r, s, q, k) <= 0;
  }
  const ExactPoint& along = is_zero(first) ? second : first;
  if (is_zero(along)) {
    return equal(p, r);
  }
  return is_zero(cross(along, between)) && boxes_touch(p, q, r, s);
}

bool exact_segment_touches(const ExactPoint& p, const ExactPoint& q, const ExactCorners& t) {
  const ExactPoint normal = normal_of(t);
  return segment_touches(p, q, t, normal, dot_sign(normal, p - t[0]), dot_sign(normal, q - t[0]));
}

bool exact_triangles_touch(const ExactCorners& a, const ExactCorners& b) {
  const Sides sides_of_a(b, a);
  if (sides_of_a.apart()) {
    return false;
  }
  const Sides sides_of_b(a, b);
  if (sides_of_b.apart()) {
    return false;
  }
  // Where they meet is convex; an extreme point of it is on an edge of one of them.
  return an_edge_touches(a, b, sides_of_a) || an_edge_touches(b, a, sides_of_b);
}

bool exact_degenerate(const ExactCorners& t) { return is_zero(normal_of(t)); }

}  // namespace kairos::ccd
