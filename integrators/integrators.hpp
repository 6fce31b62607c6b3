#pragma once

// The room `integrators`, as a consumer sees it: the catalogue of all steppers of this build.
// `#include <kairos/integrators.hpp>`; see integrators/README.md.
#include "integrators/catalogue/catalogue.hpp"

/// Ordinary differential equations in time: steppers with dense output.
namespace kairos::integrators {}
