// Contact forces of a whole step, against what the equations of its end say.

#include "core/contacts/implicit_mode.hpp"

#include "core/contacts/turning_step.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace kairos;

namespace {

using Does = FrictionChoice::Does;
constexpr double g = 9.8;

/// A floor, and blocks of 2 kg that lie on it with four corners each, one every metre along x.
TurningState blocks(const std::vector<Vector3>& velocities, double mu) {
  const Vector3 half(0.1, 0.2, 0.1);
  TurningState state;
  state.bodies.push_back({});
  state.states.push_back({});
  state.loads.push_back({});
  state.radius.push_back(0.0);
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    BodyState moving;
    moving.pose.position = {static_cast<double>(i), half.y(), 0.0};
    moving.twist.linear = velocities[i];
    GroupBody body;
    body.inverse_mass = 0.5;
    body.inverse_inertia =
        Vector3(1.5 / (0.04 + 0.01), 1.5 / 0.02, 1.5 / (0.04 + 0.01)).asDiagonal();
    body.position = moving.pose.position;
    state.bodies.push_back(body);
    state.states.push_back(moving);
    state.loads.push_back({Vector3(0.0, -g, 0.0), Vector3::Zero()});
    state.radius.push_back(half.norm());
    for (const double x : {-0.1, 0.1}) {
      for (const double z : {-0.1, 0.1}) {
        Touch touch;
        touch.b = i + 1;
        touch.on_a = {TouchFeature::Kind::plane, Vector3::Zero(), Vector3::UnitY(), 0.0};
        touch.on_b = {TouchFeature::Kind::ball, Vector3(x, -half.y(), z), Vector3::Zero(), 0.0};
        touch.normal = Vector3::UnitY();
        touch.friction = mu;
        touch.pair = i;
        state.touches.push_back(touch);
      }
    }
  }
  return state;
}

/// Velocity of a body at the end of a step of h.
Twist after(const TurningMode& mode, std::size_t i, double h) {
  return {mode.velocities[i].linear + h * mode.forces.accelerations[i].linear,
          mode.velocities[i].angular + h * mode.forces.accelerations[i].angular};
}

}  // namespace

// What slides on a line has forces that do not change: the step is exact but for where it ends.
TEST_CASE("implicit step: blocks slow down by mu g, and stop where they would turn back",
          "[implicit]") {
  constexpr double mu = 0.3;
  constexpr double h = 1e-3;
  const TurningState state = blocks({{2.0, 0.0, 0.0}, {1e-3, 0.0, 0.0}, {0.0, 0.0, -3.0}}, mu);
  const TurningMode mode = implicit_mode(state, h, {});
  REQUIRE(mode.refusal.empty());
  CHECK(mode.implicit);
  // Sweeps settle to 1e-10 of what the loads do in a step.
  const double bound = 1e-8 * g * h;
  CHECK((after(mode, 1, h).linear - Vector3(2.0 - mu * g * h, 0.0, 0.0)).norm() <= bound);
  CHECK(after(mode, 2, h).linear.norm() <= bound);
  CHECK((after(mode, 3, h).linear - Vector3(0.0, 0.0, -3.0 + mu * g * h)).norm() <= bound);
  for (std::size_t k = 0; k < 12; ++k) {
    CHECK(mode.choices[k].does == (k / 4 == 1 ? Does::sticks : Does::slides));
  }
  // Begun with its own forces the search is over at once, and finds the same.
  const TurningMode again = implicit_mode(state, h, mode.forces.force);
  CHECK((after(again, 1, h).linear - after(mode, 1, h).linear).norm() <= bound);
  CHECK(again.solves < mode.solves);
}

