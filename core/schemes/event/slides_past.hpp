#pragma once

#include "core/contact_detector.hpp"
#include "core/instant.hpp"
#include "core/state.hpp"

namespace kairos {
inline namespace core {

/// Two that touch at t may slide past each other: the plane of a face of one of them separates
/// both, up to rounding, and nothing comes nearer to it. Which edges meet is then chance: what
/// slides from one tile onto the next, at the same level, does not strike its side. How long they
/// are to be left alone, s, until they are past those edges: short, and the plane separates them
/// still at its end; 0: they strike, or one of them has no corners.
[[nodiscard]] double slides_past(const MovingShape& a, const BodyState& at_a, const MovingShape& b,
                                 const BodyState& at_b, Instant t);

}  // namespace core
}  // namespace kairos
