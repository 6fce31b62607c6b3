// Forces that scene files ask for, run: what they do to the energy is told by the ledger, line by
// line, under every scheme.

#include "core/energy_ledger.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <cmath>
#include <string>

using namespace kairos;

namespace {

const std::string two_bodies = R"(
duration = 2
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
[[body]]
name = "ball"
entity = "body"
radius = 0.1
mass = 0.5
position = [0, 1, 0]
velocity = [1, 0, 0.5]
angular_velocity = [0, 3, 20]
[[body]]
name = "box"
entity = "body"
half_extents = [0.1, 0.2, 0.3]
mass = 1.5
position = [1, 1.5, 0]
angular_velocity = [1, 2, 3]
[[force]]
)";

Simulation run(const std::string& force, const std::string& scheme,
               const std::string& integrator = "auto") {
  RunChoice choice;
  choice.method = {scheme, integrator, "certified", "newton"};
  return simulate(parse_scene(two_bodies + force, "test.toml"), choice);
}

}  // namespace

TEST_CASE("forces: under every scheme the ledger explains what each force did", "[forces]") {
  const std::string forces[] = {
      "kind = \"quadratic-drag\"\ndensity = 100",
      "kind = \"linear-drag\"\ncoefficient = 0.5\nrotational = 0.01\nwind = [0, 0, 1]",
      "kind = \"magnus-lift\"\ndensity = 50\nbodies = [\"ball\"]",
      "kind = \"buoyancy\"\ndensity = 30\ncentre = [0, 0.01, 0]",
      "kind = \"buoyancy\"\ndensity = 30",
      "kind = \"spring\"\nbodies = [\"ball\", \"box\"]\nstiffness = 20\ndamping = 0.5\n"
      "rest_length = 0.8\npoint_b = [0, 0.2, 0]",
      "kind = \"spring\"\nbodies = [\"box\"]\nstiffness = 20\nanchor = [1, 3, 0]",
      "kind = \"damper\"\nbodies = [\"ball\", \"floor\"]\ndamping = 0.5",
  };
  for (const std::string& force : forces) {
    for (const char* scheme : {"original", "substepped", "bisected", "event-driven"}) {
      CAPTURE(force, scheme);
      const Simulation sim = run(force, scheme, "dopri5");
      CAPTURE(sim.result.reason);
      CHECK(sim.result.status == RunStatus::completed);
      tests::check_explained(sim.result.ledger);
    }
  }
}

TEST_CASE("forces: drag takes energy, lift in still air does no work, springs keep it",
          "[forces]") {
  const auto work = [](const Simulation& sim) {
    return sim.result.ledger.line(EnergyLine::field_work);
  };
  // The lift's spin and speed: tens of joules of exchange; tolerances of the integrator, 1e-10.
  const double solver = 1e-8;
  const Simulation drag = run("kind = \"quadratic-drag\"\ndensity = 100", "event-driven");
  CHECK(work(drag) < -0.1);
  const Simulation lift =
      run("kind = \"magnus-lift\"\ndensity = 50\nbodies = [\"ball\"]", "event-driven");
  CHECK(std::abs(work(lift)) <= solver);
  const Simulation straight =
      run("kind = \"magnus-lift\"\ndensity = 0\nbodies = [\"ball\"]", "event-driven");
  CHECK((lift.result.state[1].pose.position - straight.result.state[1].pose.position).norm() > 0.1);
  const std::string spring =
      "kind = \"spring\"\nbodies = [\"ball\", \"box\"]\nstiffness = 20\nrest_length = 0.8";
  const Simulation elastic = run(spring, "event-driven");
  CHECK(work(elastic) == 0.0);
  CHECK(std::abs(elastic.result.ledger.energy() - elastic.result.ledger.initial_energy()) <=
        solver);
  const Simulation damped = run(spring + "\ndamping = 0.5", "event-driven");
  CHECK(work(damped) < -0.01);
  CHECK(std::abs(damped.result.ledger.energy() - damped.result.ledger.initial_energy() -
                 work(damped)) <= solver);
}

