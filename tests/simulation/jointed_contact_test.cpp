// Contact that lasts of bodies that hang on joints, in event-driven runs: joints and contacts are
// solved for together.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"
#include "tests/simulation/whole_run.hpp"

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
  tests::check_whole(sim, text);
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
  tests::check_whole(sim, text);
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
    tests::check_whole(sim, text);
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
  tests::check_whole(sim, text);
  CHECK(sim.result.state[1].twist.linear.x() >= 0.0);
}

namespace {

constexpr double swing = 0.2;      // m
constexpr double frequency = 0.8;  // Hz
const double w = 2.0 * M_PI * frequency;

/// What swings along x about (0, y, 0) and does not touch anything.
std::string driver(double y, double phase) {
  return fmt::format(
      "[[body]]\nname = \"driver\"\nentity = \"bat\"\nhalf_extents = [0.05, 0.05, 0.05]\nmass = 1\n"
      "position = [0, {}, 0]\n"
      "drive = {{amplitude = [{}, 0, 0], frequency = {}, phase = {}}}\n",
      y, swing, frequency, phase);
}

std::string cube(const std::string& name, double x, double y, double half, double mass, double v) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = [{}, {}, {}]\nmass = {}\n"
      "position = [{}, {}, 0]\nvelocity = [{}, 0, 0]\nrestitution = 0\n",
      name, half, half, half, mass, x, y, v);
}

std::string joint(const std::string& kind, const std::string& body, double y) {
  return fmt::format("[[joint]]\nkind = \"{}\"\nbodies = [\"driver\", \"{}\"]\n", kind, body) +
         (kind == "weld" ? std::string() : fmt::format("anchor = [0, {}, 0]\n", y)) +
         (kind == "slider"  ? "axis = [0, 1, 0]\n"
          : kind == "hinge" ? "axis = [0, 0, 1]\n"
                            : "");
}

/// What the lines say that gave or took energy, but for `driven_work`.
double gain_beside_driver(const EnergyLedger& ledger) {
  return ledger.energy() - ledger.initial_energy() - ledger.line(EnergyLine::driven_work);
}

}  // namespace

TEST_CASE("jointed contact: what hangs from a driven slider rests on the floor",
          "[turning][joints]") {
  const double end = 1.1;
  const std::string text = head(end) + driver(1.0, 0.0) +
                           cube("block", 0.0, 0.1, 0.1, 2.0, swing * w) +
                           joint("slider", "block", 0.1);
  const Simulation sim = run(text);
  tests::check_whole(sim, text);
  const BodyState& block = sim.result.state[2];
  CHECK(block.pose.position.x() == Approx(swing * std::sin(w * end)).margin(1e-9));
  CHECK(block.twist.linear.x() == Approx(swing * w * std::cos(w * end)).margin(1e-9));
  CHECK(tests::of_kind(sim.trajectory, EventKind::contact_ends).empty());
  const double gained = swing * w * swing * w * (std::pow(std::cos(w * end), 2) - 1.0);
  CHECK(sim.result.ledger.line(EnergyLine::driven_work) == Approx(gained).margin(1e-8));
}

TEST_CASE("jointed contact: what is welded to a driver pushes a box until it is fastest",
          "[turning][joints]") {
  const double leaves = 0.25 / frequency;
  const double end = leaves + 0.1;
  const std::string text =
      head(end) + driver(0.5, -0.5 * M_PI) + cube("pusher", -swing, 0.11, 0.1, 2.0, 0.0) +
      cube("box", -swing + 0.2, 0.1, 0.1, 3.0, 0.0) + joint("weld", "pusher", 0.0);
  const Simulation sim = run(text);
  tests::check_whole(sim, text);
  bool parted = false;
  for (const Event& event : tests::of_kind(sim.trajectory, EventKind::contact_ends)) {
    if (std::max(event.a, event.b) == 3) {
      parted = true;
      // The force vanishes as time to the end: what it is off by is what the time is off by.
      CHECK(event.time.seconds == Approx(leaves).margin(1e-8));
    }
  }
  CHECK(parted);
  const double fastest = swing * w;
  CHECK(sim.result.state[3].twist.linear.x() == Approx(fastest).margin(1e-9));
  const double slower = fastest * std::cos(w * (end - leaves));
  const EnergyLedger& ledger = sim.result.ledger;
  CHECK(ledger.line(EnergyLine::driven_work) ==
        Approx(0.5 * 3.0 * fastest * fastest + 0.5 * 2.0 * slower * slower).margin(1e-8));
  CHECK(std::abs(gain_beside_driver(ledger)) < 1e-8);
}

TEST_CASE("jointed contact: an impact on what a driver pushes is passed on to the driver",
          "[turning][joints]") {
  for (const std::string impact : {"newton", "moreau", "reflections"}) {
    CAPTURE(impact);
    const double meets = 0.15;
    const double there = -swing * std::cos(w * meets);
    const double speed = swing * w * std::sin(w * meets);
    const std::string text =
        head(0.2) + driver(0.5, -0.5 * M_PI) + cube("pusher", -swing, 0.11, 0.1, 2.0, 0.0) +
        cube("box", -swing + 0.2, 0.1, 0.1, 3.0, 0.0) +
        fmt::format(
            "[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = 0.05\nmass = 1\n"
            "restitution = 0\nposition = [{}, 0.1, 0]\nvelocity = [-1.5, {}, 0]\n",
            there + 0.35 + 1.5 * meets, 0.5 * g * meets) +
        joint("weld", "pusher", 0.0);
    RunChoice choice;
    choice.method.impact = impact;
    const Simulation sim = simulate(parse_scene(text, "test.toml"), choice);
    tests::check_whole(sim, text);
    const auto impacts = tests::of_kind(sim.trajectory, EventKind::impact);
    REQUIRE_FALSE(impacts.empty());
    CHECK(impacts[0].time.seconds == Approx(meets).margin(1e-9));
    // What nothing rebounds from goes on as it did: the driver takes all of the ball's momentum.
    CHECK(impacts[0].after_b.twist.linear.x() == Approx(speed).margin(1e-9));
    const EnergyLedger& ledger = sim.result.ledger;
    const double closing = 1.5 + speed;
    CHECK(ledger.line(EnergyLine::restitution_loss) ==
          Approx(-0.5 * closing * closing).margin(1e-8));
    CHECK(std::abs(gain_beside_driver(ledger) - ledger.line(EnergyLine::restitution_loss)) < 1e-8);
  }
}

TEST_CASE("jointed contact: a bar on a driven hinge comes to rest on the floor and is drawn along",
          "[turning][joints]") {
  for (const double e : {0.0, 0.4}) {
    CAPTURE(e);
    const std::string text =
        head(2.0) + driver(0.4, 0.0) +
        fmt::format(
            "[[body]]\nname = \"bar\"\nentity = \"body\"\nhalf_extents = [0.3, 0.04, 0.05]\n"
            "mass = 1\nrestitution = {}\nposition = [0.3, 0.4, 0]\nvelocity = [{}, 0, 0]\n",
            e, swing * w) +
        joint("hinge", "bar", 0.4);
    const Simulation sim = run(text);
    tests::check_whole(sim, text);
    CHECK_FALSE(tests::of_kind(sim.trajectory, EventKind::contact_begins).empty());
    CHECK(std::abs(sim.result.ledger.line(EnergyLine::driven_work)) > 1e-3);
  }
}
