#pragma once

#include "ccd/core_pair.hpp"
#include "ccd/witness.hpp"

namespace kairos::ccd {

[[nodiscard]] inline CorePair core_pair(const PairMotion& motion, const Kinematics& k) {
  return {motion.core_a(), motion.core_b(), k.R_WA, k.R_WB, k.d};
}
/// The witness of greatest separation of two cores.
[[nodiscard]] Witness between_cores(const PairMotion& motion, const Kinematics& k);
/// The witness along a unit direction, fixed to what it is across: to the body of a face, to the
/// edges of both, to the body of an edge, else to the world. The slope of the gap along the best
/// one is then that of the distance.
[[nodiscard]] Witness along_direction(const PairMotion& motion, const Kinematics& k,
                                      const Vector3& n);
/// By a depth that is proven, or by points of both that are nearer than the radii.
[[nodiscard]] bool cores_proven_overlapping(const PairMotion& motion, const Kinematics& k,
                                            const Witness& witness);
/// How deep they are proven to overlap, radii included, m; not positive: nothing is proven.
[[nodiscard]] double proven_depth(const PairMotion& motion, const Kinematics& k,
                                  const Witness& witness);
/// Support along the unit direction n, outwards, of a core, or of all that it passes while it spins
/// about w (eq. 8).
[[nodiscard]] double core_hull_support(const ConvexCore& core, const Matrix3& R, bool spins,
                                       const Vector3& w, const Vector3& n);

/// The witness along the cross product of two edges, world frame, on the side of n: fixed to both,
/// even where that is hardly off a face's normal. Its gap is -infinity where they are parallel.
[[nodiscard]] Witness along_two_edges(const PairMotion& motion, const Kinematics& k,
                                      const Vector3& edge_a, const Vector3& edge_b,
                                      const Vector3& n);

/// Calls visit(edge of a, edge of b), world frame, for those around where two cores touch.
template <typename Visit>
void for_each_two_edges(const PairMotion& motion, const Kinematics& k, const Vector3& n,
                        const Visit& visit) {
  const auto none = [](const Vector3&) {};
  motion.core_a().nearby(k.R_WA.transpose() * n, none, [&](const Vector3& a) {
    motion.core_b().nearby(-(k.R_WB.transpose() * n), none, [&](const Vector3& b) {
      visit(Vector3(k.R_WA * a), Vector3(k.R_WB * b));
    });
  });
}

/// Calls visit(direction), world frame, for normals of the faces around where two cores touch and
/// for what is across their edges: all along which they may leave each other.
template <typename Visit>
void for_each_axis(const PairMotion& motion, const Kinematics& k, const Witness& at,
                   const Visit& visit) {
  const Vector3& n = at.n;
  const Vector3 m_a = k.R_WA.transpose() * n;
  const Vector3 m_b = -(k.R_WB.transpose() * n);
  const auto none = [](const Vector3&) {};
  motion.core_a().nearby(
      m_a, [&](const Vector3& x) { visit(Vector3(k.R_WA * x)); }, none);
  motion.core_b().nearby(
      m_b, [&](const Vector3& x) { visit(Vector3(-(k.R_WB * x))); }, none);
  for_each_two_edges(motion, k, n, [&](const Vector3& a, const Vector3& b) {
    const Vector3 across = a.cross(b);
    const double length = across.norm();
    if (length > 0.0) {
      visit(Vector3(across / length));
      visit(Vector3(across / -length));
    }
  });
  // Round rims have normals between these: on the side to which the points of contact part.
  const Vector3 parting = k.v + k.w_b.cross(at.on_b - k.d) - k.w_a.cross(at.on_a);
  const Vector3 aside = parting - n * n.dot(parting);
  const double speed = aside.norm();
  if (speed > 0.0) {
    for (const double tilt : {0.01, 0.03, 0.1, 0.3, 1.0, 3.0}) {
      visit(Vector3((n + (tilt / speed) * aside).normalized()));
    }
  }
}

}  // namespace kairos::ccd
