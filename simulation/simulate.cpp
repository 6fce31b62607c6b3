#include "simulation/simulate.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/free_memory.hpp"
#include "core/joints/constrained_stepper.hpp"
#include "core/schemes/shared/journaled_stepper.hpp"
#include "integrators/dormand_prince.hpp"
#include "simulation/cold_restarts.hpp"
#include "simulation/model_gaps.hpp"
#include "simulation/penetration.hpp"
#include "simulation/registry.hpp"
#include "simulation/run_guard.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace kairos {
inline namespace simulation {
namespace {

/// A run of more frames than this would not end within a person's life.
constexpr double most_frames = 1e13;

/// No scene reaches farther: what is larger asks for nothing, and overflows where it is squared.
constexpr double most_tolerance = 1e12;

/// How many steps, each as far off the joints as its tolerance, a multistep method goes on from
/// states that are not put back: begun anew, it starts at order 1.
constexpr double steps_of_drift = 100.0;

/// Of the integrator of bodies that turn while they touch: it shows in gaps of 1e-10 of their size.
constexpr StepperOptions tight{1e-12, 1e-13};

/// Fewer bodies fit wherever the program does: nobody is asked how much is free.
constexpr std::size_t few_bodies = 4096;

/// The names of a choice, resolved.
struct Plan {
  std::shared_ptr<const Scheme> scheme;
  Method method;
  SchemeOptions options;
  std::string integrator;  ///< as named
};

void require(bool good, std::string_view key, double value, std::string_view allowed) {
  if (!good) {
    throw InputError("", 0, std::string(key), fmt::format("is {}; allowed: {}", value, allowed));
  }
}

bool positive(double x) { return std::isfinite(x) && x > 0.0; }
bool not_negative(double x) { return std::isfinite(x) && x >= 0.0; }

/// Of a tolerance; infinite ones ask for steps as they are given.
bool in_range(double x, double most) { return x >= 0.0 && (x <= most || std::isinf(x)); }

void check_numbers(const RunChoice& choice) {
  const StepperOptions& stepper = choice.stepper;
  require(positive(choice.duration.value_or(1.0)), "duration", choice.duration.value_or(1.0),
          "a finite number > 0 (s)");
  require(positive(choice.step.value_or(1.0)), "step", choice.step.value_or(1.0),
          "a finite number > 0 (s)");
  require(not_negative(choice.threshold), "threshold", choice.threshold,
          "a finite number > 0 (m), or 0: half of the smallest sum of two extents");
  require(choice.toi_tolerance >= 0.0 && choice.toi_tolerance <= most_tolerance, "tolerance",
          choice.toi_tolerance,
          fmt::format("a number > 0 and <= {} (m), or 0: the detector's default", most_tolerance));
  require(in_range(stepper.relative_tolerance, 1.0), "relative tolerance",
          stepper.relative_tolerance, "a number >= 0 and <= 1");
  require(in_range(stepper.absolute_tolerance, most_tolerance), "absolute tolerance",
          stepper.absolute_tolerance,
          fmt::format("a number >= 0 and <= {} (m, m/s)", most_tolerance));
  require(choice.max_events >= 0, "max events", static_cast<double>(choice.max_events),
          "a whole number >= 1, or 0: the default");
  require(choice.max_substeps >= 1, "max substeps", static_cast<double>(choice.max_substeps),
          "a whole number >= 1");
}

SchemeOptions scheme_options(const Scene& scene, const RunChoice& choice) {
  SchemeOptions options;
  options.frames = choice.frames.value_or(scene.frames);
  options.duration = choice.duration.value_or(scene.duration);
  options.step = choice.step.value_or(0.0);
  options.threshold = choice.threshold;
  options.equal_substeps = choice.equal_substeps;
  options.max_substeps = choice.max_substeps;
  options.max_events = choice.max_events;
  options.toi_tolerance = choice.toi_tolerance;
  options.roundoff = choice.roundoff;
  options.stepping = choice.stepping;
  return options;
}

Plan make_plan(const Model& model, const RunChoice& choice, const PlugIns& own) {
  check_numbers(choice);
  const auto detector = own.detector ? own.detector : find_detector(choice.method.detector);
  const auto integrator =
      detector->info().at_step_ends ? find_watching_integrator : find_integrator;
  Plan plan{own.scheme ? own.scheme : find_scheme(choice.method.scheme),
            {own.integrator ? own.integrator : integrator(choice.method.integrator, choice.stepper),
             detector, own.impact ? own.impact : find_impact_law(choice.method.impact),
             find_broad_phase(model.broad_phase()), swept_bounds(),
             find_neighbourhood(model.broad_phase())},
            scheme_options(model.scene(), choice),
            own.integrator ? "own" : choice.method.integrator};
  if (choice.cold_restarts) {
    plan.method.stepper = [make = plan.method.stepper](const Model& of, std::size_t island) {
      return with_cold_restarts(make(of, island));
    };
  }
  const double most_drift = steps_of_drift * choice.stepper.relative_tolerance;
  plan.method.stepper = [make = plan.method.stepper, most_drift](const Model& of,
                                                                 std::size_t island) {
    return make_constrained(make(of, island), of.islands()[island], most_drift);
  };
  plan.method.contact_stepper = [](double first_step) {
    return integrators::make_dopri5(tight, first_step);
  };
  const double frame = mean_frame_duration(plan.options.frames);
  require(positive(frame), "frame", frame, "a finite number > 0 (s)");
  return plan;
}

/// What a run takes of memory per body, bytes.
double bytes_of_run(const Model& model, std::string_view scheme) {
  if (scheme != "event-driven") {
    return bytes_in_frames;
  }
  double sum = 0.0;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const bool flies =
        model.is_free(i) && !model.rotates(i) && model.closed_form(model.island_of(i));
    sum += flies ? bytes_in_run : bytes_of_own_motion;
  }
  return sum / static_cast<double>(model.size());
}

std::string stepper_refusal(const Model& model, const Plan& plan) {
  for (std::size_t i = 0; i < model.islands().size(); ++i) {
    const std::unique_ptr<Stepper> stepper = plan.method.stepper(model, i);
    if (stepper == nullptr) {
      return fmt::format(
          "detector '{}' needs an integrator that finds impacts by itself: "
          "cvode-adams, cvode-bdf",
          plan.method.detector->info().name);
    }
    const std::string reason = stepper->refuses(model.islands()[i]);
    if (!reason.empty()) {
      return fmt::format("integrator '{}': {}", stepper->info().name, reason);
    }
  }
  return {};
}

std::string refusal(const Model& model, const Plan& plan) {
  const SchemeInfo scheme = plan.scheme->info();
  const DetectorInfo detector = plan.method.detector->info();
  if (scheme.needs_location && !detector.locates) {
    return fmt::format(
        "scheme '{}' needs to know when two bodies touch; detector '{}' only tells whether they do",
        scheme.name, detector.name);
  }
  if (model.has_friction() && !scheme.friction) {
    return fmt::format(
        "the scene has friction, of which scheme '{}' knows nothing; allowed: friction = 0 for all "
        "bodies of the scene, or a scheme that treats it (see `kairos list`)",
        scheme.name);
  }
  if (!model.scene().joints.empty() && !scheme.joints) {
    return fmt::format(
        "the scene has joints, of which scheme '{}' knows nothing; allowed: a scheme that holds "
        "them (see `kairos list`)",
        scheme.name);
  }
  if (model.scene().periodic && (!scheme.periodic || detector.at_step_ends)) {
    return fmt::format(
        "the scene is periodic, and {} '{}' looks at bodies only where they are, not at their "
        "images; allowed: scheme event-driven with a detector that locates contacts",
        scheme.periodic ? "detector" : "scheme", scheme.periodic ? detector.name : scheme.name);
  }
  if (const LawInfo law = plan.method.law->info(); model.has_friction() && !law.friction) {
    return fmt::format(
        "the scene has friction, of which impact law '{}' knows nothing; allowed: newton, routh, "
        "garwin; or friction = 0 for all bodies of the scene",
        law.name);
  }
  if (const std::string pair = pair_across_islands(model); detector.at_step_ends && !pair.empty()) {
    return fmt::format("detector '{}': {}", detector.name, pair);
  }
  if (!scheme.integrator.empty() && plan.integrator != "auto" &&
      plan.integrator != scheme.integrator) {
    return fmt::format(
        "scheme '{}' moves bodies by a method of its own, '{}'; integrator '{}' has "
        "no part in it; allowed: auto",
        scheme.name, scheme.integrator, plan.integrator);
  }
  if (plan.options.duration / mean_frame_duration(plan.options.frames) > most_frames) {
    return fmt::format("{} s in frames of {} s are more than {} frames", plan.options.duration,
                       mean_frame_duration(plan.options.frames), most_frames);
  }
  const std::string reason = stepper_refusal(model, plan);
  return reason.empty() ? plan.scheme->refuses(model, plan.method, plan.options) : reason;
}

/// No scheme can tell what two solids do that start inside each other.
void refuse_overlap_at_start(const Model& model) {
  const State start = model.initial_state();
  std::vector<char> in_hand(model.size(), 0);
  for (const auto& [hand, held] : model.grips()) {
    in_hand[held] = model.body(hand).drive->closed(Instant{}) ? 1 : 0;
  }
  if (const auto found = PenetrationProbe(model).first(start, in_hand)) {
    const Body& a = model.body(found->pair.first);
    const Body& b = model.body(found->pair.second);
    throw InputError(model.scene().path, b.line, "body." + b.name,
                     fmt::format("starts {:.3g} m inside body.{} (line {}), and at least one of "
                                 "them can move; solids must start apart or touching",
                                 found->depth, a.name, a.line));
  }
}

void continue_as(const Continuation& continuation, Plan& plan) {
  plan.options.keeper = continuation.keeper;
  plan.options.resume = continuation.resume;
  plan.method.stepper = [make = plan.method.stepper](const Model& model, std::size_t island) {
    return make_persistent(make(model, island));
  };
}

}  // namespace

