#pragma once

// The library's face: scenes in, runs out. `#include <kairos/simulation.hpp>`; see
// simulation/README.md.
#include "core/core.hpp"
#include "simulation/option.hpp"
#include "simulation/penetration.hpp"
#include "simulation/registry.hpp"
#include "simulation/run_metrics.hpp"
#include "simulation/scene_builder.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "simulation/version.hpp"

/// The library's face: options, registry, scene builder, `simulate`.
namespace kairos::inline simulation {}
