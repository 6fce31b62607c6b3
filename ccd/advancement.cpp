#include "ccd/advancement.hpp"

#include "ccd/body_parts.hpp"
#include "ccd/box_witness.hpp"
#include "ccd/closed_form.hpp"
#include "ccd/contact_patch.hpp"
#include "ccd/core_patch.hpp"
#include "ccd/descent_answer.hpp"
#include "ccd/moving_cores.hpp"
#include "ccd/parts_impact.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/separation_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// Evaluations that a query may take before it is `undecided`: these, and for each radian of
/// turning so many more as bodies take that nearly touch all along, up to so many radians.
constexpr int most_evaluations = 20'000;
constexpr double evaluations_per_radian = 40.0;
constexpr double most_radians = 1e4;
/// What is so near the end of the window, as a part of it, is at the end.
constexpr double end_rounding = 128.0 * u;
/// A gap of so many errors is roundoff: contact is sought from there. Twice the error is the least
/// that can be proven positive at all.
constexpr double roundoff_gap = 8.0;
constexpr double least_gap = 2.0;
/// Looks within the tolerance until a contact is sought though the gap is not roundoff yet, and
/// from then on every so often: a graze comes nearer ever more slowly.
constexpr int patience = 5;
constexpr int patience_again = 8;
/// Doublings of a look ahead: all that a double has between an ulp of 0 and a window; or, where
/// coming nearer may serve better, a few.
constexpr int all_doublings = 200;
constexpr int few_doublings = 3;
/// In touch at the start: nothing that stays above -16 errors is more than the roundoff of it.
constexpr double touch_depth = 16.0;
/// Spinning bodies: how often the hulls of all that they pass are tried, in looks from the first
/// on, if they turn by more than a radian still. Where these are apart nothing else has to be
/// looked at.
constexpr int looks_between_hulls = 64;
/// Steps back from where they are apart again, each about half of what is left: to 1e-30 of it.
constexpr int most_steps_back = 200;
/// Halvings of an interval in which the gap is least.
constexpr int most_halvings = 60;

/// sum |c_k| s^k: no coordinate of the curve is larger up to s.
double reached(const Polynomial<3>& p, double s) {
  double size = 0.0;
  for (int k = p.degree(); k >= 0; --k) {
    size = size * s + p[k].lpNorm<Eigen::Infinity>();
  }
  return size;
}

/// The shapes at one instant of the window, and what separates them there.
struct Look {
  Kinematics k;
  Witness witness;

  [[nodiscard]] double t() const { return k.t; }
  [[nodiscard]] double gap() const { return witness.gap; }
  /// Is the gap at most so many errors?
  [[nodiscard]] bool within(double errors) const { return witness.gap <= errors * k.error; }
};

