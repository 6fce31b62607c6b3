#include "integrators/euler.hpp"

#include "integrators/closed_form.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace kairos::integrators::test {
namespace {

constexpr double G = 9.8;

Island ball() {
  return {.bodies = {0},
          .inertia = {{.mass = 1.0, .principal = Vector3::Zero(), .rotates = false}},
          .constant_force = {{0.0, -G, 0.0}},
          .forces = {}};
}

double energy(const BodyState& state) {
  return 0.5 * state.twist.linear.squaredNorm() + G * state.pose.position.y();
}

TEST_CASE("The thesis' Euler gains G^2 h^2 / 2 each frame but the first, within 1e-10, for 600 s") {
  // 13.4; the gain is relative to what is gained: roundoff of E = 50 J per frame is about 1e-14 of
  // it and adds up as a random walk.
  for (const double h : {1.0 / 60.0, 1.0 / 30.0, 1.0 / 240.0, 1.0 / 1000.0}) {
    const Island island = ball();
    std::vector<BodyState> states(1);
    states[0].pose.position.y() = 5.0;
    const double initial = energy(states[0]);
    const std::unique_ptr<Stepper> stepper = make_thesis_euler({});
    stepper->start(island, Instant{}, states);
    const int frames = static_cast<int>(std::lround(600.0 / h));
    int impacts = 0;
    for (int n = 0; n < frames; ++n) {
      stepper->step(island, Instant{}, h, states);
      if (states[0].pose.position.y() < 0.5 && states[0].twist.linear.y() < 0.0) {
        states[0].twist.linear.y() *= -1.0;  // a flip costs no energy
        stepper->restart(island, Instant{}, states);
        ++impacts;
      }
    }
    const double gain = energy(states[0]) - initial;
    const double predicted = (frames - 1) * G * G * h * h / 2.0;
    CAPTURE(h, frames, impacts, gain, predicted);
    CHECK(impacts > 50);
    CHECK(std::abs(gain - predicted) <= 1e-10 * (initial + predicted));
  }
}

TEST_CASE("The thesis' acceleration is zero in the first step, lags by one, and survives impacts") {
  Island island = ball();
  std::vector<BodyState> states(1);
  const std::unique_ptr<Stepper> stepper = make_thesis_euler({});
  stepper->start(island, Instant{}, states);
  stepper->step(island, Instant{}, 0.1, states);
  CHECK(states[0].twist.linear == Vector3::Zero());
  stepper->restart(island, Instant{}, states);
  island.constant_force[0] = Vector3(3.0, 0.0, 0.0);
  stepper->step(island, Instant{}, 0.1, states);
  CHECK(states[0].twist.linear == Vector3(0.0, -G * 0.1, 0.0));
  stepper->step(island, Instant{}, 0.1, states);
  CHECK(states[0].twist.linear == Vector3(3.0 * 0.1, -G * 0.1, 0.0));
}

TEST_CASE("Euler motions are straight lines whose velocity has a polynomial of its own") {
  const Island island = ball();
  std::vector<BodyState> states(1);
  states[0].twist.linear = {1.0, 2.0, 3.0};
  std::vector<Motion> motions(1);
  const std::unique_ptr<Stepper> stepper = make_explicit_euler({});
  stepper->start(island, Instant{}, states);
  stepper->step(island, Instant{}, 0.25, states);
  stepper->dense_output(motions);
  CHECK(motions[0].position.degree() == 1);
  CHECK(motions[0].position[1] == Vector3(1.0, 2.0, 3.0));
  CHECK(motions[0].velocity(0.25) == states[0].twist.linear);
  CHECK(motions[0].velocity[1] == Vector3(0.0, -G, 0.0));
}

TEST_CASE("The closed form keeps the energy of 1e6 bounces within 1e-12") {
  // Flight from the floor to the floor and a flip: the state at each landing is rounded once.
  const Island island = ball();
  std::vector<BodyState> states(1);
  states[0].twist.linear = {0.0, 9.8, 0.0};
  const double initial = energy(states[0]);
  const std::unique_ptr<Stepper> stepper = make_closed_form({});
  stepper->start(island, Instant{}, states);
  for (int k = 0; k < 1000000; ++k) {
    const double v = states[0].twist.linear.y();
    const double y = states[0].pose.position.y();
    const double flight = (v + std::sqrt(v * v + 2.0 * G * y)) / G;
    stepper->step(island, Instant{}, flight, states);
    states[0].twist.linear.y() *= -1.0;
  }
  CHECK(std::abs(energy(states[0]) / initial - 1.0) <= 1e-12);
}

TEST_CASE("The closed form takes a step without end") {
  const Island island = ball();
  std::vector<BodyState> states(1);
  states[0].twist.linear = {1.0, 2.0, 3.0};
  std::vector<Motion> motions(1);
  const std::unique_ptr<Stepper> stepper = make_closed_form({});
  stepper->start(island, Instant{}, states);
  const double forever = std::numeric_limits<double>::infinity();
  CHECK(stepper->step(island, Instant{}, forever, states).advanced == forever);
  CHECK(states[0].pose.position == Vector3::Zero());
  stepper->dense_output(motions);
  CHECK(motions[0].duration == forever);
  CHECK(motions[0].pose(2.0).position == Vector3(2.0, 4.0 - 2.0 * G, 6.0));
}

}  // namespace
}  // namespace kairos::integrators::test
