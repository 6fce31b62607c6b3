#include "ccd/pair_looks.hpp"

#include "ccd/box_witness.hpp"
#include "ccd/moving_cores.hpp"
#include "ccd/separation_function.hpp"

#include <algorithm>
#include <cassert>

namespace kairos::ccd {
namespace {

/// Sine of the angle of edges.
constexpr double nearly_parallel = 1e-6;

}  // namespace

Look PairLooks::look(double t) {
  assert(t >= 0.0 && t <= duration());
  Look at;
  motion_.evaluate(t, at.k);
  at.witness = find_witness(kind_, motion_, at.k);
  ++count_;
  return at;
}

double PairLooks::approach(const Look& at) const {
  const TurnBounds now{.until = at.t(), .w_a = at.k.w_a.norm(), .w_b = at.k.w_b.norm()};
  return -SeparationFunction(motion_, at.k, now, at.witness).rate();
}

double PairLooks::step_along(const Kinematics& k, const Witness& witness, const TurnBounds& bounds,
                             double horizon) const {
  return witness.gap > k.error ? SeparationFunction(motion_, k, bounds, witness).advance(horizon)
                               : 0.0;
}

double PairLooks::safe_step(const Kinematics& k, const Witness& witness, const TurnBounds& bounds,
                            double horizon) const {
  const SeparationFunction moving(motion_, k, bounds, witness);
  double step = moving.advance(horizon);
  assert(step >= 0.0 && step <= horizon);
  const bool turns = motion_.turns_a() || motion_.turns_b();
  if (!turns || step >= horizon) {
    return step;
  }
  // More than half of what the approach alone would allow: turning hardly matters. The direction
  // across edges that are nearly parallel turns as fast as it likes, and closes by that.
  const bool turns_fast = witness.frame == WitnessFrame::edges && witness.sine < nearly_parallel;
  const double closing = -moving.rate();
  if (closing > 0.0 && 2.0 * step * closing > witness.gap && !turns_fast) {
    return step;
  }
  const auto try_along = [&](const Witness& other) {
    step = step < horizon ? std::max(step, step_along(k, other, bounds, horizon)) : step;
  };
  try_along(between_balls(kind_, motion_, k));
  try_along(between_hulls(kind_, motion_, k, witness));
  const bool turns_with_plane = against_plane(kind_) && motion_.turns_b();
  if (witness.frame != WitnessFrame::world && !turns_with_plane) {
    Witness still = witness;
    still.frame = WitnessFrame::world;
    try_along(still);
  }
  return step;
}

double PairLooks::step_along_axes(const Look& at, const TurnBounds& bounds, double horizon) const {
  double step = 0.0;
  const auto try_along = [&](Witness witness) {
    step = std::max(step, step_along(at.k, witness, bounds, horizon));
    if (witness.frame != WitnessFrame::world) {  // what turns may be at a face that does not
      witness.frame = WitnessFrame::world;
      step = std::max(step, step_along(at.k, witness, bounds, horizon));
    }
  };
  for (int axis = 0; kind_ == PairKind::box_box && axis < axis_count; ++axis) {
    try_along(along_axis(motion_, at.k, axis));
  }
  if (kind_ == PairKind::cores) {
    for_each_axis(motion_, at.k, at.witness,
                  [&](const Vector3& n) { try_along(along_direction(motion_, at.k, n)); });
    for_each_two_edges(motion_, at.k, at.witness.n, [&](const Vector3& a, const Vector3& b) {
      const Witness witness = along_two_edges(motion_, at.k, a, b, at.witness.n);
      step = std::max(step, step_along(at.k, witness, bounds, horizon));
    });
  }
  return step;
}

double PairLooks::step_beside_hulls(const Look& at, const TurnBounds& bounds,
                                    double horizon) const {
  Witness hulls = between_hulls(kind_, motion_, at.k, at.witness);
  if (!(hulls.gap > at.k.error)) {
    Witness nearest = at.witness;
    nearest.n = between_spun_boxes(kind_, motion_, at.k);
    hulls = between_hulls(kind_, motion_, at.k, nearest);
  }
  return step_along(at.k, hulls, bounds, horizon);
}

}  // namespace kairos::ccd
