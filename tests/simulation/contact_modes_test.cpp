// Contact that lasts, in event-driven runs: who is held, until when, and that nothing else happens.

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/penetration.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"
#include "tests/simulation/ledger_check.hpp"
#include "tests/simulation/whole_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace kairos;
using tests::of_kind;

namespace {

constexpr double g = 9.8;

Simulation run(const std::string& text, const RunChoice& choice = {}) {
  return simulate(parse_scene(text, "test.toml"), choice);
}

std::string head(double duration) {
  return fmt::format("duration = {}\nframe = {}\nG = {}\n", duration, duration / 64.0, g);
}

std::string plane(const std::string& name, const std::string& normal = "[0, 1, 0]") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = {}\n", name,
      normal);
}

std::string cube(const std::string& name, const std::string& position, double e = 0.5,
                 const std::string& rest = "") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = [0.1, 0.1, 0.1]\nmass = "
      "1.0\nrestitution = {}\nposition = {}\n{}\n",
      name, e, position, rest);
}

std::string ball(const std::string& name, const std::string& position, double e = 0.5,
                 const std::string& rest = "") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\nrestitution = "
      "{}\nposition = {}\n{}\n",
      name, e, position, rest);
}

std::string stack(int n, bool reversed = false) {
  std::vector<std::string> cubes;
  for (int k = 0; k < n; ++k) {
    cubes.push_back(cube(fmt::format("c{:03}", k), fmt::format("[0, {}, 0]", 0.1 + 0.2 * k)));
  }
  if (reversed) {
    std::reverse(cubes.begin(), cubes.end());
  }
  std::string text;
  for (const std::string& c : cubes) {
    text += c;
  }
  return text;
}

/// It ran to its end, the ledger balances, and nothing is inside anything.
void check_whole(const Simulation& sim, const std::string& text) {
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  const Model model(parse_scene(text, "test.toml"));
  CHECK_FALSE(PenetrationProbe(model).first(sim.result.state));
}

}  // namespace

TEST_CASE("a box placed on a floor stays, bit for bit", "[modes]") {
  const std::string text = head(1e4) + plane("floor") + cube("box", "[0.3, 0.1, 0.2]");
  const auto sim = run(text);
  check_whole(sim, text);
  CHECK(sim.result.cost.impacts == 0);
  CHECK(sim.result.state[1].pose.position == Vector3(0.3, 0.1, 0.2));
  CHECK(sim.result.state[1].twist.linear == Vector3(0, 0, 0));
  CHECK(of_kind(sim.trajectory, EventKind::contact_begins).size() == 1);
}

TEST_CASE("stacks of 10 and 100 stand for 1e4 s: identical bits, no event after the first instant",
          "[modes][reference]") {
  for (const int n : {10, 100}) {
    CAPTURE(n);
    const std::string text = head(1e4) + plane("floor") + stack(n);
    const Scene scene = parse_scene(text, "test.toml");
    const auto sim = run(text);
    check_whole(sim, text);
    CHECK(sim.result.cost.impacts == 0);
    CHECK(sim.result.cost.events == n);
    CHECK(sim.trajectory.events().back().time == Instant{});
    for (BodyIndex i = 1; i < scene.bodies.size(); ++i) {
      CHECK(sim.result.state[i].pose.position == scene.bodies[i].initial.pose.position);
      CHECK(sim.result.state[i].twist.linear == Vector3(0, 0, 0));
    }
  }
}

TEST_CASE("a box that falls flat: its bounces are completed at their limit", "[modes][zeno]") {
  // h = 0.4 above touch, e = 0.5: t (1 + 2 e / (1 - e)) = 3 sqrt(2 h / g).
  const std::string text = head(5.0) + plane("floor") + cube("box", "[0, 0.5, 0]");
  const auto sim = run(text);
  check_whole(sim, text);
  const auto begins = of_kind(sim.trajectory, EventKind::contact_begins);
  REQUIRE(begins.size() == 1);
  CHECK(std::abs(begins[0].time.seconds - 3.0 * std::sqrt(2.0 * 0.4 / g)) <= 1e-9);
  const double completed = sim.result.ledger.line(EnergyLine::zeno_completion);
  CHECK(completed < 0.0);
  CHECK(completed > -1e-9);  // a hop of 1e-10 of the extent
  CHECK(sim.result.state[1].twist.linear == Vector3(0, 0, 0));
}

