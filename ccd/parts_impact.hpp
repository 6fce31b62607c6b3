#pragma once

#include "ccd/advancement.hpp"

namespace kairos::ccd {

/// The first contact of two bodies of which one has parts (a mesh, a compound): the earliest of
/// those of their parts. Every pair of boxes of their trees has a time up to which it is proven
/// apart; the one with the least is looked at next, at that time. It is given more time, or opened;
/// two parts are followed as two bodies are. Once the least time is later than a contact, that one
/// is the first.
[[nodiscard]] TimeOfImpact parts_impact(const MovingShape& a, const MovingShape& b,
                                        const Window& window, const AdvancementOptions& options);
/// When two such bodies that overlap at the start part: as long as two parts are in each other by
/// some depth they cannot part before depth over the greatest speed of any point.
[[nodiscard]] TimeOfImpact parts_separation(const MovingShape& a, const MovingShape& b,
                                            const Window& window, double tolerance);

}  // namespace kairos::ccd
