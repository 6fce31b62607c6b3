#pragma once

#include "simulation/simulate.hpp"

#include <string_view>
#include <vector>

namespace kairos::experiments {

/// A method as tables and figures call it.
struct NamedMethod {
  std::string_view name;
  RunChoice choice;
};

/// The thesis' own stepping and each cure: geometric, substepped (as drawn, and in equal parts),
/// bisected, and last event-driven with `certified`.
[[nodiscard]] std::vector<NamedMethod> compared_methods();

}  // namespace kairos::experiments
