#include "ccd/advancement.hpp"

#include "ccd/closed_form.hpp"
#include "ccd/contact_patch.hpp"
#include "ccd/descent_answer.hpp"
#include "ccd/relative_boxes.hpp"
#include "ccd/roundoff.hpp"
#include "ccd/separation_function.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;
constexpr double greatest_turn = 4.0e5;  ///< rad within a window; beyond, answers are `undecided`

/// One query in progress: where it is, what separates the shapes there, what it has cost.
class Advancement {
 public:
  Advancement(const MovingShape& a, const MovingShape& b, const Window& window,
              const AdvancementOptions& options)
      : a_(a),
        b_(b),
        window_(window),
        prove_(options.prove),
        tolerance_(options.tolerance),
        kind_(pair_kind(a.shape, b.shape)),
        motion_(a, b, window) {}

  TimeOfImpact run() {
    const double clear = clear_of_balls(kind_, motion_);
    if (clear > 0.0) {
      ++evaluations_;
      if (clear >= motion_.duration()) {
        separated();
        return answer_;
      }
    }
    if (!(tolerance_ > 0.0)) {
      tolerance_ = default_tolerance(a_, b_, window_);
    }
    turn_ = motion_.bounds(clear, motion_.duration() - clear);
    limit_work();
    look(clear);
    if (clear == 0.0 && witness_.gap <= k_.error && !leave_touch()) {
      return answer_;
    }
    while (advance_once()) {
    }
    return answer_;
  }

 private:
  void limit_work() {
    const double angle = motion_.total_turn();
    // A radian takes some 40 evaluations where bodies nearly touch all along.
    budget_ = 20000 + static_cast<int>(40.0 * std::min(angle, greatest_turn));
    end_ = angle > greatest_turn * (1.0 + 1e-9) ? motion_.duration() * (greatest_turn / angle)
                                                : motion_.duration();
    if (std::isnan(end_)) {  // an infinite angle in an infinite time
      end_ = greatest_turn / (turn_.w_a + turn_.w_b);
    }
  }

  /// Where the shapes are at t, and what separates them.
  void look(double t) {
    motion_.evaluate(t, k_);
    witness_ = find_witness(kind_, motion_, k_);
    ++evaluations_;
  }

  /// Bounds of the motion from here on. Those of polynomials hold on a piece that follows the
  /// steps: short where steps are short.
  void renew_bounds() {
    if (motion_.simple()) {
      turn_.until = motion_.duration();
      return;
    }
    const bool long_piece = last_step_ > 0.0 && k_.t + 16.0 * last_step_ < turn_.until;
    if (long_piece || k_.t >= turn_.until) {
      const double remaining = motion_.duration() - k_.t;
      const double piece = last_step_ > 0.0 ? std::min(remaining, 4.0 * last_step_) : remaining;
      turn_ = motion_.bounds(k_.t, piece);
    }
  }

  /// A step that is proven free of contact: along the witness that turns with the bodies and, where
  /// turning and not approach is what limits that, also along one that stays.
  double safe_step(double horizon) const {
    const SeparationFunction moving(motion_, k_, turn_, witness_);
    double step = moving.advance(horizon);
    const bool turns = motion_.turns_a() || motion_.turns_b();
    if (!turns || step >= horizon) {
      return step;
    }
    const double closing = -moving.rate();
    if (closing > 0.0 && 2.0 * step * closing > witness_.gap) {
      return step;
    }
    const Witness balls = between_balls(kind_, motion_, k_);
    if (balls.gap > 0.1 * witness_.gap) {
      step = std::max(step, SeparationFunction(motion_, k_, turn_, balls).advance(horizon));
    }
    const bool plane = kind_ == PairKind::box_plane || kind_ == PairKind::sphere_plane;
    if (step < horizon && witness_.frame != WitnessFrame::world && !plane) {
      const Witness still = unit_in_world(motion_, k_, witness_);
      step = std::max(step, SeparationFunction(motion_, k_, turn_, still).advance(horizon));
    }
    return step;
  }

