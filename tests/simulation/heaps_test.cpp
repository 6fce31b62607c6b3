// Heaps that come to rest: that they do, and that it is not work without end.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

using namespace kairos;

namespace {

/// Nine balls that fall into a box with walls: six, and three on those.
std::string balls_in_a_box(double duration) {
  std::string text = fmt::format("duration = {}\nfriction = 0.3\n", duration);
  const auto wall = [&](const char* name, const char* half, const char* at) {
    text += fmt::format(
        "[[body]]\nname = \"{}\"\nentity = \"wall\"\nhalf_extents = {}\nposition = {}\n", name,
        half, at);
  };
  wall("floor", "[0.5, 0.05, 0.5]", "[0.0, -0.05, 0.0]");
  wall("right", "[0.05, 0.5, 0.5]", "[0.55, 0.5, 0.0]");
  wall("left", "[0.05, 0.5, 0.5]", "[-0.55, 0.5, 0.0]");
  wall("front", "[0.5, 0.5, 0.05]", "[0.0, 0.5, 0.55]");
  wall("back", "[0.5, 0.5, 0.05]", "[0.0, 0.5, -0.55]");
  for (int k = 0; k < 9; ++k) {
    const int row = k / 3;
    const double x = -0.31 + 0.305 * (k % 3) + 0.015 * row;
    const double y = row == 2 ? 0.6 : 0.3;
    const double z = row == 1 ? 0.15 : -0.2;
    text += fmt::format(
        "[[body]]\nname = \"ball-{}\"\nentity = \"body\"\nshape = \"sphere\"\nradius = 0.12\n"
        "position = [{}, {}, {}]\nmass = 1.0\nrestitution = 0.4\n",
        k, x, y, z);
  }
  return text;
}

}  // namespace

TEST_CASE("heaps: balls that fall into a box come to rest, and then cost next to nothing") {
  const Simulation sim = simulate(parse_scene(balls_in_a_box(2.5), "test.toml"), {});
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  const auto& times = sim.trajectory.frame_times();
  double fastest = 0.0;
  for (const BodyState& state : sim.trajectory.frame_state(times.size() - 1)) {
    fastest = std::max(fastest, state.twist.linear.norm());
  }
  // What is left rolls: nothing brakes that, nor what spins.
  CHECK(fastest <= 1e-6);
  // One of them rests at the edge of its cone, and was taken to begin to slide there again and
  // again: that took 17,342 steps, and now 2,553.
  CHECK(sim.result.cost.steps <= 10'000);
}