TEST_CASE("a box dropped on a resting box comes to rest on it, wherever its middle is over it",
          "[modes]") {
  for (const char* at : {"[0, 0.7, 0]", "[0.02, 0.7, 0.01]", "[0.09, 0.7, -0.05]"}) {
    CAPTURE(at);
    const std::string text =
        head(5.0) + plane("floor") + cube("lower", "[0, 0.1, 0]") + cube("upper", at);
    const auto sim = run(text);
    check_whole(sim, text);
    CHECK(sim.result.state[1].pose.position == Vector3(0.0, 0.1, 0.0));
    CHECK(std::abs(sim.result.state[2].pose.position.y() - 0.3) <= 1e-9);
    CHECK(sim.result.state[2].twist.linear == Vector3(0, 0, 0));
  }
}

TEST_CASE("a ball on a resting box, and one above it", "[modes]") {
  const std::string on =
      head(5.0) + plane("floor") + cube("box", "[0, 0.1, 0]") + ball("ball", "[0, 0.3, 0]");
  check_whole(run(on), on);
  const std::string above = head(5.0) + plane("floor") + cube("box", "[0, 0.1, 0]") +
                            ball("ball", "[0.02, 0.6, 0.01]", 1.0);
  const auto sim = run(above);
  check_whole(sim, above);
  // The box carries the impacts to the floor, and the ball bounces as on the floor itself.
  const auto begins = of_kind(sim.trajectory, EventKind::contact_begins);
  REQUIRE(begins.size() == 2);
  CHECK(std::abs(begins[1].time.seconds - 3.0 * std::sqrt(2.0 * 0.3 / g)) <= 1e-9);
  CHECK(sim.result.state[1].pose.position == Vector3(0.0, 0.1, 0.0));
}

TEST_CASE("a pyramid stands: who carries what is not told by one patch alone", "[modes]") {
  std::string text = head(100.0) + plane("floor");
  for (int row = 0; row < 4; ++row) {
    for (int k = 0; k < 4 - row; ++k) {
      text += cube(fmt::format("p{}{}", row, k),
                   fmt::format("[{}, {}, 0]", 0.25 * (k + 0.5 * row), 0.1 + 0.2 * row));
    }
  }
  const auto sim = run(text);
  check_whole(sim, text);
  CHECK(sim.result.cost.impacts == 0);
}

TEST_CASE("overhang of four boxes: stands at 0.999 of 25/24 of a length, tips at 1.001",
          "[modes][reference][slow]") {
  // Lengths of 0.2; the k-th from the top is over the one below by 1/(2k) of a length, the lowest
  // over the edge of a table.
  for (const double share : {0.999, 1.001}) {
    CAPTURE(share);
    std::string text = head(10.0) +
                       "[[body]]\nname = \"table\"\nentity = \"wall\"\nhalf_extents = [1, 0.5, "
                       "1]\nposition = [-1, -0.5, 0]\n";
    double x = -0.1;  // of the lowest, flush with the edge
    for (int k = 4; k >= 1; --k) {
      x += share * 0.2 / (2.0 * k);
      text += cube(fmt::format("b{}", k), fmt::format("[{}, {}, 0]", x, 0.1 + 0.2 * (4 - k)));
    }
    const auto sim = run(text);
    INFO(sim.result.reason);
    if (share < 1.0) {
      check_whole(sim, text);
    } else {
      // They tip together, over the edge, and then tumble; where that is followed no further the
      // run says so.
      double tipped = 0.0;
      for (std::size_t k = 0; k < sim.trajectory.frame_times().size() && tipped == 0.0; ++k) {
        const Quaternion& top = sim.trajectory.frame_state(k)[4].pose.orientation;
        const double y = (top * Vector3::UnitX()).y();
        tipped = std::abs(y) > 1e-3 ? y : 0.0;
      }
      CHECK(tipped < 0.0);
      CHECK((sim.result.status == RunStatus::completed ||
             sim.result.reason.find("allowed: ") != std::string::npos));
    }
  }
}

