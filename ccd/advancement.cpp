#include "ccd/advancement.hpp"

#include "ccd/body_parts.hpp"
#include "ccd/bounds_ahead.hpp"
#include "ccd/contact_answer.hpp"
#include "ccd/contact_search.hpp"
#include "ccd/parts_impact.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// Evaluations that a query may take before it is `undecided`: so many, and for each radian of
/// turning as many more as bodies need that nearly touch all along, up to `most_radians`.
constexpr int most_evaluations = 20'000;
constexpr double evaluations_per_radian = 40.0;
constexpr double most_radians = 1e4;
/// A contact is sought, although the gap is more than roundoff, after so many looks within the
/// tolerance, and then again after so many more: a graze comes nearer ever more slowly.
constexpr int looks_before_try = 5;
constexpr int looks_between_tries = 8;
/// After so many looks in a row within the tolerance steps are also taken along other axes than
/// that of the greatest gap: a contact has been sought and not been found.
constexpr int looks_before_axes = looks_before_try;
/// For bodies that spin by more than a radian still: looks between two tries with the hulls of all
/// that they sweep. If these hulls are apart nothing else has to be looked at.
constexpr int looks_between_hulls = 64;
/// If the bounds over a piece allow no step at all, they are made anew for this part of it.
constexpr double sliver_of_piece = 1.0 / 64.0;
/// The shortest piece for which that is done, in ulps of the time.
constexpr double ulps_of_piece = 64.0;
/// One turn, and the rounding of both ends.
constexpr double whole_turn = 2.0 * std::numbers::pi * (1.0 + 1e-12);

/// Which gap is within the tolerance: that asked for, or the default of the window so far. (What a
/// fast body reaches by the end of a long window makes no gap at its start a touch.)
struct Tolerance {
  double most = 0.0;               ///< of the whole window, m, > 0
  const MovingShape* a = nullptr;  ///< the two bodies; none: `most` is asked for
  const MovingShape* b = nullptr;
  Instant start{};

  [[nodiscard]] bool holds(const Look& at) const {
    return at.gap() <= most &&
           (a == nullptr || at.gap() <= default_tolerance(*a, *b, {start, at.t()}));
  }
};

/// Options of a query beside its two motions.
struct Effort {
  Tolerance tolerance;
  bool prove = true;         ///< an impact is a proven overlap, not a gap within the tolerance
  bool whole = true;         ///< two whole bodies; otherwise parts of bodies
  int most_evaluations = 0;  ///< of parts
};

/// The period after which both are as before, s: one body spins in place and the other rests.
double period(const PairMotion& motion, const Kinematics& k, double spin) {
  const bool alone = motion.simple() && k.v.isZero(0.0) && k.c.isZero(0.0) &&
                     (motion.turns_a() ? motion.spins_a() && !motion.turns_b()
                                       : motion.turns_b() && motion.spins_b());
  return alone && spin > 0.0 ? whole_turn / spin : std::numeric_limits<double>::infinity();
}

/// How many evaluations a query may take from t on; work is counted from where bodies come near.
int work_allowed(const Effort& effort, double spin, double remaining) {
  const double angle = spin > 0.0 ? spin * remaining : 0.0;
  const double counted = angle < most_radians ? angle : most_radians;
  return effort.whole ? most_evaluations + static_cast<int>(evaluations_per_radian * counted)
                      : effort.most_evaluations;
}

/// The end of a step that is proven free of contact, window time: exactly where the bounds end, if
/// it gets there, so that no sliver is left for the next one.
double next_after(const PairLooks& pair, const BoundsAhead& bounds, const Look& at, bool try_hulls,
                  bool try_axes) {
  const double remaining = pair.duration() - at.t();
  const double horizon = std::min(remaining, bounds.until() - at.t());
  const double spin = bounds.spin();
  double step = 0.0;
  if (try_hulls && spin * remaining > 1.0) {
    step = pair.step_beside_hulls(at, bounds.turn(), horizon);
  }
  if (step * spin < 1.0) {
    step = std::max(step, pair.safe_step(at.k, at.witness, bounds.turn(), horizon));
  }
  if (try_axes && step < horizon) {
    step = std::max(step, pair.step_along_axes(at, bounds.turn(), horizon));
  }
  if (reaches_end(step, remaining)) {
    return pair.duration();
  }
  return reaches_end(step, horizon) ? bounds.until() : at.t() + step;
}

/// Whether a contact is sought from here, the n-th look in a row within the tolerance.
bool worth_resolving(const Effort& effort, const Look& at, int n) {
  return !effort.prove || at.within(roundoff_gap) || n % looks_between_tries == looks_before_try;
}

/// The contact at this look, if there is one. Without a proof, a pair that parts is followed on: it
/// has just met.
std::optional<Ending> resolve(PairLooks& pair, const Effort& effort, const Look& at,
                              bool persistent) {
  if (effort.prove) {
    return search_contact(pair, at, persistent);
  }
  return pair.approach(at) >= 0.0 ? std::optional(Ending{ToiStatus::impact, at, at.t()})
                                  : std::nullopt;
}

