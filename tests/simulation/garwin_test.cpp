// Superballs: restitution along the surface [Garwin1969].

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace kairos;

namespace {

RunChoice garwin() {
  RunChoice choice;
  choice.method.impact = "garwin";
  return choice;
}

/// A ball of 1 kg and 0.25 m, thrown on a floor at (3, -4) m/s.
std::string thrown(double e, const std::string& mu) {
  return fmt::format(
      "duration = 0.2\nframe = \"1/60\"\nG = 0.0\nfriction = {}\n[[body]]\nname = \"floor\"\n"
      "entity = \"wall\"\nshape = \"half-space\"\n[[body]]\nname = \"ball\"\nentity = \"body\"\n"
      "shape = \"sphere\"\nradius = 0.25\nmass = 1\nrestitution = {}\nposition = [0, 0.65, 0]\n"
      "velocity = [3, -4, 0]\n",
      mu, e);
}

}  // namespace

// Of the surface's 3 m/s it takes 2 (3)/(1 + 5/2) from the ball's velocity.
TEST_CASE("garwin 11: a superball that grips, and one that slips as routh has it",
          "[garwin][reference]") {
  const auto sim = simulate(parse_scene(thrown(0.8, "inf"), "test.toml"), garwin());
  REQUIRE(sim.result.status == RunStatus::completed);
  const Twist& twist = sim.result.state[1].twist;
  CHECK(std::abs(twist.linear.x() - 1.28571428571428571) <= 1e-15);
  CHECK(std::abs(twist.linear.y() - 3.2) <= 4e-15);
  CHECK(std::abs(0.25 * twist.angular.z() + 30.0 / 7.0) <= 4e-15);
  // Backwards along the surface as fast as it came.
  CHECK(std::abs(twist.linear.x() + 0.25 * twist.angular.z() + 3.0) <= 4e-15);
  tests::check_explained(sim.result.ledger);

  RunChoice routh;
  routh.method.impact = "routh";
  const Scene slides = parse_scene(thrown(0.8, "0.1"), "test.toml");
  CHECK(simulate(slides, garwin()).result.state[1].twist.linear ==
        simulate(slides, routh).result.state[1].twist.linear);
}

TEST_CASE("garwin: thrown under a table the ball comes back at 333/343 of its speed", "[garwin]") {
  const auto sim = simulate(read_scene(shipped_scene_path("superball")), garwin());
  REQUIRE(sim.result.status == RunStatus::completed);
  const Twist& twist = sim.result.state[2].twist;
  CHECK(std::abs(twist.linear.x() + 4.0 * 333.0 / 343.0) <= 1e-13);
  CHECK(sim.result.cost.impacts == 3);
  CHECK(sim.result.ledger.line(EnergyLine::restitution_loss) == 0.0);
  tests::check_explained(sim.result.ledger);
}

// What turns couples what happens along the normal and along the surface: there a tangential
// restitution apart from the normal one could create energy.
TEST_CASE("garwin: boxes keep momentum, and never gain energy", "[garwin]") {
  constexpr std::uint64_t seed = 20261123;
  CAPTURE(seed);
  Random random(seed);
  int hits = 0;
  for (int k = 0; k < 200; ++k) {
    CAPTURE(k);
    const double e = k % 3 == 0 ? 1.0 : random.uniform(0.0, 1.0);
    const auto vector = [&](double size) {
      return fmt::format("[{}, {}, {}]", random.uniform(-size, size), random.uniform(-size, size),
                         random.uniform(-size, size));
    };
    std::string text = "duration = 1.0\nframe = \"1/60\"\nG = 0.0\nfriction = inf\n";
    for (const char* const name : {"a", "b"}) {
      const bool first = name[0] == 'a';
      text += fmt::format(
          "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = [0.1, 0.2, 0.3]\nmass = {}\n"
          "restitution = {}\nposition = [{}, 0, 0]\nvelocity = [{}, 0, 0]\n"
          "angular_velocity = {}\naxis_angle = [{}, 0.3, 0.2, {}]\n",
          name, random.uniform(0.5, 2.0), e, first ? -1.0 : 1.0, first ? 2.0 : -1.0, vector(3.0),
          random.uniform(0.1, 1.0), random.uniform(0.0, 3.0));
    }
    const Scene scene = parse_scene(text, "test.toml");
    const auto sim = simulate(scene, garwin());
    REQUIRE(sim.result.status == RunStatus::completed);
    hits += sim.result.cost.impacts > 0 ? 1 : 0;
    CHECK(sim.result.ledger.line(EnergyLine::restitution_loss) <= 0.0);
    CHECK(sim.result.ledger.line(EnergyLine::impact_friction) <= 1e-15);
    tests::check_explained(sim.result.ledger);
    Vector3 before = Vector3::Zero();
    Vector3 after = Vector3::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
      before += scene.bodies[i].mass * scene.bodies[i].initial.twist.linear;
      after += scene.bodies[i].mass * sim.result.state[i].twist.linear;
    }
    CHECK((after - before).norm() <= 1e-14);
  }
  CHECK(hits > 150);
}
