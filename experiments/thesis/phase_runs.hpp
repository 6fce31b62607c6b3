#pragma once

#include "core/scene.hpp"
#include "simulation/simulate.hpp"

#include <string>

namespace kairos::experiments::thesis {

// Runs repeated over the phase at which a frame finds the body: what happens between two frames as
// a fraction of all phases, for the errata and the tests of the predictions.

inline constexpr double bullet_length = 0.06;  ///< m, of scene bullet: wall and diameter

/// Start of the k-th of n drops whose last frame before the bounce falls everywhere, with equal
/// weight: after m frames the thesis' ball has fallen G h^2 (m-1)(m-2)/2; here m = 59 to 60.
[[nodiscard]] Scene drop_at_phase(int k, int n);
/// Fraction of n drops in which a ball that was reflected is reflected again, back inwards, when
/// frame times are uniform in 1/60 s times 1 +- jitter.
[[nodiscard]] double turned_fraction(double jitter, int n);
/// The same at a fixed frame time, with a reflection that scales the normal speed by e and does not
/// ask whether the bodies approach.
[[nodiscard]] double turned_fraction_lossy(double e, int n);

/// The bullet at a speed (m/s) and at a phase of a frame of 1/60 s.
[[nodiscard]] Scene bullet_at_phase(double speed, double phase);
/// A scheme with the thesis' integrator and impact law, and half the bullet's length as threshold.
[[nodiscard]] RunChoice substep_choice(const std::string& scheme, bool equal_substeps = false);
/// Fraction of n stratified phases at which the bullet goes through the wall; exact within 1/n for
/// any interval of phases.
[[nodiscard]] double tunnelled_fraction(RunChoice choice, double speed, int n);
/// The same in closed form, for fig. 15 taken literally with a threshold of half the bullet's
/// length: a ball first seen inside after the last whole substep of a frame, deeper than the rest
/// of that frame, is turned back in, and comes out behind the wall where whole substeps are odd in
/// number.
[[nodiscard]] double literal_passes(double speed, double threshold);

/// Fraction of n starts between the two walls of the scene corridor from which a ball at this speed
/// (m/s) gets out within a second, under the geometric approach.
[[nodiscard]] double corridor_left(double speed, int n);

}  // namespace kairos::experiments::thesis
