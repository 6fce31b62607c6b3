// An impact that bodies in touch hand on among each other, in event-driven runs with friction,
// where pairs are struck one after the other: it ends after some impacts, not after thousands.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/whole_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

using namespace kairos;

namespace {

constexpr double g = 9.8;
constexpr int boxes = 10;

/// Ten boxes of 0.5 m on each other, and a ball of 1 kg that falls on them from 0.5 m above, so far
/// off their middle.
std::string struck_stack(double off, double e, double duration) {
  std::string text = fmt::format(
      "duration = {}\nframe = \"1/60\"\nG = {}\nfriction = 0.5\n"
      "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n",
      duration, g);
  for (int k = 0; k < boxes; ++k) {
    text += fmt::format(
        "[[body]]\nname = \"box-{}\"\nentity = \"body\"\nhalf_extents = [0.25, 0.25, 0.25]\n"
        "mass = 1.0\nposition = [0, {}, 0]\nrestitution = {}\n",
        k, 0.25 + 0.5 * k, e);
  }
  return text + fmt::format(
                    "[[body]]\nname = \"ball\"\nentity = \"body\"\nshape = \"sphere\"\nradius = "
                    "0.25\nmass = 1.0\nposition = [{}, 5.75, {}]\nrestitution = {}\n",
                    off, 0.5 * off, e);
}

/// The most impacts at one instant.
int most_at_once(const Simulation& sim) {
  std::map<Instant, int> count;
  int most = 0;
  for (const Event& event : sim.trajectory.events()) {
    most = std::max(most, event.kind == EventKind::impact ? ++count[event.time] : 0);
  }
  return most;
}

}  // namespace

TEST_CASE("A ball that falls on the middle of a stack that returns nothing stops with it") {
  const std::string text = struck_stack(0.0, 0.0, 1.0);
  const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
  tests::check_whole(sim, text);
  // All that it had fallen by is lost.
  CHECK(sim.result.ledger.line(EnergyLine::restitution_loss) == Approx(-g * 0.5).epsilon(1e-12));
  for (const BodyState& state :
       sim.trajectory.frame_state(sim.trajectory.frame_times().size() - 1)) {
    CHECK(state.twist.linear.norm() <= 1e-12);
    CHECK(state.twist.angular.norm() <= 1e-12);
  }
}

TEST_CASE("An impact beside the middle of a stack is handed on some times and not thousands") {
  const double e = GENERATE(0.0, 0.5);
  CAPTURE(e);
  // Where they return a part they hop long after it: just past the impact, at 0.31944 s.
  const std::string text = struck_stack(0.1, e, e > 0.0 ? 0.3195 : 0.4);
  const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
  tests::check_whole(sim, text);
  // Some for each of the boxes, until what is left can be had at once; by turns alone it is ten
  // thousand.
  CHECK(most_at_once(sim) <= 100 * boxes);
}