TEST_CASE("a ball in a groove comes to rest, or slides along it for ever", "[modes]") {
  for (const double speed : {0.0, 2.0}) {
    for (const double e : {0.0, 0.5, 0.9}) {
      CAPTURE(speed, e);
      const std::string text =
          head(60.0) + plane("left", "[1, 1, 0]") + plane("right", "[-1, 1, 0]") +
          ball("ball", "[0.05, 1.0, 0]", e, fmt::format("velocity = [0, 0, {}]", speed));
      const auto sim = run(text);
      check_whole(sim, text);
      const BodyState& s = sim.result.state[2];
      CHECK((s.twist.linear - Vector3(0, 0, speed)).norm() <= 1e-12);
      CHECK(std::abs(s.pose.position.z() - speed * 60.0) <= 1e-9);
      CHECK(std::abs(s.pose.position.y() - 0.1 * std::sqrt(2.0)) <= 1e-8);
    }
  }
}

TEST_CASE("a block on an incline slides down on a parabola", "[modes]") {
  const double angle = M_PI / 6.0;
  const Vector3 up(std::sin(angle), std::cos(angle), 0.0);
  const Vector3 start = 0.1 * up;
  const std::string text = head(3.0) +
                           plane("incline", fmt::format("[{}, {}, 0]", up.x(), up.y())) +
                           cube("block", fmt::format("[{}, {}, 0]", start.x(), start.y()), 0.5,
                                "axis_angle = [0, 0, 1, -0.5235987755982988]");
  const auto sim = run(text);
  check_whole(sim, text);
  CHECK(sim.result.cost.impacts == 0);
  const Vector3 way = sim.result.state[1].pose.position - start;
  CHECK(std::abs(way.norm() - 0.5 * g * std::sin(angle) * 9.0) <= 1e-12);
  CHECK(std::abs(way.dot(up)) <= 1e-13);
}

TEST_CASE("a box slides to the rim of a table: where its weight comes over it, it tips and falls",
          "[modes]") {
  const std::string text = head(3.0) +
                           "[[body]]\nname = \"table\"\nentity = \"wall\"\nhalf_extents = [1, 0.5, "
                           "1]\n" +
                           cube("box", "[0, 0.6, 0]", 0.5, "velocity = [2, 0, 0]");
  const auto sim = run(text);
  check_whole(sim, text);
  double turns = 3.0;  // from when on it does, s
  for (std::size_t k = sim.trajectory.frame_times().size(); k-- > 0;) {
    if (!sim.trajectory.frame_state(k)[1].twist.angular.isZero(0.0)) {
      turns = sim.trajectory.frame_times()[k].seconds;
    }
  }
  CHECK(turns > 0.5);
  CHECK(turns < 0.6);
  CHECK(sim.result.state[1].pose.position.y() < -1.0);
}

TEST_CASE("a ball slides over a box and off it", "[modes]") {
  const std::string text = head(2.0) + plane("floor") + cube("box", "[0, 0.1, 0]") +
                           ball("ball", "[0, 0.3, 0]", 0.5, "velocity = [2, 0, 0]");
  const auto sim = run(text);
  INFO(sim.result.reason);
  const auto ends = of_kind(sim.trajectory, EventKind::contact_ends);
  REQUIRE_FALSE(ends.empty());
  CHECK(std::abs(ends[0].time.seconds - 0.05) <= 1e-14);
  CHECK(sim.result.state[1].pose.position == Vector3(0.0, 0.1, 0.0));
}

TEST_CASE("cradle in touch: laws of groups", "[modes][reference]") {
  const std::string text = "duration = 2\nframe = 0.1\nG = 0\n" +
                           ball("a", "[-1, 0, 0]", 1.0, "velocity = [1, 0, 0]") +
                           ball("b", "[0, 0, 0]", 1.0) + ball("c", "[0.2, 0, 0]", 1.0);
  RunChoice choice;
  choice.method.impact = "reflections";
  auto sim = run(text, choice);
  check_whole(sim, text);
  CHECK(std::abs(sim.result.state[2].twist.linear.x() - 1.0) <= 1e-12);
  CHECK(std::abs(sim.result.state[0].twist.linear.x()) <= 1e-12);
  choice.method.impact = "moreau";
  sim = run(text, choice);
  check_whole(sim, text);
  CHECK(std::abs(sim.result.state[0].twist.linear.x() + 1.0 / 3.0) <= 1e-12);
  CHECK(std::abs(sim.result.state[2].twist.linear.x() - 2.0 / 3.0) <= 1e-12);
}