/// One query: two motions in a window, bounds of what is ahead, and what it has cost so far.
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
        motion_(a, b, window, Positions::heights) {}

  Advancement(const MovingShape& a, const ConvexCore& part_of_a, const MovingShape& b,
              const ConvexCore* part_of_b, const Window& window, const PartQuery& query)
      : a_(a),
        b_(b),
        window_(window),
        prove_(query.prove),
        of_parts_(true),
        most_evaluations_(query.most_evaluations),
        tolerance_(query.tolerance),
        kind_(part_of_b != nullptr ? PairKind::cores : PairKind::core_plane),
        motion_(part_of_b != nullptr
                    ? PairMotion({part_of_a, a.motion}, {*part_of_b, b.motion}, window)
                    : PairMotion({part_of_a, a.motion}, b, window, Positions::heights)) {}

  TimeOfImpact run(double from = 0.0) {
    const double clear = std::max(from, clear_of_balls(kind_, motion_));
    if (clear > from) {
      ++evaluations_;
      if (clear >= motion_.duration()) {
        return separated();
      }
    }
    if (!(tolerance_ > 0.0)) {
      tolerance_ = default_tolerance(a_, b_, window_);
    }
    bound_from(clear, motion_.duration() - clear);
    Look at = look(clear);
    if (clear == 0.0 && at.within(1.0)) {
      if (const auto answer = leave_touch(at)) {
        return *answer;
      }
    }
    return advance_from(at);
  }

 private:
  using Answer = std::optional<TimeOfImpact>;

  /// The main loop: a look, a contact if it is one, a step that is proven free of contact.
  TimeOfImpact advance_from(Look at) {
    const int budget = work_allowed(at.t());
    const int first = evaluations_;
    const double repeats = at.t() + period(at.k);
    int near = 0;  // looks within the tolerance, one after the other
    while (true) {
      const bool spent = evaluations_ > budget;
      near = at.gap() <= tolerance_ ? near + 1 : 0;
      if (near > 0 && ((spent && !of_parts_) || worth_resolving(at, near))) {
        if (const auto answer = resolve_contact(at, spent && !of_parts_)) {
          return *answer;
        }
      }
      if (spent) {  // far from touch: whoever asks again from here comes through
        return undecided(at, at.t());
      }
      renew_bounds(at.t());
      const double next = next_after(at, (evaluations_ - first) % looks_between_hulls == 0);
      if (next >= std::min(motion_.duration(), repeats)) {
        return separated();
      }
      if (next > at.t()) {
        last_step_ = next - at.t();
        at = look(next);
      } else if (!motion_.simple() && bounds_.until - at.t() > 64.0 * ulp(at.t())) {
        last_step_ = (bounds_.until - at.t()) / 64.0;  // bounds over a long piece were useless
      } else {                                         // time itself has no finer grain
        return resolve_contact(at, true).value_or(undecided(at, motion_.duration()));
      }
    }
  }

  [[nodiscard]] bool worth_resolving(const Look& at, int near) const {
    return !prove_ || at.within(roundoff_gap) || near % patience_again == patience;
  }

  /// Work is counted from where the bodies come near.
  [[nodiscard]] int work_allowed(double t) const {
    const double angle = spin() > 0.0 ? spin() * (motion_.duration() - t) : 0.0;
    const double counted = angle < most_radians ? angle : most_radians;
    return of_parts_ ? most_evaluations_
                     : most_evaluations + static_cast<int>(evaluations_per_radian * counted);
  }

  /// After how long all is as it was, s: one body spins in its place and the other stays.
  [[nodiscard]] double period(const Kinematics& k) const {
    const bool alone = motion_.simple() && k.v.isZero(0.0) && k.c.isZero(0.0) &&
                       (motion_.turns_a() ? motion_.spins_a() && !motion_.turns_b()
                                          : motion_.turns_b() && motion_.spins_b());
    constexpr double turn =
        2.0 * std::numbers::pi * (1.0 + 1e-12);  // and the rounding of both ends
    return alone && spin() > 0.0 ? turn / spin() : std::numeric_limits<double>::infinity();
  }

  /// Angular speed of bodies that turn at constant rates, rad/s.
  [[nodiscard]] double spin() const {
    return (motion_.spins_a() ? bounds_.w_a : 0.0) + (motion_.spins_b() ? bounds_.w_b : 0.0);
  }

  /// Where the shapes are at t, and what separates them.
  Look look(double t) {
    Look at;
    motion_.evaluate(t, at.k);
    at.witness = find_witness(kind_, motion_, at.k);
    ++evaluations_;
    return at;
  }

  /// Bounds of the motion from here on. Those of polynomials hold on a piece that follows the
  /// steps: four steps long, and made anew before it is 16 steps too long.
  void renew_bounds(double t) {
    if (motion_.simple()) {
      bounds_.until = motion_.duration();
      return;
    }
    const bool long_piece = last_step_ > 0.0 && t + 16.0 * last_step_ < bounds_.until;
    if (long_piece || t >= bounds_.until) {
      const double remaining = motion_.duration() - t;
      const double piece = last_step_ > 0.0 ? std::min(remaining, 4.0 * last_step_) : remaining;
      bound_from(t, piece);
    } else if (t > bounded_at_ && !bounds_used_again_) {
      // How far d is bent from what it was there, and that from what it is here.
      bounds_.bend *= 2.0;
      bounds_used_again_ = true;
    }
  }

  void bound_from(double t, double piece) {
    bounds_ = motion_.bounds(t, piece);
    bounded_at_ = t;
    bounds_used_again_ = false;
  }

  /// The end of a step that is proven free of contact: exactly where the bounds end, if it gets
  /// there, so that no sliver is left for the next one.
  [[nodiscard]] double next_after(const Look& at, bool try_hulls) const {
    const double remaining = motion_.duration() - at.t();
    const double horizon = std::min(remaining, bounds_.until - at.t());
    double step = 0.0;
    if (try_hulls && spin() * remaining > 1.0) {
      Witness hulls = between_hulls(kind_, motion_, at.k, at.witness);
      if (!(hulls.gap > at.k.error)) {
        Witness nearest = at.witness;
        nearest.n = between_spun_boxes(kind_, motion_, at.k);
        hulls = between_hulls(kind_, motion_, at.k, nearest);
      }
      step = step_along(at.k, hulls, bounds_, horizon);
    }
    if (step * spin() < 1.0) {
      step = std::max(step, safe_step(at.k, at.witness, bounds_, horizon));
    }
    if (step >= remaining * (1.0 - end_rounding)) {
      return motion_.duration();
    }
    return step >= horizon * (1.0 - end_rounding) ? bounds_.until : at.t() + step;
  }

  /// How far f is positive: along the witness that turns with the bodies and, where turning and not
  /// approach is what limits that, also along directions that stay.
  [[nodiscard]] double safe_step(const Kinematics& k, const Witness& witness,
                                 const TurnBounds& bounds, double horizon) const {
    const SeparationFunction moving(motion_, k, bounds, witness);
    double step = moving.advance(horizon);
    const bool turns = motion_.turns_a() || motion_.turns_b();
    if (!turns || step >= horizon) {
      return step;
    }
    // More than half of what the approach alone would allow: turning hardly matters.
    const double closing = -moving.rate();
    if (closing > 0.0 && 2.0 * step * closing > witness.gap) {
      return step;
    }
    const auto try_along = [&](const Witness& other) {
      step = step < horizon ? std::max(step, step_along(k, other, bounds, horizon)) : step;
    };
    try_along(between_balls(kind_, motion_, k));
    try_along(between_hulls(kind_, motion_, k, witness));
    const bool plane = against_plane(kind_);
    if (witness.frame != WitnessFrame::world && !(plane && motion_.turns_b())) {
      Witness still = witness;
      still.frame = WitnessFrame::world;
      try_along(still);
    }
    return step;
  }

  [[nodiscard]] double step_along(const Kinematics& k, const Witness& witness,
                                  const TurnBounds& bounds, double horizon) const {
    return witness.gap > k.error ? SeparationFunction(motion_, k, bounds, witness).advance(horizon)
                                 : 0.0;
  }

  /// Speed at which the gap closes along the witness, m/s. By bounds for this instant: those of the
  /// steps ahead may be infinite, where a polynomial quaternion comes near zero.
  [[nodiscard]] double approach(const Look& at) const {
    return -SeparationFunction(motion_, at.k, motion_.bounds(at.t(), 0.0), at.witness).rate();
  }

  /// How far ahead a gap within roundoff is first looked at, s: the time to cover `length`, and
  /// never so little that 200 doublings would not reach the end of the window. Without that a query
  /// that starts at 0, where an ulp is nothing, would answer before it got anywhere, and whoever
  /// asks again from there would ask for ever.
  [[nodiscard]] double first_look(const Look& at, double length, double speed) const {
    const double remaining = motion_.duration() - at.t();
    const double unit = std::isfinite(remaining) ? remaining : 1.0;
    const double crossing = motion_.time_to_cover(length, speed, at.k);
    return std::max(
        {8.0 * ulp(at.t()), std::ldexp(unit, -150), std::isfinite(crossing) ? crossing : unit});
  }

  /// Looks ahead from a gap within tolerance, ever further, for a proven overlap. No answer means
  /// that coming nearer is better; who cannot is `persistent` and gets one.
  Answer resolve_contact(const Look& here, bool persistent) {
    const double speed = approach(here);
    if (!prove_) {  // a pair that leaves is followed: it has just met
      return speed >= 0.0 ? Answer(impact(here, here.t())) : std::nullopt;
    }
    persistent = persistent || here.within(least_gap);
    const double apart = std::max(here.gap(), least_gap * here.k.error);
    const double remaining = motion_.duration() - here.t();
    double ahead = first_look(here, 1.5 * (here.gap() + 4.0 * here.k.error), std::abs(speed));
    double before = here.t();
    double t = before;
    for (int attempt = 0; attempt < (persistent ? all_doublings : few_doublings); ++attempt) {
      ahead = std::min(ahead, remaining);
      t = here.t() + ahead;
      const Look there = look(t);
      if (proven_overlap(kind_, motion_, there.k, there.witness)) {
        return impact(here, t);
      }
      if (there.gap() > apart && !there.within(least_gap)) {
        if (persistent) {
          if (const auto t_hi = overlap_between(before, t)) {
            return impact(here, *t_hi);
          }
        }
        break;
      }
      if (!(ahead < remaining)) {
        break;
      }
      before = t;
      ahead *= 2.0;
    }
    return persistent ? Answer(undecided(here, t)) : std::nullopt;
  }

  /// They are apart at both ends, or nearly: a proven overlap where the gap is least between.
  std::optional<double> overlap_between(double low, double high) {
    for (int i = 0; i < most_halvings; ++i) {
      const double middle = low + 0.5 * (high - low);
      if (!(middle > low && middle < high)) {
        break;
      }
      const Look there = look(middle);
      if (proven_overlap(kind_, motion_, there.k, there.witness)) {
        return middle;
      }
      (approach(there) > 0.0 ? low : high) = middle;
    }
    return std::nullopt;
  }

  // ---- a start in touch ---------------------------------------------------------------------

  /// The start is within roundoff of touching, or overlaps. An answer, or none and `at` is where
  /// the shapes have left each other and the search goes on.
  Answer leave_touch(Look& at) {
    if (proven_overlap(kind_, motion_, at.k, at.witness)) {
      return overlapping(at);
    }
    if (at.gap() >= -least_gap * at.k.error) {
      const double duration = motion_.duration();
      const double left = time_of_leaving(at, motion_.simple() ? duration : bounds_.until);
      if (left >= duration * (1.0 - end_rounding) && duration > 0.0) {
        return separated();
      }
      if (left > 0.0) {
        last_step_ = left;
        at = look(left);
        return std::nullopt;
      }
    }
    return enter(at);
  }

  /// Up to when they are apart after leaving, along the witness or, where they touch along several
  /// axes (a corner, an edge), along any of them; 0 if they do not leave. Every axis counts by its
  /// gap along the unit direction: what is only noise, a cross product of parallel edges, separates
  /// nothing (eq. 5).
  [[nodiscard]] double time_of_leaving(const Look& at, double horizon) const {
    const auto leaving_along = [&](const Witness& witness) {
      return SeparationFunction(motion_, at.k, bounds_, witness).advance_from_touch(horizon);
    };
    double left = leaving_along(at.witness);
    for (int axis = 0; kind_ == PairKind::box_box && !(left > 0.0) && axis < axis_count; ++axis) {
      const Witness witness = along_axis(motion_, at.k, axis);
      if (witness.gap >= -least_gap * at.k.error) {
        left = leaving_along(witness);
      }
    }
    if (kind_ == PairKind::cores && !(left > 0.0)) {
      for_each_axis(motion_, at.k, at.witness, [&](const Vector3& n) {
        const Witness witness = along_direction(motion_, at.k, n);
        if (!(left > 0.0) && witness.gap >= -least_gap * at.k.error) {
          left = leaving_along(witness);
        }
      });
    }
    return left;
  }

  /// In touch and not provably leaving by rates: an overlap soon is an impact now; a gap soon, back
  /// from which they are proven apart until they touch, means that they have left (rolling off, a
  /// turning corner); neither, that they slide.
  Answer enter(Look& at) {
    const Look here = at;
    const double duration = motion_.duration();
    const double rate = approach(here);
    const double scale = motion_.speed_bound(here.k, motion_.bounds(0.0, 0.0), 0.0);
    double ahead = first_look(here, 8.0 * here.k.error, rate > here.k.rate_error ? rate : scale);
    double t = 0.0;
    for (int attempt = 0; attempt < all_doublings && ahead > 0.0; ++attempt) {
      t = std::min(ahead, duration);
      const Look there = look(t);
      if (proven_overlap(kind_, motion_, there.k, there.witness)) {
        return impact(here, t);
      }
      if (!there.within(4.0)) {
        if (!left_before(here, there)) {
          break;
        }
        last_step_ = t;
        at = there;
        return std::nullopt;
      }
      if (!(ahead < duration) || !std::isfinite(2.0 * ahead)) {
        break;
      }
      ahead *= 2.0;
    }
    return undecided(here, t);
  }

  /// Apart at `there`: have they been so since a time up to which the touch at `start` got no
  /// deeper than rounding (eq. 10)? The same steps, backwards.
  [[nodiscard]] bool left_before(const Look& start, const Look& there) {
    Look at = there;
    for (int i = 0; i < most_steps_back; ++i) {
      const TurnBounds ahead = motion_.bounds(0.0, at.t());
      const SeparationFunction touch(motion_, start.k, ahead, start.witness);
      if (touch.least_within(at.t()) >= -touch_depth * start.k.error) {
        return true;
      }
      const Kinematics back = reversed(at.k);
      const double step = safe_step(back, at.witness, reversed(ahead), at.t());
      const double t = at.t() - step;
      if (!(t < at.t()) || at.within(1.0)) {
        return false;
      }
      if (!(t > 0.0)) {
        return true;
      }
      at = look(t);
    }
    return false;
  }

  // ---- answers ------------------------------------------------------------------------------

  [[nodiscard]] TimeOfImpact separated() const {
    TimeOfImpact answer;
    answer.status = ToiStatus::separated;
    answer.t_lo = answer.t_hi = motion_.duration();
    answer.evaluations = evaluations_;
    return answer;
  }
  TimeOfImpact impact(const Look& at, double t_hi) {
    return at_contact(ToiStatus::impact, at, t_hi);
  }
  TimeOfImpact undecided(const Look& at, double t_hi) {
    return at_contact(ToiStatus::undecided, at, t_hi);
  }
  TimeOfImpact overlapping(const Look& at) { return at_contact(ToiStatus::overlapping, at, 0.0); }
  TimeOfImpact at_contact(ToiStatus status, const Look& at, double t_hi);
  void add_nearest_points(TimeOfImpact& answer, const Look& at) const;

  MovingShape a_;
  MovingShape b_;
  Window window_;
  bool prove_;
  bool of_parts_ = false;
  int most_evaluations_ = 0;  ///< of parts
  double tolerance_;
  PairKind kind_;
  PairMotion motion_;
  TurnBounds bounds_;        ///< of what is ahead
  double bounded_at_ = 0.0;  ///< when they were made, s
  bool bounds_used_again_ = false;
  double last_step_ = 0.0;  ///< s
  int evaluations_ = 0;
};

