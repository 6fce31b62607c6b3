#pragma once

#include "core/contacts/turning_way.hpp"

namespace kairos {
inline namespace core {

/// Adds to a step what its contact forces do along its motions: their power at 8 nodes, and the
/// polynomials through it, integrated.
void book_turning_step(TurningWay& way, TurningStep& step);

}  // namespace core
}  // namespace kairos
