// The four choices are independent: every scheme with every integrator, detector and impact law
// runs, or is refused with a reason, on the shipped scenes.

#include "core/reading/scene_reader.hpp"
#include "experiments/parallel_for.hpp"
#include "simulation/registry.hpp"
#include "simulation/run_metrics.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/thoroughness.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <string>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;

namespace {

std::vector<std::string> integrator_names() {
  std::vector<std::string> names{"auto"};
  for (const IntegratorEntry& entry : integrator_entries()) {
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

/// Which of so many scenes in a row has a combination to run.
std::size_t turn_of(std::size_t combination, std::size_t scenes) {
  // Fibonacci hashing (Knuth, The Art of Computer Programming 3, 6.4): neighbours have other turns.
  return static_cast<std::size_t>((combination * 0x9e3779b97f4a7c15ULL) >> 32U) % scenes;
}

enum class Fate { completed, stopped, refused, wrong };

/// What became of one combination; `fault` says what is wrong.
struct Walk {
  Fate fate = Fate::wrong;
  std::string fault;
};

Walk walk(const Model& model, const MethodChoice& method, double duration) {
  RunChoice choice;
  choice.method = method;
  choice.duration = duration;
  choice.stepper = {1e-5, 1e-5};  // so that controlled methods of order 2 take few steps too
  MetricsRecorder metrics;
  try {
    if (!why_refused(model, choice).empty()) {
      return {Fate::refused, ""};
    }
    const RunResult result = simulate(model, choice, metrics);
    if (result.status == RunStatus::stopped) {
      return {result.reason.empty() ? Fate::wrong : Fate::stopped, "stopped without a reason"};
    }
    // Roundoff: frame times are summed.
    const bool whole = std::abs(result.end.seconds - *choice.duration) <= 1e-15;
    return {whole ? Fate::completed : Fate::wrong, "did not reach the end"};
  } catch (const std::exception& error) {
    return {Fate::wrong, error.what()};
  }
}

}  // namespace

// Each scene has an eighth of the combinations, and each combination every eighth scene: all of
// them on all scenes take many minutes of a processor (./test --thorough).
TEST_CASE("every combination on the shipped scenes runs or is refused with a reason",
          "[product][slow]") {
  const std::size_t every = tests::thorough() ? 1 : 8;
  const std::vector<MethodChoice> choices = product();
  REQUIRE(choices.size() >= 5 * 8 * 4 * 2);
  REQUIRE_FALSE(shipped_scenes().empty());
  std::size_t turn = 0;
  for (const std::string& name : shipped_scenes()) {
    const Model model(read_scene(find_scene(name)));
    std::vector<std::size_t> mine;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (turn_of(i, every) == turn) {
        mine.push_back(i);
      }
    }
    turn = (turn + 1) % every;
    std::vector<Walk> walks(mine.size());
    // Methods of low order take thousands of steps to keep what turns in touch: there one frame,
    // and laws of impact and detectors with `auto` alone, for they have no part in that.
    const bool turns = name == "ladder" || name == "pyramid" || name == "woodpecker";
    const double duration = name == "ladder" || name == "pyramid" ? 1.0 / 60.0 : 0.05;  // s
    parallel_for(mine.size(), 0, [&](std::size_t i) {
      const MethodChoice& c = choices[mine[i]];
      const bool again = turns && c.scheme == "event-driven" && c.integrator != "auto" &&
                         (c.impact != "newton" || c.detector != "certified");
      walks[i] = again ? Walk{Fate::refused, ""} : walk(model, c, duration);
    });
    std::array<int, 4> tally{};
    for (std::size_t i = 0; i < mine.size(); ++i) {
      ++tally[static_cast<std::size_t>(walks[i].fate)];
      const MethodChoice& c = choices[mine[i]];
      INFO(name << ": " << c.scheme << " + " << c.integrator << " + " << c.detector << " + "
                << c.impact << ": " << walks[i].fault);
      CHECK(walks[i].fate != Fate::wrong);
    }
    CAPTURE(name, tally[0], tally[1], tally[2]);  // completed, stopped, refused
    if (name == "dominoes") {  // they fall on each other: many methods stop, and say so
      CHECK(tally[0] > 0);
    } else {
      CHECK(tally[0] > tally[1]);
    }
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