// What is held has nothing left along its normals when the step begins. Forces that took it away
// once more would leave the blocks approaching the floor.
TEST_CASE("implicit step: forces are those of the velocities that the step begins with",
          "[implicit]") {
  constexpr double h = 1e-3;
  const double part = GENERATE(0.1, 0.5, 0.9);  // of what the loads make in the step
  CAPTURE(part);
  const TurningState state = blocks({{0.0, part * g * h, 0.0}, {0.0, 0.0, 0.0}}, 0.3);
  const TurningMode mode = implicit_mode(state, h, {});
  REQUIRE(mode.refusal.empty());
  for (const std::size_t i : {1U, 2U}) {
    CHECK(mode.velocities[i].linear.norm() <= 1e-12 * g * h);  // held: roundoff
    // Sweeps settle to 1e-10 of what the loads do in a step.
    CHECK(after(mode, i, h).linear.norm() <= 1e-8 * g * h);
    double pressed = 0.0;
    for (std::size_t k = 4 * (i - 1); k < 4 * i; ++k) {
      pressed += mode.forces.force[k].y();
    }
    CHECK(pressed == Approx(2.0 * g).epsilon(1e-8));  // their weights
  }
}

TEST_CASE("implicit step: what approaches when it begins is stopped by an impulse, which is told",
          "[implicit]") {
  constexpr double h = 1e-3;
  const TurningState state = blocks({{0.0, -0.1 * g * h, 0.0}, {0.0, 0.1 * g * h, 0.0}}, 0.3);
  const TurningMode mode = implicit_mode(state, h, {});
  REQUIRE(mode.refusal.empty());
  REQUIRE(mode.struck.size() == 8);
  const std::ptrdiff_t struck = std::count(mode.struck.begin(), mode.struck.begin() + 4, 1);
  CHECK(struck >= 1);  // one corner or more: they are redundant
  CHECK(std::count(mode.struck.begin() + 4, mode.struck.end(), 1) == 0);
}

// Up an incline slides a block, slower than its weight along it brakes in the step, and is held
// then by friction. That pushes up, and gives energy to a block that slides up with it from the
// start: m (a h - u) u. That is told, unless it is nothing.
TEST_CASE("implicit step: what gives energy to a block that slides up an incline is told",
          "[implicit]") {
  constexpr double h = 1e-3;
  constexpr double mu = 0.8;
  constexpr double down = 0.5 * g;                                    // a: along the incline, m/s^2
  const double part = GENERATE(0.0, 1e-9, 0.01, 0.3, 0.9, 1.2, 1.5);  // of a h: u
  CAPTURE(part);
  TurningState state = blocks({{part * down * h, 0.0, 0.0}}, mu);
  state.loads[1].linear.x() = -down;
  const TurningMode mode = implicit_mode(state, h, {});
  REQUIRE(mode.refusal.empty());
  // Sweeps settle to 1e-10 of what the loads do in a step.
  CHECK(after(mode, 1, h).linear.norm() <= 1e-8 * g * h);
  double power = 0.0;
  for (const Vector3& force : mode.forces.force) {
    power += force.dot(mode.velocities[1].linear);
  }
  CHECK(mode.gives == (part > 0.001 && part < 1.0));
  CHECK((power > 1e-6 * g * g * h) == mode.gives);
}

TEST_CASE("implicit step: impulses are within their cones, and take energy from what they meet",
          "[implicit]") {
  constexpr std::uint64_t seed = 20261124;
  CAPTURE(seed);
  Random random(seed);
  for (int trial = 0; trial < 200; ++trial) {
    CAPTURE(trial);
    const double mu = random.uniform(0.0, 2.0);
    const double h = std::pow(10.0, random.uniform(-6.0, -2.0));
    std::vector<Vector3> velocities;
    for (int i = 0; i < 3; ++i) {
      velocities.emplace_back(random.uniform(-1.0, 1.0) * h, 0.0, random.uniform(-1.0, 1.0) * h);
    }
    TurningState state = blocks(velocities, mu);
    for (std::size_t i = 1; i < state.loads.size(); ++i) {
      state.loads[i].linear += Vector3(random.uniform(-9.0, 9.0), 0.0, random.uniform(-9.0, 9.0));
      state.loads[i].angular = Vector3(0.0, random.uniform(-9.0, 9.0), 0.0);
    }
    const TurningMode mode = implicit_mode(state, h, {});
    REQUIRE(mode.refusal.empty());
    double work = 0.0;
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const Touch& touch = state.touches[k];
      const Vector3& f = mode.forces.force[k];
      CHECK(f.y() >= 0.0);
      CHECK(std::hypot(f.x(), f.z()) <= mu * f.y() * (1.0 + 1e-9));
      const Twist v = after(mode, touch.b, h);
      const Vector3 arm = touch.on_b.at;
      work += f.dot(v.linear + v.angular.cross(arm));
    }
    // Some 20 N act at some .05 m/s; what sweeps leave is 1e-10 of both.
    CHECK(work <= 1e-7 * h);
  }
}

