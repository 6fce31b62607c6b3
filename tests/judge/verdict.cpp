#include "tests/judge/verdict.hpp"

#include "tests/judge/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::judge {
namespace {

/// Contact counts as clear, or as clearly none, beyond this many times `roundoff`.
constexpr double beyond_doubt = 64.0;

/// Evaluations that only one query of a thousand may take.
constexpr int costly = 2000;

constexpr double infinity = std::numeric_limits<double>::infinity();

double error_radii(const Query& q) { return q.a.error_radius + q.b.error_radius; }

/// The deepest contact that a look at 256 instants of [t0, t1] finds.
double depth_between(const Query& q, Long t0, Long t1) {
  double deepest = 0.0;
  for (int i = 0; i <= 256; ++i) {
    const Long t = t0 + (t1 - t0) * i / 256;
    deepest = std::max(deepest, -exact_gap(q, t));
  }
  return deepest;
}

/// What an answer may be wrong by: nothing; but of bodies that touch at the start to rounding no
/// one can ask on which side of it they are. The factor leaves room for the bounds of others.
double forgiven(const Query& q, double start_gap) {
  const double hidden = 8.0 * roundoff(q, 0.0);
  return std::abs(start_gap) <= hidden ? hidden : 0.0;
}

/// Where a proof gave up: an instant of contact among 4096 of the rest of the window.
Look sampled(const Query& q, const Level& level, Long t0, Long t1) {
  constexpr int count = 4096;
  for (int i = 0; i <= count; ++i) {
    const Long t = t0 + (t1 - t0) * i / count;
    if (exact_gap(q, t) <= static_cast<double>(level.stop(q, t))) {
      return {Finding::contact, t};
    }
  }
  return {Finding::unproven, t0};
}

void check_none_before(const Query& q, double end, double start_gap, Fault fault,
                       Verdict& verdict) {
  const Level level{.floor = forgiven(q, start_gap)};
  Look seen = look(q, 0, end, level);
  if (seen.finding == Finding::unproven) {
    seen = sampled(q, level, seen.when, end);
  }
  const double when = static_cast<double>(seen.when);
  if (seen.finding == Finding::contact) {
    const double depth = depth_between(q, seen.when, end);
    const bool from_touch = std::abs(start_gap) <= beyond_doubt * roundoff(q, 0.0);
    const bool little = from_touch && depth <= beyond_doubt * roundoff(q, when);
    verdict.note(little ? Fault::shallow : fault, depth, when, roundoff(q, when));
  } else if (seen.finding == Finding::unproven) {
    verdict.note(Fault::unproven, 0.0, when, roundoff(q, when));
  }
}

void check_some_within(const Query& q, const TimeOfImpact& answer, double start_gap,
                       Verdict& verdict) {
  const double hidden = roundoff(q, answer.t_hi);
  const Level level{.above = true, .floor = forgiven(q, start_gap)};
  if (exact_gap(q, answer.t_hi) <= static_cast<double>(level.stop(q, answer.t_hi))) {
    return;
  }
  const Look seen = look(q, answer.t_lo, answer.t_hi, level);
  if (seen.finding == Finding::clear) {
    verdict.note(Fault::untrue, exact_gap(q, answer.t_hi), answer.t_hi, hidden);
  } else if (seen.finding == Finding::unproven) {
    verdict.note(Fault::unproven, 0.0, answer.t_hi, hidden);
  }
}

double exact_distance(const Query& q, double t) {
  const Long rough = distance(q.a, q.b, placed<Long>(q, Long(t))).gap;
  if (static_cast<double>(rough) - error_radii(q) <= allowed_gap(q, t)) {
    return static_cast<double>(rough) - error_radii(q);
  }
  return static_cast<double>(distance(q.a, q.b, placed<Quad>(q, Quad(t))).gap) - error_radii(q);
}

void check_gap(const Query& q, const TimeOfImpact& answer, Verdict& verdict) {
  const double hidden = roundoff(q, answer.t_lo);
  const double apart = exact_distance(q, answer.t_lo);
  const bool out_of_budget =
      answer.status == ToiStatus::undecided && answer.t_hi == answer.t_lo && answer.t_lo > 0.0;
  if (apart > allowed_gap(q, answer.t_lo)) {
    verdict.note(out_of_budget ? Fault::gave_up : Fault::far, apart, answer.t_lo, hidden);
  }
  if (answer.gap > std::max(apart, 0.0) + hidden) {
    verdict.note(Fault::gap, answer.gap - apart, answer.t_lo, hidden);
  }
}

/// The normal of a ball has one direction.
double tilt_of_normal(const Query& q, const TimeOfImpact& answer, const Placed<Long>& at) {
  if (q.a.kind != Kind::sphere && q.b.kind != Kind::sphere) {
    return 0.0;
  }
  const Vector<Long> right = separation(q.a, q.b, at).normal;
  return static_cast<double>(norm(right - Vector<Long>(answer.normal)));
}

void check_normal(const Query& q, const TimeOfImpact& answer, Verdict& verdict) {
  const double hidden = roundoff(q, answer.t_lo);
  const double length = answer.normal.norm();
  const Vector<Long> n(answer.normal);
  const Placed<Long> at = placed<Long>(q, Long(answer.t_lo));
  double overlap =
      static_cast<double>(support(q.a, at.a, n) + support(q.b, at.b, -n) - dot(n, at.offset));
  for (const bool first : {true, false}) {
    if ((first ? q.a : q.b).kind == Kind::half_space) {
      const Vector<Long> up = first ? outward(q.a, at.a) : -outward(q.b, at.b);
      const double tilt = static_cast<double>(norm(n - up));
      overlap = tilt > 1e-9 ? tilt : 0.0;
    }
  }
  // Told on its own scale: the gap may be negative by rounding, and so may it be along n.
  const double reach = std::min(q.a.kind == Kind::sphere ? q.a.reach() : infinity,
                                q.b.kind == Kind::sphere ? q.b.reach() : infinity);
  if (tilt_of_normal(q, answer, at) > 1e-8 + beyond_doubt * hidden / reach ||
      std::abs(length - 1.0) > 1e-9 || !(overlap <= 10.0 * allowed_gap(q, answer.t_lo))) {
    verdict.note(Fault::normal, overlap, answer.t_lo, hidden);
  }
}

/// How far a point in the world is from the surface of a body, m.
double off_surface(const Body& body, const Vector3& point, double s) {
  Query alone;
  alone.a = body;
  alone.a.age = s;
  alone.b = {};
  alone.b.position = point;
  const Placed<Long> at = placed<Long>(alone, 0.0L);
  if (body.kind == Kind::sphere) {
    return std::abs(static_cast<double>(norm(at.offset) - Long(body.half_extents.x())));
  }
  if (body.kind == Kind::half_space) {
    return std::abs(static_cast<double>(dot(outward(body, at.a), at.offset)));
  }
  const Vector<Long> p = at.a.along(at.offset);
  Long inside = -std::numeric_limits<Long>::infinity();
  for (int i = 0; i < 3; ++i) {
    inside = std::max(inside, magnitude(p[i]) - Long(body.half_extents[i]));
  }
  return std::abs(static_cast<double>(inside));
}

/// Witness points lie on the surfaces, no farther apart than the bodies.
void check_witnesses(const Query& q, const TimeOfImpact& answer, Verdict& verdict) {
  const double t = answer.t_lo;
  const double slack = 10.0 * allowed_gap(q, t) + error_radii(q);
  const double off = std::max(off_surface(q.a, answer.witness_a, q.a.age + t),
                              off_surface(q.b, answer.witness_b, q.b.age + t));
  const double apart = (answer.witness_b - answer.witness_a).norm();
  const double beyond = apart - std::max(exact_distance(q, t), 0.0);
  if (!(off <= slack) || !(beyond <= slack)) {
    verdict.note(Fault::witness, std::max(off, beyond), t, roundoff(q, t));
  }
}

/// Whoever starts in one another by rounding may stay so.
void check_poses(const Query& q, const TimeOfImpact& answer, double start_gap, Verdict& verdict) {
  if (answer.t_lo == 0.0) {
    return;  // those of the query
  }
  const auto pose = [&](const Body& body) {
    const Motion motion = body.motion(q.start, q.duration);
    return motion.pose((q.start + answer.t_lo) - motion.start);  // as whoever asked comes there
  };
  const Pose a = pose(q.a);
  const Pose b = pose(q.b);
  const double gap = exact_gap(q, a, b);
  const double hidden = roundoff(q, answer.t_lo);
  const double allowed = start_gap > 0.0 ? 0.0 : hidden;
  if (gap < -allowed) {
    verdict.note(Fault::dips, -gap, answer.t_lo, hidden);
  }
}

void check_bracket(const Query& q, const TimeOfImpact& answer, Verdict& verdict) {
  const double hidden = roundoff(q, answer.t_hi);
  const double depth = -exact_gap(q, answer.t_hi);
  const double extent = std::min(q.a.smallest_extent(), q.b.smallest_extent());
  if (depth > std::min(100.0 * allowed_gap(q, answer.t_hi),
                       std::max(0.1 * extent, 10.0 * allowed_gap(q, answer.t_hi)))) {
    verdict.note(Fault::wide, depth, answer.t_hi, hidden);
  }
}

void check_undecided(const Query& q, const TimeOfImpact& answer, Verdict& verdict) {
  const Look apart = look(q, answer.t_lo, answer.t_hi, {.above = true, .share = beyond_doubt});
  const Look deep = look(q, answer.t_lo, answer.t_hi, {.share = beyond_doubt});
  const double hidden = roundoff(q, answer.t_hi);
  if (verdict.has(Fault::gave_up)) {
    return;
  }
  if (apart.finding == Finding::clear) {
    verdict.note(Fault::vague, exact_gap(q, answer.t_hi), answer.t_hi, hidden);
  } else if (deep.finding == Finding::contact) {
    verdict.note(Fault::vague, -depth_between(q, deep.when, answer.t_hi),
                 static_cast<double>(deep.when), hidden);
  } else {
    verdict.note(Fault::hidden, 0.0, answer.t_lo, hidden);
  }
}

/// Touching at the start by rounding, never deeper, and well apart in the end: told if the answer
/// is anything but `separated`.
void check_parting(const Query& q, const TimeOfImpact& answer, double start_gap, Verdict& verdict) {
  const double hidden = roundoff(q, 0.0);
  if (answer.status == ToiStatus::separated || answer.t_lo > 0.0 || start_gap < -hidden ||
      start_gap > allowed_gap(q, 0.0) ||
      exact_gap(q, q.duration) < beyond_doubt * roundoff(q, q.duration)) {
    return;
  }
  if (look(q, 0, q.duration, {.share = 1.0}).finding == Finding::clear) {
    verdict.note(Fault::kept, 0.0, answer.t_lo, hidden);
  }
}

bool makes_sense(const Query& q, const TimeOfImpact& answer) {
  if (answer.status == ToiStatus::separated) {
    return true;
  }
  return answer.t_lo >= 0.0 && answer.t_lo <= answer.t_hi && answer.t_hi <= q.duration &&
         std::isfinite(answer.gap) && answer.normal.allFinite();
}

void check_swept(const Query& q, const TimeOfImpact& answer, const ContactDetector& detector,
                 Verdict& verdict) {
  const bool deep_at_end =
      answer.status == ToiStatus::impact && exact_gap(q, answer.t_hi) < -roundoff(q, answer.t_hi);
  if (!deep_at_end && !verdict.has(Fault::missed) && !verdict.has(Fault::late)) {
    return;
  }
  const Shape a = q.a.shape();
  const Shape b = q.b.shape();
  const Motion motion_a = q.a.motion(q.start, q.duration);
  const Motion motion_b = q.b.motion(q.start, q.duration);
  if (!detector.swept_overlap({a, motion_a}, {b, motion_b}, {q.start, q.duration})) {
    verdict.note(Fault::swept, verdict.depth, answer.t_hi, roundoff(q, answer.t_hi));
  }
}

void check_instant(const Query& q, const ContactDetector& detector, Verdict& verdict) {
  const Pose a = q.a.motion(q.start, q.duration).pose(q.a.age);
  const Pose b = q.b.motion(q.start, q.duration).pose(q.b.age);
  Query bare = q;
  bare.a.error_radius = bare.b.error_radius = 0.0;
  const double gap = exact_gap(bare, a, b);
  const double hidden = 8.0 * roundoff(q, 0.0);
  const Overlap told = detector.overlap(q.a.shape(), a, q.b.shape(), b);
  const bool touching = detector.overlaps(q.a.shape(), a, q.b.shape(), b);
  if ((gap > hidden && (told.overlapping || touching)) ||
      (gap < -hidden && !(told.overlapping && touching))) {
    verdict.note(Fault::instant, gap, 0.0, hidden);
  }
}

}  // namespace

