#pragma once

#include "tests/judge/query.hpp"

#include <array>
#include <string>
#include <string_view>

namespace kairos::judge {

/// What can be wrong with an answer; the first `promises` break what `certified` promises.
enum class Fault {
  missed,    ///< `separated`, but there is contact
  late,      ///< contact before t_lo
  untrue,    ///< `impact` or `overlapping`, and provably apart up to t_hi
  far,       ///< the distance at t_lo is above the tolerance
  gap,       ///< the gap that is told is above the distance at t_lo, beyond rounding
  dips,      ///< the bodies overlap at the poses of t_lo, as a double computes them
  normal,    ///< not of length one, or the bodies overlap along it
  witness,   ///< not on the surfaces, or farther apart than the bodies
  wide,      ///< at t_hi they are deep in one another
  vague,     ///< `undecided`, though there is clear contact, or clearly none
  nonsense,  ///< a number that is none, or a bracket outside the window
  swept,     ///< `swept_overlap` says no where there is contact
  instant,   ///< `overlap` or `overlaps` at the start is wrong beyond rounding
  unsaid,    ///< overlapping at the start beyond the tolerance, and not told so
  hidden,    ///< `undecided`, and rounding hides the truth: told, not a fault
  kept,     ///< within tolerance at the start, only parting, and not `separated`: told, not a fault
  shallow,  ///< `missed` or `late` by little more than rounding, from a touch: told, not a fault
  costly,   ///< more than 2,000 evaluations: told, not a fault
  gave_up,  ///< `undecided` out of touch, its budget of work spent: told, not a fault
  unproven,  ///< the judge's own budget ran out: told, not a fault
};
inline constexpr std::size_t fault_count = 20;
inline constexpr std::size_t promises = 14;
[[nodiscard]] std::string_view to_string(Fault fault);

struct Verdict {
  std::array<bool, fault_count> found{};
  double depth = 0.0;     ///< of the worst contact, or size of what is wrong, m
  double when = 0.0;      ///< s
  double rounding = 0.0;  ///< what rounding hides there, m

  [[nodiscard]] bool has(Fault fault) const { return found[static_cast<std::size_t>(fault)]; }
  void note(Fault fault, double size, double at, double hidden);
  [[nodiscard]] bool breaks_a_promise() const;
  [[nodiscard]] std::string faults() const;
};

[[nodiscard]] Verdict judge(const Query& query, const TimeOfImpact& answer,
                            const ContactDetector& detector);

/// The tolerance that an answer is held to: the query's own, or 1e-9 of the smaller extent; plus
/// the roundoff of the coordinates.
[[nodiscard]] double allowed_gap(const Query& query, double t);

}  // namespace kairos::judge
