#include "ccd/advancement.hpp"
#include "ccd/body_parts.hpp"
#include "ccd/common_point.hpp"
#include "ccd/moving_cores.hpp"
#include "ccd/pair_motion.hpp"
#include "ccd/parts_impact.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/separation_function.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// How long every point of b at `depth` stays inside, s. The bound over a long horizon is useless
/// if bodies accelerate: `horizon` shrinks to what the answer needs, and the next step starts from
/// it. Against a half-space only its normal separates, and the gap along it says more than a speed.
double safely_inside(PairKind kind, const PairMotion& motion, const Kinematics& k,
                     const Witness& witness, double& horizon) {
  const bool plane = against_plane(kind);
  // Along the witness the depth is only an upper bound; for cores the proven depth is used.
  const double depth =
      kind == PairKind::cores ? proven_depth(motion, k, witness) : -witness.gap - k.error;
  while (true) {
    const TurnBounds bounds = motion.bounds(k.t, horizon);
    double safe = 0.0;
    if (plane) {
      safe = SeparationFunction(motion, k, bounds, witness).advance_inside(horizon);
    } else {
      const double speed = motion.speed_bound(k, bounds, horizon);
      safe = speed > 0.0 ? depth / speed : horizon;
      safe = std::max(safe, common_point(kind, motion, k, bounds, witness, horizon));
    }
    if (!(safe < 0.25 * horizon) || !(depth > 0.0)) {
      return std::min(safe, horizon);
    }
    horizon = std::max(2.0 * safe, horizon / 16.0);
  }
}

}  // namespace

TimeOfImpact advance_to_separation(const MovingShape& a, const MovingShape& b, const Window& window,
                                   double tolerance) {
  if (has_parts(a.shape) || has_parts(b.shape)) {
    return parts_separation(a, b, window, tolerance);
  }
  const PairKind kind = pair_kind(a.shape, b.shape);
  const PairMotion motion(a, b, window, Positions::heights);
  const double enough = tolerance > 0.0 ? tolerance : default_tolerance(a, b, window);
  const double duration = motion.duration();
  TimeOfImpact toi;
  Kinematics k;
  double t = 0.0;
  double probe = 0.0;
  double horizon = std::isfinite(duration) ? duration : 1.0;  // of the bounds
  bool settled = false;
  for (int step = 0; step < 200000 && !settled; ++step) {
    motion.evaluate(t + probe, k);
    ++toi.evaluations;
    const Witness witness = find_witness(kind, motion, k);
    toi.normal = witness.n;
    if (witness.gap > k.error && (t + probe > 0.0 || witness.gap > enough)) {
      toi.status = t + probe > 0.0 ? ToiStatus::impact : ToiStatus::separated;
      toi.t_lo = t;
      toi.t_hi = t + probe;
      return toi;
    }
    if (!(t + probe < duration)) {
      break;
    }
    const bool deep = -witness.gap > enough &&
                      (kind != PairKind::cores || proven_depth(motion, k, witness) > 0.0);
    if (deep) {  // no point of b leaves a before depth / speed
      t += probe;
      probe = 0.0;
      horizon = std::min(duration - t, 4.0 * horizon);
      const double safe = safely_inside(kind, motion, k, witness, horizon);
      settled = !(t + safe > t);
      t = std::min(t + safe, duration);
    } else {  // within tolerance of parting: look ahead, ever further
      const double speed = motion.speed_bound(k, motion.bounds(k.t, 0.0), 0.0);
      const double least = motion.time_to_cover(0.25 * enough, speed, k);
      probe = std::min(duration - t, std::max({2.0 * probe, 8.0 * ulp(t), least}));
      settled = !(t + probe > t) || !std::isfinite(probe);
    }
  }
  toi.status = ToiStatus::overlapping;
  toi.t_lo = toi.t_hi = duration;
  return toi;
}

}  // namespace kairos::ccd
