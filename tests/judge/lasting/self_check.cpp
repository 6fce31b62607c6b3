#include "tests/judge/lasting/self_check.hpp"

#include "core/reading/scene_reader.hpp"
#include "tests/judge/lasting/cone_fit.hpp"
#include "tests/judge/lasting/touching.hpp"
#include "tests/judge/lasting/verdict.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace kairos::judge {
namespace {

constexpr double g = 9.8;

/// A motion made by hand, in a frame of its own: x down the incline, y away from it.
struct Case {
  std::string name;
  double angle = 0.0;  ///< of the incline, rad
  double friction = 0.0;
  std::string shape;
  double height = 0.0;  ///< of the centre above the surface, m
  double speed = 0.0;   ///< at the start, m/s
  double along = 0.0;   ///< acceleration down the incline, m/s^2
  double away = 0.0;    ///< acceleration away from it, m/s^2
  double spin = 0.0;    ///< at the start, about the axis that a ball rolls down by, rad/s
  double spinning_up = 0.0;
  double look = 1.0;  ///< factor of the friction that the judge is told
  std::function<void(std::vector<Motion>&)> spoil = {};
};

Verdict judged(const Case& c) {
  const double s = std::sin(c.angle);
  const double k = std::cos(c.angle);
  const Vector3 down(k, -s, 0.0);
  const Vector3 up(s, k, 0.0);
  const Model model(parse_scene(
      fmt::format(
          "duration = 1\nG = {}\nfriction = {}\n[[body]]\nname = \"floor\"\nentity = "
          "\"wall\"\nshape = \"half-space\"\nnormal = [{:.17g}, {:.17g}, 0]\n"
          "[[body]]\nname = \"it\"\nentity = \"body\"\nmass = 2\nposition = [0, 9, 0]\n{}\n",
          g, c.friction, s, k, c.shape),
      "self_check.toml"));
  const Pose pose{c.height * up, Quaternion(Eigen::AngleAxisd(-c.angle, Vector3::UnitZ()))};
  Motion motion = Motion::ballistic(Instant{}, 0.5, pose, {c.speed * down, Vector3::Zero()},
                                    c.along * down + c.away * up);
  if (c.spin != 0.0 || c.spinning_up != 0.0) {
    motion.rotation = RotationKind::polynomial;  // a ball: how it is turned is not looked at
    motion.angular_velocity =
        Polynomial<3>(Vector3(0.0, 0.0, -c.spin), Vector3(0.0, 0.0, -c.spinning_up));
  }
  std::vector<Motion> motions{motion, motion.shifted(0.5)};
  motions[1].duration = 0.5;
  motions[0].duration = 0.5;
  if (c.spoil) {
    c.spoil(motions);
  }
  Trajectory run;
  run.begin(model);
  run.motion(0, Motion::at_rest(Instant{}, {}));
  for (const Motion& m : motions) {
    run.motion(1, m);
  }
  EnergyLedger ledger;
  ledger.open(100.0, 0.0);
  ledger.exchange(100.0);
  Look look;
  look.times = 50;
  look.friction = c.look;
  return judge(model, run, Instant{1.0, 0.0}, ledger, look);
}

const std::string box = "half_extents = [0.2, 0.1, 0.3]";
const std::string ball = "shape = \"sphere\"\nradius = 0.1";

Case sliding_box(double mu = 0.3) {
  return {"a box slides down", 0.5, mu, box, 0.1, 1.0, g * (std::sin(0.5) - mu * std::cos(0.5))};
}
Case resting_box() { return {"a box rests", 0.25, 0.26, box, 0.1}; }
Case sliding_ball() {
  const double braking = 0.2 * g;
  return {"a ball slides on a floor", 0.0, 0.2, ball, 0.1, 8.0, -braking, 0.0, 5.0,
          2.5 * braking / 0.1};
}
/// Rolling asks for a friction of 2/7 tan(angle): the judge is told 0.5 % more.
Case rolling_ball() {
  const double a = 5.0 / 7.0 * g * std::sin(0.5);
  return {"a ball rolls down",
          0.5,
          1.005 * 2.0 / 7.0 * std::tan(0.5),
          ball,
          0.1,
          0.5,
          a,
          0.0,
          5.0,
          a / 0.1};
}

class Check {
 public:
  int failures = 0;

  void passes(const Case& c) {
    const Verdict v = judged(c);
    if (!v.right()) {
      fail(fmt::format("{}: right, and not passed: {} {}", c.name, v.refusal,
                       v.findings.empty() ? "" : to_string(v.findings[0].fault)));
    }
  }
  void caught(Case c, Fault fault, const std::string& how,
              const std::function<void(Case&)>& spoil) {
    spoil(c);
    const Verdict v = judged(c);
    const bool found = std::any_of(v.findings.begin(), v.findings.end(),
                                   [&](const Finding& f) { return f.fault == fault; });
    if (!found) {
      fail(fmt::format("{}, {}: passed, and is not right ({})", c.name, how, to_string(fault)));
    }
  }
  void equals(const std::string& what, Real is, Real expected, Real tolerance) {
    if (!(std::abs(is - expected) <= tolerance)) {
      fail(fmt::format("{}: {} instead of {}", what, static_cast<double>(is),
                       static_cast<double>(expected)));
    }
  }