MethodChoice MethodChoice::thesis() { return {"original", "thesis-euler", "sat", "thesis"}; }

std::string why_refused(const Model& model, const RunChoice& choice, const PlugIns& own) {
  return refusal(model, make_plan(model, choice, own));
}

RunResult simulate(const Model& model, const RunChoice& choice, Recorder& recorder,
                   const Continuation& continuation, const PlugIns& own) {
  Plan plan = make_plan(model, choice, own);
  if (model.size() > few_bodies) {
    const double bytes_a_body = bytes_of_run(model, plan.scheme->info().name);
    if (const std::string why = why_no_room(model.size(), bytes_a_body, free_memory());
        !why.empty()) {
      throw InputError(model.scene().path, 0, "", why);
    }
  }
  if (const std::string reason = refusal(model, plan); !reason.empty()) {
    throw InputError(model.scene().path, 0, "", reason);
  }
  refuse_overlap_at_start(model);
  if (continuation.keeper != nullptr || !continuation.resume.empty()) {
    continue_as(continuation, plan);
  }
  RunGuard guard(recorder, plan.scheme->info().integrator.empty());
  try {
    return plan.scheme->run(model, plan.method, plan.options, guard);
  } catch (const RunGuard::Broken& found) {
    return std::move(guard).stopped(found.reason);
  }
}

Simulation simulate(const Scene& scene, const RunChoice& choice, const PlugIns& own) {
  const Model model(scene);
  Simulation simulation;
  simulation.result = simulate(model, choice, simulation.trajectory, {}, own);
  return simulation;
}

}  // namespace simulation
}  // namespace kairos
