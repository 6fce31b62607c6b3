// What each entity gives and takes, as chapters 5 to 7 and appendix 13 of the thesis have it.

#include "core/entity.hpp"

#include "core/random.hpp"
#include "core/scene.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <numbers>

using namespace kairos;

namespace {

constexpr double pi = std::numbers::pi;

Body make(std::string_view kind, double mass, std::vector<double> values = {}) {
  const EntityType* type = find_entity(kind);
  REQUIRE(type != nullptr);
  if (values.empty()) {
    for (const EntityKey& key : type->keys) {
      values.push_back(key.default_value);
    }
  }
  Body body;
  body.name = std::string(kind);
  body.entity = type->make(values);
  body.shape = Sphere{0.5};
  body.mass = mass;
  return body;
}

BodyState moving(const Vector3& velocity) {
  BodyState state;
  state.twist.linear = velocity;
  return state;
}

/// What the thesis' collision hands from one to the other (13.5), without normals of round pairs.
Gift gift_of(const Body& giver, const BodyState& state) {
  Gift gift{giver.entity->physics_type(), giver.entity->get_momentum(giver, state), std::nullopt,
            giver.entity->nudge()};
  if (giver.entity->stationary()) {
    gift.normal = giver.normal(state.pose);
  }
  return gift;
}

Vector3 after_hit(const Body& taker, const Vector3& velocity, const Body& giver,
                  const BodyState& giver_state) {
  BodyState state = moving(velocity);
  taker.entity->give_momentum(taker, state, gift_of(giver, giver_state));
  return state.twist.linear;
}

double angle(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

TEST_CASE("catalogue: every entity is what it says it is", "[entity]") {
  for (const EntityType& type : entity_catalogue()) {
    INFO(type.kind);
    const Body body = make(type.kind, 1.0);
    CHECK(body.entity->kind() == type.kind);
    CHECK(body.entity->mobility() == type.mobility);
    CHECK(body.entity->is_field() == (type.kind == "anti-gravity-pad"));
    CHECK_FALSE(type.summary.empty());
    CHECK_FALSE(type.source.empty());
    for (const EntityKey& key : type.keys) {
      CHECK(key.lowest <= key.default_value);
      CHECK(key.default_value <= key.highest);
    }
  }
  CHECK(find_entity("unicorn") == nullptr);
}

TEST_CASE("wall: mirrors a ball, whichever way it flies and its normal points", "[entity]") {
  Body wall = make("wall", -1.0);
  const Body ball = make("ball", 2.0);
  CHECK(after_hit(ball, {3, -4, 5}, wall, {}) == Vector3(3, 4, 5));
  // No approach test: a ball that leaves already is turned back in (the jiggle).
  CHECK(after_hit(ball, {3, 4, 5}, wall, {}) == Vector3(3, -4, 5));
  wall.normal_B = -Vector3::UnitY();
  CHECK(after_hit(ball, {3, -4, 5}, wall, {}) == Vector3(3, 4, 5));
  CHECK(wall.entity->get_momentum(wall, {}).mass == -1.0);
}

TEST_CASE("walls, pads, conveyors and bats take nothing", "[entity]") {
  const Body ball = make("ball", 1.0);
  const Gift gift = gift_of(ball, moving({1, 2, 3}));
  for (const char* kind : {"wall", "anti-gravity-pad", "conveyor", "bat", "hand"}) {
    INFO(kind);
    const Body body = make(kind, 1.0);
    BodyState state = moving({7, 8, 9});
    Vector3 force = Vector3::Zero();
    body.entity->give_momentum(body, state, gift);
    body.entity->give_force(force, {1, 1, 1});
    CHECK(state.twist.linear == Vector3(7, 8, 9));
    CHECK(force == Vector3::Zero());
  }
}

TEST_CASE("ball and ball: the exchange keeps momentum and energy", "[entity]") {
  const std::uint64_t seed = 20;
  CAPTURE(seed);
  Random random(seed);
  for (int i = 0; i < 1000; ++i) {
    const Body a = make("ball", random.log_uniform(1e-3, 1e3));
    const Body b = make("ball", random.log_uniform(1e-3, 1e3));
    const Vector3 va = random.direction() * random.uniform(0.0, 10.0);
    const Vector3 vb = random.direction() * random.uniform(0.0, 10.0);
    const Vector3 wa = after_hit(a, va, b, moving(vb));
    const Vector3 wb = after_hit(b, vb, a, moving(va));
    const double momentum = a.mass * va.norm() + b.mass * vb.norm();
    const double energy = a.mass * va.squaredNorm() + b.mass * vb.squaredNorm();
    // Roundoff: factors near 2 on either side, a handful of operations.
    CHECK((a.mass * (wa - va) + b.mass * (wb - vb)).norm() < 1e-14 * momentum);
    CHECK(std::abs(a.mass * wa.squaredNorm() + b.mass * wb.squaredNorm() - energy) <
          2e-14 * energy);
  }
}

TEST_CASE("prediction 7: exchanging whole vectors is wrong by the angle off the centre line",
          "[entity][prediction]") {
  const Body ball = make("ball", 1.0);
  for (const double theta : {0.0, 0.1, 0.5, 1.0, 1.5}) {
    const Vector3 centre_line = Vector3::UnitX();
    const Vector3 v(std::cos(theta), std::sin(theta), 0.0);
    INFO(theta);
    // A target at rest flies along v, though it should fly along the centre line.
    const Vector3 target = after_hit(ball, Vector3::Zero(), ball, moving(v));
    CHECK(angle(target, centre_line) == Approx(theta).margin(1e-15));
    // In the centre-of-mass frame each should have only its normal part turned round.
    const Vector3 thesis = after_hit(ball, v, ball, moving(-v));
    const Vector3 right = v - 2.0 * v.dot(centre_line) * centre_line;
    CHECK(angle(thesis, right) == Approx(2.0 * theta).margin(1e-15));
  }
}

TEST_CASE("prediction 6: a conveyor swallows balls lighter than its belt", "[entity][prediction]") {
  const Body conveyor = make("conveyor", -1.0);
  for (const double mass : {0.1, 1.0, 9.9, 10.1, 20.0, 100.0}) {
    INFO(mass);
    const Body ball = make("ball", mass);
    const Vector3 v = after_hit(ball, {0, -3, 0}, conveyor, {});
    // The exchange, then the reflection: -(m-10)/(m+10) of the normal speed.
    CHECK(v.y() == Approx(3.0 * (mass - 10.0) / (mass + 10.0)).epsilon(1e-14));
    CHECK(v.x() == Approx(20.0 / (mass + 10.0)).epsilon(1e-14));
    CHECK((v.y() < 0.0) == (mass < 10.0));
  }
}

TEST_CASE("conveyor: its belt runs along its own length", "[entity]") {
  const Body conveyor = make("conveyor", -1.0, {4.0, 2.5});
  BodyState state;
  state.pose.orientation = rotate({0, pi / 2, 0}, Quaternion::Identity());
  const Momentum belt = conveyor.entity->get_momentum(conveyor, state);
  CHECK(belt.mass == 4.0);
  CHECK((belt.velocity - Vector3(0, 0, -2.5)).norm() < 1e-15);
  CHECK(conveyor.entity->surface_velocity(conveyor, state) == belt.velocity);
  Body plane = make("conveyor", -1.0, {4.0, 2.5});
  plane.shape = HalfSpace{Vector3(1, 0, 0)};  // in its surface, not out of it
  CHECK((plane.entity->surface_velocity(plane, {}) - Vector3(0, -2.5, 0)).norm() < 1e-15);
  CHECK(make("wall", -1.0).entity->surface_velocity(conveyor, state) == Vector3::Zero());
}

TEST_CASE("anti-gravity pad: twice its G upwards, and no momentum", "[entity]") {
  Body pad = make("anti-gravity-pad", -1.0);
  pad.G = 3.0;
  CHECK(pad.entity->get_force(pad, {}) == Vector3(0, 6, 0));
  const Body ball = make("ball", 1.0);
  CHECK(after_hit(ball, {1, -2, 3}, pad, {}) == Vector3(1, -2, 3));
  Vector3 force(0, -9.8, 0);
  ball.entity->give_force(force, pad.entity->get_force(pad, {}));
  CHECK(force.y() == Approx(-3.8));
}

TEST_CASE("bat: moves the ball out of its way by the nudge, along the change of velocity",
          "[entity]") {
  Body ball = make("ball", 1.0);
  ball.scale = 2.0;
  const Body bat = make("bat", 3.0, {0.01, 1.0, 0.0025, 0.0});
  BodyState state = moving({-1, 0, 0});
  ball.entity->give_momentum(ball, state, gift_of(bat, moving({4, 0, 0})));
  // v' = ((1-3)(-1) + 2*3*4)/4 = 6.5.
  CHECK(state.twist.linear.x() == Approx(6.5));
  CHECK(state.pose.position.x() == Approx(0.0025 * 2.0 * 7.5));
  // The prose of 7.4: along v' itself.
  BodyState prose = moving({-1, 0, 0});
  ball.entity->give_momentum(
      ball, prose, gift_of(make("bat", 3.0, {0.01, 1.0, 0.0, 0.0025}), moving({4, 0, 0})));
  CHECK(prose.twist.linear.x() == Approx(6.5));
  CHECK(prose.pose.position.x() == Approx(0.0025 * 2.0 * 6.5));
  // The default does not move it.
  BodyState still = moving({-1, 0, 0});
  ball.entity->give_momentum(ball, still, gift_of(make("bat", 3.0), moving({4, 0, 0})));
  CHECK(still.pose.position == Vector3::Zero());
}

TEST_CASE("bat: its velocity is renewed past the threshold only, by the last interval alone",
          "[entity]") {
  const Body bat = make("bat", 1.0);
  TrackerMemory memory;
  const auto at = [](double x) {
    BodyState state;
    state.pose.position.x() = x;
    return state;
  };
  const double h = 1.0 / 60.0;
  CHECK(bat.entity->tracked_velocity(memory, at(1.0), h).x() == 0.0);
  CHECK(bat.entity->tracked_velocity(memory, at(1.009), h).x() == 0.0);
  // 0.011 m since the accepted sample, two frames ago, divided by one frame: too fast.
  CHECK(bat.entity->tracked_velocity(memory, at(1.011), h).x() == Approx(0.011 / h));
  // Stopped: the velocity stays.
  CHECK(bat.entity->tracked_velocity(memory, at(1.011), h).x() == Approx(0.011 / h));
  // An interval of 0 s is taken for 1e-8 s.
  CHECK(bat.entity->tracked_velocity(memory, at(2.011), 0.0).x() == Approx(1e8));
  // Others tell the truth.
  BodyState truth = moving({5, 0, 0});
  CHECK(make("wall", -1.0).entity->tracked_velocity(memory, truth, h).x() == 5.0);
}

TEST_CASE("bat: a true speed of 0.1 m/s reads 0.65 m/s at 60 Hz", "[entity][prediction]") {
  // 1/600 m a frame: the seventh exceeds 0.01 m; 0.0116667 m in one frame is 0.7 m/s, and the sixth
  // just reaches the threshold, so that the reading depends on roundoff: 0.6 or 0.7.
  const Body bat = make("bat", 1.0);
  TrackerMemory memory;
  double sum = 0.0;
  int renewals = 0;
  Vector3 last = Vector3::Zero();
  for (int n = 0; n < 6000; ++n) {
    BodyState state;
    state.pose.position.x() = 0.1 * n / 60.0;
    const Vector3 accepted = memory.accepted_position;
    const bool was_primed = memory.primed;
    last = bat.entity->tracked_velocity(memory, state, 1.0 / 60.0);
    if (was_primed && memory.accepted_position != accepted) {
      sum += last.x();
      ++renewals;
    }
  }
  REQUIRE(renewals > 0);
  const double mean = sum / renewals;
  CHECK(mean > 0.6 - 1e-9);
  CHECK(mean < 0.7 + 1e-9);
}
