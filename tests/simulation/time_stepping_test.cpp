// The schemes that step over contacts, against what is known: sliding, rolling, sticking, rebound,
// sinking, belts; and what their books say of it.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/locations.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace kairos;

namespace {

const std::vector<std::string> stepping{"moreau-jean", "pgs", "xpbd", "penalty"};

/// A body, and a floor through the origin unless `ground` is another.
Scene scene_of(const std::string& top, const std::string& thing,
               const std::string& ground = "entity = \"wall\"\nshape = \"half-space\"\n") {
  return parse_scene(top + "\n[[body]]\nname = \"ground\"\n" + ground +
                         "[[body]]\nname = \"thing\"\nentity = \"body\"\nmass = 1.0\n" + thing,
                     "");
}

RunChoice with(const std::string& scheme, double frame, double duration) {
  RunChoice choice;
  choice.method.scheme = scheme;
  choice.frames = FixedFrames{frame};
  choice.duration = duration;
  return choice;
}

Simulation run(const Scene& scene, const RunChoice& choice) {
  Simulation s = simulate(scene, choice);
  CHECK(s.result.status == RunStatus::completed);
  tests::check_explained(s.result.ledger);
  return s;
}

/// A flat block that slides with 3 m/s, mu = 0.3, across both axes.
Scene sliding_block() {
  return scene_of("friction = 0.3",
                  "half_extents = [0.5, 0.001, 0.5]\nposition = [0, 0.001, 0]\n"
                  "velocity = [1.8, 0, 2.4]\nrestitution = 0\n");
}

double slid(const std::string& scheme, double frame) {
  const Simulation s = run(sliding_block(), with(scheme, frame, 1.5));
  CHECK(s.result.state[1].twist.linear.norm() <= 1e-3);
  const Vector3 p = s.result.state[1].pose.position;
  return std::hypot(p.x(), p.z());
}

/// A block on an incline of 30 degrees.
Scene on_incline(double mu) {
  return scene_of("friction = " + std::to_string(mu),
                  "half_extents = [0.2, 0.1, 0.2]\nrestitution = 0\n"
                  "position = [0.05, 0.08660254037844387, 0]\n"
                  "axis_angle = [0, 0, 1, -0.5235987755982988]\n",
                  "entity = \"wall\"\nshape = \"half-space\"\n"
                  "normal = [0.5, 0.8660254037844387, 0]\n");
}

double along_incline(const Simulation& s) {
  const Vector3 moved = s.result.state[1].pose.position - Vector3(0.05, 0.08660254037844387, 0.0);
  return moved.dot(Vector3(0.8660254037844387, -0.5, 0.0));
}

/// Boxes on each other, with sides of 0.5 m.
Scene stack_of(int boxes) {
  std::string text =
      "friction = 0.5\n[[body]]\nname = \"floor\"\nentity = \"wall\"\n"
      "shape = \"half-space\"\n";
  for (int k = 0; k < boxes; ++k) {
    text += "[[body]]\nname = \"box" + std::to_string(k) +
            "\"\nentity = \"body\"\nmass = 1\nrestitution = 0\n"
            "half_extents = [0.25, 0.25, 0.25]\nposition = [0, " +
            std::to_string(0.25 + 0.5 * k) + ", 0]\n";
  }
  return parse_scene(text, "");
}

Scene falling_ball(double e) {
  return scene_of(
      "", "radius = 0.5\nposition = [0, 5.4, 0]\nrestitution = " + std::to_string(e) + "\n");
}

}  // namespace

TEST_CASE("stepping: a sliding block stops where Coulomb says, to the order of the step",
          "[stepping]") {
  const double a = 0.3 * 9.8;
  const double cone = 9.0 / (2.0 * a);
  // A pyramid stops each axis by itself.
  const double pyramid = std::hypot(1.8 * 1.8 / (2.0 * a), 2.4 * 2.4 / (2.0 * a));
  for (const double h : {1.0 / 50.0, 1.0 / 120.0, 1.0 / 500.0}) {
    CAPTURE(h);
    // theta = 1/2: exact as long as it slides; the step in which it stops errs by a h^2/8 at most.
    CHECK(std::abs(slid("moreau-jean", h) - cone) <= 0.125 * a * h * h + 1e-9);
    // Symplectic Euler moves with the velocity at the end of a step: v0 h/2 too short, order 1.
    CHECK(std::abs(slid("pgs", h) - pyramid) <= 0.55 * 3.0 * h);
    // xpbd the same in 20 substeps; its friction asks for the load of the position solve alone,
    // while the tipping moment is borne in the velocity solve: mu hy/hx of the distance.
    CHECK(std::abs(slid("xpbd", h) - cone) <= 0.55 * 3.0 * h / 20.0 + 2.0 * 0.3 * 0.002 * cone);
    // penalty in 100; slip below the stiction velocity v_s dies out in v_s^2/(2 a) more.
    CHECK(std::abs(slid("penalty", h) - cone) <= 0.55 * 3.0 * h / 100.0 + 1e-4 / (2.0 * a) + 1e-5);
  }
}

