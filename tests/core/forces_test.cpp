#include "core/error.hpp"
#include "core/forces/buoyancy.hpp"
#include "core/forces/drag.hpp"
#include "core/forces/magnus.hpp"
#include "core/forces/spring.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

namespace kairos {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

BodyState turned_body() {
  BodyState state;
  state.pose.position = {0.3, -0.2, 0.9};
  state.pose.orientation = Quaternion(0.5, 0.5, -0.5, 0.5);
  state.twist.linear = {1.0, -2.0, 0.5};
  state.twist.angular = {0.2, 3.0, -1.0};
  return state;
}

std::vector<Wrench> wrenches(const Force& force, const std::vector<BodyState>& bodies) {
  std::vector<Wrench> result(bodies.size());
  force.add(Instant{}, bodies, result);
  return result;
}

/// Power of a force, W: what its potential must lose per second.
double power(const std::vector<Wrench>& forces, const std::vector<BodyState>& bodies) {
  double sum = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    sum +=
        forces[i].force.dot(bodies[i].twist.linear) + forces[i].torque.dot(bodies[i].twist.angular);
  }
  return sum;
}

BodyState moved(const BodyState& body, double dt) {
  BodyState result = body;
  result.pose.position += dt * body.twist.linear;
  result.pose.orientation = rotate(dt * body.twist.angular, body.pose.orientation);
  return result;
}

/// A conservative force's power is what its potential loses along the motion of its bodies, by
/// central differences: O(dt^2) + eps/dt with dt = 1e-5, of energies near 10 J.
void check_potential(const Force& force, const std::vector<BodyState>& bodies) {
  REQUIRE(force.conservative());
  const double dt = 1e-5;
  std::vector<BodyState> later, earlier;
  for (const BodyState& body : bodies) {
    later.push_back(moved(body, dt));
    earlier.push_back(moved(body, -dt));
  }
  const double loss =
      -(force.potential(Instant{}, later) - force.potential(Instant{}, earlier)) / (2.0 * dt);
  CHECK(std::abs(loss - power(wrenches(force, bodies), bodies)) <= 1e-8);
}

TEST_CASE("Quadratic drag opposes the velocity against the wind, growing with its square") {
  const QuadraticDrag drag(
      {.density = 1.2, .drag_coefficient = 0.45, .area = 0.01, .wind = {1.0, 0.0, 0.0}});
  BodyState body = turned_body();
  const Vector3 u = body.twist.linear - Vector3(1.0, 0.0, 0.0);
  const Vector3 force = wrenches(drag, {body})[0].force;
  CHECK((force + 0.5 * 1.2 * 0.45 * 0.01 * u.norm() * u).norm() <= 8.0 * eps * force.norm());
  body.twist.linear = Vector3(1.0, 0.0, 0.0) + 3.0 * u;
  CHECK((wrenches(drag, {body})[0].force - 9.0 * force).norm() <= 64.0 * eps * force.norm());
  CHECK(!drag.conservative());
  CHECK(drag.potential(Instant{}, std::vector<BodyState>{body}) == 0.0);
}

TEST_CASE("Linear drag opposes velocity and spin") {
  const LinearDrag drag({.coefficient = 0.3, .rotational = 0.02, .wind = Vector3::Zero()});
  const BodyState body = turned_body();
  const Wrench wrench = wrenches(drag, {body})[0];
  CHECK(wrench.force == -0.3 * body.twist.linear);
  CHECK(wrench.torque == -0.02 * body.twist.angular);
}

TEST_CASE("Magnus lift is perpendicular to motion and spin: backspin lifts") {
  const MagnusLift lift(
      {.density = 1.2, .lift_coefficient = 0.8, .radius = 0.02, .wind = Vector3::Zero()});
  BodyState body;
  body.twist.linear = {10.0, 0.0, 0.0};
  body.twist.angular = {0.0, 0.0, 300.0};  // the top of the ball moves backwards
  const Vector3 force = wrenches(lift, {body})[0].force;
  const double expected = 0.5 * 1.2 * 0.8 * std::numbers::pi * std::pow(0.02, 3) * 300.0 * 10.0;
  CHECK((force - Vector3(0.0, expected, 0.0)).norm() <= 8.0 * eps * expected);
  CHECK(force.dot(body.twist.linear) == 0.0);
}

