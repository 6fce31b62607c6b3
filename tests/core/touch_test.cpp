// Where and how fast two features touch, against differences of where they are.

#include "core/contacts/touch.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <Eigen/Geometry>

#include <utility>

using namespace kairos;

namespace {

using Kind = TouchFeature::Kind;

Vector3 any(Random& random) {
  Vector3 v;
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = random.uniform(-1.0, 1.0);
  }
  return v;
}

/// One number a statement: in what order arguments are drawn is not known.
BodyState any_state(Random& random) {
  BodyState state;
  state.pose.position = any(random);
  state.twist.linear = any(random);
  state.twist.angular = any(random);
  const double angle = random.uniform(0.0, 3.0);
  const Vector3 axis = any(random).normalized();
  state.pose.orientation = Quaternion(Eigen::AngleAxisd(angle, axis));
  return state;
}

TouchFeature feature(Kind kind, double radius, Random& random) {
  TouchFeature out;
  out.kind = kind;
  out.at = any(random);
  out.direction = kind == Kind::ball ? Vector3(Vector3::Zero()) : Vector3(any(random).normalized());
  out.radius = kind == Kind::plane ? 0.0 : kind == Kind::rim ? radius + 0.1 : radius;
  out.near = out.at;
  if (kind == Kind::cone) {
    const Vector3 around = out.direction.cross(any(random)).normalized();
    out.radius = 0.0;
    out.sine = random.uniform(0.2, 0.8);
    out.near =
        out.at + 0.4 * (out.sine * around - std::sqrt(1.0 - out.sine * out.sine) * out.direction);
  }
  if (kind == Kind::rim) {
    out.near = out.at + out.radius * out.direction.cross(any(random)).normalized();
  }
  return out;
}

/// Of a line or a rim, where it is to touch.
Vector3 place(const TouchFeature& f) { return f.kind == Kind::rim ? f.near : f.at; }
Vector3 tangent(const TouchFeature& f) {
  return f.kind == Kind::rim ? Vector3(f.direction.cross(f.near - f.at).normalized()) : f.direction;
}
double roundness(const TouchFeature& f) { return f.kind == Kind::rim ? 0.0 : f.radius; }

/// Moves b so that it crosses a at these places.
void place_across(Touch& touch, const BodyState& a, BodyState& b) {
  const Vector3 across = (a.pose.orientation * tangent(touch.on_a))
                             .cross(b.pose.orientation * tangent(touch.on_b))
                             .normalized();
  touch.normal = across;
  const double apart = roundness(touch.on_a) + roundness(touch.on_b);
  b.pose.position +=
      a.pose.to_world(place(touch.on_a)) + apart * across - b.pose.to_world(place(touch.on_b));
}

/// Turns and moves what touches a cone to where the cone's side is.
void place_at_cone(const TouchFeature& cone, const BodyState& of_cone, const TouchFeature& other,
                   BodyState& moved) {
  const Vector3 along = cone.near - cone.at;
  const Vector3 q = (along - cone.direction * cone.direction.dot(along)).normalized();
  const Vector3 n = of_cone.pose.orientation *
                    (std::sqrt(1.0 - cone.sine * cone.sine) * q + cone.sine * cone.direction);
  Quaternion& turned = moved.pose.orientation;
  if (other.kind != Kind::ball) {
    const Vector3 t = turned * tangent(other);
    turned = Quaternion::FromTwoVectors(t, (t - n * n.dot(t)).normalized()) * turned;
    if (other.kind == Kind::rim && (turned * (other.near - other.at)).dot(n) > 0.0) {
      turned = Quaternion(Eigen::AngleAxisd(3.141592653589793, turned * tangent(other))) * turned;
    }
  }
  moved.pose.position +=
      of_cone.pose.to_world(cone.near) + roundness(other) * n - moved.pose.to_world(place(other));
}

/// After s without any force or torque about the middle of a ball.
BodyState later(const BodyState& state, double s) {
  BodyState out = state;
  out.pose.position += s * state.twist.linear;
  const Vector3 turn = s * state.twist.angular;
  const double angle = turn.norm();
  out.pose.orientation =
      Quaternion(Eigen::AngleAxisd(angle, angle > 0.0 ? Vector3(turn / angle) : Vector3::UnitX())) *
      state.pose.orientation;
  return out;
}