// Corners that push against each other would turn the body as soon as it moves.
TEST_CASE("implicit step: corners that stick share alike, whatever they pushed before",
          "[implicit]") {
  constexpr std::uint64_t seed = 20261128;
  CAPTURE(seed);
  Random random(seed);
  constexpr double weight = 2.0 * g;
  const TurningState state = blocks({Vector3::Zero()}, 0.8);
  for (int trial = 0; trial < 50; ++trial) {
    // Against each other along both diagonals, and no more than friction holds.
    const double one = random.uniform(-0.1, 0.1) * weight;
    const double other = random.uniform(-0.1, 0.1) * weight;
    std::vector<Vector3> warm;
    for (const auto& [x, z] : {std::pair{-1.0, -1.0}, {-1.0, 1.0}, {1.0, -1.0}, {1.0, 1.0}}) {
      const double along = x * z > 0.0 ? one : other;
      warm.emplace_back(along * x, 0.25 * weight, along * z);
    }
    const TurningMode mode = implicit_mode(state, 1e-3, warm);
    REQUIRE(mode.refusal.empty());
    for (const Vector3& f : mode.forces.force) {
      // Sweeps settle to 1e-10 of what the loads do.
      CHECK((f - Vector3(0.0, 0.25 * weight, 0.0)).norm() <= 1e-8 * weight);
    }
  }
}

// Four corners that slide can carry the same in many ways, of which the order of a sweep chose one.
TEST_CASE("implicit step: over many touches mirrored corners that slide carry alike",
          "[implicit]") {
  constexpr std::uint64_t seed = 20261128;
  CAPTURE(seed);
  Random random(seed);
  constexpr double h = 1e-3;
  constexpr double weight = 2.0 * g;
  for (int trial = 0; trial < 20; ++trial) {
    const double mu = random.uniform(0.05, 0.4);  // at 0.5 they tip over
    const double speed = random.uniform(0.1, 3.0);
    const std::vector<Vector3> velocities(12, Vector3(speed, 0.0, 0.0));
    const TurningState state = blocks(velocities, mu);
    const TurningMode mode = implicit_mode(state, h, {});
    REQUIRE(mode.refusal.empty());
    // Sweeps settle to 1e-10 of what the loads do.
    for (std::size_t i = 1; i <= velocities.size(); ++i) {
      CHECK(std::abs(after(mode, i, h).linear.x() - (speed - mu * g * h)) <= 1e-8 * g * h);
    }
    for (std::size_t k = 0; k < state.touches.size(); k += 2) {  // z = -0.1, then 0.1
      CHECK((mode.forces.force[k] - mode.forces.force[k + 1]).norm() <= 1e-8 * weight);
    }
  }
}

