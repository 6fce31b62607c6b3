#pragma once

#include "tests/judge/verdict.hpp"

namespace kairos::judge {

/// Asks when two overlapping bodies part.
[[nodiscard]] TimeOfImpact ask_parting(const Query& query, const ContactDetector& detector);

/// Judges the answer: `missed` (`overlapping`, though they are apart at some instant), `late`
/// (apart before t_lo), `untrue` (not apart at t_hi, or overlapping where it says apart from the
/// start), `wide` (deep in one another at t_lo). Looks at 512 instants: what it finds is so, what
/// it does not find is not proven.
[[nodiscard]] Verdict judge_parting(const Query& query, const TimeOfImpact& answer);

}  // namespace kairos::judge