TEST_CASE("where bodies stand in the file changes no bit", "[modes][invariance]") {
  const std::string falls = ball("z-ball", "[0.02, 2.6, 0.01]");
  const auto forward = run(head(5.0) + plane("floor") + stack(8) + falls);
  const auto backward = run(head(5.0) + falls + stack(8, true) + plane("floor"));
  REQUIRE(forward.result.status == RunStatus::completed);
  REQUIRE(forward.trajectory.events().size() == backward.trajectory.events().size());
  for (std::size_t k = 0; k < forward.trajectory.events().size(); ++k) {
    CHECK(forward.trajectory.events()[k].time == backward.trajectory.events()[k].time);
  }
  CHECK(forward.result.ledger.line(EnergyLine::restitution_loss) ==
        backward.result.ledger.line(EnergyLine::restitution_loss));
}

TEST_CASE("whatever the integrator and detector, what is held is held", "[modes]") {
  for (const char* integrator : {"rk4", "thesis-euler", "velocity-verlet"}) {
    for (const char* detector : {"certified", "conservative-advancement"}) {
      CAPTURE(integrator, detector);
      RunChoice choice;
      choice.method.integrator = integrator;
      choice.method.detector = detector;
      const std::string text = head(5.0) + plane("floor") + stack(3);
      check_whole(run(text, choice), text);
    }
  }
}

// Rims are watched of round ends and of hulls, too: a ball went on level beside them.
TEST_CASE("a ball that slides off the end of a cylinder, a cone or a hull leaves it at the rim",
          "[modes]") {
  for (const char* const shape :
       {"shape = \"cylinder\"\nradius = 0.7\nlength = 0.5\nposition = [0, -0.25, 0]\n",
        "shape = \"cone\"\nradius = 0.7\nheight = 0.8\nposition = [0, -0.2, 0]\n"
        "axis_angle = [1, 0, 0, 3.141592653589793]\n",
        "shape = \"hull\"\nposition = [0, -0.25, 0]\npoints = [[0.7, 0.25, 1], [0.7, 0.25, -1], "
        "[-0.7, 0.25, 1], [-0.7, 0.25, -1], [0.7, -0.25, 1], [0.7, -0.25, -1], [-0.7, -0.25, 1], "
        "[-0.7, -0.25, -1]]\n"}) {
    CAPTURE(shape);
    const Simulation sim =
        run("duration = 1\nframe = \"1/60\"\nG = 9.8\n[[body]]\nname = "
            "\"table\"\nentity = \"wall\"\n" +
            std::string(shape) +
            "[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = 0.1\nmass = "
            "1\nrestitution = 0\nposition = [0, 0.1, 0]\nvelocity = [2, 0, 0]\n");
    double ends = -1.0;
    for (const Event& event : sim.trajectory.events()) {
      if (event.kind == EventKind::contact_ends && ends < 0.0) {
        ends = event.time.seconds;
      }
    }
    CHECK(std::abs(ends - 0.35) <= 1e-9);
    tests::check_explained(sim.result.ledger);
  }
}

namespace {

/// A ball that slides along x at 1 m/s, without friction, on what is at y = 0.
std::string slider(const std::string& floor, double x, double duration) {
  return head(duration) + "[[body]]\nname = \"floor\"\nentity = \"wall\"\n" + floor +
         fmt::format(
             "[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = 0.1\nmass = 1\n"
             "restitution = 0\nposition = [{}, 0.1, 0.05]\nvelocity = [1, 0, 0]\n",
             x);
}

/// When something like that happens first, s.
double first(const Simulation& sim, EventKind kind) {
  for (const Event& event : sim.trajectory.events()) {
    if (event.kind == kind) {
      return event.time.seconds;
    }
  }
  return -1.0;
}

}  // namespace