TEST_CASE(
    "Buoyancy lifts, rights a body whose centre of volume is off its origin, and has a "
    "potential") {
  const Buoyancy buoyancy({.density = 1000.0,
                           .volume = 1e-3,
                           .gravity = {0.0, -9.81, 0.0},
                           .centre_B = {0.0, 0.05, 0.1}});
  const BodyState body = turned_body();
  CHECK((wrenches(buoyancy, {body})[0].force - Vector3(0.0, 9.81, 0.0)).norm() <= 8.0 * eps * 9.81);
  check_potential(buoyancy, {body});
}

TEST_CASE("A spring between points of two bodies obeys Newton's third law and has a potential") {
  const Spring spring({.stiffness = 7.0,
                       .damping = 0.0,
                       .rest_length = 0.4,
                       .point_A = {0.1, 0.2, 0.0},
                       .point_B = {-0.3, 0.0, 0.1},
                       .anchor_W = Vector3::Zero()});
  std::vector<BodyState> bodies{turned_body(), {}};
  bodies[1].pose.position = {-1.0, 0.4, 0.2};
  bodies[1].twist.angular = {1.0, 0.5, -0.3};
  const std::vector<Wrench> result = wrenches(spring, bodies);
  CHECK((result[0].force + result[1].force).norm() == 0.0);
  Vector3 moment = Vector3::Zero();  // no torque on the pair
  for (std::size_t i = 0; i < 2; ++i) {
    moment += result[i].torque + bodies[i].pose.position.cross(result[i].force);
  }
  CHECK(moment.norm() <= 64.0 * eps * result[0].force.norm());
  check_potential(spring, bodies);
}

TEST_CASE("A spring to an anchor pulls back; its damper only takes energy") {
  const Spring free_length({.stiffness = 4.0,
                            .damping = 0.0,
                            .rest_length = 0.0,
                            .point_A = Vector3::Zero(),
                            .point_B = Vector3::Zero(),
                            .anchor_W = {1.0, 0.0, 0.0}});
  BodyState body = turned_body();
  CHECK(wrenches(free_length, {body})[0].force == -4.0 * (body.pose.position - Vector3(1, 0, 0)));
  check_potential(free_length, {body});
  body.pose.position = {1.0, 0.0, 0.0};  // both ends in one point
  CHECK(wrenches(free_length, {body})[0].force == Vector3::Zero());

  const Spring damper({.stiffness = 0.0,
                       .damping = 2.0,
                       .rest_length = 0.0,
                       .point_A = {0.1, 0.0, 0.0},
                       .point_B = Vector3::Zero(),
                       .anchor_W = Vector3::Zero()});
  body = turned_body();
  CHECK(!damper.conservative());
  CHECK(power(wrenches(damper, {body}), {body}) < 0.0);
}

TEST_CASE("Forces refuse parameters that make no sense") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {-1.0, nan, infinity}) {
    CHECK_THROWS_AS(QuadraticDrag({1.2, 0.45, bad, Vector3::Zero()}), InputError);
    CHECK_THROWS_AS(LinearDrag({bad, 0.0, Vector3::Zero()}), InputError);
    CHECK_THROWS_AS(MagnusLift({1.2, 1.0, bad, Vector3::Zero()}), InputError);
    CHECK_THROWS_AS(Buoyancy({bad, 1.0, Vector3::Zero(), Vector3::Zero()}), InputError);
    CHECK_THROWS_AS(Spring({bad, 0.0, 0.0, Vector3::Zero(), Vector3::Zero(), Vector3::Zero()}),
                    InputError);
  }
  CHECK_THROWS_AS(QuadraticDrag({1.2, 0.45, 0.1, Vector3(nan, 0.0, 0.0)}), InputError);
}

}  // namespace
}  // namespace kairos
