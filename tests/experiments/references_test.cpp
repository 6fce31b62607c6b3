// The report's problems of lasting contact: what event-driven answers is the truth, the rest has a
// reason.
#include "core/reading/scene_reader.hpp"
#include "experiments/references/reference_problem.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace kairos;
using namespace kairos::experiments;

TEST_CASE("references: event-driven is right to the digits given, or stops and says why",
          "[references]") {
  int answered = 0;
  for (const ReferenceProblem& problem : reference_problems()) {
    CAPTURE(problem.name, problem.quantity);
    RunChoice choice;
    choice.method.impact = problem.impact;
    choice.stepper = {1e-13, 1e-14};
    const Simulation run = simulate(parse_scene(problem.toml, "reference.toml"), choice);
    if (run.result.status == RunStatus::stopped) {
      CHECK(run.result.reason.find("allowed: ") != std::string::npos);
      continue;
    }
    ++answered;
    const double scale = std::max(1.0, std::abs(problem.truth));
    CHECK(std::abs(problem.measured(run) - problem.truth) <= problem.within * scale);
  }
  CHECK(answered >= 40);
}
