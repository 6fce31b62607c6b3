#pragma once

#include "core/scheme.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace kairos {
inline namespace simulation {

// The one place where a string becomes a type: it knows the names of both sides of every port and
// plugs them together. All functions are thread-safe; unknown names throw `InputError` with the
// names that exist.

/// A stepper of this build, and what makes one.
struct IntegratorEntry {
  StepperInfo info;
  StepperFactory make = nullptr;
};

/// All schemes, the thesis' own first.
[[nodiscard]] std::span<const std::shared_ptr<const Scheme>> schemes();
/// All integrators; not called `integrators`, which is their namespace.
[[nodiscard]] std::span<const IntegratorEntry> integrator_entries();
/// All detectors.
[[nodiscard]] std::span<const std::shared_ptr<const ContactDetector>> detectors();
/// All impact laws.
[[nodiscard]] std::span<const std::shared_ptr<const ImpactLaw>> impact_laws();

/// Names of all broad phases.
[[nodiscard]] std::span<const std::string_view> broad_phases();

/// The scheme of this name.
[[nodiscard]] std::shared_ptr<const Scheme> find_scheme(std::string_view name);
/// The detector of this name.
[[nodiscard]] std::shared_ptr<const ContactDetector> find_detector(std::string_view name);
/// The impact law of this name.
[[nodiscard]] std::shared_ptr<const ImpactLaw> find_impact_law(std::string_view name);
/// One stepper per island: the named one, used as named; for `auto` what the model chooses:
/// `closed-form` where it can, a Runge-Kutta method otherwise.
[[nodiscard]] IslandStepperFactory find_integrator(std::string_view name,
                                                   const StepperOptions& options = {});
/// The same with steppers that end their steps where bodies meet (`Stepper::watch`); null where a
/// stepper cannot. `auto`: cvode-adams.
[[nodiscard]] IslandStepperFactory find_watching_integrator(std::string_view name,
                                                            const StepperOptions& options = {});
/// The broad phase of this name, for bodies that are at one time together.
[[nodiscard]] BroadPhaseFactory find_broad_phase(std::string_view name);
/// The same for bodies that each move from a time of their own; a broad phase of boxes then has
/// windows.
[[nodiscard]] NeighbourhoodFactory find_neighbourhood(std::string_view name);
/// The box that a broad phase is given of a moving shape.
[[nodiscard]] SweptBounds swept_bounds();

}  // namespace simulation
}  // namespace kairos
