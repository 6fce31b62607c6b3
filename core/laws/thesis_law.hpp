#pragma once

#include "core/impact_law.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `thesis`: DealWithCollision (13.5). Both momenta and both forces are read first; forces are
/// exchanged; then each side is given the other's momentum, with the other's face normal if the
/// other is stationary, with the line of centres if both are round, otherwise without a normal.
/// There is no approach test: whoever calls it twice reflects twice.
[[nodiscard]] std::unique_ptr<ImpactLaw> make_thesis_law();

}  // namespace core
}  // namespace kairos
