#pragma once

#include "core/stepper.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// Lets any stepper move an island with joints: returns it as it is where the island has none, or
/// where the stepper holds joints by itself.
///
/// The stepper solves the index-reduced equations: the forces of the joints are the island's last
/// force. After each of its steps the states are put back onto the constraints, positions first and
/// then velocities, nearest as the masses measure; a method of order p is off by O(h^(p+1)) after a
/// step, so that this costs no order [Hairer2006, IV.4]. The dense output is bent by cubics, so
/// that it begins and ends at the states; in between its error is as before.
///
/// Methods of one step go on from the states as they were put back. Multistep methods keep their
/// history: what is put back are the states that they show, until their own have drifted by
/// `most_drift` of the size, where they begin anew: some steps' worth of their tolerance.
[[nodiscard]] std::unique_ptr<Stepper> make_constrained(std::unique_ptr<Stepper> stepper,
                                                        const Island& island, double most_drift);

}  // namespace core
}  // namespace kairos