/// The main loop: a look, a contact if it is one, a step that is proven free of contact (eq. 9).
/// `last_step`: the one that led to the look `at`, s; 0: none.
Ending advance_from(PairLooks& pair, BoundsAhead& bounds, const Effort& effort, Look at,
                    double last_step) {
  const double duration = pair.duration();
  const int budget = work_allowed(effort, bounds.spin(), duration - at.t());
  const int first = pair.count();
  const double repeats = at.t() + period(pair.motion(), at.k, bounds.spin());
  int near = 0;  // looks within the tolerance, one after the other
  while (true) {
    const bool spent = pair.count() > budget;
    near = effort.tolerance.holds(at) ? near + 1 : 0;
    if (near > 0 && ((spent && effort.whole) || worth_resolving(effort, at, near))) {
      if (const auto ending = resolve(pair, effort, at, spent && effort.whole)) {
        return *ending;
      }
    }
    if (spent) {  // far from touch: a query that starts here has all its work again
      return {ToiStatus::undecided, at, at.t()};
    }
    bounds.renew(at.t(), last_step);
    const bool try_hulls = (pair.count() - first) % looks_between_hulls == 0;
    const double next = next_after(pair, bounds, at, try_hulls, near > looks_before_axes);
    if (next >= std::min(duration, repeats)) {
      return {ToiStatus::separated, at, duration};
    }
    assert(next >= at.t());
    const double piece = bounds.until() - at.t();
    if (next > at.t()) {
      last_step = next - at.t();
      at = pair.look(next);
    } else if (!pair.motion().simple() && piece > ulps_of_piece * ulp(at.t())) {
      last_step = sliver_of_piece * piece;  // bounds over a long piece were useless
    } else {                                // time itself has no finer grain
      return resolve(pair, effort, at, true).value_or(Ending{ToiStatus::undecided, at, duration});
    }
  }
}

/// Advances from a time up to which the two are proven apart.
Ending advance(PairLooks& pair, const Effort& effort, double from) {
  BoundsAhead bounds(pair.motion());
  bounds.begin(from, pair.duration() - from);
  Look at = pair.look(from);
  double last_step = 0.0;
  if (from == 0.0 && at.within(1.0)) {
    std::variant<Ending, Look> left = leave_touch(pair, at, bounds.turn());
    if (const auto* ending = std::get_if<Ending>(&left)) {
      return *ending;
    }
    at = std::get<Look>(left);
    last_step = at.t();
  }
  return advance_from(pair, bounds, effort, at, last_step);
}

/// Skips to where the balls around the bodies touch, and advances from there.
TimeOfImpact run(PairKind kind, const PairMotion& motion, const MovingShape& a,
                 const MovingShape& b, const Window& window, Effort effort, double from) {
  PairLooks pair(kind, motion);
  TimeOfImpact answer;
  answer.t_lo = answer.t_hi = pair.duration();
  const double clear = std::max(from, clear_of_balls(kind, motion));
  if (clear > from) {
    pair.count_one();
    if (clear >= pair.duration()) {
      answer.evaluations = pair.count();
      return answer;
    }
  }
  if (!(effort.tolerance.most > 0.0)) {
    effort.tolerance = {default_tolerance(a, b, window), &a, &b, window.start};
  }
  const Ending ending = advance(pair, effort, clear);
  assert(ending.t_hi >= ending.at.t() && ending.t_hi <= pair.duration());
  answer.evaluations = pair.count();
  if (ending.status != ToiStatus::separated) {
    answer.status = ending.status;
    answer.t_lo = ending.at.t();
    answer.t_hi = ending.t_hi;
    tell_contact(pair, a, b, window, effort.whole, ending.at, answer);
  }
  return answer;
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
  if (has_parts(a.shape) || has_parts(b.shape)) {
    return parts_impact(a, b, window, options);
  }
  const PairMotion motion(a, b, window, Positions::heights);
  return run(pair_kind(a.shape, b.shape), motion, a, b, window,
             {.tolerance = {.most = options.tolerance}, .prove = options.prove}, 0.0);
}

TimeOfImpact advance_parts(const MovingShape& a, const ConvexCore& part_of_a, const MovingShape& b,
                           const ConvexCore* part_of_b, const Window& window,
                           const PartQuery& query) {
  const PairMotion motion = part_of_b != nullptr
                                ? PairMotion({part_of_a, a.motion}, {*part_of_b, b.motion}, window)
                                : PairMotion({part_of_a, a.motion}, b, window, Positions::heights);
  return run(part_of_b != nullptr ? PairKind::cores : PairKind::core_plane, motion, a, b, window,
             {.tolerance = {.most = query.tolerance},
              .prove = query.prove,
              .whole = false,
              .most_evaluations = query.most_evaluations},
             query.from);
}

}  // namespace kairos::ccd