std::string_view to_string(Fault fault) {
  constexpr std::array<std::string_view, fault_count> names{
      "missed",  "late", "false",   "far",      "gap",     "dips",    "normal",
      "witness", "wide", "vague",   "nonsense", "swept",   "instant", "unsaid",
      "hidden",  "kept", "shallow", "costly",   "gave_up", "unproven"};
  return names[static_cast<std::size_t>(fault)];
}

void Verdict::note(Fault fault, double size, double at, double hidden) {
  found[static_cast<std::size_t>(fault)] = true;
  if (std::abs(size) > std::abs(depth) || rounding == 0.0) {
    depth = size;
    when = at;
    rounding = hidden;
  }
}

bool Verdict::breaks_a_promise() const {
  return std::any_of(found.begin(), found.begin() + promises, [](bool x) { return x; });
}

std::string Verdict::faults() const {
  std::string names;
  for (std::size_t i = 0; i < fault_count; ++i) {
    if (found[i]) {
      names += (names.empty() ? "" : " ") + std::string(to_string(static_cast<Fault>(i)));
    }
  }
  return names;
}

double allowed_gap(const Query& q, double t) {
  const double extent = std::min(q.a.smallest_extent(), q.b.smallest_extent());
  return (q.tolerance > 0.0 ? q.tolerance : 1e-9 * extent) + beyond_doubt * roundoff(q, t);
}

