// What stops where friction presses it together the more the more it presses: Painleve's case.

#include "core/contacts/jam.hpp"

#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

namespace {

constexpr double length = 0.5;  // half of a rod, m

/// A rod that leans at `theta` over the floor, to +x of its lower end, which slides at u.
TurningState leaning(double theta, double mu, double u) {
  TurningState state;
  const Vector3 end(-length * std::cos(theta), -length * std::sin(theta), 0.0);
  const Vector3 middle = -end;
  state.bodies.push_back({});
  GroupBody rod;
  rod.inverse_mass = 1.0;
  rod.inverse_inertia = Matrix3::Identity() * (3.0 / (length * length));
  rod.position = middle;
  state.bodies.push_back(rod);
  BodyState moving;
  moving.pose.position = middle;
  moving.twist.linear = Vector3(u, 0.0, 0.0);
  state.states = {BodyState{}, moving};
  state.loads = {Twist{}, Twist{Vector3(0.0, -9.8, 0.0), Vector3::Zero()}};
  state.radius = {0.0, length};
  Touch touch;
  touch.a = 0;
  touch.b = 1;
  touch.on_a = {TouchFeature::Kind::plane, Vector3::Zero(), Vector3::UnitY(), 0.0};
  touch.on_b = {TouchFeature::Kind::ball, end, Vector3::Zero(), 0.0};
  touch.normal = Vector3::UnitY();
  touch.friction = mu;
  touch.rest_speed = 1e-5;
  state.touches.push_back(touch);
  return state;
}

double energy(const Twist& v) {
  return 0.5 * v.linear.squaredNorm() + v.angular.squaredNorm() * length * length / 6.0;
}

}  // namespace

// Of mu = 1.5 between .883862626373 and 1.27493630397 rad (reference problem 13).
TEST_CASE("jam: a rod that slides in Painleve's case is stopped by an impulse", "[jam]") {
  for (const double theta : {0.8839, 1.1, 1.2749}) {
    for (const double speed : {1.0, 1e-3}) {
      // Towards where it leans, or away: one of them jams.
      const auto one = jam(leaning(theta, 1.5, speed), 1e-9);
      const auto other = jam(leaning(theta, 1.5, -speed), 1e-9);
      CAPTURE(theta, speed);
      REQUIRE(one.has_value() != other.has_value());
      const auto& found = one ? one : other;
      const TurningState state = leaning(theta, 1.5, one ? speed : -speed);
      CHECK(found->tangential);
      CHECK(found->struck == std::vector<char>{1});
      const Twist& before = state.states[1].twist;
      const Twist& after = found->velocities[1];
      const Vector3 end = state.states[1].pose.position;
      CHECK(after.at(Vector3::Zero(), end).norm() <= 1e-13 * speed);
      CHECK(energy(after) < energy(before));
      // The impulse presses, and is within the cone.
      const Vector3 p = after.linear - before.linear;
      CHECK(p.y() > 0.0);
      CHECK(std::abs(p.x()) <= 1.5 * p.y());
    }
  }
}

TEST_CASE("jam: what slides otherwise is left alone", "[jam]") {
  for (const double u : {1.0, -1.0}) {
    CHECK_FALSE(jam(leaning(0.88, 1.5, u), 1e-9));
    CHECK_FALSE(jam(leaning(1.28, 1.5, u), 1e-9));
    CHECK_FALSE(jam(leaning(1.1, 1.3, u), 1e-9));
    CHECK_FALSE(jam(leaning(1.1, 0.0, u), 1e-9));
  }
}

TEST_CASE("jam: what approaches is stopped within the cone of its friction", "[jam]") {
  // It slides away from where it leans, and on: the impulse leans as far as friction allows.
  TurningState state = leaning(0.5, 0.2, 0.0);
  state.states[1].twist.linear = Vector3(1.0, -1e-3, 0.0);
  const auto found = jam(state, 1e-9);
  REQUIRE(found.has_value());
  CHECK_FALSE(found->tangential);
  const Twist& after = found->velocities[1];
  const Vector3 p = after.linear - state.states[1].twist.linear;
  CHECK(p.x() == Approx(-0.2 * p.y()).epsilon(1e-9));
  CHECK(std::abs(after.at(Vector3::Zero(), state.states[1].pose.position).y()) <= 1e-13);
  CHECK(energy(after) < energy(state.states[1].twist));
}
