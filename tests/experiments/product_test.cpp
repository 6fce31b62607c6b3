// The four choices are independent: every scheme with every integrator, detector and impact law on
// every shipped scene runs, or is refused with a reason.

#include "core/error.hpp"
#include "experiments/registry.hpp"
#include "experiments/run_metrics.hpp"
#include "experiments/scene_library.hpp"
#include "experiments/simulation.hpp"
#include "tests/catch.hpp"

#include <string>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;

namespace {

std::vector<std::string> integrator_names() {
  std::vector<std::string> names{"auto"};
  for (const IntegratorEntry& entry : integrators()) {
    names.emplace_back(entry.info.name);
  }
  return names;
}

std::vector<MethodChoice> product() {
  std::vector<MethodChoice> choices;
  for (const auto& scheme : schemes()) {
    for (const std::string& integrator : integrator_names()) {
      for (const auto& detector : detectors()) {
        for (const auto& law : impact_laws()) {
          choices.push_back({std::string(scheme->info().name), integrator,
                             std::string(detector->info().name), std::string(law->info().name)});
        }
      }
    }
  }
  return choices;
}

/// Counts what happened to the combinations of one scene.
struct Tally {
  int completed = 0;
  int stopped = 0;
  int refused = 0;
};

void walk(const Model& model, const MethodChoice& method, Tally& tally) {
  INFO(method.scheme << " + " << method.integrator << " + " << method.detector << " + "
                     << method.impact);
  RunChoice choice;
  choice.method = method;
  choice.duration = 0.1;  // s: a few frames of every scene, most of them with a contact
  MetricsRecorder metrics;
  if (!why_refused(model, choice).empty()) {
    CHECK_THROWS_AS(simulate(model, choice, metrics), InputError);
    ++tally.refused;
    return;
  }
  const RunResult result = simulate(model, choice, metrics);
  if (result.status == RunStatus::stopped) {
    CHECK_FALSE(result.reason.empty());
    ++tally.stopped;
  } else {
    CHECK(result.end.seconds == Approx(*choice.duration).epsilon(1e-12));  // sums of frame times
    CHECK(metrics.metrics().frames > 0);
    ++tally.completed;
  }
}

}  // namespace

TEST_CASE("every combination on every scene runs or is refused with a reason", "[product][slow]") {
  const std::vector<MethodChoice> choices = product();
  REQUIRE(choices.size() >= 5 * 8 * 4 * 2);
  REQUIRE_FALSE(shipped_scenes().empty());
  for (const std::string& name : shipped_scenes()) {
    INFO(name);
    const Model model(read_scene(find_scene(name)));
    Tally tally;
    for (const MethodChoice& method : choices) {
      walk(model, method, tally);
    }
    WARN(name << ": " << tally.completed << " completed, " << tally.stopped
              << " stopped with a reason, " << tally.refused << " refused with a reason");
    CHECK(tally.completed > 0);
  }
}

TEST_CASE("what is refused says which choices do not go together", "[product]") {
  const Model model(read_scene(find_scene("bounce")));
  RunChoice choice;
  choice.method = {"event-driven", "auto", "sat", "newton"};
  const std::string reason = why_refused(model, choice);
  CAPTURE(reason);
  CHECK(reason.find("event-driven") != std::string::npos);
  CHECK(reason.find("sat") != std::string::npos);
}