// In a step this short the loads do less than rounding: what a sweep still changes is noise.
TEST_CASE("implicit step: what changes by rounding alone has settled", "[implicit]") {
  constexpr std::uint64_t seed = 20261125;
  CAPTURE(seed);
  Random random(seed);
  int most = 0;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vector3> velocities;
    for (int i = 0; i < 6; ++i) {
      velocities.emplace_back(random.uniform(-3.0, 3.0), 0.0, random.uniform(-3.0, 3.0));
    }
    TurningState state = blocks(velocities, 0.8);
    const Quaternion turn =
        rotate(random.direction() * random.uniform(0.0, 3.0), Quaternion::Identity());
    for (std::size_t i = 0; i < state.bodies.size(); ++i) {
      const Vector3 spin(0.0, random.uniform(-5.0, 5.0), 0.0);
      GroupBody& body = state.bodies[i];
      BodyState& at = state.states[i];
      body.position = turn * body.position;
      body.inverse_inertia =
          turn.toRotationMatrix() * body.inverse_inertia * turn.toRotationMatrix().transpose();
      at.pose.position = turn * at.pose.position;
      at.pose.orientation = (turn * at.pose.orientation).normalized();
      at.twist.linear = turn * at.twist.linear;
      at.twist.angular = i > 0 ? Vector3(turn * spin) : Vector3(Vector3::Zero());
      state.loads[i].linear = turn * state.loads[i].linear;
    }
    for (Touch& touch : state.touches) {
      touch.normal = turn * touch.normal;
    }
    const TurningMode mode = implicit_mode(state, 1e-9, {});
    CHECK(mode.refusal.empty());
    most = std::max(most, mode.solves / static_cast<int>(state.touches.size()));
  }
  // Sweeps come from a few tens to rounding, and 64 more show that they stay there.
  CHECK(most < 500);
}

// A force on a touch that opens would act on one of the two alone: the other goes on by itself.
TEST_CASE("implicit step: what opens has no force, rough as it may be", "[implicit]") {
  constexpr std::uint64_t seed = 20261125;
  constexpr double h = 1e-3;
  CAPTURE(seed);
  Random random(seed);
  int open = 0;
  for (int trial = 0; trial < 300; ++trial) {
    CAPTURE(trial);
    TurningState state = blocks({Vector3::Zero(), Vector3::Zero()}, 1e8);
    for (Touch& touch : state.touches) {
      touch.rough = true;
    }
    for (std::size_t i = 1; i < state.loads.size(); ++i) {
      state.loads[i].linear = Vector3(random.uniform(-9.0, 9.0), random.uniform(-9.0, 1.0), 0.0);
      state.loads[i].angular = 100.0 * random.direction();
      state.states[i].twist.linear = h * random.direction() * 9.0;
    }
    const TurningMode mode = implicit_mode(state, h, {});
    if (!mode.refusal.empty()) {
      continue;
    }
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      if (mode.choices[k].does == Does::opens) {
        CHECK(mode.forces.force[k].isZero(0.0));
        ++open;
      }
    }
  }
  CHECK(open > 100);
}

namespace {

/// A plank of 1 m along x, 2 kg, that hangs on the world at its end at the origin, and touches the
/// floor with a corner at the other, level with the joint. It turns about the upright at `spin`.
struct Plank {
  static constexpr double mass = 2.0;
  static constexpr double mu = 0.4;
  static constexpr double about_end = 0.3 + 0.25 * mass;  ///< kg m^2, upright

  Plank(JointKind kind, const Vector3& axis, double spin)
      : joints({placed(kind, axis)}, {inertia()}) {
    group.bodies = {0, 1};
    group.inertia = {BodyInertia{}, inertia()};
    group.constant_force = {Vector3::Zero(), Vector3(0.0, -mass * g, 0.0)};
    group.forces.resize(2);
    group.mechanisms.push_back({{1}, &joints, {}});
    group.start.radius = {0.0, 0.5};
    BodyState plank;
    plank.pose.position = {0.5, 0.0, 0.0};
    plank.twist = {Vector3(0.0, 0.0, -0.5 * spin), Vector3(0.0, spin, 0.0)};
    group.start.states = {BodyState{}, plank};
    Touch touch;
    touch.b = 1;
    touch.on_a = {TouchFeature::Kind::plane, Vector3::Zero(), Vector3::UnitY(), 0.0};
    touch.on_b = {TouchFeature::Kind::ball, Vector3(0.5, 0.0, 0.0), Vector3::Zero(), 0.0};
    touch.normal = Vector3::UnitY();
    touch.friction = mu;
    group.start.touches.push_back(touch);
  }

