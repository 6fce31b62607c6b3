// Contact that lasts of bodies that hang on joints, in event-driven runs: joints and contacts are
// solved for together.

#include "core/joint_system.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/penetration.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace kairos;

namespace {

constexpr double g = 9.8;
constexpr double r = 0.05;

std::string head(double duration) {
  return fmt::format(
      "duration = {}\nframe = \"1/60\"\nG = {}\n"
      "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\nrestitution = 0\n",
      duration, g);
}

std::string ball(const std::string& name, const Vector3& x, const Vector3& v) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"ball\"\nradius = {}\nmass = 1.0\nrestitution = 0\n"
      "position = [{}, {}, {}]\nvelocity = [{}, {}, {}]\n",
      name, r, x.x(), x.y(), x.z(), v.x(), v.y(), v.z());
}

std::string box(const std::string& name, const Vector3& x, double e) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = [0.2, 0.05, 0.05]\nmass = 1.0\n"
      "restitution = {}\nposition = [{}, {}, {}]\n",
      name, e, x.x(), x.y(), x.z());
}

Simulation run(const std::string& text) { return simulate(parse_scene(text, "test.toml"), {}); }

/// It ends, the ledger closes, and in no frame do bodies overlap or joints open.
void check_whole(const Simulation& sim, const std::string& text) {
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  const Model model(parse_scene(text, "test.toml"));
  const PenetrationProbe probe(model);
  double open = 0.0;
  std::vector<BodyState> states;
  for (std::size_t k = 0; k < sim.trajectory.frame_times().size(); ++k) {
    CHECK_FALSE(probe.first(sim.trajectory.frame_state(k)));
    for (const Island& island : model.islands()) {
      if (island.joints == nullptr) {
        continue;
      }
      states.clear();
      for (const BodyIndex i : island.bodies) {
        states.push_back(sim.trajectory.frame_state(k)[i]);
      }
      open = std::max(open, island.joints->residual(sim.trajectory.frame_times()[k], states));
    }
  }
  // Frames are within steps, whose own error is some 1e-12.
  CHECK(open < 1e-10);
  // What is left of motion is truncation of steps: a small part of all that flowed.
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::truncation)) < 1e-9 * sim.result.ledger.flow());
}

}  // namespace

TEST_CASE("jointed contact: two balls on a rod turn on the floor", "[turning][joints]") {
  const double omega = 3.0;
  const Vector3 drift(0.4, 0.0, -0.1);
  const Vector3 half(0.25, 0.0, 0.0);
  const Vector3 spins(0.0, 0.0, -omega * 0.25);
  const Vector3 middle(0.0, r, 0.0);
  const std::string text = head(2.0) + ball("near", middle - half, drift - spins) +
                           ball("far", middle + half, drift + spins) +
                           "[[joint]]\nkind = \"rod\"\nbodies = [\"near\", \"far\"]\n";
  const Simulation sim = run(text);
  check_whole(sim, text);
  const Vector3 arm = 0.25 * Vector3(std::cos(2.0 * omega), 0.0, -std::sin(2.0 * omega));
  CHECK((sim.result.state[1].pose.position - (middle + 2.0 * drift - arm)).norm() < 1e-9);
  CHECK((sim.result.state[2].pose.position - (middle + 2.0 * drift + arm)).norm() < 1e-9);
}

TEST_CASE("jointed contact: a ladder of two balls leaves its wall at 2/3 of its height",
          "[turning][joints]") {
  const double high = std::sqrt(0.75);  // the sine of 60 degrees; the rod is 1 m long
  const double speed = std::sqrt(2.0 * g * high / 3.0);  // of its angle, where it leaves the wall
  // The angle turns as sqrt(2 g (high - sin)): with s^2 = high - sin the time is an integral of
  // ds / cos, of which nothing is singular.
  double integral = 0.0;
  const int n = 2000;
  const double ds = std::sqrt(high / 3.0) / n;
  for (int k = 0; k <= n; ++k) {
    const double sine = high - k * ds * (k * ds);
    integral += (k == 0 || k == n ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) / std::sqrt(1.0 - sine * sine);
  }
  const double leaves = std::sqrt(2.0 / g) * integral * ds / 3.0;
  const std::string text =
      head(leaves + 0.05) +
      "[[body]]\nname = \"wall\"\nentity = \"wall\"\nshape = \"half-space\"\nrestitution = 0\n"
      "normal = [1, 0, 0]\n" +
      ball("high", {r, r + high, 0.0}, Vector3::Zero()) +
      ball("low", {r + 0.5, r, 0.0}, Vector3::Zero()) +
      "[[joint]]\nkind = \"rod\"\nbodies = [\"high\", \"low\"]\n";
  const Simulation sim = run(text);
  check_whole(sim, text);
  const auto ends = tests::of_kind(sim.trajectory, EventKind::contact_ends);
  REQUIRE(ends.size() == 1);
  // A force that vanishes is found with the square of what it turns with: forces are off by 1e-11.
  CHECK(ends[0].time.seconds == Approx(leaves).margin(1e-9));
  const BodyState& left = sim.result.state[2];
  const BodyState& right = sim.result.state[3];
  // Nothing pushes the two along the floor any more.
  CHECK(left.twist.linear.x() + right.twist.linear.x() ==
        Approx(2.0 / 3.0 * high * speed).margin(1e-9));
  CHECK(left.pose.position.x() > r);
}

TEST_CASE("jointed contact: bars on hinges come down on the floor and slide out",
          "[turning][joints]") {
  for (const double e : {0.0, 0.3}) {
    CAPTURE(e);
    const std::string text =
        head(2.0) + box("upper", {0.2, 0.55, 0.0}, e) + box("lower", {0.6, 0.55, 0.0}, e) +
        "[[joint]]\nkind = \"hinge\"\nbodies = [\"upper\"]\nanchor = [0, 0.55, 0]\n"
        "axis = [0, 0, 1]\n"
        "[[joint]]\nkind = \"hinge\"\nbodies = [\"upper\", \"lower\"]\nanchor = [0.4, 0.55, 0]\n"
        "axis = [0, 0, 1]\n";
    const Simulation sim = run(text);
    check_whole(sim, text);
    CHECK_FALSE(tests::of_kind(sim.trajectory, EventKind::contact_begins).empty());
  }
}

TEST_CASE("jointed contact: a bar on a hinge falls on a box and pushes it away",
          "[turning][joints]") {
  const std::string text =
      head(1.0) +
      "[[body]]\nname = \"crate\"\nentity = \"body\"\nhalf_extents = [0.1, 0.1, 0.1]\nmass = 2.0\n"
      "restitution = 0\nposition = [0.45, 0.1, 0]\n" +
      box("bar", {0.2, 0.42, 0.0}, 0.0) +
      "[[joint]]\nkind = \"hinge\"\nbodies = [\"bar\"]\nanchor = [0, 0.42, 0]\n"
      "axis = [0, 0, 1]\n";
  const Simulation sim = run(text);
  check_whole(sim, text);
  CHECK(sim.result.state[1].twist.linear.x() >= 0.0);
}
