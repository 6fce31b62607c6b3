#pragma once

#include "core/impact_law.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `moreau`: as `newton` between two bodies; where several touch, Newton's hypothesis for all of
/// them at once (see `newton_group`). A cradle in touch goes apart as one ball and the rest.
[[nodiscard]] std::unique_ptr<ImpactLaw> make_moreau_law();

/// `reflections`: as `newton` between two bodies; where several touch, reflections in turn (see
/// `reflected_group`). A cradle in touch hands the impact on.
[[nodiscard]] std::unique_ptr<ImpactLaw> make_reflections_law();

}  // namespace core
}  // namespace kairos
