#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "simulation/registry.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <string>
#include <vector>

// The broad phase changes what a run costs and not what happens in it.

using namespace kairos;

namespace {

/// 64 balls in a box, without gravity.
std::string gas() {
  std::string text = "duration = 0.5\nframe = 0.1\nG = 0\n";
  for (int side = 0; side < 6; ++side) {
    std::string half = "[2, 2, 2]";
    std::string at = "[0, 0, 0]";
    half[static_cast<std::size_t>(1 + 3 * (side / 2))] = '1';
    at.replace(static_cast<std::size_t>(1 + 3 * (side / 2)), 1, side % 2 == 0 ? "-3" : "3");
    text += "[[body]]\nname = \"wall" + std::to_string(side) +
            "\"\nentity = \"wall\"\nhalf_extents = " + half + "\nposition = " + at + "\n";
  }
  for (int k = 0; k < 64; ++k) {
    const auto coordinate = [](int i) { return std::to_string(-1.5 + i); };
    // Any fixed directions will do: thirds, fifths and sevenths of a turn do not repeat soon.
    text += "[[body]]\nname = \"ball" + std::to_string(100 + k) +
            "\"\nentity = \"ball\"\nradius = 0.3\nmass = 1\nposition = [" + coordinate(k % 4) +
            ", " + coordinate(k / 4 % 4) + ", " + coordinate(k / 16) + "]\nvelocity = [" +
            std::to_string(3.0 * std::sin(2.1 * k)) + ", " +
            std::to_string(3.0 * std::sin(1.3 * k)) + ", " +
            std::to_string(3.0 * std::cos(0.9 * k)) + "]\n";
  }
  return text;
}

std::vector<Event> impacts(std::string_view broad_phase) {
  ModelOptions options;
  options.broad_phase = broad_phase;
  const Model model(parse_scene(gas(), "gas.toml"), options);
  Trajectory trajectory;
  const RunResult result = simulate(model, {}, trajectory);
  REQUIRE(result.status == RunStatus::completed);
  return trajectory.events();
}

}  // namespace

TEST_CASE("every broad phase gives the same sequence of impacts", "[broad-phase]") {
  const std::vector<Event> reference = impacts("all-pairs");
  REQUIRE(reference.size() > 100);
  for (const std::string_view name : broad_phases()) {
    CAPTURE(name);
    const std::vector<Event> events = impacts(name);
    REQUIRE(events.size() == reference.size());
    for (std::size_t k = 0; k < events.size(); ++k) {
      REQUIRE(events[k].a == reference[k].a);
      REQUIRE(events[k].b == reference[k].b);
      // Queries start at other times, which moves a root by roundoff; collisions of balls multiply
      // that by some 10 each, and a ball has about 5 in this time.
      REQUIRE(std::abs(events[k].time.seconds - reference[k].time.seconds) <= 1e-9);
    }
  }
}
