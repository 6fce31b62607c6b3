// Contact that lasts of bodies that hang on each other by springs and dampers, in event-driven
// runs, against closed forms.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"
#include "tests/simulation/whole_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace kairos;

namespace {

constexpr double g = 9.8;

std::string head(double duration) {
  return fmt::format(
      "duration = {}\nframe = \"1/60\"\nG = {}\n[[body]]\nname = \"floor\"\nentity = \"wall\"\n"
      "shape = \"half-space\"\nrestitution = 0\nfriction = 1\n",
      duration, g);
}

/// A cube with sides of 0.2 m.
std::string cube(const std::string& name, double mass, double x, double y, double mu) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = [0.1, 0.1, 0.1]\nmass = {}\n"
      "position = [{}, {}, 0]\nfriction = {}\nrestitution = 0\n",
      name, mass, x, y, mu);
}

std::string spring(double stiffness, double length, double damping = 0.0) {
  return fmt::format(
      "[[force]]\nkind = \"spring\"\nbodies = [\"one\", \"other\"]\nstiffness = {}\n"
      "rest_length = {}\ndamping = {}\n",
      stiffness, length, damping);
}

Simulation run(const std::string& text) {
  const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
  tests::check_whole(sim, text);
  return sim;
}

}  // namespace

TEST_CASE("springs in touch: two cubes swing on a smooth floor", "[turning][springs]") {
  const double k = 40.0;
  const double m1 = 1.0;
  const double m2 = 3.0;
  const double end = 1.3;
  const std::string text = head(end) + cube("one", m1, 0.0, 0.1, 0.0) +
                           cube("other", m2, 0.6, 0.1, 0.0) + spring(k, 0.5);
  const Simulation sim = run(text);
  const double w = std::sqrt(k * (m1 + m2) / (m1 * m2));
  const double apart = 0.5 + 0.1 * std::cos(w * end);
  const double middle = 0.6 * m2 / (m1 + m2);
  CHECK(sim.result.state[1].pose.position.x() ==
        Approx(middle - apart * m2 / (m1 + m2)).epsilon(0.0).margin(1e-9));
  CHECK(sim.result.state[2].pose.position.x() ==
        Approx(middle + apart * m1 / (m1 + m2)).epsilon(0.0).margin(1e-9));
  CHECK(tests::of_kind(sim.trajectory, EventKind::contact_ends).empty());
}

TEST_CASE("springs in touch: a damper takes what is told", "[turning][springs]") {
  const double k = 40.0;
  const double c = 1.2;
  const double end = 1.3;
  const std::string text = head(end) + cube("one", 2.0, 0.0, 0.1, 0.0) +
                           cube("other", 2.0, 0.6, 0.1, 0.0) + spring(k, 0.5, c);
  const Simulation sim = run(text);
  const double decay = c / 2.0;  // of both: c / (2 m) with the reduced mass, 1 kg
  const double w = std::sqrt(k - decay * decay);
  const double apart =
      0.5 + 0.1 * std::exp(-decay * end) * (std::cos(w * end) + decay / w * std::sin(w * end));
  CHECK(sim.result.state[2].pose.position.x() - sim.result.state[1].pose.position.x() ==
        Approx(apart).epsilon(0.0).margin(1e-9));
  const EnergyLedger& ledger = sim.result.ledger;
  CHECK(ledger.line(EnergyLine::field_work) ==
        Approx(ledger.energy() - ledger.initial_energy()).epsilon(0.0).margin(1e-9));
}

TEST_CASE("springs in touch: a cube leaves the floor when its spring draws more than it weighs",
          "[turning][springs]") {
  // The upper one is let go where the spring is pressed by three times what it carries at rest.
  const double k = 200.0;
  const double m1 = 0.8;
  const double m2 = 1.0;
  const double length = 0.6;
  const double rests = length - m2 * g / k;
  const double pressed = 3.0 * m2 * g / k;  // below that
  const double w = std::sqrt(k / m2);
  // Up it goes as rests - pressed cos(w t); the spring draws m1 g where it is longer by m1 g / k.
  const double leaves = std::acos(-(m1 + m2) * g / k / pressed) / w;
  const std::string text = head(leaves + 0.02) + cube("one", m1, 0.0, 0.1, 0.0) +
                           cube("other", m2, 0.0, 0.1 + rests - pressed, 0.0) + spring(k, length);
  const Simulation sim = run(text);
  const auto ends = tests::of_kind(sim.trajectory, EventKind::contact_ends);
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].time.seconds == Approx(leaves).epsilon(0.0).margin(1e-9));
  CHECK(sim.result.state[1].pose.position.y() > 0.1 + 1e-6);
}

TEST_CASE("springs in touch: a cube swings on a rough floor until friction holds it",
          "[turning][springs][friction]") {
  // Half swings, each shorter by twice what friction holds; the other end is too heavy to slide.
  const std::string text = head(1.5) + cube("one", 50.0, 0.0, 0.1, 1.0) +
                           cube("other", 1.0, 0.7, 0.1, 0.04) + spring(100.0, 0.6);
  const Simulation sim = run(text);
  CHECK(sim.result.state[2].pose.position.x() ==
        Approx(0.6 + 0.0176 - 0.0).epsilon(0.0).margin(1e-8));
  CHECK(std::abs(sim.result.state[1].pose.position.x()) < 1e-10);
  double last = 0.0;
  for (const Event& event : tests::of_kind(sim.trajectory, EventKind::stick_begins)) {
    last = std::max(last, event.time.seconds);
  }
  CHECK(last == Approx(0.3 * M_PI).epsilon(0.0).margin(1e-6));
  CHECK(sim.result.ledger.line(EnergyLine::friction) ==
        Approx(-0.5 * 100.0 * (0.01 - 0.0176 * 0.0176)).epsilon(0.0).margin(1e-8));
}
