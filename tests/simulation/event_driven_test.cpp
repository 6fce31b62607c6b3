#include "ccd/shape_detector.hpp"
#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "simulation/registry.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

// Event-driven simulation: rest and what ends it, fields, drives, what it refuses to do, and that
// the order of bodies in a file changes no bit.

using namespace kairos;
using tests::of_kind;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

Simulation run(const std::string& text, const std::string& integrator = "auto",
               const std::string& law = "newton") {
  RunChoice choice;
  choice.method = {"event-driven", integrator, "certified", law};
  return simulate(parse_scene(text, "test.toml"), choice);
}

const std::string floor_body = R"(
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
)";

std::string ball(const std::string& name, const std::string& rest) {
  return "[[body]]\nname = \"" + name + "\"\nentity = \"ball\"\nradius = 0.5\n" + rest + "\n";
}

}  // namespace

TEST_CASE("an elastic ball keeps its energy and its impact times over 1000 bounces",
          "[event-driven]") {
  const double H = 4.5;
  const double G = 9.8;
  const auto sim = run("duration = 1917\nframe = 10\nG = 9.8\n" + floor_body +
                       ball("ball", "mass = 1.0\nposition = [0, 5.0, 0]"));
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const auto impacts = of_kind(sim.trajectory, EventKind::impact);
  REQUIRE(impacts.size() >= 1000);
  const double fall = std::sqrt(2.0 * H / G);
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    const double exact = (2.0 * static_cast<double>(k) + 1.0) * fall;
    CAPTURE(k);
    // A few ulp of the fall per bounce, rounded outwards: far below the 1e-12 that is promised.
    REQUIRE(std::abs(impacts[k].time.seconds / exact - 1.0) <= 1e-12);
    REQUIRE(impacts[k].contact.gap >= 0.0);
  }
  CHECK(std::abs(sim.result.ledger.energy() / sim.result.ledger.initial_energy() - 1.0) <= 1e-12);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("bounces with e = 0.5 die down at the Zeno time and the ball stays", "[event-driven]") {
  const auto sim = run("duration = 3\nframe = 0.1\nG = 9.8\n" + floor_body +
                       ball("ball", "mass = 1.0\nposition = [0, 1.5, 0]\nrestitution = 0.5"));
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const auto rest = of_kind(sim.trajectory, EventKind::contact_begins);
  REQUIRE(rest.size() == 1);
  CHECK(std::abs(rest[0].time.seconds - 1.3552618543578769) <= 1e-9);
  CHECK(of_kind(sim.trajectory, EventKind::contact_ends).empty());
  CHECK(sim.result.state[1].twist.linear.norm() == 0.0);
  // 1e-10 of the extent is what the settling height may be.
  CHECK(std::abs(sim.result.state[1].pose.position.y() - 0.5) <= 2e-10);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("Siconos' ball: 44 impacts before 8.5 s with e = 0.9, rest at 8.5789491787",
          "[event-driven]") {
  const auto sim = run("duration = 9\nframe = 0.1\nG = 9.81\n" + floor_body +
                       ball("ball", "mass = 1.0\nposition = [0, 1.5, 0]\nrestitution = 0.9"));
  int before = 0;
  double last = 0.0;
  for (const Event& impact : of_kind(sim.trajectory, EventKind::impact)) {
    if (impact.time.seconds < 8.5) {
      ++before;
      last = impact.time.seconds;
    }
  }
  CHECK(before == 44);
  CHECK(std::abs(last - 8.49137402565) <= 1e-10);  // the digits that are published
  const auto rest = of_kind(sim.trajectory, EventKind::contact_begins);
  REQUIRE(rest.size() == 1);
  CHECK(std::abs(rest[0].time.seconds - 8.5789491787) <= 1e-9);
}

TEST_CASE("a ball at rest on a tilted plane slides without friction: s = g sin(a) t^2 / 2",
          "[event-driven]") {
  // A half-space tilted by 0.3 rad about z; the ball starts touching it.
  const double a = 0.3;
  const auto digits = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", x);
    return std::string(text);
  };
  const double nx = -std::sin(a);
  const double ny = std::cos(a);
  const auto sim = run(
      "duration = 2\nframe = 0.1\nG = 9.8\n[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape "
      "= \"half-space\"\naxis_angle = [0, 0, 1, 0.3]\n" +
      ball("ball",
           "mass = 2.0\nposition = [" + digits(0.5 * nx) + ", " + digits(0.5 * ny) + ", 0]"));
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const BodyState& end = sim.result.state[1];
  const double speed = 9.8 * std::sin(a) * 2.0;
  CHECK(std::abs(end.twist.linear.norm() - speed) <= 1e-12 * speed);  // a parabola: roundoff
  CHECK(std::abs(Vector3(nx, ny, 0.0).dot(end.pose.position) - 0.5) <= 1e-12);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("a ball slides off the edge of a box and falls", "[event-driven]") {
  const auto sim = run(
      "duration = 3\nframe = 0.1\nG = 9.8\n[[body]]\nname = \"table\"\nentity = "
      "\"wall\"\nhalf_extents = [1, 0.5, 1]\nposition = [0, -0.5, 0]\n" +
      ball("ball", "mass = 1.0\nposition = [0, 0.5, 0]\nvelocity = [5, 0, 0]\nrestitution = 0.5"));
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const auto leaves = of_kind(sim.trajectory, EventKind::contact_ends);
  REQUIRE(leaves.size() == 1);
  CHECK(std::abs(leaves[0].time.seconds - 0.2) <= 1e-12);  // 1 m at 5 m/s
  const BodyState& end = sim.result.state[1];
  CHECK(std::abs(end.pose.position.x() - 15.0) <= 1e-9);
  CHECK(std::abs(end.pose.position.y() - (0.5 - 4.9 * 2.8 * 2.8)) <= 1e-9);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("a ball on a vibrating table lifts off where the table draws away", "[event-driven]") {
  // y = 0.05 sin(2 pi 4 t): A w^2 = 31.6 m/s^2 > g, so that the ball leaves where
  // A w^2 sin(w t) = g: t = asin(g / (A w^2)) / w.
  const double w = 2.0 * M_PI * 4.0;
  const auto sim =
      run("duration = 0.05\nframe = 0.01\nG = 9.8\n[[body]]\nname = \"table\"\nentity = "
          "\"bat\"\nmass = 1\nhalf_extents = [1, 0.1, 1]\nposition = [0, 0, "
          "0]\n[body.drive]\namplitude = [0, "
          "0.05, 0]\nfrequency = 4\n" +
          ball("ball", "mass = 1.0\nposition = [0, 0.6, 0]\nvelocity = [0, " +
                           std::to_string(0.05 * w) + ", 0]\nrestitution = 0.0"));
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const auto leaves = of_kind(sim.trajectory, EventKind::contact_ends);
  REQUIRE(leaves.size() == 1);
  CHECK(std::abs(leaves[0].time.seconds - std::asin(9.8 / (0.05 * w * w)) / w) <= 1e-6);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("a pad is entered and left at located times, and its work is booked", "[event-driven]") {
  // Gravity -9.8, pad +19.6: above the pad the ball falls, inside it is decelerated by +9.8.
  const auto sim =
      run("duration = 4\nframe = 0.1\nG = 9.8\n[[body]]\nname = \"pad\"\nentity = "
          "\"anti-gravity-pad\"\nhalf_extents = [1, 1, 1]\nposition = [0, 0, 0]\n[[body]]\nname = "
          "\"ball\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\nposition = [0, 2.1, 0]\n");
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const auto enters = of_kind(sim.trajectory, EventKind::field_entered);
  const auto leaves = of_kind(sim.trajectory, EventKind::field_left);
  REQUIRE(enters.size() >= 1);
  REQUIRE(leaves.size() >= 1);
  // A fall of 1 m, then as long again to a stop 1 m deeper, and back.
  const double fall = std::sqrt(2.0 / 9.8);
  CHECK(std::abs(enters[0].time.seconds - fall) <= 1e-8);
  CHECK(std::abs(leaves[0].time.seconds - 3.0 * fall) <= 1e-7);
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::field_work)) > 0.0);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("Newton's cradle: n in, n out", "[event-driven]") {
  for (const int n : {1, 2, 3}) {
    std::string text = "duration = 2\nframe = 0.1\nG = 0\n";
    for (int k = 0; k < 5; ++k) {
      // The first n come in with a gap of 1 m in front of the rest; all others touch.
      const double x = k < n ? k - 1.0 : k;
      text += ball("ball" + std::to_string(k), "mass = 1.0\nposition = [" + std::to_string(x) +
                                                   ", 0, 0]\nvelocity = [" +
                                                   std::string(k < n ? "1" : "0") + ", 0, 0]");
    }
    const auto sim = run(text);
    INFO(sim.result.reason);
    REQUIRE(sim.result.status == RunStatus::completed);
    for (int k = 0; k < 5; ++k) {
      CAPTURE(n, k);
      const double expected = k >= 5 - n ? 1.0 : 0.0;
      CHECK(std::abs(sim.result.state[static_cast<std::size_t>(k)].twist.linear.x() - expected) <=
            4.0 * eps);
    }
  }
}

TEST_CASE("the thesis' conveyor swallows a light ball: the run stops and says so",
          "[event-driven]") {
  const auto sim =
      run("duration = 2\nframe = 0.1\nG = 9.8\n[[body]]\nname = \"belt\"\nentity = "
          "\"conveyor\"\nhalf_extents = [1, 0.1, 1]\n" +
              ball("ball", "mass = 1.0\nposition = [0, 2, 0]"),
          "auto", "thesis");
  CHECK(sim.result.status == RunStatus::stopped);
  CHECK(sim.result.reason.find("still approaching") != std::string::npos);
  CHECK(sim.result.reason.find("'belt'") != std::string::npos);
  tests::check_explained(sim.result.ledger);  // the last frame shows what the last impact left
}

TEST_CASE("a box that lands tilted rocks to rest", "[event-driven]") {
  const auto sim = run("duration = 20\nframe = 0.1\nG = 9.8\n" + floor_body + R"(
[[body]]
name = "box"
entity = "body"
half_extents = [0.2, 0.2, 0.2]
mass = 1.0
position = [0, 1, 0]
axis_angle = [0, 0, 1, 0.2]
restitution = 0.3
)");
  INFO(sim.result.reason);
  CHECK(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  CHECK(sim.result.cost.impacts > 3);  // it fell and bounced first
  CHECK(sim.result.state[1].twist.angular.isZero(0.0));
}

TEST_CASE("the order of bodies in the file changes no bit", "[event-driven]") {
  const std::string a = ball("a", "mass = 1.0\nposition = [0, 3, 0]\nvelocity = [0.3, 0, 0.1]");
  const std::string b = ball("b", "mass = 2.0\nposition = [1.1, 5, 0]\nrestitution = 0.9");
  const std::string c = ball("c", "mass = 0.5\nposition = [0.4, 7, 0.2]");
  const auto one = run("duration = 5\nframe = 0.1\nG = 9.8\n" + floor_body + a + b + c);
  const auto two = run("duration = 5\nframe = 0.1\nG = 9.8\n" + c + b + floor_body + a);
  REQUIRE(one.trajectory.events().size() == two.trajectory.events().size());
  for (std::size_t k = 0; k < one.trajectory.events().size(); ++k) {
    REQUIRE(one.trajectory.events()[k].time == two.trajectory.events()[k].time);
  }
  CHECK(one.result.state[3].pose.position == two.result.state[0].pose.position);  // c
  CHECK(one.result.ledger.energy() == two.result.ledger.energy());
}

TEST_CASE("both contacts of a fast bat within one frame are found", "[event-driven]") {
  // x = 0.4 sin(2 pi 8 t): the bat sweeps through the ball's place twice within 1/60 s.
  const auto sim = run(
      "duration = 1\nframe = 0.5\nG = 0\n[[body]]\nname = \"bat\"\nentity = \"bat\"\nmass = "
      "1000\nhalf_extents = [0.0075, 0.08, 0.08]\n[body.drive]\namplitude = [0.4, 0, 0]\nfrequency "
      "= 8\n[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = 0.02\nmass = 0.0027\nposition = "
      "[0.2, 0, 0]\n");
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  CHECK(of_kind(sim.trajectory, EventKind::impact).size() >= 1);
  CHECK(sim.result.state[1].pose.position.x() > 0.4);  // driven away, never passed
  tests::check_explained(sim.result.ledger);
}

namespace {

/// Never decides, and never gets on: every answer is good for 1e-30 s.
class Hesitant final : public ccd::ShapeDetector {
 public:
  [[nodiscard]] DetectorInfo info() const override {
    return {.name = "hesitant", .locates = true, .proves = true, .summary = ""};
  }

 private:
  [[nodiscard]] TimeOfImpact ordered_time_of_impact(const MovingShape& /*a*/,
                                                    const MovingShape& /*b*/,
                                                    const Window& /*window*/,
                                                    double /*tolerance*/) const override {
    return {.status = ToiStatus::undecided, .t_hi = 1e-30, .normal = -Vector3::UnitY()};
  }
};

}  // namespace

TEST_CASE("event-driven: a detector that never gets on is an accumulation, not a hang",
          "[event-driven]") {
  const Model model(parse_scene(
      floor_body + ball("ball", "mass = 1.0\nposition = [0, 1, 0]\nvelocity = [0, 1, 0]"),
      "test.toml"));
  const Method method{.stepper = find_integrator("closed-form"),
                      .detector = std::make_shared<Hesitant>(),
                      .law = find_impact_law("newton"),
                      .broad_phase = find_broad_phase(model.broad_phase()),
                      .swept_bounds = swept_bounds(),
                      .neighbourhood = find_neighbourhood(model.broad_phase())};
  Trajectory trajectory;
  const RunResult result =
      find_scheme("event-driven")
          ->run(model, method, {.frames = FixedFrames{1.0 / 60.0}}, trajectory);
  CHECK(result.status == RunStatus::stopped);
  CAPTURE(result.reason);
  CHECK(result.reason.starts_with("accumulation: whether"));
}