TEST_CASE("stepping: what a block loses by sliding is in the ledger's line friction",
          "[stepping][energy]") {
  const Simulation s = run(sliding_block(), with("moreau-jean", 1.0 / 60.0, 1.5));
  const EnergyLedger& ledger = s.result.ledger;
  const double rubbed =
      ledger.line(EnergyLine::friction) + ledger.line(EnergyLine::impact_friction);
  CHECK(std::abs(rubbed + 4.5) <= 1e-9);  // all of m v^2/2; solver tolerance
  CHECK(std::abs(ledger.line(EnergyLine::restitution_loss)) <= 1e-9);
  for (const std::string& scheme : stepping) {
    CAPTURE(scheme);
    const Simulation of = run(sliding_block(), with(scheme, 1.0 / 60.0, 1.5));
    CHECK(of.result.ledger.line(EnergyLine::friction) <= 0.0);
  }
}

TEST_CASE("stepping: a sliding ball ends up rolling with 5/7 of its velocity", "[stepping]") {
  const Scene scene = scene_of("friction = 0.2",
                               "radius = 0.5\nposition = [0, 0.5, 0]\n"
                               "velocity = [7, 0, 0]\nrestitution = 0\n");
  for (const std::string& scheme : stepping) {
    CAPTURE(scheme);
    const BodyState ball = run(scene, with(scheme, 1.0 / 60.0, 1.5)).result.state[1];
    // Within what one step of friction changes, mu g h; penalty and xpbd: of a substep.
    CHECK(std::abs(ball.twist.linear.x() - 5.0) <= 0.2 * 9.8 / 60.0);
    CHECK(std::abs(ball.twist.angular.z() + 10.0) <= 0.2 * 9.8 / 60.0 / 0.5);
  }
  // The solver for the exact cone knows no step here: sticking is sticking.
  const BodyState ball = run(scene, with("moreau-jean", 1.0 / 60.0, 1.5)).result.state[1];
  CHECK(std::abs(ball.twist.linear.x() - 5.0) <= 1e-9);
}

TEST_CASE("stepping: a block on an incline slides as it should, sticks, or creeps", "[stepping]") {
  // 2 m in 1.11758177245 s at mu = 0.2. The first step has half of the acceleration of the others
  // where it ends in one; theta = 1/2 is exact.
  CHECK(
      std::abs(along_incline(run(on_incline(0.2), with("moreau-jean", 1.0 / 60.0, 1.11758177245))) -
               2.0) <= 1e-9);
  const auto stuck = [](const std::string& scheme) {
    return along_incline(run(on_incline(0.6), with(scheme, 1.0 / 60.0, 10.0)));
  };
  CHECK(std::abs(stuck("moreau-jean")) <= 1e-9);
  CHECK(std::abs(stuck("pgs")) <= 1e-4);  // while ten sweeps have not found the impulses
  // Regularised friction holds only while something slips: v = v_s tan(30 deg)/mu for ever.
  CHECK(std::abs(stuck("penalty") / (10.0 * 0.01 * std::tan(M_PI / 6.0) / 0.6) - 1.0) <= 1e-3);
}

TEST_CASE("stepping: a ball rebounds with e times its velocity, and the loss is booked",
          "[stepping][energy]") {
  for (const double e : {0.0, 0.5, 1.0}) {
    for (const std::string scheme : {"moreau-jean", "pgs", "xpbd"}) {
      CAPTURE(scheme, e);
      RunChoice choice = with(scheme, 1.0 / 60.0, 1.1);
      const Simulation s = run(falling_ball(e), choice);
      REQUIRE(s.trajectory.events().size() >= 1);
      const Event& impact = s.trajectory.events().front();
      const double before = impact.before_b.twist.linear.y();
      const double after = impact.after_b.twist.linear.y();
      // xpbd takes the velocity that gravity has given in the substep too.
      const double kicked = scheme == "xpbd" ? before - 9.8 / 1200.0 : before;
      // pgs pushes what has sunk in apart, where that is faster: Baumgarte's beta/h (depth - slop).
      const double pushed =
          scheme == "pgs" ? 0.2 * 60.0 * std::max(-impact.contact.gap - 0.005, 0.0) : 0.0;
      CHECK(std::abs(after - std::max(-e * kicked, pushed)) <= 1e-9);
      // The book of the impact: m (v'^2 - v^2)/2, but for what gravity did in the step.
      const double change = 0.5 * (after * after - before * before);
      const double told = s.result.ledger.line(EnergyLine::restitution_loss);
      const double corrected = s.result.ledger.line(EnergyLine::position_correction);
      CHECK(std::abs(told + corrected - change) <= 10.0 * 9.8 / 60.0);
    }
  }
}

