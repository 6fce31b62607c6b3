#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `penalty`: contacts as springs and dampers. A point that overlaps by d at the rate d' is pressed
/// by f = k d^n (1 + 3/2 alpha d') >= 0 [HuntCrossley1975]; alpha as given, or such that their
/// e = 1 - alpha v holds for the pair's restitution and the fastest approach of this contact.
/// Friction is Coulomb's, regularised: mu f u/max(|u|, stiction_velocity), so that nothing ever
/// sticks entirely. Symplectic Euler, with forces where the step begins. What a spring holds is
/// counted as restitution loss until it gives it back.
[[nodiscard]] std::unique_ptr<Scheme> make_penalty();

}  // namespace core
}  // namespace kairos
