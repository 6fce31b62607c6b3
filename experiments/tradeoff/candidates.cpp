#include "experiments/tradeoff/candidates.hpp"

#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kairos::experiments {
namespace {

/// Collects candidates that this model can run.
class Collector {
 public:
  explicit Collector(const Model& model)
      : model_(model), h_(mean_frame_duration(model.scene().frames)) {}

  void add(const std::string& name, const std::string& group, RunChoice choice, int parts = 1) {
    choice.frames = parts == 1 ? model_.scene().frames : FrameTimes(FixedFrames{h_ / parts});
    const std::string full = parts == 1 ? name : fmt::format("{}, h/{}", name, parts);
    if (why_refused(model_, choice).empty()) {
      found_.push_back({full, group, std::move(choice)});
    }
  }
  [[nodiscard]] double h() const { return h_; }
  [[nodiscard]] std::vector<Candidate> take() && { return std::move(found_); }

 private:
  const Model& model_;
  double h_;
  std::vector<Candidate> found_;
};

RunChoice method(const char* scheme, const char* integrator, const char* detector) {
  return {.method = {scheme, integrator, detector, "newton"}};
}

bool all_closed_form(const Model& model) {
  for (std::size_t k = 0; k < model.islands().size(); ++k) {
    if (!model.closed_form(k)) {
      return false;
    }
  }
  return true;
}

void frame_based(Collector& all) {
  all.add("thesis", "original", {.method = MethodChoice::thesis()});
  for (const int parts : {1, 4, 16}) {
    for (const char* integrator : {"thesis-euler", "symplectic-euler", "velocity-verlet", "rk4"}) {
      all.add(fmt::format("original {}", integrator), "original",
              method("original", integrator, "sat"), parts);
    }
  }
  for (const int parts : {1, 4}) {
    all.add("geometric", "geometric", method("geometric", "velocity-verlet", "certified"), parts);
    all.add("substepped", "substepped", method("substepped", "velocity-verlet", "sat"), parts);
    RunChoice equal = method("substepped", "velocity-verlet", "sat");
    equal.equal_substeps = true;
    all.add("equal substeps", "substepped", equal, parts);
    all.add("bisected bisection", "bisected", method("bisected", "velocity-verlet", "bisection"),
            parts);
    all.add("bisected certified", "bisected", method("bisected", "rk4", "certified"), parts);
  }
}

/// The schemes that people use, with the options of their sources.
void time_stepping(Collector& all) {
  for (const int parts : {1, 4}) {
    for (const char* scheme : {"moreau-jean", "pgs", "xpbd", "penalty"}) {
      all.add(scheme, scheme, method(scheme, "auto", "certified"), parts);
    }
  }
}

void event_driven(Collector& all, bool closed_form) {
  const auto add = [&](const std::string& name, const char* integrator, double step, double tol,
                       const char* detector = "certified") {
    RunChoice choice = method("event-driven", integrator, detector);
    if (step > 0.0) {
      choice.step = step;
    }
    if (tol > 0.0) {
      choice.stepper = {tol, tol};
    }
    all.add(name, "event-driven", choice);
  };
  add("event-driven auto", "auto", 0.0, 0.0);
  add("event-driven auto bisection", "auto", 0.0, 0.0, "bisection");
  add("event-driven auto conservative", "auto", 0.0, 0.0, "conservative-advancement");
  for (const int parts : {1, 4, 16}) {
    const std::string h = parts == 1 ? "h" : fmt::format("h/{}", parts);
    add("event-driven symplectic-euler step " + h, "symplectic-euler", all.h() / parts, 0.0);
    add("event-driven velocity-verlet step " + h, "velocity-verlet", all.h() / parts, 0.0);
  }
  if (closed_form) {
    return;  // all that follow are exact there, and dearer than the closed form
  }
  for (const int parts : {1, 4, 16}) {
    const std::string h = parts == 1 ? "h" : fmt::format("h/{}", parts);
    add("event-driven rk4 step " + h, "rk4", all.h() / parts, 0.0);
  }
  for (const char* integrator : {"dopri5", "gsl-rk8pd", "cvode-adams"}) {
    const auto known = integrator_entries();
    if (std::none_of(known.begin(), known.end(),
                     [&](const IntegratorEntry& e) { return e.info.name == integrator; })) {
      continue;
    }
    for (const double tol : {1e-4, 1e-7, 1e-10}) {
      add(fmt::format("event-driven {} {:.0e}", integrator, tol), integrator, 0.0, tol);
    }
  }
}

}  // namespace

std::string Candidate::options() const {
  const MethodChoice& m = choice.method;
  std::string out = fmt::format("--scheme {} --integrator {} --detector {} --impact {}", m.scheme,
                                m.integrator, m.detector, m.impact);
  if (const auto* fixed = choice.frames ? std::get_if<FixedFrames>(&*choice.frames) : nullptr) {
    out += fmt::format(" --frame {}", fixed->duration);
  }
  if (choice.step) {
    out += fmt::format(" --step {}", *choice.step);
  }
  if (choice.equal_substeps) {
    out += " --equal-substeps";
  }
  const StepperOptions defaults;
  if (choice.stepper.relative_tolerance != defaults.relative_tolerance) {
    out += fmt::format(" --relative-tolerance {} --absolute-tolerance {}",
                       choice.stepper.relative_tolerance, choice.stepper.absolute_tolerance);
  }
  return out;
}

std::vector<Candidate> sensible_candidates(const Model& model) {
  Collector all(model);
  frame_based(all);
  time_stepping(all);
  event_driven(all, all_closed_form(model));
  return std::move(all).take();
}

}  // namespace kairos::experiments