TEST_CASE("forces: a ball that lies on a floor is lifted where a spring pulls harder than gravity",
          "[forces]") {
  // It slides towards the anchor 2 m above the floor's origin; the force of the spring upwards is
  // 20 N/m 1.9 m = 38 N wherever it is: more than the 9.8 N of gravity. With damping by the floor
  // (e = 0) it must not stay. With 2 N/m it is 3.8 N, and it stays.
  const auto height_after = [](const std::string& stiffness) {
    const std::string text = R"(
duration = 1
G = 9.8
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
[[body]]
name = "ball"
entity = "ball"
radius = 0.1
mass = 1
position = [1, 0.1, 0]
velocity = [0, -1, 0]
restitution = 0
[[force]]
kind = "spring"
bodies = ["ball"]
anchor = [0, 2, 0]
stiffness = )" + stiffness;
    const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
    CAPTURE(sim.result.reason);
    CHECK(sim.result.status == RunStatus::completed);
    tests::check_explained(sim.result.ledger);
    return sim.result.state[1].pose.position.y() - 0.1;
  };
  CHECK(height_after("20") > 0.5);
  CHECK(std::abs(height_after("2")) < 1e-12);
}

TEST_CASE("forces: a spring that slackens lets a ball lie, one that tightens lifts it",
          "[forces]") {
  // A ball on a floor without friction slides from rest towards below the anchor at height L0: the
  // pull upwards k (1 - L0/L) h grows with the distance, so it slides out again and lifts where
  // k h (1 - L0/L) = m g: with k = 30, h = 1.1, L0 = 1.1 at L = L0/(1 - 9.8/33).
  const std::string text = R"(
duration = 0.6
G = 9.8
frame = "1/240"
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
[[body]]
name = "ball"
entity = "ball"
radius = 0.1
mass = 1
position = [0, 0.1, 0]
velocity = [10, -0.001, 0]
restitution = 0
[[force]]
kind = "spring"
bodies = ["ball"]
anchor = [0, 1.2, 0]
stiffness = 30
rest_length = 1.1
)";
  const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
  const double length = 1.1 / (1.0 - 9.8 / 33.0);
  const double exact = std::sqrt(length * length - 1.1 * 1.1);
  double lifted = 0.0;
  for (const Event& event : sim.trajectory.events()) {
    if (event.kind == EventKind::contact_ends && lifted == 0.0) {
      lifted = event.after_a.pose.position.x() + event.after_b.pose.position.x();
    }
  }
  // The integrator's tolerance of 1e-10, over a few segments.
  CHECK(std::abs(lifted - exact) <= 1e-8);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE(
    "forces: a table that carries a ball against a spring does that work, and nothing is lost",
    "[forces]") {
  // A w^2 = 2 m/s^2 < g: the ball, under a spring from below that pulls with 6 N and more, stays.
  // After 1.25 s the table is 0.05 m higher: work against gravity and spring, and none that is
  // booked as error of the integrator.
  const std::string text = R"(
duration = 1.25
frame = "1/60"
G = 9.8
[[body]]
name = "table"
entity = "bat"
mass = 1
half_extents = [1, 0.1, 1]
position = [0, 0, 0]
[body.drive]
amplitude = [0, 0.05, 0]
frequency = 1
[[body]]
name = "ball"
entity = "ball"
radius = 0.1
mass = 1
position = [0.2, 0.2, 0]
velocity = [0, 0.3, 0]
restitution = 0
[[force]]
kind = "spring"
bodies = ["ball"]
anchor = [0, -2, 0]
stiffness = 3
)";
  const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
  CAPTURE(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const EnergyLedger& ledger = sim.result.ledger;
  CHECK(sim.result.state[1].pose.position.y() == Approx(0.25).epsilon(1e-9));  // still on it
  // The integrator's tolerance of 1e-10, over 75 segments of some 10 J.
  CHECK(std::abs(ledger.line(EnergyLine::truncation)) <= 1e-7);
  CHECK(ledger.line(EnergyLine::driven_work) > 0.4);
  tests::check_explained(ledger);
}