/// A derivative by central differences with steps h and h/2, extrapolated: to h^4.
template <typename F>
auto slope(const F& f, double h) {
  const auto once = [&](double d) { return ((f(d) - f(-d)) / (2.0 * d)).eval(); };
  return ((4.0 * once(0.5 * h) - once(h)) / 3.0).eval();
}

}  // namespace

TEST_CASE("velocities and accelerations of touches are derivatives", "[friction]") {
  // All pairs of features that touch in one point: balls, planes, edges, sides of capsules, rims,
  // cones.
  Random random(20261130);
  int elsewhere = 0;
  int asked = 0;
  const std::pair<Kind, Kind> pairs[] = {
      {Kind::rim, Kind::ball},  {Kind::ball, Kind::rim},   {Kind::rim, Kind::plane},
      {Kind::plane, Kind::rim}, {Kind::ball, Kind::plane}, {Kind::plane, Kind::ball},
      {Kind::ball, Kind::ball}, {Kind::line, Kind::ball},  {Kind::ball, Kind::line},
      {Kind::line, Kind::line}, {Kind::rim, Kind::line},   {Kind::line, Kind::rim},
      {Kind::rim, Kind::rim}};
  for (std::size_t trial = 0; trial < 1900; ++trial) {
    const auto [of_a, of_b] = pairs[trial % std::size(pairs)];
    Touch touch;
    touch.on_a = feature(of_a, trial % 4 < 2 ? 0.3 : 0.0, random);
    touch.on_b = feature(of_b, trial % 3 == 0 ? 0.4 : 0.1, random);
    if (of_a == Kind::ball && of_b == Kind::rim) {
      touch.on_a.radius += 0.1;  // a corner at a rim has no normal
    }
    BodyState a = any_state(random);
    BodyState b = any_state(random);
    touch.normal = b.pose.position - a.pose.position;
    bool placed = false;
    if (of_a == Kind::rim ? of_b == Kind::line || of_b == Kind::rim
                          : of_a == Kind::line && of_b == Kind::rim) {
      place_across(touch, a, b);
      placed = true;
    }
    if (of_a == Kind::cone) {
      place_at_cone(touch.on_a, a, touch.on_b, b);
      placed = true;
    } else if (of_b == Kind::cone) {
      place_at_cone(touch.on_b, b, touch.on_a, a);
      placed = true;
    }
    // They touch, and neither part nor approach.
    TouchNow now = look_at(touch, a, b);
    if (placed && !(std::abs(now.gap) <= 1e-9)) {
      ++elsewhere;  // what bends towards the other is nearest there
      continue;
    }
    b.pose.position -= now.gap * now.normal;
    now = look_at(touch, a, b);
    b.twist.linear -= now.normal * now.normal.dot(now.velocity);
    now = look_at(touch, a, b);
    touch.normal = now.normal;
    CAPTURE(trial, touch.on_a.radius, touch.on_b.radius);
    CHECK(std::abs(now.gap) <= 1e-13);
    CHECK((now.point_a - now.point_b).norm() <= 1e-12);
    const auto at = [&](double s) { return look_at(touch, later(a, s), later(b, s)); };
    // Where differences of two lengths agree: what crosses at a small angle, or bends towards the
    // other nearly as much as that bends away, turns fast, or runs away.
    const auto differences = [&](double h) {
      Eigen::Matrix<double, 5, 1> out;
      out[0] = slope([&](double s) { return Eigen::Matrix<double, 1, 1>(at(s).gap); }, h)[0];
      out[1] = slope(
          [&](double s) { return Eigen::Matrix<double, 1, 1>(at(s).normal.dot(at(s).velocity)); },
          h)[0];
      out.tail<3>() = slope([&](double s) { return at(s).velocity; }, h);
      return out;
    };
    const auto found = differences(2e-4);
    const double steep = 1.0 + std::abs(now.normal_bias) + now.bias.norm();
    const double allowed = 1e-6 * steep * steep;
    if (steep < 50.0 && (found - differences(4e-4)).norm() <= 0.1 * allowed) {
      ++asked;
      CHECK(std::abs(found[0]) <= allowed);
      CHECK(std::abs(found[1] - now.normal_bias) <= allowed);
      CHECK((found.tail<3>() - now.bias).norm() <= allowed);
    }
  }
  CHECK(elsewhere < 100);
  CHECK(asked > 1400);
}