  /// One step of the main loop: false when the answer is known.
  bool advance_once() {
    if (evaluations_ > budget_ || k_.t > end_) {
      return undecided_until(motion_.duration());
    }
    if (witness_.gap <= tolerance_) {
      ++near_;
      const bool at_roundoff = witness_.gap <= 8.0 * k_.error / witness_.length;
      const bool enough = !prove_ || at_roundoff || near_ % 8 == 5;
      if (enough && resolve_contact()) {
        return false;
      }
    } else {
      near_ = 0;
    }
    renew_bounds();
    const double remaining = motion_.duration() - k_.t;
    const double horizon = motion_.simple() ? remaining : std::min(remaining, turn_.until - k_.t);
    const double step = safe_step(horizon);
    if (step >= remaining * (1.0 - 128.0 * u)) {
      return separated();
    }
    // A step to the end of the bounds goes there exactly: no sliver is left for the next one.
    const double next = step >= horizon * (1.0 - 128.0 * u) ? turn_.until : k_.t + step;
    if (!(next > k_.t)) {
      if (!motion_.simple() && turn_.until - k_.t > 64.0 * ulp(k_.t)) {
        last_step_ = (turn_.until - k_.t) / 64.0;  // bounds over a long piece were useless
        return true;
      }
      return resolve_stuck();
    }
    last_step_ = step;
    look(next);
    return true;
  }

  /// How far ahead a gap within roundoff is first looked at, s: the time to cover `length`, and
  /// never so little that 200 doublings would not reach the end of the window. Without that a query
  /// that starts at 0, where an ulp is nothing, would answer before it got anywhere, and whoever
  /// asks again from there would ask for ever.
  double first_look(double length, double speed) const {
    const double remaining = motion_.duration() - k_.t;
    const double unit = std::isfinite(remaining) ? remaining : 1.0;
    const double crossing = motion_.time_to_cover(length, speed, k_);
    return std::max(
        {8.0 * ulp(k_.t), std::ldexp(unit, -150), std::isfinite(crossing) ? crossing : unit});
  }

  /// Looks ahead from a gap within tolerance for a proven overlap. True if that settles the query.
  bool resolve_contact() {
    if (!prove_) {  // a pair that leaves is followed: it has just met
      return approach() >= 0.0 && impact(k_.t, k_.t);
    }
    const Kinematics here = k_;
    const Witness witness = witness_;
    const double reach = witness.gap + 4.0 * k_.error / witness.length;
    double ahead = first_look(1.5 * reach, std::abs(approach()));
    const double remaining = motion_.duration() - here.t;
    const bool stuck = witness.gap <= 2.0 * here.error / witness.length;
    for (int attempt = 0; attempt < (stuck ? 200 : 3); ++attempt) {
      ahead = std::min(ahead, remaining);
      look(here.t + ahead);
      if (proven_overlap(kind_, motion_, k_, witness_)) {
        const double t_hi = k_.t;
        k_ = here;
        witness_ = witness;
        return impact(here.t, t_hi);
      }
      if (witness_.gap > 2.0 * k_.error / witness_.length || !(ahead < remaining)) {
        break;
      }
      ahead *= 2.0;
    }
    if (!stuck) {  // not proven yet: closer is better
      k_ = here;
      witness_ = witness;
      return false;
    }
    const double t_hi = k_.t;
    k_ = here;
    witness_ = witness;
    undecided_until(t_hi);
    return true;
  }

  /// No step is possible any more, whatever the gap: time itself has no finer grain.
  bool resolve_stuck() {
    witness_.gap = std::min(witness_.gap, k_.error);
    return resolve_contact() ? false : undecided_until(motion_.duration());
  }

  /// Speed at which the gap closes along the witness, m/s. By bounds for this instant: those of the
  /// steps ahead may be infinite, where a polynomial quaternion comes near zero.
  double approach() const {
    return -SeparationFunction(motion_, k_, motion_.bounds(k_.t, 0.0), witness_).rate();
  }

