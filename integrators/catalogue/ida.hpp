#pragma once

#include "core/stepper.hpp"

namespace kairos::integrators {

/// IDA of SUNDIALS [Hindmarsh2005], BDF of orders 1 to 5, on islands with joints as what they are:
/// a differential-algebraic system, in the form of Gear, Gupta and Leimkuhler [Hairer1996, VII.2],
///
///   p' = v + M^-1 J^T m,   M v' = f + J^T l,   0 = r(p),   0 = J v,
///
/// with orientations as unit quaternions. It holds the joints by itself, within its tolerance. Not
/// a choice of a run: it starts at order 1 after every event, and refuses joints that depend on
/// each other. It is there to check the index-reduced equations and their projections by another
/// way to the same motion. Null where SUNDIALS or its IDA is not built in.
[[nodiscard]] std::unique_ptr<Stepper> make_ida(const StepperOptions& options);

}  // namespace kairos::integrators
