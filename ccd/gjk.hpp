#pragma once

#include "ccd/core_pair.hpp"

#include <array>

namespace kairos::ccd {

/// Up to four points of B - A.
struct Simplex {
  std::array<DifferencePoint, 4> points;
  std::array<double, 4> weights{};  ///< of the point nearest to 0: >= 0, sum 1
  int size = 0;

  [[nodiscard]] const DifferencePoint& operator[](int i) const {
    return points[static_cast<std::size_t>(i)];
  }
  void add(const DifferencePoint& p) { points[static_cast<std::size_t>(size++)] = p; }
  /// The point that the weights make.
  [[nodiscard]] DifferencePoint nearest() const;
};

/// What was found between two cores: a proposal, which `CorePair::separation` proves.
struct GjkResult {
  bool inside = false;             ///< 0 is in the simplex: they overlap, but for rounding
  Vector3 n = Vector3::UnitX();    ///< unit, from a to b; of the greatest separation found
  double lower = 0.0;              ///< separation along n, m
  double upper = 0.0;              ///< distance of the nearest points found, m
  Vector3 on_a = Vector3::Zero();  ///< these points, from the origin of a, world axes
  Vector3 on_b = Vector3::Zero();
  Simplex simplex;
  int iterations = 0;
};

/// Nearest points of two convex bodies [Gilbert1988]: ends where upper - lower is at most
/// `precision` of upper, or where rounding lets nothing improve. `start`: a direction to begin
/// with, any but 0.
[[nodiscard]] GjkResult gjk(const CorePair& pair, const Vector3& start, double precision);

}  // namespace kairos::ccd
