// A conveyor under `newton`: smooth bodies, so the belt runs on under what it meets and is a wall.
// Under `thesis` it exchanges momentum (prediction 6 and its neighbours hold that).

#include "core/reading/scene_reader.hpp"
#include "simulation/registry.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace kairos;

namespace {

/// An item above (or beside) a belt, or a wall of the same size.
struct Laid {
  double height, restitution;
  double mass = 1e6;  ///< of the belt, kg
};

std::string item(const Vector3& position, double speed, double restitution) {
  return fmt::format(
      "[[body]]\nname = \"item\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\n"
      "position = [{}, {}, {}]\nvelocity = [{}, 0, 0]\nrestitution = {}\n",
      position.x(), position.y(), position.z(), speed, restitution);
}

std::string on_belt(const Laid& laid, bool belt) {
  return "duration = 5.0\nframe = \"1/60\"\nG = 9.81\n[[body]]\nname = \"belt\"\n"
         "half_extents = [50.0, 0.1, 0.5]\nposition = [0.0, -0.1, 0.0]\n" +
         (belt ? fmt::format("entity = \"conveyor\"\nbelt_speed = 1.0\nbelt_mass = {}\n", laid.mass)
               : std::string("entity = \"wall\"\n")) +
         item({0.0, laid.height, 0.0}, 0.0, laid.restitution);
}

Simulation run(const std::string& text, const std::string& scheme) {
  return simulate(parse_scene(text, ""), {.method = {scheme, "auto", "certified", "newton"}});
}

}  // namespace

TEST_CASE("a belt without friction is a wall, whatever its mass, and carries nothing", "[belt]") {
  for (const auto& scheme : schemes()) {
    const std::string name(scheme->info().name);
    for (const Laid& laid : {Laid{0.1, 0.5}, Laid{0.2, 0.5}, Laid{0.3, 0.6}, Laid{0.4, 0.8},
                             Laid{0.5, 0.7}, Laid{0.5, 1.0, 10.0}}) {
      CAPTURE(name, laid.height, laid.restitution, laid.mass);
      const Simulation belt = run(on_belt(laid, true), name);
      const Simulation wall = run(on_belt(laid, false), name);
      CHECK(belt.result.status == RunStatus::completed);
      CHECK(belt.result.cost.impacts == wall.result.cost.impacts);
      const BodyState& end = belt.result.state[1];
      CHECK(end.twist.linear == wall.result.state[1].twist.linear);
      CHECK(end.pose.position == wall.result.state[1].pose.position);
      CHECK(end.twist.linear.x() == 0.0);
      CHECK(belt.result.ledger.line(EnergyLine::conveyor_and_hand) == 0.0);
      tests::check_explained(belt.result.ledger);
    }
  }
}

TEST_CASE("an item meets the end of a belt and goes back as from a wall", "[belt]") {
  const Simulation sim =
      run("duration = 2.0\nframe = \"1/60\"\nG = 9.81\n[[body]]\nname = \"belt\"\nentity = "
          "\"conveyor\"\nhalf_extents = [0.5, 0.1, 0.5]\nposition = [0.0, 0.1, 0.0]\n"
          "belt_speed = 1.0\nbelt_mass = 10.0\n[[body]]\nname = \"floor\"\nentity = \"wall\"\n"
          "shape = \"half-space\"\n" +
              item({-2.0, 0.1, 0.0}, 1.0, 1.0),
          "event-driven");
  INFO(sim.result.reason);
  CHECK(sim.result.status == RunStatus::completed);
  CHECK(sim.result.state[2].twist.linear.x() == -1.0);
  // To the end at -0.5 - 0.1 in 1.4 s, and back for 0.6 s. The impact acts within 1e-9 of the
  // item's 0.2 m before the end, and twice that is missing.
  CHECK(std::abs(sim.result.state[2].pose.position.x() + 1.2) <= 4e-10);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("explain says what a belt does and under which law", "[belt][model]") {
  const Model model(parse_scene(on_belt({0.5, 1.0}, true), ""));
  std::string told;
  for (const Decision& decision : model.decisions()) {
    if (decision.text.find("belt") != std::string::npos) {
      told += decision.text + " because " + decision.reason;
    }
  }
  CAPTURE(told);
  CHECK(told.find("1 m/s") != std::string::npos);
  CHECK(told.find("newton") != std::string::npos);
  CHECK(told.find("thesis") != std::string::npos);
}
