#include "ccd/box_witness.hpp"

#include "ccd/contact_patch.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// Boxes nearer than this part of their extents may touch along edges that the error hides.
constexpr double near = 1e-3;

/// a x b, every component to 2 ulp of itself: the cross product of nearly parallel vectors points
/// where it should [Jeannerod2013].
Vector3 accurate_cross(const Vector3& a, const Vector3& b) {
  return {difference_of_products(a.y(), b.z(), a.z(), b.y()),
          difference_of_products(a.z(), b.x(), a.x(), b.z()),
          difference_of_products(a.x(), b.y(), a.y(), b.x())};
}

double support(const Vector3& half, const Matrix3& R, const Vector3& n) {
  return half[0] * std::abs(n.dot(R.col(0))) + half[1] * std::abs(n.dot(R.col(1))) +
         half[2] * std::abs(n.dot(R.col(2)));
}

/// The gap along a unit direction.
double gap_along(const PairMotion& motion, const Kinematics& k, const Vector3& n) {
  return n.dot(k.d) - support(motion.half_a(), k.R_WA, n) - support(motion.half_b(), k.R_WB, n) -
         motion.reach();
}

Witness along_edges(const PairMotion& motion, const Kinematics& k, int axis) {
  Witness witness;
  witness.axis = axis;
  const Vector3 cross = accurate_cross(k.R_WA.col(witness.edge_a()), k.R_WB.col(witness.edge_b()));
  // Scaled, so that the squares of tiny components do not vanish.
  const double size = cross.lpNorm<Eigen::Infinity>();
  if (!(size > 0.0)) {
    witness.gap = -infinity;
    return witness;
  }
  const Vector3 direction = cross / size;
  const double length = direction.norm();
  witness.sine = size * length;
  witness.n = direction / length;
  if (witness.n.dot(k.d) < 0.0) {
    witness.n = -witness.n;
    witness.sign = -1.0;
  }
  witness.frame = motion.turns_a() || motion.turns_b() ? WitnessFrame::edges : WitnessFrame::world;
  witness.gap = gap_along(motion, k, witness.n);
  return witness;
}

/// Fixed to the body that has an edge across the direction: the direction then stays across it.
WitnessFrame frame_across(const PairMotion& motion, const Kinematics& k, const Vector3& n) {
  if (!motion.turns_a() && !motion.turns_b()) {
    return WitnessFrame::world;
  }
  const double a = (k.R_WA.transpose() * n).cwiseAbs().minCoeff();
  const double b = (k.R_WB.transpose() * n).cwiseAbs().minCoeff();
  if (a <= b) {
    return motion.turns_a() ? WitnessFrame::a : WitnessFrame::world;
  }
  return motion.turns_b() ? WitnessFrame::b : WitnessFrame::world;
}

/// Makes a direction that is across edges of the boxes, but for `noise`, so to roundoff: by the
/// rest, an edge would reach out in proportion to its length.
Vector3 snapped(const Kinematics& k, const Vector3& n, double noise) {
  Vector3 across[6];
  int count = 0;
  for (const Matrix3* R : {&k.R_WA, &k.R_WB}) {
    for (int i = 0; i < 3; ++i) {
      if (std::abs(n.dot(R->col(i))) <= noise) {
        across[count++] = R->col(i);
      }
    }
  }
  if (count == 0) {
    return n;
  }
  Vector3 exact = n;
  if (count == 1) {
    exact -= across[0] * across[0].dot(exact);
    exact -= across[0] * across[0].dot(exact);  // the rounding of the first time
  } else {
    const Vector3 cross = accurate_cross(across[0], across[1]);
    const double length = cross.norm();
    exact = length > 0.0 ? Vector3(cross * ((cross.dot(n) < 0.0 ? -1.0 : 1.0) / length)) : n;
  }
  return exact.normalized();
}

/// The direction of the distance if it is none of the 15 axes: from a corner to a corner or edge.
Witness along_distance(const PairMotion& motion, const Kinematics& k, const Witness& best) {
  const NearestPoints nearest = nearest_of_boxes(relative_boxes(motion, k));
  if (!(nearest.distance > 0.0)) {
    return best;
  }
  const auto along = [&](const Vector3& n) {
    Witness witness;
    witness.n = n;
    witness.gap = gap_along(motion, k, n);
    witness.frame = frame_across(motion, k, n);
    return witness;
  };
  const Vector3 n = (k.R_WA * ((nearest.on_b - nearest.on_a) / nearest.distance)).normalized();
  const Witness raw = along(n);
  const Witness exact = along(snapped(k, n, 16.0 * k.error / nearest.distance));
  const Witness& witness = exact.gap > raw.gap ? exact : raw;
  return witness.gap > best.gap ? witness : best;
}

