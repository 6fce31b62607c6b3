#include "ccd/triangle_witness.hpp"

#include "ccd/mesh/triangle_contact.hpp"
#include "ccd/mesh/triangle_distance.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>

namespace kairos::ccd {
namespace {

class Search {
 public:
  Search(const Corners& a, const Corners& b) : a_(a), b_(b) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges_a_[i] = a[(i + 1) % 3] - a[i];
      edges_b_[i] = b[(i + 1) % 3] - b[i];
      for (const Vector3& x : a) {
        size_ = std::max(size_, (b[i] - x).norm());
      }
    }
  }

  /// The separation along x, divided by its length; negative infinity for 0.
  double try_along(const Vector3& x) {
    const double length = x.norm();
    if (!(length > 0.0)) {
      return -infinity;
    }
    const Vector3 n = x / length;
    const double separation = std::min({n.dot(b_[0]), n.dot(b_[1]), n.dot(b_[2])}) -
                              std::max({n.dot(a_[0]), n.dot(a_[1]), n.dot(a_[2])});
    if (separation > best.separation) {
      best.separation = separation;
      best.n = n;
    }
    return separation;
  }
  void try_both(const Vector3& x) {
    try_along(x);
    try_along(-x);
  }

  void features(const Vector3& between) {
    const Vector3 normal_a = across_both(edges_a_[0], edges_a_[1]);
    const Vector3 normal_b = across_both(edges_b_[0], edges_b_[1]);
    for (const Vector3& e : edges_a_) {
      for (const Vector3& f : edges_b_) {
        (void)across_both(e, f);
      }
      try_both(e.cross(normal_a));
      across(e, between);
    }
    for (const Vector3& f : edges_b_) {
      try_both(f.cross(normal_b));
      across(f, between);
    }
  }

  /// Are they proven to overlap? The faces of their difference are across two edges, of one
  /// triangle or of both. Each such direction, as computed, is off by 8 u over the sine of the
  /// edges; if along all of them they are in each other by more than that moves a support and by
  /// twice the error, the difference contains a ball about 0 that no error takes 0 out of.
  [[nodiscard]] bool overlap(double error) const { return deepest_ < -2.0 * error; }

  CoreWitness best{.separation = -infinity};

 private:
  /// Tries what is across two edges, both ways.
  Vector3 across_both(const Vector3& e, const Vector3& f) {
    const Vector3 x = e.cross(f);
    const double length = x.norm();
    if (!(length > 0.0)) {
      deepest_ = infinity;
      return x;
    }
    const double margin = 8.0 * unit_roundoff * size_ * (e.norm() * f.norm() / length);
    deepest_ = std::max({deepest_, try_along(x) + margin, try_along(-x) + margin});
    return x;
  }
  /// From a corner to an edge that is nearest to it.
  void across(const Vector3& e, const Vector3& between) {
    const double square = e.squaredNorm();
    if (square > 0.0) {
      try_along(between - e * (e.dot(between) / square));
    }
  }

  const Corners& a_;
  const Corners& b_;
  Corners edges_a_, edges_b_;
  double size_ = 0.0;           ///< no point of the difference is farther from 0, m
  double deepest_ = -infinity;  ///< greatest separation across two edges, from above, m
};

}  // namespace

CoreWitness triangle_witness(const CorePair& pair, double error) {
  Corners a;
  Corners b;
  for (std::size_t i = 0; i < 3; ++i) {
    a[i] = pair.R_WA * pair.a.corner(i);
    b[i] = pair.d + pair.R_WB * pair.b.corner(i);
  }
  const TriangleDistance nearest = triangle_distance(a, b, error);
  const Vector3 between = nearest.on_b - nearest.on_a;
  Search search(a, b);
  search.try_along(between);
  search.features(between);
  CoreWitness& found = search.best;
  found.upper = nearest.upper;
  found.on_a = nearest.on_a;
  found.on_b = nearest.on_b;
  if (search.overlap(error) ||
      (found.separation < 0.0 && float_triangles_touch(a, b, error) == FloatVerdict::touching)) {
    found.depth = error;
    found.on_a = found.on_b = common_point(a, b);
    found.upper = 0.0;
  }
  return found;
}

}  // namespace kairos::ccd
