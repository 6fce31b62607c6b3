// Contact that lasts, of bodies that feel springs and drag: loads change while they touch.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/whole_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

using namespace kairos;

namespace {

std::string head(double duration, double mu, double gravity = 9.8) {
  return fmt::format(
      "duration = {}\nframe = \"1/60\"\nG = {}\nfriction = {}\n[[body]]\nname = \"floor\"\n"
      "entity = \"wall\"\nshape = \"half-space\"\n",
      duration, gravity, mu);
}

std::string box(const std::string& name, const std::string& position, double e,
                const std::string& rest = "") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = [0.2, 0.1, 0.2]\nmass = 1\n"
      "restitution = {}\nposition = {}\n{}\n",
      name, e, position, rest);
}

std::string spring(const std::string& body, const std::string& anchor, double stiffness) {
  return fmt::format(
      "[[force]]\nkind = \"spring\"\nname = \"of {}\"\nbodies = [\"{}\"]\nanchor = {}\n"
      "stiffness = {}\n",
      body, body, anchor, stiffness);
}

Simulation check(const std::string& text) {
  const Scene scene = parse_scene(text, "test.toml");
  Simulation sim = simulate(scene, {});
  tests::check_whole(sim, scene);
  CHECK(sim.result.ledger.line(EnergyLine::friction) <= 0.0);
  return sim;
}

}  // namespace

// x'' = -100 x -+ 1.96: half a period of pi/10 from one turning point to the next, each nearer by
// 0.0392, until the spring does not overcome friction.
TEST_CASE("problem 17: a block on a spring is rubbed, turns back twice, and stops",
          "[modes][friction][reference]") {
  const Simulation sim = check(head(3.0, 0.2) + box("block", "[0.1, 0.1, 0]", 0.0) +
                               spring("block", "[0, 0.1, 0]", 100));
  std::vector<double> turns;
  double stops = -1.0;
  for (const Event& event : sim.trajectory.events()) {
    if (event.kind == EventKind::slip_begins) {
      turns.push_back(event.time.seconds);
    } else if (event.kind == EventKind::stick_begins) {
      CHECK(stops < 0.0);
      stops = event.time.seconds;
    }
  }
  REQUIRE(turns.size() == 3);
  CHECK(turns[0] == 0.0);
  CHECK(std::abs(turns[1] - M_PI / 10.0) <= 1e-9);
  CHECK(std::abs(turns[2] - M_PI / 5.0) <= 1e-9);
  CHECK(std::abs(stops - 0.942477796077) <= 1e-9);
  CHECK(std::abs(sim.result.state[1].pose.position.x() - 0.0176) <= 1e-9);
  // 1.96 N over 0.1608 + 0.0824 + 0.004 m.
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::friction) + 1.96 * 0.2472) <= 1e-9);
}

TEST_CASE("a spring presses a box to a wall, on which it comes to rest", "[modes]") {
  const Simulation sim = check(head(5.0, 0.0, 0.0) + box("block", "[0, 0.6, 0]", 0.5) +
                               spring("block", "[0, -0.3, 0]", 20));
  CHECK(sim.result.cost.impacts > 10);
  const BodyState& end = sim.result.state[1];
  CHECK(std::abs(end.pose.position.y() - 0.1) <= 1e-9);
  CHECK(end.twist.linear.norm() <= 1e-12);
}

TEST_CASE("a box on a spring lands on another, and both come to rest", "[modes]") {
  const Simulation sim =
      check(head(5.0, 0.4) + box("low", "[0, 0.1, 0]", 0.2) + box("high", "[0.02, 0.5, 0]", 0.2) +
            spring("high", "[0, 0.2, 0]", 60));
  CHECK(std::abs(sim.result.state[1].pose.position.y() - 0.1) <= 1e-9);
  CHECK(std::abs(sim.result.state[2].pose.position.y() - 0.3) <= 1e-8);
}

// m v' = -c v - mu m g: v = (v0 + w) exp(-c t/m) - w, w = mu m g/c, which ends at m/c ln(1 + v0/w).
TEST_CASE("a block slides through air, and stops", "[modes][friction]") {
  const Simulation sim =
      check(head(1.0, 0.3) + box("block", "[0, 0.1, 0]", 0.0, "velocity = [2, 0, 0]") +
            "[[force]]\nkind = \"linear-drag\"\nname = \"air\"\nbodies = [\"block\"]\n"
            "coefficient = 0.5\n");
  const double w = 0.3 * 9.8 / 0.5;
  const double stops = 2.0 * std::log(1.0 + 2.0 / w);
  double told = -1.0;
  for (const Event& event : sim.trajectory.events()) {
    if (event.kind == EventKind::stick_begins) {
      told = event.time.seconds;
    }
  }
  CHECK(std::abs(told - stops) <= 1e-9);
  const double way = 2.0 * (2.0 + w) * (1.0 - w / (2.0 + w)) - w * stops;
  CHECK(std::abs(sim.result.state[1].pose.position.x() - way) <= 1e-9);
}