/// Gap from below, normal and nearest points at `t_lo`.
TimeOfImpact Advancement::at_contact(ToiStatus status, const Look& here, double t_hi) {
  TimeOfImpact answer;
  answer.status = status;
  answer.t_lo = here.t();
  answer.t_hi = t_hi;
  Look at = here;
  // Whoever evaluates the poses sees absolute coordinates, each rounded: a gap within 32 u of them
  // may look like an overlap.
  const double coordinates = reached(a_.motion.position, start_of(a_.motion, window_) + at.t()) +
                             reached(b_.motion.position, start_of(b_.motion, window_) + at.t()) +
                             at.k.d.lpNorm<1>() + motion_.radius_a() + motion_.radius_b();
  if (!of_parts_ && at.gap() - at.k.error <= 64.0 * u * coordinates) {
    retreat_from_overlap(a_, b_, window_, answer);
    if (answer.t_lo != at.t()) {
      at = look(answer.t_lo);
    }
  }
  answer.evaluations = evaluations_;
  answer.normal = at.witness.n;
  answer.gap = std::max(0.0, at.gap() - at.k.error);
  add_nearest_points(answer, at);
  return answer;
}

/// Where the shapes are nearest, along the witness.
void Advancement::add_nearest_points(TimeOfImpact& answer, const Look& at) const {
  const Vector3& n = answer.normal;
  const Matrix3& R = at.k.R_WA;
  const Vector3 origin_a = a_.motion.position(start_of(a_.motion, window_) + answer.t_lo);
  if (kind_ == PairKind::box_box) {
    const Witness& w = at.witness;
    const RelativeBoxes boxes = relative_boxes(motion_, at.k);
    if (w.axis == Witness::none) {
      const NearestPoints nearest = nearest_of_boxes(boxes);
      answer.witness_a = origin_a + R * nearest.on_a;
      answer.witness_b = origin_a + R * nearest.on_b;
      return;
    }
    const ContactPatch patch = contact_patch(boxes, w.axis, w.sign, R.transpose() * w.n);
    answer.witness_a = origin_a + R * patch.on_a;
    answer.witness_b = origin_a + R * patch.on_b;
    return;
  }
  if (kind_ == PairKind::cores) {
    const CorePatch patch = core_patch(core_pair(motion_, at.k), n);
    const double rounded = motion_.core_a().rounding();
    answer.witness_a = origin_a + patch.on_a() + rounded * n;
    answer.witness_b = answer.witness_a + n * (at.gap() + motion_.error_reach());
    return;
  }
  if (kind_ == PairKind::core_plane) {
    const Vector3 lowest = lowest_point(motion_.core_a(), R.transpose() * n);
    answer.witness_a = origin_a + R * lowest + motion_.core_a().rounding() * n;
  } else if (kind_ == PairKind::box_plane) {
    // Roundoff of a rotated extent: 1024 u of the size, as in `measure_overlap`.
    answer.witness_a = origin_a + R * lowest_centroid(motion_.half_a(), R.transpose() * n,
                                                      1024.0 * u * motion_.half_a().sum());
  } else {
    answer.witness_a = origin_a + n * std::get<Sphere>(a_.shape).radius;
  }
  answer.witness_b = answer.witness_a + n * (at.gap() + motion_.error_reach());
}

double local_end(const Motion& motion, const Window& window) {
  return std::abs(window.start - motion.start) +
         (std::isfinite(window.duration) ? window.duration : 0.0);
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
  return has_parts(a.shape) || has_parts(b.shape) ? parts_impact(a, b, window, options)
                                                  : Advancement(a, b, window, options).run();
}

TimeOfImpact advance_parts(const MovingShape& a, const ConvexCore& part_of_a, const MovingShape& b,
                           const ConvexCore* part_of_b, const Window& window,
                           const PartQuery& query) {
  return Advancement(a, part_of_a, b, part_of_b, window, query).run(query.from);
}

}  // namespace kairos::ccd