 private:
  void fail(const std::string& what) {
    ++failures;
    fmt::print("self-check: {}\n", what);
  }
};

/// One point: what is nearest in a round cone is known in closed form.
void check_fit(Check& check) {
  for (const double mu : {0.0, 0.1, 0.5, 2.0}) {
    for (const double angle : {0.0, 0.05, 0.3, 1.0, 2.0, 3.0}) {
      ForceSet set;
      set.gives = Matrix::Identity();
      set.normal = Vector(0.36L, 0.48L, 0.8L);
      set.friction = mu;
      const Vector across = set.normal.cross(Vector(1, 2, -1)).normalized();
      const Column asked = std::cos(Real(angle)) * set.normal + std::sin(Real(angle)) * across;
      const Real edge = std::atan(Real(mu));
      const Real beyond = Real(angle) - edge;
      const Real left = beyond <= 0                              ? 0
                        : beyond >= std::numbers::pi_v<Real> / 2 ? 1
                                                                 : std::sin(beyond);
      check.equals(fmt::format("cone of {} at {}", mu, angle), fit({set}, asked).left.norm(), left,
                   1e-15L);
    }
  }
  // Four corners that carry a load outside of them tip: 1 on one side at arm 2, arms 1.
  std::vector<ForceSet> sets;
  for (const Real x : {-1, 1}) {
    ForceSet set;
    set.gives = Eigen::Matrix<Real, Eigen::Dynamic, 3>::Zero(2, 3);
    set.gives(0, 1) = 1;
    set.gives(1, 1) = x;
    set.normal = Vector(0, 1, 0);
    sets.push_back(set);
  }
  Column load(2);
  load << 1, 0.5L;
  check.equals("a load between two corners", fit(sets, load).left.norm(), 0, 1e-15L);
  load << 1, 2;
  check.equals("a load beyond them", fit(sets, load).left.norm(), std::sqrt(0.5L), 1e-15L);
}

/// Two edges at an angle of 1e-7 pass by each other at 1e-12 m of both coordinates: along the
/// normals of all faces the boxes overlap by 9e-9 m.
void check_edges(Check& check) {
  const double h = 0.125;
  const Real apart = 1e-12L;
  const Vector diagonal = Vector(1, 1, 0).normalized();
  const Moment a = moment_of(Motion::at_rest(Instant{}, Pose{}), 0);
  Moment b = a;
  b.position = Vector(2 * h + apart, 2 * h + apart, 0);
  b.turned = Eigen::AngleAxis<Real>(1e-7L, diagonal).toRotationMatrix();
  const Box cube{Vector3(h, h, h)};
  check.equals("edges that pass by each other", nearness(cube, a, cube, b, 0).gap,
               std::sqrt(Real(2)) * apart, 1e-18L);
}

void check_motions(Check& check) {
  for (const Case& c :
       {sliding_box(), sliding_box(0.0), resting_box(), sliding_ball(), rolling_ball()}) {
    check.passes(c);
  }
  for (const double factor : {0.99, 1.01}) {
    const auto by = [&](Case& c) { c.look = factor; };
    check.caught(sliding_box(), Fault::forces, "friction off by 1 %", by);
    check.caught(sliding_ball(), Fault::forces, "friction off by 1 %", by);
  }
  check.caught(rolling_ball(), Fault::forces, "with 1 % less friction than it takes",
               [](Case& c) { c.look = 0.99; });
  check.caught(resting_box(), Fault::forces, "on a slope that is too steep",
               [](Case& c) { c.friction = 0.25; });
  check.caught(resting_box(), Fault::forces, "accelerated by 1e-4 g",
               [](Case& d) { d.along += 1e-4 * g; });
  for (const Case& c : {sliding_box(), sliding_ball(), rolling_ball()}) {
    check.caught(c, Fault::forces, "accelerated by 1e-7 g more",
                 [](Case& d) { d.along += 1e-7 * g; });
  }
  for (const Case& c : {sliding_box(), resting_box(), sliding_ball(), rolling_ball()}) {
    check.caught(c, Fault::forces, "held at 1e-7 m", [](Case& d) { d.height += 1e-7; });
    check.caught(c, Fault::overlap, "sunk in by 1e-12 m", [](Case& d) { d.height -= 1e-12; });
    check.caught(c, Fault::strays, "its velocity is not its own", [](Case& d) {
      d.spoil = [](std::vector<Motion>& m) { m[1].velocity[0].z() += 1e-6; };
    });
    check.caught(c, Fault::jump, "jumps by 1e-6 m/s", [](Case& d) {
      d.spoil = [](std::vector<Motion>& m) {
        m[1].velocity[0].z() += 1e-6;
        m[1].position.resize(2);
        m[1].position[1].z() += 1e-6;
      };
    });
    check.caught(c, Fault::gap, "a motion ends too soon",
                 [](Case& d) { d.spoil = [](std::vector<Motion>& m) { m[1].duration = 0.25; }; });
    check.caught(c, Fault::gains, "driven by friction", [](Case& d) {
      d.along = g * (std::sin(d.angle) + d.friction * std::cos(d.angle));
      d.speed = 1.0;
    });
    check.caught(c, Fault::forces, "sticks to a ceiling",
                 [](Case& d) { d.angle += std::numbers::pi; });
  }
  check.caught(resting_box(), Fault::forces, "creeps along and is not slowed",
               [](Case& d) { d.speed = 1e-3; });
  check.caught(rolling_ball(), Fault::forces, "does not turn faster",
               [](Case& d) { d.spinning_up = 0.0; });
  check.caught(sliding_ball(), Fault::forces, "is not turned by friction",
               [](Case& d) { d.spinning_up = 0.0; });
}

}  // namespace

int self_check() {
  Check check;
  check_fit(check);
  check_edges(check);
  check_motions(check);
  fmt::print("self-check: {} failures\n", check.failures);
  return check.failures;
}

}  // namespace kairos::judge
