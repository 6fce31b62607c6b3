#include "ccd/witness.hpp"

#include "ccd/box_witness.hpp"
#include "ccd/core_of_shape.hpp"
#include "ccd/moving_cores.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/spun_box.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

Witness between_points(const Vector3& d, double reach) {
  Witness witness;
  const double distance = d.norm();
  witness.n = distance > 0.0 ? Vector3(d / distance) : Vector3(Vector3::UnitY());
  witness.gap = distance - reach;
  return witness;
}

/// a is a sphere, b a box: the direction from the nearest point of the box.
Witness from_box(const PairMotion& motion, const Kinematics& k) {
  const Vector3 c = -(k.R_WB.transpose() * k.d);
  const Vector3& half = motion.half_b();
  const Vector3 out = c - c.cwiseMax(-half).cwiseMin(half);
  const double distance = out.norm();
  Witness witness;
  witness.frame = motion.turns_b() ? WitnessFrame::b : WitnessFrame::world;
  if (distance > 0.0) {
    witness.n = k.R_WB * (out / -distance);
    witness.gap = distance - motion.reach();
    return witness;
  }
  int face = 0;
  const double depth = (half - c.cwiseAbs()).minCoeff(&face);
  witness.n = k.R_WB.col(face) * (c[face] < 0.0 ? 1.0 : -1.0);
  witness.gap = -depth - motion.reach();
  return witness;
}

/// b is a half-space.
Witness from_plane(const PairMotion& motion, const Kinematics& k) {
  Witness witness;
  witness.frame = motion.turns_b() ? WitnessFrame::b : WitnessFrame::world;
  witness.n = -k.R_WB.col(1);
  double support = motion.reach();
  if (motion.radius_a() > 0.0) {
    const Vector3 n_A = k.R_WA.transpose() * witness.n;
    support +=
        motion.has_cores() ? motion.core_a().support(n_A) : motion.half_a().dot(n_A.cwiseAbs());
  }
  witness.gap = witness.n.dot(k.d) - support;
  return witness;
}

/// Support along n of a rounded box (its rounding is in `PairMotion::reach`), or of the hull of all
/// that it passes while it spins about w (eq. 8).
double hull_support(const Vector3& half, const Matrix3& R, bool spins, const Vector3& w,
                    const Vector3& n) {
  const Vector3 n_B = R.transpose() * n;
  if (!spins) {
    return half.dot(n_B.cwiseAbs());
  }
  const Vector3 axis = R.transpose() * w.normalized();
  const double along = std::abs(n_B.dot(axis));
  const double across = n_B.cross(axis).norm();
  double support = 0.0;
  for (int corner = 0; corner < 4; ++corner) {  // of opposite corners one is as good as the other
    const Vector3 x((corner & 1) != 0 ? half.x() : -half.x(),
                    (corner & 2) != 0 ? half.y() : -half.y(), half.z());
    support = std::max(support, along * std::abs(x.dot(axis)) + across * x.cross(axis).norm());
  }
  return support;
}

}  // namespace

PairKind pair_kind(const Shape& a, const Shape& b) {
  if (is_convex_pair(a, b)) {
    return std::holds_alternative<HalfSpace>(b) ? PairKind::core_plane : PairKind::cores;
  }
  const bool sphere = std::holds_alternative<Sphere>(a);
  if (std::holds_alternative<HalfSpace>(b)) {
    return sphere ? PairKind::sphere_plane : PairKind::box_plane;
  }
  if (std::holds_alternative<Sphere>(b)) {
    return PairKind::sphere_sphere;
  }
  return sphere ? PairKind::sphere_box : PairKind::box_box;
}

Witness between_balls(PairKind kind, const PairMotion& motion, const Kinematics& k) {
  const double reach = motion.reach() + motion.radius_a() + motion.radius_b();
  Witness witness;
  if (against_plane(kind)) {
    witness.n = -k.R_WB.col(1);
    // A plane that turns has no ball around it.
    witness.gap = motion.turns_b() ? -infinity : witness.n.dot(k.d) - reach;
  } else {
    witness = between_points(k.d, reach);
  }
  witness.frame = WitnessFrame::hulls;
  return witness;
}

