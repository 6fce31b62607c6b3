#pragma once

#include "ccd/convex_core.hpp"

namespace kairos::ccd {

/// A point of the difference B - A of two placed cores, and the points that it is made of, all from
/// the origin of a, world axes, m.
struct DifferencePoint {
  Vector3 w = Vector3::Zero();  ///< on_b - on_a
  Vector3 on_a = Vector3::Zero();
  Vector3 on_b = Vector3::Zero();
};

/// Two cores at one instant. They have a point in common exactly if 0 is in B - A.
struct CorePair {
  const ConvexCore& a;
  const ConvexCore& b;
  const Matrix3& R_WA;
  const Matrix3& R_WB;
  Vector3 d;  ///< origin of b from that of a, world axes, m

  /// The least n . w of B - A: positive for any n proves them apart; over |n| it is no more than
  /// their distance.
  [[nodiscard]] double separation(const Vector3& n) const {
    return n.dot(d) - a.support(R_WA.transpose() * n) - b.support(-(R_WB.transpose() * n));
  }
  /// A point of B - A where n . w is least.
  [[nodiscard]] DifferencePoint support(const Vector3& n) const {
    DifferencePoint p;
    p.on_a = R_WA * a.support_point(R_WA.transpose() * n);
    p.on_b = d + R_WB * b.support_point(-(R_WB.transpose() * n));
    p.w = p.on_b - p.on_a;
    return p;
  }
  [[nodiscard]] double size() const { return a.radius() + b.radius(); }
};

}  // namespace kairos::ccd
