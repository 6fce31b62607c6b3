#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `moreau-jean`: time stepping of Moreau and Jean [Moreau1988, Jean1999]. A step of h takes
/// M (v1 - v0) = h ((1 - theta) F0 + theta F1) + H^T p and x1 = x0 + h ((1 - theta) v0 + theta v1).
/// Contacts that are closed where bodies are forecast, x0 + (1 - theta) h v0, obey Newton's law and
/// Coulomb's as one statement on velocities: with w = u1 + e u0 along the normal, 0 <= w, 0 <= p_n,
/// w p_n = 0, and p in the friction cone. The contacts are solved one after the other on the exact
/// cone until velocities no longer change (nonlinear Gauss-Seidel [Jourdan1998]), from the impulses
/// of the last step. F1 is taken where an Euler step predicts the end. Nothing puts positions back:
/// what has sunk in, by up to (1 - theta) h u at each landing, stays so.
[[nodiscard]] std::unique_ptr<Scheme> make_moreau_jean();

}  // namespace core
}  // namespace kairos
