#include "tests/judge/parting.hpp"

#include "tests/judge/clearance.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::judge {
namespace {

/// The first of 512 instants of [0, end) at which the bodies are apart by more than the tolerance.
void check_together_until(const Query& q, double end, Fault fault, Verdict& verdict) {
  for (int i = 0; i < 512; ++i) {
    const double t = end * i / 512.0;
    const double gap = exact_gap(q, t);
    if (gap > allowed_gap(q, t)) {
      verdict.note(fault, gap, t, roundoff(q, t));
      return;
    }
  }
}

void check_bracket(const Query& q, const TimeOfImpact& answer, Verdict& verdict) {
  const double apart = exact_gap(q, answer.t_hi);
  const double hidden = roundoff(q, answer.t_hi);
  if (!(apart > -hidden)) {
    verdict.note(Fault::untrue, apart, answer.t_hi, hidden);
  }
  const double before = exact_gap(q, answer.t_lo);
  const double extent = std::min(q.a.smallest_extent(), q.b.smallest_extent());
  if (before < -std::max(1e-3 * extent, 100.0 * allowed_gap(q, answer.t_lo))) {
    verdict.note(Fault::wide, before, answer.t_lo, hidden);
  }
}

}  // namespace

TimeOfImpact ask_parting(const Query& q, const ContactDetector& detector) {
  const Shape shape_a = q.a.shape();
  const Shape shape_b = q.b.shape();
  const Motion motion_a = q.a.motion(q.start, q.duration);
  const Motion motion_b = q.b.motion(q.start, q.duration);
  return detector.time_of_separation({shape_a, motion_a}, {shape_b, motion_b},
                                     {q.start, q.duration}, q.tolerance);
}

Verdict judge_parting(const Query& q, const TimeOfImpact& answer) {
  Verdict verdict;
  const double start_gap = exact_gap(q, 0);
  switch (answer.status) {
    case ToiStatus::separated:
      if (start_gap < -allowed_gap(q, 0.0)) {
        verdict.note(Fault::untrue, start_gap, 0.0, roundoff(q, 0.0));
      }
      break;
    case ToiStatus::overlapping:
      check_together_until(q, q.duration, Fault::missed, verdict);
      break;
    case ToiStatus::impact:
    case ToiStatus::undecided:
      if (!(answer.t_lo >= 0.0 && answer.t_lo <= answer.t_hi && answer.t_hi <= q.duration)) {
        verdict.note(Fault::nonsense, 0.0, answer.t_lo, 0.0);
        break;
      }
      check_together_until(q, answer.t_lo, Fault::late, verdict);
      if (answer.status == ToiStatus::impact) {
        check_bracket(q, answer, verdict);
      } else {
        verdict.note(Fault::hidden, 0.0, answer.t_lo, 0.0);
      }
      break;
  }
  return verdict;
}

}  // namespace kairos::judge