Witness between_hulls(PairKind kind, const PairMotion& motion, const Kinematics& k,
                      const Witness& along) {
  Witness best;
  best.gap = -infinity;
  best.frame = WitnessFrame::hulls;
  const bool plane = against_plane(kind);
  if ((motion.turns_a() && !motion.spins_a()) ||
      (motion.turns_b() && (plane || !motion.spins_b()))) {
    return best;
  }
  const auto keep_better = [&](Vector3 n) {
    const double length = n.norm();
    if (!(length > 0.0)) {
      return;
    }
    n /= !plane && n.dot(k.d) < 0.0 ? -length : length;
    double gap = n.dot(k.d) - motion.reach();
    if (motion.radius_a() > 0.0) {
      gap -= motion.has_cores()
                 ? core_hull_support(motion.core_a(), k.R_WA, motion.turns_a(), k.w_a, n)
                 : hull_support(motion.half_a(), k.R_WA, motion.turns_a(), k.w_a, n);
    }
    if (motion.radius_b() > 0.0) {
      gap -= motion.has_cores()
                 ? core_hull_support(motion.core_b(), k.R_WB, motion.turns_b(), k.w_b, -n)
                 : hull_support(motion.half_b(), k.R_WB, motion.turns_b(), k.w_b, n);
    }
    if (gap > best.gap) {
      best.gap = gap;
      best.n = n;
    }
  };
  keep_better(along.n);
  if (plane) {  // the only direction there is
    return best;
  }
  keep_better(k.d);
  // Tries faces that do not turn, axes of turning, and directions across these.
  for (const bool second : {false, true}) {
    const bool turns = second ? motion.turns_b() : motion.turns_a();
    if (turns) {
      const Vector3 axis = (second ? k.w_b : k.w_a).normalized();
      keep_better(axis);
      keep_better(k.d - axis * axis.dot(k.d));
    } else if ((second ? motion.radius_b() : motion.radius_a()) > 0.0) {
      for (int i = 0; i < 3; ++i) {
        keep_better((second ? k.R_WB : k.R_WA).col(i));
      }
    }
  }
  return best;
}

Vector3 between_spun_boxes(PairKind kind, const PairMotion& motion, const Kinematics& k) {
  if (against_plane(kind) || motion.has_cores() || (motion.turns_a() && !motion.spins_a()) ||
      (motion.turns_b() && !motion.spins_b())) {
    return Vector3::Zero();
  }
  const SpunBox a = motion.turns_a()
                        ? SpunBox::spinning(motion.half_a(), Vector3::Zero(), k.R_WA, k.w_a)
                        : SpunBox(motion.half_a(), Vector3::Zero(), k.R_WA);
  const SpunBox b = motion.turns_b() ? SpunBox::spinning(motion.half_b(), k.d, k.R_WB, k.w_b)
                                     : SpunBox(motion.half_b(), k.d, k.R_WB);
  return direction_between(a, b, Vector3::Zero());
}

double clear_of_balls(PairKind kind, const PairMotion& motion) {
  const bool plane = against_plane(kind);
  if (plane && motion.turns_b()) {
    return 0.0;
  }
  const double reach =
      (motion.reach() + motion.radius_a() + motion.radius_b()) * (1.0 + 8.0 * unit_roundoff);
  double t = 0.0;
  Kinematics k;
  // Along the line of the centres the distance is a parabola, or not below one. Three such lines
  // come near enough to where the balls touch: the bodies inside them matter then.
  for (int line = 0; line < (plane ? 1 : 3); ++line) {
    plane ? motion.evaluate(t, k) : motion.evaluate_translation(t, k);
    const double distance = k.d.norm();
    const Vector3 n = plane ? Vector3(-k.R_WB.col(1)) : Vector3(k.d / distance);
    const double value = (plane ? n.dot(k.d) : distance) - reach - k.error;
    if (!(value > 0.05 * reach)) {
      break;
    }
    const double bend = motion.bend(t, motion.duration());
    const double step =
        first_root(value, n.dot(k.v) - k.rate_error, n.dot(k.c) - bend - k.second_error);
    const double remaining = motion.duration() - t;
    if (step >= remaining) {
      return motion.duration();
    }
    t += step * (1.0 - 64.0 * u);
  }
  return t;
}

Witness find_witness(PairKind kind, const PairMotion& motion, const Kinematics& k) {
  switch (kind) {
    case PairKind::sphere_sphere:
      return between_points(k.d, motion.reach());
    case PairKind::sphere_box:
      return from_box(motion, k);
    case PairKind::sphere_plane:
    case PairKind::box_plane:
    case PairKind::core_plane:
      return from_plane(motion, k);
    case PairKind::cores:
      return between_cores(motion, k);
    case PairKind::box_box:
      break;
  }
  return between_boxes(motion, k);
}

bool proven_overlap(PairKind kind, const PairMotion& motion, const Kinematics& k,
                    const Witness& witness) {
  switch (kind) {
    case PairKind::box_box:
      return boxes_proven_overlapping(motion, k, witness);
    case PairKind::cores:
      return cores_proven_overlapping(motion, k, witness);
    default:
      return witness.gap < -k.error;
  }
}

double first_root(double f, double b, double c) {
  const double discriminant = b * b - 4.0 * f * c;
  if (!std::isfinite(discriminant)) {
    return 0.0;
  }
  if (c < 0.0) {
    const double root = std::sqrt(discriminant);
    return b <= 0.0 ? 2.0 * f / (root - b) : -(b + root) / (2.0 * c);
  }
  if (b >= 0.0 || discriminant < 0.0) {
    return infinity;
  }
  return 2.0 * f / (std::sqrt(discriminant) - b);
}

}  // namespace kairos::ccd
