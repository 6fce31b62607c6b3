#include "ccd/contact_search.hpp"

#include "ccd/box_witness.hpp"
#include "ccd/moving_cores.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/separation_function.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Relative rounding of times.
constexpr double end_rounding = 128.0 * unit_roundoff;
/// Twice the error is the least gap that can be proven positive at all.
constexpr double least_gap = 2.0;
/// At a gap of so many errors the bodies are apart, whichever way both were rounded.
constexpr double clear_gap = 4.0;
/// A pair in touch at the start whose gap stays above -16 errors may have roundoff only.
constexpr double touch_depth = 16.0;
/// Doublings of a look ahead: all that a double has between an ulp of 0 and a window; or, where
/// coming nearer may serve better, a few.
constexpr int all_doublings = 200;
constexpr int few_doublings = 3;
/// The first look ahead is no nearer than 2^-150 of the window, from which `all_doublings` reach
/// its end.
constexpr int least_look = -150;
/// Nor nearer than so many ulps of the time.
constexpr double least_ulps = 8.0;
/// The first look is where a pair would be past the touch by half of its gap and of its rounding.
constexpr double past_touch = 1.5;
/// An overlap deeper than so many gaps of the touch tells little about when it began.
constexpr double deep_overlap = 8.0;
/// From a touch: where it would be beyond roundoff.
constexpr double out_of_touch = 8.0;
/// Steps back from where they are apart again, each about half of what is left: to 1e-30 of it.
constexpr int most_steps_back = 200;
/// Halvings of an interval in which the gap is least.
constexpr int most_halvings = 60;
/// They end where the gap changes by so many errors at most in what is left.
constexpr double level_gap = 0x1p-6;

/// How far ahead a gap within roundoff is first looked at, s: the time to cover `length` (m) at
/// `speed` (m/s), and never so little that the doublings would not reach the end of the window.
/// Without that a query that starts at 0, where an ulp is nothing, would answer before it got
/// anywhere, and whoever asks again from there would ask for ever.
double first_look(const PairMotion& motion, const Look& at, double length, double speed) {
  const double remaining = motion.duration() - at.t();
  const double unit = std::isfinite(remaining) ? remaining : 1.0;
  const double crossing = motion.time_to_cover(length, speed, at.k);
  return std::max({least_ulps * ulp(at.t()), std::ldexp(unit, least_look),
                   std::isfinite(crossing) ? crossing : unit});
}

/// The two are apart at both ends, or nearly: finds a proven overlap between, where the gap is
/// least.
std::optional<Look> overlap_between(PairLooks& pair, double low, double high) {
  assert(low <= high);
  for (int i = 0; i < most_halvings; ++i) {
    const double middle = low + 0.5 * (high - low);
    if (!(middle > low && middle < high)) {
      break;
    }
    const Look there = pair.look(middle);
    if (pair.overlap_proven(there)) {
      return there;
    }
    const double rate = pair.approach(there);
    if (std::abs(rate) * (high - low) <= level_gap * there.k.error) {
      break;
    }
    (rate > 0.0 ? low : high) = middle;
  }
  return std::nullopt;
}

/// A proven overlap in (low, high], no deeper than `enough` unless none so shallow is proven: they
/// may come faster than they began, where another corner gets ahead.
double shallow_overlap(PairLooks& pair, double low, Look at, double enough) {
  for (int i = 0; i < most_halvings && at.gap() < -enough; ++i) {
    const double middle = low + 0.5 * (at.t() - low);
    if (!(middle > low && middle < at.t())) {
      break;
    }
    const Look there = pair.look(middle);
    if (pair.overlap_proven(there)) {
      at = there;
    } else {
      low = middle;
    }
  }
  return at.t();
}

/// Up to when they are apart after leaving, along the witness or, where they touch along several
/// axes (a corner, an edge), along any of them; 0 if they do not leave. Every axis counts by its
/// gap along the unit direction: what is only noise, a cross product of parallel edges, separates
/// nothing (eq. 5).
double time_of_leaving(const PairLooks& pair, const Look& at, const TurnBounds& bounds,
                       double horizon) {
  const PairMotion& motion = pair.motion();
  const auto leaving_along = [&](const Witness& witness) {
    return SeparationFunction(motion, at.k, bounds, witness).advance_from_touch(horizon);
  };
  const auto touches_along = [&](const Witness& witness) {
    return witness.gap >= -least_gap * at.k.error;
  };
  double left = leaving_along(at.witness);
  for (int axis = 0; pair.kind() == PairKind::box_box && !(left > 0.0) && axis < axis_count;
       ++axis) {
    const Witness witness = along_axis(motion, at.k, axis);
    if (touches_along(witness)) {
      left = leaving_along(witness);
    }
  }
  if (pair.kind() == PairKind::cores && !(left > 0.0)) {
    for_each_axis(motion, at.k, at.witness, [&](const Vector3& n) {
      const Witness witness = along_direction(motion, at.k, n);
      if (!(left > 0.0) && touches_along(witness)) {
        left = leaving_along(witness);
      }
    });
  }
  return left;
}