/// Looks at pairs of nearly parallel edges, whose separation the error hides from the search for
/// the greatest.
Witness among_small_sines(const PairMotion& motion, const Kinematics& k, Witness best) {
  const Matrix3 R_AB = k.R_WA.transpose() * k.R_WB;
  for (int axis = 6; axis < axis_count; ++axis) {
    const double cosine = R_AB((axis - 6) / 3, (axis - 6) % 3);
    if (axis == best.axis || 1.0 - cosine * cosine > small_sine * small_sine) {
      continue;
    }
    const Witness witness = along_edges(motion, k, axis);
    if (witness.gap > best.gap) {
      best = witness;
    }
  }
  return best;
}

}  // namespace

RelativeBoxes relative_boxes(const PairMotion& motion, const Kinematics& k) {
  return {motion.half_a(), k.R_WA, motion.half_b(), k.R_WB, k.d};
}

Witness along_axis(const PairMotion& motion, const Kinematics& k, int axis) {
  if (axis >= 6) {
    return along_edges(motion, k, axis);
  }
  Witness witness;
  witness.axis = axis;
  witness.n = axis < 3 ? Vector3(k.R_WA.col(axis)) : Vector3(k.R_WB.col(axis - 3));
  if (witness.n.dot(k.d) < 0.0) {
    witness.n = -witness.n;
    witness.sign = -1.0;
  }
  witness.gap = gap_along(motion, k, witness.n);
  const bool turns = axis < 3 ? motion.turns_a() : motion.turns_b();
  witness.frame = !turns ? WitnessFrame::world : axis < 3 ? WitnessFrame::a : WitnessFrame::b;
  return witness;
}

Witness between_boxes(const PairMotion& motion, const Kinematics& k) {
  const AxisSeparation best =
      greatest_separation(motion.half_a(), k.R_WA, motion.half_b(), k.R_WB, k.d);
  Witness witness;
  if (best.axis < 6) {
    const bool of_a = best.axis < 3;
    witness.axis = best.axis;
    witness.sign = best.sign;
    witness.gap = best.value - motion.reach();
    witness.n = best.sign * (of_a ? k.R_WA.col(best.axis) : k.R_WB.col(best.axis - 3));
    if (of_a ? motion.turns_a() : motion.turns_b()) {
      witness.frame = of_a ? WitnessFrame::a : WitnessFrame::b;
    }
  } else {
    witness = along_edges(motion, k, best.axis);
  }
  const double extents = motion.radius_a() + motion.radius_b();
  const double separation = witness.gap + motion.reach();
  if (witness.gap <= near * extents) {
    witness = among_small_sines(motion, k, witness);
  }
  // A distance is at most sqrt(3) times the greatest separation (eq. 3).
  if (motion.reach() > 0.0 && separation > 0.0 && separation < 2.0 * motion.reach()) {
    witness = along_distance(motion, k, witness);
  }
  return witness;
}

bool boxes_proven_overlapping(const PairMotion& motion, const Kinematics& k,
                              const Witness& witness) {
  if (!(witness.gap < -k.error)) {
    return false;
  }
  const double reach = motion.reach();
  if (reach > 0.0 && witness.gap + reach > 0.0) {
    const NearestPoints nearest = nearest_of_boxes(relative_boxes(motion, k));
    // The points are put together from 3 products each: 8 u of the extents and the distance.
    return nearest.distance + k.error + 8.0 * u * (motion.radius_a() + motion.radius_b()) < reach;
  }
  if (reach > 8.0 * k.error) {  // no axis separates the boxes: a distance below sqrt(3) E (eq. 3)
    return true;
  }
  if (all_separations_below(motion.half_a(), k.R_WA, motion.half_b(), k.R_WB, k.d, k.error)) {
    return true;
  }
  // Nearly parallel edges decide nothing by unnormalised directions; by unit ones they can.
  for (int axis = 0; axis < axis_count; ++axis) {
    if (!(along_axis(motion, k, axis).gap + reach < -2.0 * k.error)) {
      return false;
    }
  }
  return true;
}

}  // namespace kairos::ccd