Verdict judge(const Query& q, const TimeOfImpact& answer, const ContactDetector& detector) {
  Verdict verdict;
  if (!makes_sense(q, answer)) {
    verdict.note(Fault::nonsense, 0.0, answer.t_lo, 0.0);
    return verdict;
  }
  const double start_gap = exact_gap(q, 0);
  switch (answer.status) {
    case ToiStatus::separated:
      check_none_before(q, q.duration, start_gap, Fault::missed, verdict);
      break;
    case ToiStatus::overlapping:
      if (start_gap > 8.0 * roundoff(q, 0.0)) {
        verdict.note(Fault::untrue, start_gap, 0.0, roundoff(q, 0.0));
      }
      break;
    case ToiStatus::impact:
    case ToiStatus::undecided:
      if (answer.t_lo > 0.0) {
        check_none_before(q, answer.t_lo, start_gap, Fault::late, verdict);
      } else if (start_gap < -allowed_gap(q, 0.0)) {
        verdict.note(Fault::unsaid, -start_gap, 0.0, roundoff(q, 0.0));
      }
      check_gap(q, answer, verdict);
      check_normal(q, answer, verdict);
      check_witnesses(q, answer, verdict);
      check_poses(q, answer, start_gap, verdict);
      if (answer.status == ToiStatus::impact) {
        check_some_within(q, answer, start_gap, verdict);
        check_bracket(q, answer, verdict);
      } else {
        check_undecided(q, answer, verdict);
      }
      break;
  }
  if (answer.evaluations > costly) {
    verdict.note(Fault::costly, 0.0, answer.t_lo, 0.0);
  }
  check_parting(q, answer, start_gap, verdict);
  check_swept(q, answer, detector, verdict);
  check_instant(q, detector, verdict);
  return verdict;
}

}  // namespace kairos::judge
