// What an implicit step says of what touches where it is cut off before its end.

#include "core/contacts/implicit_mode.hpp"
#include "core/contacts/turning_step.hpp"
#include "integrators/runge_kutta_4.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

namespace {

using Does = FrictionChoice::Does;
constexpr double g = 9.8;
constexpr double mu = 0.3;
constexpr double h = 1e-3;
constexpr double gap = 1e-9;

/// A block of 2 kg on the corners of a floor that ends along x where the block is after `until`.
TurningGroup block(double speed, double until) {
  const Vector3 half(0.1, 0.2, 0.1);
  TurningGroup group;
  group.inertia = {{},
                   {.mass = 2.0,
                    .principal = Vector3(0.05, 0.02, 0.05) * (2.0 / 1.5),
                    .rotates = true,
                    .bounding_radius = half.norm()}};
  group.bodies = {0, 1};
  group.constant_force = {Vector3::Zero(), Vector3(0.0, -2.0 * g, 0.0)};
  group.forces.resize(2);
  group.start.radius = {0.0, half.norm()};
  BodyState moving;
  moving.pose.position = {0.0, half.y() + gap, 0.0};
  moving.twist.linear = {speed, 0.0, 0.0};
  group.start.states = {{}, moving};
  TurningPair pair;
  pair.b = 1;
  pair.nearest = gap;
  for (const double x : {-0.1, 0.1}) {
    for (const double z : {-0.1, 0.1}) {
      Touch touch;
      touch.b = 1;
      touch.on_a = {TouchFeature::Kind::plane, Vector3::Zero(), Vector3::UnitY(), 0.0};
      touch.on_b = {TouchFeature::Kind::ball, Vector3(x, -half.y(), z), Vector3::Zero(), 0.0};
      touch.normal = Vector3::UnitY();
      touch.friction = mu;
      touch.gap = gap;
      group.start.touches.push_back(touch);
      pair.planes_a = {touch.on_a};
      pair.corners_b.push_back(touch.on_b);
      group.rims.push_back({{.sides = {{Vector3::UnitX(), x + until}}, .of_a = true}});
    }
  }
  group.pairs = {pair};
  const std::vector<BodyState> free{moving};
  group.start = turning_state(group, Instant{}, free);
  return group;
}

}  // namespace

// A block would stop at the end of the step, u/h being what friction does. It comes to an edge
// before: there it still slides, and what follows has to say so, for it stops later, untold.
TEST_CASE("implicit step: what is to stop at its end slides where it is cut off before",
          "[implicit]") {
  const double u = 0.9 * mu * g * h;
  const bool cut = GENERATE(true, false);
  CAPTURE(cut);
  const TurningGroup group = block(u, cut ? 0.3 * u * h : 1.0);
  const TurningMode mode = implicit_mode(group.start, h, {});
  REQUIRE(mode.refusal.empty());
  REQUIRE(mode.choices.front().does == Does::sticks);
  const auto stepper = integrators::make_rk4({});
  const TurningStep step = turning_step(group, mode, *stepper, Instant{}, h);
  REQUIRE(step.refusal.empty());
  REQUIRE(step.end == (cut ? TurningEnd::rim : TurningEnd::step));
  REQUIRE(step.choices.size() == 4);
  for (const FrictionChoice& c : step.choices) {
    CHECK(c.does == (cut ? Does::slides : Does::sticks));
  }
  // It slows down evenly, u (1 - t/h), and is 0.3 u h on its way at t = h (1 - sqrt(0.4)).
  const double left = cut ? std::sqrt(0.4) * u : 0.0;
  CHECK(step.states[1].twist.linear.x() == Approx(left).margin(1e-9 * u));
}
