// What lies on a table that is driven across its face: it goes with it as long as that presses.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace kairos;

namespace {

constexpr double g = 9.8;
constexpr double half = 0.1;

std::string block() { return fmt::format("half_extents = [{0}, {0}, {0}]\n", half); }
std::string ball() { return fmt::format("shape = \"sphere\"\nradius = {}\n", half); }

/// A table that moves as amplitude sin(w t), and a body that lies on it and moves as it does.
std::string scene(double duration, const Vector3& amplitude, double w, const std::string& shape,
                  double mu) {
  const Vector3 v = w * amplitude;
  return fmt::format(
      "duration = {}\nframe = {}\nG = {}\nfriction = {}\n"
      "[[body]]\nname = \"table\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = [0, 1, 0]\n"
      "[body.drive]\namplitude = [{}, {}, 0]\nfrequency = {:.17g}\n"
      "[[body]]\nname = \"load\"\nentity = \"body\"\n{}mass = 1.0\nrestitution = 0.0\n"
      "position = [0, {}, 0]\nvelocity = [{:.17g}, {:.17g}, 0]\n",
      duration, duration / 64.0, g, mu, amplitude.x(), amplitude.y(), w / (2.0 * M_PI), shape, half,
      v.x(), v.y());
}

const Event* first(const Simulation& sim, EventKind kind) {
  for (const Event& event : sim.trajectory.events()) {
    if (event.kind == kind) {
      return &event;
    }
  }
  return nullptr;
}

/// When what left the table at t0 is back on it, s: Newton's method in long double.
double back_on_it(double amplitude, double w, double t0) {
  const long double a = amplitude;
  long double t = t0 + 0.25L;
  for (int i = 0; i < 60; ++i) {
    const long double s = t - t0;
    const long double flight = a * std::sin(w * static_cast<long double>(t0)) +
                               a * w * std::cos(w * static_cast<long double>(t0)) * s -
                               0.5L * g * s * s;
    const long double rate =
        a * w * std::cos(w * static_cast<long double>(t0)) - g * s - a * w * std::cos(w * t);
    t -= (flight - a * std::sin(w * t)) / rate;
  }
  return static_cast<double>(t);
}

}  // namespace

TEST_CASE("a table that shakes: what lies on it leaves when the table falls faster, and lands") {
  const double amplitude = 0.05;
  const double w = 6.0 * M_PI;
  for (const std::string& shape : {ball(), block()}) {
    CAPTURE(shape);
    const std::string text = scene(5.0, {0, amplitude, 0}, w, shape, 0.0);
    const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
    INFO(sim.result.reason);
    REQUIRE(sim.result.status == RunStatus::completed);
    tests::check_explained(sim.result.ledger);
    const double leaves = std::asin(g / (amplitude * w * w)) / w;
    const Event* left = first(sim, EventKind::contact_ends);
    REQUIRE(left != nullptr);
    // The drive is a Taylor series of relative error 1e-14, whose second derivative decides.
    CHECK(std::abs(left->time.seconds - leaves) <= 1e-12);
    const Event* landed = first(sim, EventKind::impact);
    REQUIRE(landed != nullptr);
    CHECK(std::abs(landed->time.seconds - back_on_it(amplitude, w, leaves)) <= 1e-12);
    CHECK(sim.result.cost.impacts == 15);  // one a period
  }
}

TEST_CASE("a table that shakes: what rides on it for long does not sink in") {
  for (const std::string& shape : {ball(), block()}) {
    CAPTURE(shape);
    const std::string text = scene(300.0, {0, 0.05, 0}, 5.56, shape, 0.0);
    const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
    INFO(sim.result.reason);
    REQUIRE(sim.result.status == RunStatus::completed);
    tests::check_explained(sim.result.ledger);
    // 8,500 pieces of the drive, cut short by up to 1e-15 m each.
    for (std::size_t k = 0; k < sim.trajectory.frame_times().size(); ++k) {
      const auto& bodies = sim.trajectory.frame_state(k);
      const double gap = bodies[1].pose.position.y() - half - bodies[0].pose.position.y();
      CHECK(gap >= -1e-16);  // roundoff of what it is a difference of
      CHECK(gap <= 1e-13);
    }
  }
}

TEST_CASE("a table that shakes aslant: a block sticks while friction of what presses holds it") {
  const double mu = 0.3;
  const double w = 10.0;
  const Vector3 amplitude(0.04, 0.02, 0.0);
  const Simulation sim =
      simulate(parse_scene(scene(1.0, amplitude, w, block(), mu), "test.toml"), {});
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  // a w^2 sin = mu (g - b w^2 sin)
  const double slips = std::asin(mu * g / (w * w * (amplitude.x() + mu * amplitude.y()))) / w;
  const Event* const begins = first(sim, EventKind::slip_begins);
  REQUIRE(begins != nullptr);
  CHECK(std::abs(begins->time.seconds - slips) <= 1e-12);
  // The table brakes, and friction of what presses brakes the block less.
  const auto slid = [&](double t) {
    const double v = w * amplitude.x() * std::cos(w * slips);
    const double s = t - slips;
    return amplitude.x() * std::sin(w * slips) + v * s -
           mu * (0.5 * g * s * s + amplitude.y() * (std::sin(w * t) - std::sin(w * slips) -
                                                    w * std::cos(w * slips) * s));
  };
  for (const double s : {0.01, 0.05, 0.1, 0.2}) {
    CAPTURE(s);
    const BodyState load = sim.trajectory.at(1, Instant{} + (slips + s));
    CHECK(std::abs(load.pose.position.x() - slid(slips + s)) <= 1e-9);
    CHECK(load.twist.angular.norm() <= 1e-12);
  }
}

// It is thrown off, and lands where the table falls away faster than it would: it leaves at once.
// Blocks that came to rest there were settled at that instant without end.
TEST_CASE("what lands on a table that falls away faster goes on with its velocity", "[driven]") {
  const double amplitude = 0.1;
  const double w = 6.0 * M_PI;
  const double end = 0.6;
  const std::string plate = "half_extents = [1, 0.1, 1]\nposition = [0, -0.1, 0]\n";
  for (const std::string& shape : {block(), ball()}) {
    CAPTURE(shape);
    std::string text = scene(end, {0.0, amplitude, 0.0}, w, shape, 0.0);
    const std::string plane = "shape = \"half-space\"\nnormal = [0, 1, 0]\n";
    text.replace(text.find(plane), plane.size(), plate);
    const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
    INFO(sim.result.reason);
    REQUIRE(sim.result.status == RunStatus::completed);
    const Event* const lands = first(sim, EventKind::impact);
    REQUIRE(lands != nullptr);
    const double t = lands->time.seconds;
    REQUIRE(amplitude * w * w * std::sin(w * t) > g);
    const double flight = end - t;
    const double height = half + amplitude * (std::sin(w * t) + w * std::cos(w * t) * flight) -
                          0.5 * g * flight * flight;
    const BodyState load = sim.trajectory.at(1, Instant{} + end);
    // Impacts are located to 1e-9 of the extent; what has a speed of w A goes that far.
    CHECK(std::abs(load.pose.position.y() - height) <= 1e-8);
    tests::check_explained(sim.result.ledger);
  }
}