TEST_CASE("stepping: what comes near slowly and then touches has one impact", "[stepping]") {
  const Scene scene = scene_of("G = 0",
                               "radius = 0.5\nposition = [0, 0.52, 0]\n"
                               "velocity = [0, -0.1, 0]\nrestitution = 0\n");
  for (const std::string& scheme : stepping) {
    CAPTURE(scheme);
    // pgs sees it from 5 mm on, three steps before it touches.
    CHECK(run(scene, with(scheme, 1.0 / 60.0, 0.5)).result.cost.impacts == 1);
  }
}

TEST_CASE("stepping: stacks sink as far as their scheme lets them", "[stepping]") {
  const auto sunk = [](const std::string& scheme) {
    std::vector<double> depths;
    const Simulation s = run(stack_of(3), with(scheme, 1.0 / 60.0, 2.0));
    double below = -0.25;
    for (std::size_t k = 1; k <= 3; ++k) {
      const double y = s.result.state[k].pose.position.y();
      depths.push_back(below + 0.5 - y);
      below = y;
    }
    return depths;
  };
  for (const double depth : sunk("moreau-jean")) {
    CHECK(std::abs(depth) <= 1e-9);  // it rests from the first step on: solver tolerance
  }
  for (const double depth : sunk("pgs")) {
    CHECK(std::abs(depth) <= 0.005);  // slop
  }
  for (const double depth : sunk("xpbd")) {
    CHECK(std::abs(depth) <= 1e-3);
  }
  // Four springs of k d^(3/2) bear what is above them.
  const std::vector<double> depths = sunk("penalty");
  for (std::size_t k = 0; k < 3; ++k) {
    const double load = static_cast<double>(3 - k) * 9.8;
    CHECK(std::abs(depths[k] / std::pow(load / 4e6, 2.0 / 3.0) - 1.0) <= 1e-3);
  }
}

TEST_CASE("stepping: a belt carries by friction, and the ledger says who did the work",
          "[stepping][energy]") {
  const Scene scene = scene_of("friction = 0.5",
                               "half_extents = [0.5, 0.1, 0.5]\nposition = [0, 0.1, 0]\n"
                               "restitution = 0\n",
                               "entity = \"conveyor\"\nshape = \"half-space\"\nbelt_speed = 1.0\n");
  for (const std::string& scheme : stepping) {
    CAPTURE(scheme);
    const Simulation s = run(scene, with(scheme, 1.0 / 60.0, 2.0));
    const EnergyLedger& ledger = s.result.ledger;
    // xpbd jitters: 1e-3 of the speed.
    CHECK(std::abs(s.result.state[1].twist.linear.x() - 1.0) <= 1e-3);
    // The belt gives twice what the box takes up; the other half is rubbed away.
    CHECK(std::abs(ledger.line(EnergyLine::conveyor_and_hand) - 1.0) <= 1e-2);
    CHECK(std::abs(ledger.line(EnergyLine::friction) + ledger.line(EnergyLine::impact_friction) +
                   0.5) <= 1e-2);
  }
}

TEST_CASE("stepping: what does not fit is refused with a reason", "[stepping]") {
  const Model block(sliding_block());
  const auto refused = [&](RunChoice choice, const std::string& why) {
    const std::string reason = why_refused(block, choice);
    CAPTURE(reason, why);
    CHECK(reason.find(why) != std::string::npos);
  };
  for (const std::string& scheme : stepping) {
    RunChoice choice = with(scheme, 0.01, 1.0);
    CHECK(why_refused(block, choice).empty());
    choice.method.integrator = "rk4";
    refused(choice, "integrator 'rk4' has no part in it; allowed: auto");
    choice.method = {scheme, "auto", "certified", "thesis"};
    refused(choice, "impact law 'thesis'");
  }
  refused(with("original", 0.01, 1.0), "friction");
  const Model rally(read_scene(tests::source_path("scenes/table-tennis.toml")));
  CHECK(why_refused(rally, with("pgs", 0.01, 1.0)).find("hands") != std::string::npos);
  const Model rough(scene_of("friction = inf", "radius = 0.5\nposition = [0, 0.5, 0]\n"));
  CHECK(why_refused(rough, with("penalty", 0.01, 1.0)).find("rough") != std::string::npos);
  CHECK(why_refused(rough, with("moreau-jean", 0.01, 1.0)).empty());
}