// It went on level in the air: nobody watched where a face of several pieces ends.
TEST_CASE("what slides off a mesh or a compound leaves it at the rim, and not at a seam",
          "[modes]") {
  const std::string mesh =
      "shape = \"height-field\"\nspacing = [1, 1]\nheights = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]\n";
  const std::string boards =
      "shape = \"compound\"\n[[body.part]]\nshape = \"box\"\nhalf_extents = [0.5, 0.1, 1]\n"
      "position = [-0.5, -0.1, 0]\n[[body.part]]\nshape = \"cylinder\"\nradius = 0.5\nlength = 1\n"
      "position = [0, -0.5, 0]\n[[body.part]]\nshape = \"hull\"\nposition = [0.5, -0.25, 0]\n"
      "points = [[0.5, 0.25, 1], [0.5, 0.25, -1], [-0.5, 0.25, 1], [-0.5, 0.25, -1], "
      "[0.5, -0.25, 1], [0.5, -0.25, -1], [-0.5, -0.25, 1], [-0.5, -0.25, -1]]\n";
  for (const std::string& floor : {mesh, boards}) {
    CAPTURE(floor);
    const std::string scene = slider(floor, -0.75, 3.0);
    const Simulation sim = run(scene);
    tests::check_whole(sim, scene);
    // Pieces of a face have 1e-12 of the size between them; a tenfold of that.
    CHECK(std::abs(first(sim, EventKind::contact_ends) - 1.75) <= 2e-11);
    // Faster than sqrt(g r): it flies from there on.
    const Vector3 flown = sim.trajectory.at(1, Instant{} + 2.25).pose.position;
    CHECK((flown - Vector3(1.5, 0.1 - 0.125 * g, 0.05)).norm() <= 1e-9);
  }
}

// It went through: whoever is in touch was not asked whether it meets the rest.
TEST_CASE("what slides on one part of a body strikes another where it meets that", "[modes]") {
  const double ramp = 1.0 - 0.1 * (std::sqrt(2.0) - 1.0);  // where the ball meets 45 degrees
  const std::pair<std::string, double> floors[] = {
      {"shape = \"height-field\"\nspacing = [1, 1]\n"
       "heights = [[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [1, 1, 1]]\n",
       ramp},
      {"shape = \"compound\"\n[[body.part]]\nshape = \"box\"\nhalf_extents = [1, 0.1, 1]\n"
       "position = [0, -0.1, 0]\n[[body.part]]\nshape = \"box\"\nhalf_extents = [0.1, 0.5, 1]\n"
       "position = [0.9, 0.4, 0]\n",
       0.7}};
  for (const auto& [floor, x] : floors) {
    CAPTURE(floor);
    const std::string scene = slider(floor, -0.5, 3.0);
    const Simulation sim = run(scene);
    tests::check_whole(sim, scene);
    // The tolerance of the detector, 1e-9 of the ball, seen along a slope of 45 degrees.
    CHECK(std::abs(first(sim, EventKind::impact) - (x + 0.5)) <= 1e-9);
  }
  // A bridge whose piers hang beside the box that it slides on; its centre of mass is 0.04 m below
  // the middle of its deck.
  const std::string over =
      head(2.0) +
      "[[body]]\nname = \"box\"\nentity = \"wall\"\nhalf_extents = [0.5, 0.5, 0.5]\n"
      "position = [0, -0.5, 0]\n[[body]]\nname = \"bridge\"\nentity = \"body\"\n"
      "shape = \"compound\"\nmass = 1\nposition = [0, 0.06, 0]\nvelocity = [1, 0, 0]\n"
      "restitution = 0\n[[body.part]]\nshape = \"box\"\nhalf_extents = [1, 0.1, 0.1]\n"
      "[[body.part]]\nshape = \"box\"\nhalf_extents = [0.1, 0.2, 0.1]\n"
      "position = [-0.9, -0.14, 0]\n"
      "[[body.part]]\nshape = \"box\"\nhalf_extents = [0.1, 0.2, 0.1]\n"
      "position = [0.9, -0.14, 0]\n";
  const Simulation bridge = run(over);
  tests::check_whole(bridge, over);
  CHECK(std::abs(first(bridge, EventKind::impact) - 0.3) <= 1e-9);
}