/// Apart at `there`: have they been so since a time up to which the touch at `start` got no deeper
/// than rounding (eq. 10)? The same steps, backwards.
bool left_before(PairLooks& pair, const Look& start, const Look& there) {
  const PairMotion& motion = pair.motion();
  Look at = there;
  for (int i = 0; i < most_steps_back; ++i) {
    const TurnBounds ahead = motion.bounds(0.0, at.t());
    const SeparationFunction touch(motion, start.k, ahead, start.witness);
    if (touch.least_within(at.t()) >= -touch_depth * start.k.error) {
      return true;
    }
    const Kinematics back = reversed(at.k);
    const double step = pair.safe_step(back, at.witness, reversed(ahead), at.t());
    const double t = at.t() - step;
    if (!(t < at.t()) || at.within(1.0)) {
      return false;
    }
    if (!(t > 0.0)) {
      return true;
    }
    at = pair.look(t);
  }
  return false;
}

/// In touch and not provably leaving by rates: an overlap soon is an impact now; a gap soon, back
/// from which they are proven apart until they touch, means that they have left (rolling off, a
/// turning corner); neither, that they slide.
std::variant<Ending, Look> enter(PairLooks& pair, const Look& here) {
  const PairMotion& motion = pair.motion();
  const double duration = motion.duration();
  const double rate = pair.approach(here);
  const double scale = motion.speed_bound(here.k, motion.bounds(0.0, 0.0), 0.0);
  double ahead = first_look(motion, here, out_of_touch * here.k.error,
                            rate > here.k.rate_error ? rate : scale);
  const double enough = deep_overlap * clear_gap * here.k.error;
  double before = 0.0;
  double t = 0.0;
  for (int attempt = 0; attempt < all_doublings && ahead > 0.0; ++attempt) {
    t = std::min(ahead, duration);
    const Look there = pair.look(t);
    if (pair.overlap_proven(there)) {
      return Ending{ToiStatus::impact, here, shallow_overlap(pair, before, there, enough)};
    }
    if (!there.within(clear_gap)) {
      if (left_before(pair, here, there)) {
        return there;
      }
      if (const auto overlap = overlap_between(pair, before, t)) {
        return Ending{ToiStatus::impact, here, shallow_overlap(pair, before, *overlap, enough)};
      }
      break;
    }
    if (!(ahead < duration) || !std::isfinite(2.0 * ahead)) {
      break;
    }
    before = t;
    ahead *= 2.0;
  }
  return Ending{ToiStatus::undecided, here, t};
}

}  // namespace

bool reaches_end(double step, double remaining) { return step >= remaining * (1.0 - end_rounding); }

std::optional<Ending> search_contact(PairLooks& pair, const Look& here, bool persistent) {
  const double speed = pair.approach(here);
  persistent = persistent || here.within(least_gap);
  const double apart = std::max(here.gap(), least_gap * here.k.error);
  const double room = here.gap() + clear_gap * here.k.error;
  const double enough = deep_overlap * std::max(room, here.k.error);
  const double remaining = pair.duration() - here.t();
  double ahead = first_look(pair.motion(), here, past_touch * room, std::abs(speed));
  double before = here.t();
  double t = before;
  for (int attempt = 0; attempt < (persistent ? all_doublings : few_doublings); ++attempt) {
    ahead = std::min(ahead, remaining);
    t = std::min(here.t() + ahead, pair.duration());  // the sum is rounded
    const Look there = pair.look(t);
    if (pair.overlap_proven(there)) {
      return Ending{ToiStatus::impact, here, shallow_overlap(pair, before, there, enough)};
    }
    if (there.gap() > apart && !there.within(least_gap)) {
      if (persistent) {
        if (const auto overlap = overlap_between(pair, before, t)) {
          return Ending{ToiStatus::impact, here, shallow_overlap(pair, before, *overlap, enough)};
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
  return persistent ? std::optional(Ending{ToiStatus::undecided, here, t}) : std::nullopt;
}

std::variant<Ending, Look> leave_touch(PairLooks& pair, const Look& start,
                                       const TurnBounds& bounds) {
  if (pair.overlap_proven(start)) {
    return Ending{ToiStatus::overlapping, start, 0.0};
  }
  if (start.gap() >= -least_gap * start.k.error) {
    const double duration = pair.duration();
    const double horizon = pair.motion().simple() ? duration : bounds.until;
    const double left = time_of_leaving(pair, start, bounds, horizon);
    if (reaches_end(left, duration) && duration > 0.0) {
      return Ending{ToiStatus::separated, start, duration};
    }
    if (left > 0.0) {
      return pair.look(left);
    }
  }
  return enter(pair, start);
}

}  // namespace kairos::ccd