  [[nodiscard]] TurningState state() const {
    return turning_state(group, Instant{}, std::span(group.start.states).last(1));
  }
  static BodyInertia inertia() {
    return {.mass = mass, .principal = Vector3(0.1, 0.3, 0.3), .rotates = true};
  }
  static JointSystem::Placed placed(JointKind kind, const Vector3& axis) {
    JointSystem::Placed out;
    out.joint.kind = kind;
    out.joint.b.point = {-0.5, 0.0, 0.0};
    out.joint.a.frame = out.joint.b.frame = Quaternion::FromTwoVectors(Vector3::UnitX(), axis);
    out.joint.b.body = 0;
    out.b.place = 0;
    return out;
  }

  JointSystem joints;
  TurningGroup group;
};

}  // namespace

// The joint carries half of the plank, the floor the other half.
TEST_CASE("implicit step: a plank on a ball joint is slowed at its end, and stops",
          "[implicit][joints]") {
  constexpr double h = 1e-4;
  constexpr double slowed = Plank::mu * 0.5 * Plank::mass * g / Plank::about_end;  // rad/s^2
  const double spin = GENERATE(2.0, -0.5, 0.5 * slowed * h);
  CAPTURE(spin);
  // Friction is against the slip at the end, which is not quite along z: it is on a circle.
  const double bound = 1e-8 + spin * spin * h * h;
  const Plank plank(JointKind::ball, Vector3::UnitX(), spin);
  const TurningState state = plank.state();
  const TurningMode mode = implicit_mode(state, h, {});
  REQUIRE(mode.refusal.empty());
  const double left = std::abs(spin) - std::min(std::abs(spin), slowed * h);
  const Twist end = after(mode, 1, h);
  CHECK(std::abs(end.angular.y() - std::copysign(left, spin)) <= bound * slowed * h);
  CHECK(mode.choices[0].does == (left > 0.0 ? Does::slides : Does::sticks));
  const Vector3& f = mode.forces.force[0];
  CHECK(f.y() == Approx(0.5 * Plank::mass * g).epsilon(1e-8));
  // It turns z down where it turns about y.
  CHECK(f.z() == Approx((spin - std::copysign(left, spin)) * Plank::about_end / h).epsilon(bound));
  CHECK(std::abs(end.linear.y() + 0.5 * end.angular.z()) <= 1e-8 * g * h);  // at rest
}

// The joint holds the end along the floor, so that what presses it rubs nowhere.
TEST_CASE("implicit step: the end of a plank on a hinge is pressed straight down",
          "[implicit][joints]") {
  constexpr double h = 1e-3;
  const Plank plank(JointKind::hinge, Vector3::UnitZ(), 0.0);
  const TurningMode mode = implicit_mode(plank.state(), h, {});
  REQUIRE(mode.refusal.empty());
  CHECK((mode.forces.force[0] - Vector3(0.0, 0.5 * Plank::mass * g, 0.0)).norm() <= 1e-8 * g);
  CHECK(after(mode, 1, h).linear.norm() <= 1e-8 * g * h);
  CHECK(after(mode, 1, h).angular.norm() <= 1e-8 * g * h);
}

// Nothing is known of what would press where the joint carries all: there is no force.
TEST_CASE("implicit step: what joints do not let move along a normal is left alone",
          "[implicit][joints]") {
  constexpr double h = 1e-3;
  const Plank plank(JointKind::hinge, Vector3::UnitY(), 2.0);
  const TurningMode mode = implicit_mode(plank.state(), h, std::vector{Vector3(0.0, 3.0, 1.0)});
  REQUIRE(mode.refusal.empty());
  CHECK(mode.forces.force[0].isZero(0.0));
  CHECK(after(mode, 1, h).angular.y() == Approx(2.0).epsilon(1e-12));
}
