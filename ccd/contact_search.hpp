#pragma once

#include "ccd/pair_looks.hpp"
#include "core/time_of_impact.hpp"

#include <optional>
#include <variant>

namespace kairos::ccd {

/// A gap of so many errors is roundoff: contact is sought from there.
inline constexpr double roundoff_gap = 8.0;

/// How a search ends: with `status`, `t_lo` at the look `at`, and `t_hi` (window time, s).
struct Ending {
  ToiStatus status = ToiStatus::separated;
  Look at;
  double t_hi = 0.0;
};

/// Looks ahead from a gap within the tolerance, ever further, for a proven overlap. None: coming
/// nearer is better; who cannot come nearer is `persistent` and gets an ending.
[[nodiscard]] std::optional<Ending> search_contact(PairLooks& pair, const Look& here,
                                                   bool persistent);

/// A start within roundoff of touching, or in an overlap: an ending, or the look from which the
/// bodies have left each other and the search goes on. `bounds`: of what is ahead of the start.
[[nodiscard]] std::variant<Ending, Look> leave_touch(PairLooks& pair, const Look& start,
                                                     const TurnBounds& bounds);

/// What is so near the end of the window, as a part of it, is at the end.
[[nodiscard]] bool reaches_end(double step, double remaining);

}  // namespace kairos::ccd
