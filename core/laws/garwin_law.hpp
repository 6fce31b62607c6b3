#pragma once

#include "core/impact_law.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `garwin`: a ball that grips and springs back along the surface too, as a superball does
/// [Garwin1969]. What touches has its whole relative velocity reversed, which keeps the energy;
/// then an impulse along the normal takes so much that v_n' = -e v_n. Where friction cannot hold
/// that (tangential more than mu times normal impulse, or a normal one that would pull) it is
/// `routh`'s impact.
[[nodiscard]] std::unique_ptr<ImpactLaw> make_garwin_law();

}  // namespace core
}  // namespace kairos