  /// The start is within roundoff of touching, or overlaps. True if the shapes leave each other and
  /// the search goes on from a later time; false with the answer if not.
  bool leave_touch() {
    if (proven_overlap(kind_, motion_, k_, witness_)) {
      answer_.status = ToiStatus::overlapping;
      return finish(0.0, 0.0);
    }
    const double duration = motion_.duration();
    const double horizon = motion_.simple() ? duration : turn_.until;
    if (witness_.gap >= -2.0 * k_.error / witness_.length) {
      const SeparationFunction separation(motion_, k_, turn_, witness_);
      double left = separation.advance_from_touch(horizon);
      if (!(left > 0.0) && kind_ == PairKind::box_box) {
        left = leave_along_another_axis(horizon);
      }
      if (left >= duration * (1.0 - 128.0 * u) && duration > 0.0) {
        separated();
        return false;
      }
      if (left > 0.0) {
        last_step_ = left;
        look(left);
        return true;
      }
      if (separation.rate() < -k_.rate_error) {
        return enter();
      }
    }
    return enter();
  }

  /// Touch along several axes (a corner, an edge): leaving along any of them is leaving.
  double leave_along_another_axis(double horizon) const {
    const RelativeBoxes boxes(motion_.half_a(), k_.R_WA, motion_.half_b(), k_.R_WB, k_.d);
    double left = 0.0;
    for (int axis = 0; axis < axis_count; ++axis) {
      const AxisSeparation s = axis_separation(boxes, axis);
      if (s.value - motion_.reach() < -k_.error || !(s.length > 0.0)) {
        continue;
      }
      Witness witness;
      witness.gap = s.gap() - motion_.reach();
      witness.n = k_.R_WA * axis_normal(boxes, s);
      witness.frame = axis < 3   ? (motion_.turns_a() ? WitnessFrame::a : WitnessFrame::world)
                      : axis < 6 ? (motion_.turns_b() ? WitnessFrame::b : WitnessFrame::world)
                                 : WitnessFrame::world;
      left = std::max(left,
                      SeparationFunction(motion_, k_, turn_, witness).advance_from_touch(horizon));
    }
    return left;
  }

  /// In touch and not provably leaving: an overlap soon is an impact now; a gap soon means that
  /// they have left (rolling off, a turning corner); neither, that they slide.
  bool enter() {
    const Kinematics here = k_;
    const Witness witness = witness_;
    const double duration = motion_.duration();
    const double rate = approach();
    const double scale = motion_.speed_bound(k_, motion_.bounds(0.0, 0.0), 0.0);
    double ahead = first_look(8.0 * k_.error, rate > k_.rate_error ? rate : scale);
    for (int attempt = 0; attempt < 200 && ahead > 0.0; ++attempt) {
      ahead = std::min(ahead, duration);
      look(ahead);
      if (proven_overlap(kind_, motion_, k_, witness_)) {
        const double t_hi = k_.t;
        k_ = here;
        witness_ = witness;
        impact(0.0, t_hi);
        return false;
      }
      if (witness_.gap > 4.0 * k_.error / witness_.length) {
        last_step_ = ahead;
        return true;
      }
      if (!(ahead < duration) || !std::isfinite(2.0 * ahead)) {
        break;
      }
      ahead *= 2.0;
    }
    k_ = here;
    witness_ = witness;
    undecided_until(duration);
    return false;
  }

  // ---- answers: each returns false, "the query is settled" -----------------------------------

  bool separated() {
    answer_.status = ToiStatus::separated;
    answer_.t_lo = answer_.t_hi = motion_.duration();
    answer_.evaluations = evaluations_;
    return false;
  }
  bool impact(double t_lo, double t_hi) {
    answer_.status = ToiStatus::impact;
    finish(t_lo, t_hi);
    return true;
  }
  bool undecided_until(double t_hi) {
    answer_.status = ToiStatus::undecided;
    return finish(k_.t, t_hi);
  }
  bool finish(double t_lo, double t_hi);
  void nearest_points();

  MovingShape a_;
  MovingShape b_;
  Window window_;
  bool prove_;
  double tolerance_;
  PairKind kind_;
  PairMotion motion_;
  TurnBounds turn_;
  double end_ = 0.0;
  int budget_ = 0;
  int evaluations_ = 0;
  int near_ = 0;
  double last_step_ = 0.0;
  Kinematics k_;
  Witness witness_;
  TimeOfImpact answer_;
};

