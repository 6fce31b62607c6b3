#include "ccd/contact_answer.hpp"

#include "ccd/box_witness.hpp"
#include "ccd/closed_form.hpp"
#include "ccd/contact_patch.hpp"
#include "ccd/core_patch.hpp"
#include "ccd/descent_answer.hpp"
#include "ccd/moving_cores.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cassert>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;
/// A caller that evaluates the poses has rounded absolute coordinates: a gap within 32 u of both
/// bodies' may look like an overlap.
constexpr double pose_rounding = 64.0 * u;
/// Roundoff of a rotated extent, as a part of the size: as in `measure_overlap`.
constexpr double extent_rounding = 1024.0 * u;

struct NearestOnBoth {
  Vector3 on_a;
  Vector3 on_b;
};

/// The nearest points of two boxes, in the frame of a.
NearestOnBoth nearest_on_boxes(const PairMotion& motion, const Look& at) {
  const Witness& w = at.witness;
  const RelativeBoxes boxes = relative_boxes(motion, at.k);
  if (w.axis == Witness::none) {
    const NearestPoints nearest = nearest_of_boxes(boxes);
    return {nearest.on_a, nearest.on_b};
  }
  const ContactPatch patch = contact_patch(boxes, w.axis, w.sign, at.k.R_WA.transpose() * w.n);
  return {patch.on_a, patch.on_b};
}

/// Where a is nearest along the witness, world; not of two boxes. `origin`: that of a.
Vector3 nearest_on_a(const PairLooks& pair, const MovingShape& a, const Vector3& origin,
                     const Look& at) {
  const PairMotion& motion = pair.motion();
  const Vector3& n = at.witness.n;
  const Matrix3& R = at.k.R_WA;
  switch (pair.kind()) {
    case PairKind::cores:
      return origin + core_patch(core_pair(motion, at.k), n).on_a() +
             motion.core_a().rounding() * n;
    case PairKind::core_plane:
      return origin + R * lowest_point(motion.core_a(), R.transpose() * n) +
             motion.core_a().rounding() * n;
    case PairKind::box_plane:
      return origin + R * lowest_centroid(motion.half_a(), R.transpose() * n,
                                          extent_rounding * motion.half_a().sum());
    default:
      return origin + n * std::get<Sphere>(a.shape).radius;
  }
}

/// Where the shapes are nearest, along the witness.
void add_nearest_points(const PairLooks& pair, const MovingShape& a, const Window& window,
                        const Look& at, TimeOfImpact& answer) {
  const Vector3 origin_a = a.motion.position(start_of(a.motion, window) + answer.t_lo);
  if (pair.kind() == PairKind::box_box) {
    const NearestOnBoth nearest = nearest_on_boxes(pair.motion(), at);
    answer.witness_a = origin_a + at.k.R_WA * nearest.on_a;
    answer.witness_b = origin_a + at.k.R_WA * nearest.on_b;
    return;
  }
  answer.witness_a = nearest_on_a(pair, a, origin_a, at);
  answer.witness_b = answer.witness_a + answer.normal * (at.gap() + pair.motion().error_reach());
}

}  // namespace

double reached(const Polynomial<3>& p, double s) {
  double size = 0.0;
  for (int k = p.degree(); k >= 0; --k) {
    size = size * s + p[k].lpNorm<Eigen::Infinity>();
  }
  return size;
}

void tell_contact(PairLooks& pair, const MovingShape& a, const MovingShape& b, const Window& window,
                  bool whole, Look at, TimeOfImpact& answer) {
  const PairMotion& motion = pair.motion();
  const double coordinates = reached(a.motion.position, start_of(a.motion, window) + at.t()) +
                             reached(b.motion.position, start_of(b.motion, window) + at.t()) +
                             at.k.d.lpNorm<1>() + motion.radius_a() + motion.radius_b();
  if (whole && at.gap() - at.k.error <= pose_rounding * coordinates) {
    retreat_from_overlap(a, b, window, answer);
    if (answer.t_lo != at.t()) {
      at = pair.look(answer.t_lo);
    }
  }
  assert(answer.t_lo >= 0.0 && answer.t_lo <= answer.t_hi);
  answer.evaluations = pair.count();
  answer.normal = at.witness.n;
  answer.gap = std::max(0.0, at.gap() - at.k.error);
  add_nearest_points(pair, a, window, at, answer);
}

}  // namespace kairos::ccd
