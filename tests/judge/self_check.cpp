#include "tests/judge/self_check.hpp"

#include "ccd/certified.hpp"
#include "tests/judge/verdict.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <numbers>
#include <vector>

namespace kairos::judge {
namespace {

/// A query whose first contact is known.
struct Known {
  Query query;
  double time;     ///< of first contact, s
  double closing;  ///< speed of approach then, m/s
  Vector3 normal;
  Vector3 point;  ///< where they touch, m
};

Body unit_box() { return {}; }

Body plane_along_x() {
  Body body;
  body.kind = Kind::half_space;
  body.normal = Vector3::UnitX();
  return body;
}

/// A ball of radius 1/2 thrown at a wall against an acceleration: 3 - 4 t + t^2/2 = 1/2.
Known thrown_ball() {
  Known known;
  known.query.id = "thrown ball";
  known.query.a = plane_along_x();
  known.query.b.kind = Kind::sphere;
  known.query.b.half_extents = Vector3::Constant(0.5);
  known.query.b.position = {3.0, 0.25, 0.5};
  known.query.b.velocity = {-4.0, 1.0, 0.0};
  known.query.b.acceleration = {1.0, 0.0, 0.0};
  known.time = 4.0 - std::sqrt(11.0);
  known.closing = 4.0 - known.time;
  known.normal = Vector3::UnitX();
  known.point = {0.0, 0.25 + known.time, 0.5};
  return known;
}

/// Two cubes of one tilted orientation, face at face.
Known tilted_cubes() {
  Known known;
  known.query.id = "tilted cubes";
  known.query.a = unit_box();
  known.query.b = unit_box();
  const Vector3 tilt(0.3, -0.2, 0.5);
  known.query.a.orientation = known.query.b.orientation = rotate(tilt, Quaternion::Identity());
  known.normal = known.query.a.orientation * Vector3::UnitZ();
  known.query.b.position = 5.0 * known.normal;
  known.query.b.velocity = -6.0 * known.normal;
  known.time = 0.5;
  known.closing = 6.0;
  known.point = known.normal;
  return known;
}

/// A cube that turns about its centre beside a wall: its edge comes down onto it when
/// sin x + cos x = 1.25 (x: the angle turned, from 0).
Known turning_cube() {
  Known known;
  known.query.id = "turning cube";
  known.query.a = plane_along_x();
  known.query.b = unit_box();
  known.query.b.position = {1.25, 0.0, 0.0};
  known.query.b.spin = {0.0, 0.0, 0.5};
  const double angle = std::numbers::pi / 4 - std::acos(1.25 / std::numbers::sqrt2);
  known.time = angle / 0.5;
  known.closing = 0.5 * (std::cos(angle) - std::sin(angle));
  known.normal = Vector3::UnitX();
  known.point = {0.0, std::cos(angle) - std::sin(angle), 0.0};
  return known;
}

/// Two edges at right angles: the gap along z is z - 2 sqrt(2).
Known crossed_edges() {
  Known known;
  known.query.id = "crossed edges";
  known.query.a = unit_box();
  known.query.b = unit_box();
  known.query.a.orientation =
      rotate(Vector3(std::numbers::pi / 4, 0.0, 0.0), Quaternion::Identity());
  known.query.b.orientation =
      rotate(Vector3(0.0, std::numbers::pi / 4, 0.0), Quaternion::Identity());
  known.query.b.position = {0.1, 0.2, 4.0};
  known.query.b.velocity = {0.0, 0.0, -2.0};
  known.time = 2.0 - std::numbers::sqrt2;
  known.closing = 2.0;
  known.point = {0.1, 0.0, std::numbers::sqrt2};
  known.normal = Vector3::UnitZ();
  return known;
}

/// Corner of a cube towards a ball along the diagonal.
Known ball_at_corner() {
  Known known;
  known.query.id = "ball at a corner";
  known.query.a = unit_box();
  known.query.b.kind = Kind::sphere;
  known.normal = Vector3::Ones() / std::sqrt(3.0);
  known.query.b.position = Vector3::Constant(3.0);
  known.query.b.velocity = Vector3::Constant(-2.0);
  known.query.b.half_extents = Vector3::Constant(0.5);
  known.time = 1.0 - 0.25 / std::sqrt(3.0);
  known.closing = 2.0 * std::sqrt(3.0);
  known.point = Vector3::Ones();
  return known;
}

TimeOfImpact right_answer(const Known& known) {
  TimeOfImpact answer;
  answer.status = ToiStatus::impact;
  answer.t_lo = known.time - 1e-11;
  answer.t_hi = known.time + 1e-11;
  answer.gap = 0.5e-11 * known.closing;
  answer.normal = known.normal;
  answer.witness_a = answer.witness_b = known.point;
  return answer;
}

struct Spoilt {
  Fault fault;
  std::function<void(const Known&, TimeOfImpact&)> spoil;
};

std::vector<Spoilt> spoilt_answers() {
  return {
      {Fault::missed, [](const Known&, TimeOfImpact& x) { x.status = ToiStatus::separated; }},
      {Fault::late,
       [](const Known& k, TimeOfImpact& x) {
         x.t_lo = k.time + 1e-13;
         x.gap = 0.0;
       }},
      {Fault::untrue, [](const Known& k, TimeOfImpact& x) { x.t_hi = k.time - 1e-13; }},
      {Fault::untrue, [](const Known&, TimeOfImpact& x) { x.status = ToiStatus::overlapping; }},
      {Fault::far, [](const Known& k, TimeOfImpact& x) { x.t_lo = k.time - 1e-7; }},
      {Fault::gap, [](const Known&, TimeOfImpact& x) { x.gap += 1e-9; }},
      {Fault::dips, [](const Known& k, TimeOfImpact& x) { x.t_lo = x.t_hi = k.time + 1e-9; }},
      {Fault::normal, [](const Known&, TimeOfImpact& x) { x.normal = -x.normal; }},
      {Fault::normal,
       [](const Known&, TimeOfImpact& x) {
         x.normal = (x.normal + Vector3(1e-3, -2e-3, 1.5e-3)).normalized();
       }},
      {Fault::witness, [](const Known&, TimeOfImpact& x) { x.witness_b.y() += 1e-3; }},
      {Fault::wide, [](const Known& k, TimeOfImpact& x) { x.t_hi = k.time + 1e-3; }},
      {Fault::vague,
       [](const Known& k, TimeOfImpact& x) {
         x.status = ToiStatus::undecided;
         x.t_hi = k.time + 1e-9;
       }},
      {Fault::vague,
       [](const Known& k, TimeOfImpact& x) {
         x.status = ToiStatus::undecided;
         x.t_lo = k.time - 2e-10;
         x.t_hi = k.time - 1e-10;
       }},
      {Fault::nonsense,
       [](const Known&, TimeOfImpact& x) { x.gap = std::numeric_limits<double>::quiet_NaN(); }},
      {Fault::nonsense, [](const Known&, TimeOfImpact& x) { std::swap(x.t_lo, x.t_hi); }},
  };
}

int check(const Known& known, const ContactDetector& detector) {
  int wrong = 0;
  const Verdict verdict = judge(known.query, right_answer(known), detector);
  if (verdict.breaks_a_promise()) {
    std::cout << fmt::format("{}: the right answer is called {} ({} m)\n", known.query.id,
                             verdict.faults(), verdict.depth);
    ++wrong;
  }
  for (const Spoilt& spoilt : spoilt_answers()) {
    TimeOfImpact answer = right_answer(known);
    spoilt.spoil(known, answer);
    if (!judge(known.query, answer, detector).has(spoilt.fault)) {
      std::cout << fmt::format("{}: an answer that is {} passes\n", known.query.id,
                               to_string(spoilt.fault));
      ++wrong;
    }
  }
  return wrong;
}

}  // namespace

int self_check() {
  const auto detector = ccd::make_certified();
  int wrong = 0;
  for (const Known& known :
       {thrown_ball(), tilted_cubes(), turning_cube(), crossed_edges(), ball_at_corner()}) {
    wrong += check(known, *detector);
    Known other = known;
    other.query = known.query.exchanged();
    other.normal = -known.normal;
    wrong += check(other, *detector);
  }
  return wrong;
}

}  // namespace kairos::judge