/// Gap from below, normal and nearest points at `t_lo`.
bool Advancement::finish(double t_lo, double t_hi) {
  answer_.t_lo = t_lo;
  answer_.t_hi = t_hi;
  answer_.evaluations = evaluations_;
  if (k_.t != t_lo) {
    look(t_lo);
  }
  // Whoever evaluates the poses sees absolute coordinates, each rounded: a gap within 32 u of them
  // may look like an overlap.
  const double coordinates = a_.motion.position(start_of(a_.motion, window_) + t_lo).lpNorm<1>() +
                             k_.d.lpNorm<1>() + motion_.radius_a() + motion_.radius_b();
  if (witness_.gap - k_.error / witness_.length <= 64.0 * u * coordinates) {
    retreat_from_overlap(a_, b_, window_, answer_);
    if (answer_.t_lo != k_.t) {
      look(answer_.t_lo);
    }
  }
  answer_.normal = witness_.n / witness_.length;
  answer_.gap = std::max(0.0, witness_.gap - k_.error / witness_.length);
  nearest_points();
  return false;
}

/// Where the shapes are nearest, along the witness.
void Advancement::nearest_points() {
  const Vector3& n = answer_.normal;
  const Vector3 origin_a = a_.motion.position(start_of(a_.motion, window_) + answer_.t_lo);
  if (kind_ == PairKind::box_box) {
    const RelativeBoxes boxes(motion_.half_a(), k_.R_WA, motion_.half_b(), k_.R_WB, k_.d);
    const AxisSeparation axis{witness_.axis, witness_.gap * witness_.length, witness_.length,
                              witness_.sign};
    const ContactPatch patch = contact_patch(boxes, axis);
    answer_.witness_a = origin_a + k_.R_WA * patch.on_a;
    answer_.witness_b = origin_a + k_.R_WA * patch.on_b;
    return;
  }
  if (kind_ == PairKind::box_plane) {
    // Roundoff of a rotated extent: 1024 u of the size, as in `measure_overlap`.
    answer_.witness_a =
        origin_a + k_.R_WA * lowest_centroid(motion_.half_a(), k_.R_WA.transpose() * n,
                                             1024.0 * u * motion_.half_a().sum());
  } else {
    answer_.witness_a = origin_a + n * std::get<Sphere>(a_.shape).radius;
  }
  answer_.witness_b = answer_.witness_a + n * (witness_.gap + motion_.error_reach());
}

double local_end(const Motion& motion, const Window& window) {
  return std::abs(window.start - motion.start) +
         (std::isfinite(window.duration) ? window.duration : 0.0);
}

/// sum |c_k| s^k: no coordinate of the curve is larger up to s.
double reached(const Polynomial<3>& p, double s) {
  double size = 0.0;
  for (int k = p.degree(); k >= 0; --k) {
    size = size * s + p[k].lpNorm<Eigen::Infinity>();
  }
  return size;
}

double finite_radius(const Shape& shape) {
  const double radius = bounding_radius(shape);
  return std::isfinite(radius) ? radius : 0.0;
}

}  // namespace

double default_tolerance(const MovingShape& a, const MovingShape& b, const Window& window) {
  const double extent = std::min(smallest_extent(a.shape), smallest_extent(b.shape));
  const double s_a = local_end(a.motion, window);
  const double s_b = local_end(b.motion, window);
  const double radii = finite_radius(a.shape) + finite_radius(b.shape);
  const double coordinates = reached(a.motion.position, s_a) + reached(b.motion.position, s_b);
  double apart = coordinates;
  if (a.motion.start == b.motion.start) {  // seen from each other
    Polynomial<3> d = b.motion.position;
    d.resize(std::max(d.degree(), a.motion.position.degree()));
    for (int k = 0; k <= a.motion.position.degree(); ++k) {
      d[k] -= a.motion.position[k];
    }
    apart = std::min(apart, reached(d, s_a));
  }
  // Roundoff: 64 u of the largest coordinates that the motions reach, and twice the bound of a
  // separation's rounding, 96 u (|d|_1 + |A|_1 + |B|_1), with |d|_1 <= 3 |d|.
  return 1e-9 * extent + 64.0 * u * coordinates + 640.0 * u * (apart + radii);
}

TimeOfImpact advance_to_impact(const MovingShape& a, const MovingShape& b, const Window& window,
                               const AdvancementOptions& options) {
  return Advancement(a, b, window, options).run();
}

}  // namespace kairos::ccd
