// Coulomb's friction in event-driven runs, against what is known to twelve digits.

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/penetration.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace kairos;

namespace {

constexpr double g = 9.8;

std::string head(double duration, double mu, double g_used = g) {
  return fmt::format("duration = {}\nframe = {}\nG = {}\nfriction = {}\n", duration,
                     duration / 64.0, g_used,
                     std::isinf(mu) ? std::string("inf") : fmt::format("{}", mu));
}

std::string plane(const std::string& name, const Vector3& n = Vector3::UnitY()) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = [{}, {}, {}]\n",
      name, n.x(), n.y(), n.z());
}

std::string at(const Vector3& p) { return fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z()); }

std::string box(const std::string& name, const Vector3& half, const Vector3& p,
                const std::string& rest = "", double e = 0.0, double mass = 1.0) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = {}\nmass = {}\nrestitution = "
      "{}\nposition = {}\n{}\n",
      name, at(half), mass, e, at(p), rest);
}

std::string ball(const std::string& name, double r, const Vector3& p, const std::string& rest = "",
                 double e = 0.0) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nshape = \"sphere\"\nradius = {}\nmass = "
      "1.0\nrestitution = {}\nposition = {}\n{}\n",
      name, r, e, at(p), rest);
}

std::string moving(const Vector3& v) { return "velocity = " + at(v); }

Simulation run(const std::string& text) { return simulate(parse_scene(text, "test.toml"), {}); }

void check_whole(const Simulation& sim, const std::string& text) {
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  const Model model(parse_scene(text, "test.toml"));
  CHECK_FALSE(PenetrationProbe(model).first(sim.result.state));
  CHECK(sim.result.ledger.line(EnergyLine::friction) <= 0.0);
  // Friction that sticks does no work: roundoff of an impulse times a velocity of none.
  CHECK(sim.result.ledger.line(EnergyLine::impact_friction) <= 1e-15);
}

std::vector<double> times(const Simulation& sim, EventKind kind) {
  std::vector<double> found;
  for (const Event& event : sim.trajectory.events()) {
    if (event.kind == kind) {
      found.push_back(event.time.seconds);
    }
  }
  return found;
}

}  // namespace

TEST_CASE("friction 1: a block slides, stops and stays", "[friction][reference]") {
  const std::string text = head(10.0, 0.3) + plane("floor") +
                           box("block", {0.2, 0.1, 0.2}, {0, 0.1, 0}, moving({3, 0, 0}));
  const auto sim = run(text);
  check_whole(sim, text);
  const auto sticks = times(sim, EventKind::stick_begins);
  REQUIRE(sticks.size() == 1);
  CHECK(std::abs(sticks[0] - 1.02040816327) <= 1e-11);
  CHECK(std::abs(sticks[0] - 3.0 / (0.3 * g)) <= 1e-14);
  const BodyState& end = sim.result.state[1];
  CHECK(std::abs(end.pose.position.x() - 1.53061224490) <= 1e-11);
  CHECK(std::abs(end.pose.position.x() - 4.5 / (0.3 * g)) <= 1e-14);
  CHECK(end.twist.linear == Vector3(0, 0, 0));
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::friction) + 4.5) <= 1e-14);
}

TEST_CASE("friction 1: a tall block slides flat while mu < b/h", "[friction][reference]") {
  for (const double mu : {0.2499999, 0.2500001}) {
    CAPTURE(mu);
    const std::string text = head(10.0, mu) + plane("floor") +
                             box("block", {0.1, 0.4, 0.1}, {0, 0.4, 0}, moving({3, 0, 0}));
    const auto sim = run(text);
    check_whole(sim, text);
    double turns = 0.0;
    for (std::size_t k = 0; k < sim.trajectory.frame_times().size(); ++k) {
      turns = std::max(turns, sim.trajectory.frame_state(k)[1].twist.angular.norm());
    }
    CHECK((turns > 0.0) == (mu > 0.25));
  }
}

namespace {

const Vector3 up_30(0.5, std::sqrt(3.0) / 2.0, 0.0);
const Vector3 down_30(std::sqrt(3.0) / 2.0, -0.5, 0.0);
constexpr const char* turned_30 = "axis_angle = [0, 0, 1, -0.5235987755982988]\n";

std::string incline(double duration, double mu, const Vector3& v = Vector3::Zero()) {
  return head(duration, mu) + plane("incline", up_30) +
         box("block", {0.2, 0.1, 0.2}, 0.1 * up_30, turned_30 + moving(v));
}

}  // namespace

TEST_CASE("friction 2: an incline of 30 degrees", "[friction][reference]") {
  const std::string slides = incline(1.11758177245, 0.2);
  const auto down = run(slides);
  check_whole(down, slides);
  const Vector3 way = down.result.state[1].pose.position - 0.1 * up_30;
  CHECK(std::abs(way.dot(down_30) - 2.0) <= 1e-10);
  CHECK(std::abs(way.dot(up_30)) <= 1e-13);

  const std::string thrown = incline(1.10737916775, 0.2, -3.0 * down_30);
  const auto up = run(thrown);
  check_whole(up, thrown);
  const auto slips = times(up, EventKind::slip_begins);
  REQUIRE(slips.size() == 2);
  CHECK(slips[0] == 0.0);
  CHECK(std::abs(slips[1] - 0.454723913604) <= 1e-12);
  CHECK(std::abs((up.result.state[1].pose.position - 0.1 * up_30).dot(down_30)) <= 1e-10);
  CHECK(std::abs(up.result.state[1].twist.linear.dot(down_30) - 2.09018732652) <= 1e-10);

  const std::string stays = incline(1e4, 0.6);
  const auto still = run(stays);
  check_whole(still, stays);
  const Scene scene = parse_scene(stays, "test.toml");
  CHECK(still.result.state[1].pose.position == scene.bodies[1].initial.pose.position);
  CHECK(still.result.state[1].twist.linear == Vector3(0, 0, 0));
}

TEST_CASE("friction: what is pinned at mu = tan alpha sticks or slides, and nothing else",
          "[friction]") {
  for (const double off : {-1e-9, 0.0, 1e-9}) {
    CAPTURE(off);
    const std::string text = incline(10.0, std::sqrt(1.0 / 3.0) * (1.0 + off));
    const auto sim = run(text);
    check_whole(sim, text);
    CHECK(sim.result.cost.events <= 3);
    const double way = (sim.result.state[1].pose.position - 0.1 * up_30).norm();
    CHECK((off < 0.0 ? way > 1e-9 : way <= 1e-12));
  }
}

TEST_CASE("friction 3: a ball slides, then rolls", "[friction][reference]") {
  const std::string text =
      head(10.0, 0.2) + plane("floor") + ball("ball", 0.25, {0, 0.25, 0}, moving({7, 0, 0}));
  const auto sim = run(text);
  check_whole(sim, text);
  const auto rolls = times(sim, EventKind::roll_begins);
  REQUIRE(rolls.size() == 1);
  CHECK(std::abs(rolls[0] - 1.02040816327) <= 1e-11);
  CHECK(std::abs(rolls[0] - 2.0 / (0.2 * g)) <= 1e-14);
  const BodyState& end = sim.result.state[1];
  CHECK(std::abs(end.twist.linear.x() - 5.0) <= 1e-14);
  CHECK(std::abs(end.twist.angular.z() + 20.0) <= 1e-13);
  CHECK(std::abs(end.pose.position.x() - (6.12244897959 + 5.0 * (10.0 - rolls[0]))) <= 1e-10);
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::friction) + 7.0) <= 1e-13);
}

TEST_CASE("friction 4: a ball on an incline rolls, or slides and turns", "[friction][reference]") {
  struct Case {
    double mu;
    double a;
    double rate;  // r dw/dt
  };
  const double least = std::tan(M_PI / 6.0) * 2.0 / 7.0;
  CHECK(std::abs(least - 0.164957219768) <= 1e-12);
  for (const Case& c : {Case{0.3, 3.5, 3.5},
                        {least * (1.0 + 1e-9), 3.5, 3.5},
                        {0.1, 4.05129510429, 2.12176223927},
                        {INFINITY, 3.5, 3.5}}) {
    CAPTURE(c.mu);
    const std::string text =
        head(2.0, c.mu) + plane("incline", up_30) + ball("ball", 0.25, 0.25 * up_30);
    const auto sim = run(text);
    check_whole(sim, text);
    CHECK(std::abs(sim.result.state[1].twist.linear.dot(down_30) - 2.0 * c.a) <= 2e-11);
    CHECK(std::abs(-0.25 * sim.result.state[1].twist.angular.z() - 2.0 * c.rate) <= 2e-11);
    CHECK(times(sim, EventKind::slip_begins).size() == (c.mu < least ? 1 : 0));
  }
}

TEST_CASE("friction 11: a ball with friction and restitution", "[friction][reference]") {
  struct Case {
    double mu;
    double vx;
    double rw;
  };
  for (const Case& c : {Case{0.1, 2.28, 1.8}, {0.3, 15.0 / 7.0, 15.0 / 7.0}}) {
    CAPTURE(c.mu);
    const std::string text = head(0.2, c.mu, 0.0) + plane("floor") +
                             ball("ball", 0.25, {0, 0.65, 0}, moving({3, -4, 0}), 0.8);
    const auto sim = run(text);
    check_whole(sim, text);
    const BodyState& end = sim.result.state[1];
    CHECK(std::abs(end.twist.linear.x() - c.vx) <= 1e-14);
    CHECK(std::abs(end.twist.linear.y() - 3.2) <= 1e-14);
    CHECK(std::abs(-0.25 * end.twist.angular.z() - c.rw) <= 1e-14);
  }
}

namespace {

std::string belt(double speed) {
  return fmt::format(
      "[[body]]\nname = \"belt\"\nentity = \"conveyor\"\nshape = \"half-space\"\nbelt_speed = {}\n",
      speed);
}

}  // namespace

TEST_CASE("friction: a belt carries a block, and pays for it", "[friction][belt]") {
  const std::string text =
      head(5.0, 0.25, 9.8) + belt(2.0) + box("block", {0.2, 0.1, 0.2}, {0, 0.1, 0});
  const auto sim = run(text);
  check_whole(sim, text);
  const auto sticks = times(sim, EventKind::stick_begins);
  REQUIRE(sticks.size() == 1);
  CHECK(std::abs(sticks[0] - 2.0 / (0.25 * g)) <= 1e-14);
  CHECK(sim.result.state[1].twist.linear == Vector3(2, 0, 0));
  // Half of what the belt does goes into the block, half into heat.
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::conveyor_and_hand) - 4.0) <= 1e-13);
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::friction) + 2.0) <= 1e-13);
}

TEST_CASE("friction: a ball dropped on a belt", "[friction][belt]") {
  const std::string text = head(20.0, 0.3) + belt(2.0) + ball("ball", 0.25, {0, 0.5, 0}, "", 0.5);
  const auto sim = run(text);
  check_whole(sim, text);
  // It ends rolling at 2/7 of the belt's speed, whatever came before: nothing has a moment about
  // the line of contact.
  CHECK(std::abs(sim.result.state[1].twist.linear.x() - 4.0 / 7.0) <= 1e-9);
  CHECK(std::abs(sim.result.state[1].twist.linear.y()) <= 1e-12);
}

TEST_CASE("friction: stacks of boxes", "[friction]") {
  SECTION("stand, bit for bit") {
    std::string text = head(1e4, 0.5) + plane("floor");
    for (int k = 0; k < 10; ++k) {
      text += box(fmt::format("b{}", k), {0.25, 0.25, 0.25}, {0, 0.25 + 0.5 * k, 0});
    }
    const auto sim = run(text);
    check_whole(sim, text);
    CHECK(sim.result.cost.events == 10);
    CHECK(sim.result.state[10].pose.position == Vector3(0, 4.75, 0));
  }
  SECTION("a block pushed along on another, which slides on the floor") {
    // mu = 0.5 between both, 0.1 below: the upper brakes at 4.9, the lower gains
    // 4.9 - 2 * 0.98 = 2.94 until both have one velocity; then both brake at 0.98.
    const std::string text = head(10.0, 0.5) + "friction_combine = \"minimum\"\n" + plane("floor") +
                             "friction = 0.1\n" + box("lower", {2.0, 0.25, 0.5}, {0, 0.25, 0}) +
                             box("upper", {0.25, 0.25, 0.25}, {0, 0.75, 0}, moving({3, 0, 0}));
    const auto sim = run(text);
    check_whole(sim, text);
    const double t1 = 3.0 / (4.9 + 2.94);
    const double v = 2.94 * t1;
    const auto sticks = times(sim, EventKind::stick_begins);
    REQUIRE(sticks.size() == 2);
    CHECK(std::abs(sticks[0] - t1) <= 1e-14);
    CHECK(std::abs(sticks[1] - (t1 + v / 0.98)) <= 1e-13);
    const double way = 0.5 * 2.94 * t1 * t1 + 0.5 * v * v / 0.98;
    CHECK(std::abs(sim.result.state[1].pose.position.x() - way) <= 1e-13);
  }
  SECTION("a wedge of boxes on an incline holds together") {
    std::string text = head(100.0, 0.6) + plane("incline", up_30);
    for (int k = 0; k < 3; ++k) {
      text += box(fmt::format("b{}", k), {0.2, 0.05, 0.2}, (0.05 + 0.1 * k) * up_30, turned_30);
    }
    const auto sim = run(text);
    check_whole(sim, text);
    const Scene scene = parse_scene(text, "test.toml");
    for (BodyIndex i = 1; i < 4; ++i) {
      CHECK(sim.result.state[i].pose.position == scene.bodies[i].initial.pose.position);
    }
  }
}

TEST_CASE("friction: a box lands flat with a velocity along the floor", "[friction]") {
  const std::string text = head(10.0, 0.2) + plane("floor") +
                           box("box", {0.3, 0.1, 0.3}, {0, 0.6, 0}, moving({3, 0, 0}), 0.5);
  const auto sim = run(text);
  INFO(sim.result.reason);
  check_whole(sim, text);
  CHECK(sim.result.state[1].twist.linear == Vector3(0, 0, 0));
  // Each impulse along the floor is mu times that against it, and the floor has borne g t by the
  // time t, but for the momentum of the hop at which the rest of them is completed: of 1e-10 of the
  // extent, 0.2 m, so that u = sqrt(2 g h) = 2e-5 m/s, and u / g is missing.
  const auto sticks = times(sim, EventKind::stick_begins);
  REQUIRE(sticks.size() == 1);
  CHECK(std::abs(sticks[0] - 3.0 / (0.2 * g)) <= 2.1e-6);
}

TEST_CASE("friction: scenes moved, turned, mirrored and in other units are the same",
          "[friction][invariance]") {
  const auto text = [](double unit, const Vector3& by, int turn, bool mirror) {
    const auto map = [&](Vector3 v) {
      v.z() = mirror ? -v.z() : v.z();
      for (int k = 0; k < turn; ++k) {
        v = Vector3(v.z(), v.y(), -v.x());
      }
      return Vector3(unit * v);
    };
    return fmt::format("duration = 3.0\nframe = 0.125\nG = {}\nfriction = 0.25\n", unit * g) +
           "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\nposition = " +
           at(by) + "\n" +
           ball("ball", unit * 0.25, by + map({0, 0.25, 0}), moving(map({3, 0, 4}))) +
           box("box", unit * Vector3(0.25, 0.25, 0.25), by + map({8, 0.25, 0}),
               moving(map({-1, 0, 0.5})));
  };
  const auto usual = run(text(1.0, {0, 0, 0}, 0, false));
  INFO(usual.result.reason);
  REQUIRE(usual.result.status == RunStatus::completed);
  const BodyState& end = usual.result.state[1];
  SECTION("units of powers of two: bit for bit") {
    for (const double unit : {0x1p-20, 0x1p10}) {
      const auto other = run(text(unit, {0, 0, 0}, 0, false));
      REQUIRE(other.result.status == RunStatus::completed);
      CHECK(other.result.state[1].pose.position == unit * end.pose.position);
      CHECK(other.result.state[1].twist.linear == unit * end.twist.linear);
      CHECK(other.result.state[2].pose.position == unit * usual.result.state[2].pose.position);
    }
  }
  SECTION("moved, turned, mirrored: to roundoff") {
    const auto moved = run(text(1.0, {64, -32, 16}, 0, false));
    CHECK((moved.result.state[1].pose.position - end.pose.position - Vector3(64, -32, 16)).norm() <=
          1e-12);
    const auto turned = run(text(1.0, {0, 0, 0}, 1, false));
    const Vector3 p = end.pose.position;
    CHECK((turned.result.state[1].pose.position - Vector3(p.z(), p.y(), -p.x())).norm() <= 1e-13);
    const auto mirrored = run(text(1.0, {0, 0, 0}, 0, true));
    CHECK((mirrored.result.state[1].pose.position - Vector3(p.x(), p.y(), -p.z())).norm() <= 1e-13);
  }
}

namespace {

/// x = amplitude sin(w t), a plate from the floor of the world up to 0.
std::string plate(double amplitude, double w) {
  return fmt::format(
      "[[body]]\nname = \"plate\"\nentity = \"wall\"\nhalf_extents = [2, 0.5, 2]\n"
      "position = [0, -0.5, 0]\n[body.drive]\namplitude = [{}, 0, 0]\nfrequency = {:.17g}\n",
      amplitude, w / (2.0 * M_PI));
}

}  // namespace

TEST_CASE("friction 17: a plate that swings: a block sticks, slips and is reversed",
          "[friction][reference]") {
  const std::string text = head(0.6, 0.3) + plate(0.1, 10.0) +
                           box("block", {0.2, 0.1, 0.2}, {0, 0.1, 0}, moving({1.0, 0, 0}));
  const auto sim = run(text);
  check_whole(sim, text);
  const auto slips = times(sim, EventKind::slip_begins);
  REQUIRE(slips.size() >= 2);
  CHECK(std::abs(slips[0] - 0.0298409112025) <= 1e-11);
  CHECK(std::abs(slips[1] - 0.444573242718) <= 1e-9);
}

namespace {

/// Holds friction to what it is: it takes energy on every leg, between every two frames.
class TakesOnly final : public Recorder {
 public:
  void frame(const Frame& frame) override {
    const double now = frame.ledger.line(EnergyLine::friction);
    CHECK(now <= last_ + 1e-13 * frame.ledger.flow());
    last_ = now;
    tests::check_explained(frame.ledger);
  }

 private:
  double last_ = 0.0;
};

}  // namespace

TEST_CASE("friction takes energy on every leg of random scenes, and nothing is unexplained",
          "[friction]") {
  int kept = 0;
  constexpr int trials = 60;
  for (std::uint64_t seed = 0; seed < trials; ++seed) {
    CAPTURE(seed);
    Random random(14, seed);
    const auto pick = [&](double low, double high) { return random.uniform(low, high); };
    const Vector3 n = Vector3(pick(-0.3, 0.3), 1.0, 0.0).normalized();
    const Vector3 t(n.y(), -n.x(), 0.0);
    std::string text = head(pick(1.0, 6.0), pick(0.05, 0.9)) + plane("floor", n);
    double place = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double r = pick(0.05, 0.3);
      const std::string name = fmt::format("b{}", k);
      const std::string v = moving(pick(-3, 3) * t);
      // They rest on the plane, or fall on it; one beside the other, out of each other's way.
      const double above = seed % 2 == 0 ? 0.0 : pick(0.0, 0.4);
      const Vector3 at = (r + above) * n + place * Vector3::UnitZ();
      place += 1.0;
      text += ball(name, r, at, v, pick(0.0, 0.8));
    }
    const Model model(parse_scene(text, "test.toml"));
    TakesOnly watch;
    const RunResult result = simulate(model, {}, watch);
    INFO(result.reason);
    CHECK(result.status == RunStatus::completed);
    CHECK_FALSE(PenetrationProbe(model).first(result.state));
    kept += result.status == RunStatus::completed ? 1 : 0;
  }
  CHECK(kept == trials);
}

TEST_CASE("friction: what slides across an incline turns downhill, and stops where it must",
          "[friction]") {
  // Against Runge-Kutta of v' = g_t - mu g_n v/|v|, in steps of 1e-5 s, until it creeps.
  const double mu = 0.8;  // > tan 30 deg: it stops
  const Vector3 across = up_30.cross(down_30);
  Vector3 v = 2.0 * across + 1.0 * down_30;
  Vector3 x = Vector3::Zero();
  const auto rate = [&](const Vector3& u) {
    return Vector3(g * 0.5 * down_30 - mu * g * std::sqrt(0.75) * u.normalized());
  };
  const double h = 1e-5;
  while (v.norm() > 1e-3) {
    const Vector3 k1 = rate(v);
    const Vector3 k2 = rate(v + 0.5 * h * k1);
    const Vector3 k3 = rate(v + 0.5 * h * k2);
    const Vector3 k4 = rate(v + h * k3);
    x += h * (v + h / 6.0 * (k1 + k2 + k3));
    v += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  x += 0.5 * v * (v.norm() / (mu * g * std::sqrt(0.75) - g * 0.5));
  const std::string text = incline(5.0, mu, 2.0 * across + 1.0 * down_30);
  const auto sim = run(text);
  check_whole(sim, text);
  const BodyState& end = sim.result.state[1];
  CHECK(end.twist.linear == Vector3(0, 0, 0));
  CHECK((end.pose.position - 0.1 * up_30 - x).norm() <= 1e-8);  // of the steps near the end
  REQUIRE(times(sim, EventKind::stick_begins).size() == 1);
  CHECK(times(sim, EventKind::slip_begins).size() == 1);
  // Nothing else takes or gives: what gravity did is what friction took, but for the start.
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::friction) + 2.5 + g * 0.5 * x.dot(down_30)) <=
        1e-8);
}

TEST_CASE("friction: a ball thrown across an incline slides on a curve until it rolls",
          "[friction]") {
  const Vector3 across = up_30.cross(down_30);
  const std::string text = head(3.0, 0.4) + plane("incline", up_30) +
                           ball("ball", 0.25, 0.25 * up_30, moving(3.0 * across));
  const auto sim = run(text);
  check_whole(sim, text);
  CHECK(times(sim, EventKind::roll_begins).size() == 1);
  // From then on it rolls down at 5/7 g sin, and keeps what it has across.
  const BodyState& end = sim.result.state[1];
  const Vector3 slip = end.twist.linear + end.twist.angular.cross(-0.25 * up_30);
  CHECK(slip.norm() <= 1e-12);
  // About the line through where it touches nothing but gravity has a moment, whatever the slip:
  // v + 2/5 r w x n along the plane grows with g sin alone.
  const Vector3 spin = 0.4 * 0.25 * end.twist.angular.cross(up_30);
  const Vector3 moment = end.twist.linear + (spin - up_30 * up_30.dot(spin));
  CHECK(std::abs(moment.dot(across) - 3.0) <= 1e-11);
  CHECK(std::abs(moment.dot(down_30) - 3.0 * g * 0.5) <= 1e-11);
}

namespace {

/// Keeps the world once, after so many offers.
class KeepsOnce final : public CheckpointKeeper {
 public:
  explicit KeepsOnce(int offers) : offers_(offers) {}
  bool wants(Instant, bool) override { return --offers_ == 0; }
  void keep(Instant, std::string_view world) override { bytes = world; }
  std::string bytes;

 private:
  int offers_;
};

}  // namespace

TEST_CASE("friction: a run that is interrupted while it slides goes on as if nothing had been",
          "[friction]") {
  const Vector3 across = up_30.cross(down_30);
  for (const std::string& text :
       {head(3.0, 0.4) + plane("incline", up_30) +
            ball("ball", 0.25, 0.25 * up_30, moving(3.0 * across)),
        head(2.0, 0.3) + plate(0.1, 10.0) +
            box("block", {0.2, 0.1, 0.2}, {0, 0.1, 0}, moving({1.0, 0, 0})),
        head(3.0, 0.2) + plane("floor") +
            ball("ball", 0.25, {0, 0.5, 0}, moving({7, 0, 0}), 0.5)}) {
    const Model model(parse_scene(text, "test.toml"));
    Recorder none;
    const RunResult whole = simulate(model, {}, none);
    for (const int frame : {2, 7, 20}) {
      CAPTURE(text, frame);
      KeepsOnce keeper(frame);
      simulate(model, {}, none, {.keeper = &keeper});
      REQUIRE_FALSE(keeper.bytes.empty());
      const RunResult resumed = simulate(model, {}, none, {.resume = keeper.bytes});
      CHECK(resumed.status == RunStatus::completed);
      CHECK(resumed.state[1].pose.position == whole.state[1].pose.position);
      CHECK(resumed.state[1].twist.angular == whole.state[1].twist.angular);
      CHECK(resumed.ledger.line(EnergyLine::friction) == whole.ledger.line(EnergyLine::friction));
    }
  }
}

// Half of a face that spins lands: friction acts where that is pressed, and slides there. What it
// took at the middle of the patch was not what it did to the body.
TEST_CASE("friction: a face that lands flat, and spins, takes from the body what is booked",
          "[friction]") {
  const Simulation sim = simulate(
      parse_scene("duration = 0.2\nframe = \"1/60\"\nG = 0\nfriction = 0.3\n[[body]]\nname = "
                  "\"table\"\nentity = \"wall\"\nhalf_extents = [1, 0.5, 1]\nposition = [-1, "
                  "-0.5, 0]\n[[body]]\nname = \"box\"\nentity = \"body\"\nhalf_extents = [0.3, "
                  "0.1, 0.2]\nmass = 1\nrestitution = 0.3\nposition = [-0.1, 0.2, 0]\nvelocity = "
                  "[-1, -1, 0.3]\nangular_velocity = [0, 2, 0]\n",
                  "test.toml"),
      {});
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  CHECK(sim.result.cost.impacts > 0);
  CHECK(sim.result.ledger.line(EnergyLine::impact_friction) < 0.0);
  tests::check_explained(sim.result.ledger);
}

// One beside the middle of the other: an impulse that turned neither would not keep its moment.
TEST_CASE("friction: a box that lands flat on another keeps momentum and its moment",
          "[friction]") {
  for (const double beside : {0.0, 0.05, 0.2, 0.4}) {
    for (const double slides : {0.0, 0.4}) {
      for (const double spins : {0.0, 1.5}) {
        CAPTURE(beside, slides, spins);
        const Scene scene = parse_scene(
            fmt::format(
                "duration = 0.45\nframe = \"1/60\"\nG = 0\nfriction = 0.3\n[[body]]\nname = "
                "\"low\"\nentity = \"body\"\nhalf_extents = [0.3, 0.1, 0.3]\nmass = 1\n"
                "restitution = 0.5\n[[body]]\nname = \"high\"\nentity = \"body\"\n"
                "half_extents = [0.3, 0.1, 0.3]\nmass = 2\nrestitution = 0.5\nposition = "
                "[{}, 0.4, 0.02]\nvelocity = [{}, -1, 0]\nangular_velocity = [0, {}, 0]\n",
                beside, slides, spins),
            "test.toml");
        const Simulation sim = simulate(scene, {});
        INFO(sim.result.reason);
        REQUIRE(sim.result.status == RunStatus::completed);
        CHECK(sim.result.cost.impacts > 0);
        tests::check_explained(sim.result.ledger);
        CHECK(sim.result.ledger.line(EnergyLine::restitution_loss) +
                  sim.result.ledger.line(EnergyLine::impact_friction) <
              0.0);
        const Model model(scene);
        const auto moment = [&](const State& state) {
          Vector3 sum = Vector3::Zero();
          for (BodyIndex i = 0; i < 2; ++i) {
            const auto& [pose, twist] = state[i];
            const Vector3 spin = pose.orientation.conjugate() * twist.angular;
            sum += pose.position.cross(model.inertia(i).mass * twist.linear) +
                   pose.orientation * Vector3(model.inertia(i).principal.cwiseProduct(spin));
          }
          return sum;
        };
        const State start{scene.bodies[0].initial, scene.bodies[1].initial};
        // A top is integrated to 1e-9.
        CHECK((moment(sim.result.state) - moment(start)).norm() <= 1e-9);
      }
    }
  }
}

// The heavy ball pins the light one by infinitely many impacts, which take most of the slide: when
// the rest of it ends was told from the slide before.
TEST_CASE("friction: a slide that an accumulation slowed ends where it comes to rest",
          "[friction]") {
  const Simulation sim = simulate(
      parse_scene(
          "duration = 0.78\nframe = 0.047\nG = 9.8\n[[body]]\nname = \"plane\"\nentity = "
          "\"wall\"\nshape = \"half-space\"\nnormal = [-0.09989892418683778, "
          "0.994997590422365, 0]\nfriction = 0.13\n[[body]]\nname = \"low\"\nentity = "
          "\"ball\"\nradius = 0.12\nposition = [0.16, 0.44, 0]\nmass = 1\nrestitution = "
          "0.5\nfriction = 0.3\n[[body]]\nname = \"high\"\nentity = \"ball\"\nradius = "
          "0.42\nposition = [0.16, 1.2, 0]\nmass = 580\nrestitution = 0.72\nfriction = 0.3\n",
          "test.toml"),
      {});
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  // Friction holds both on this slope (0.197 > tan 0.1): nothing moves any more.
  CHECK(sim.result.ledger.kinetic() == 0.0);
  tests::check_explained(sim.result.ledger);
}

// Four boxes beside and on each other: side faces touch, slide and press nothing. Forces of least
// norm pull at some of their corners and press at others.
TEST_CASE("friction: what is redundant and presses nothing rubs nothing", "[friction]") {
  constexpr double half = 1.2576266;
  std::string text = head(2.6311168, 0.3) + plane("floor");
  text += box("b", Vector3::Constant(half), {2.5152532, 7.3353647, 0}, "", 0.5);
  text += box("c", Vector3::Constant(half), {0, 7.3353647, 0}, "", 0.5);
  text += box("d", Vector3::Constant(half), {5.0305064, 4.8201115, 0}, "friction = 0", 0.5);
  text += box("e", Vector3::Constant(half), {2.5152532, 4.8201115, 0}, "", 0.5);
  const Simulation sim = simulate(parse_scene(text, "test.toml"), {});
  INFO(sim.result.reason);
  CHECK(sim.result.cost.steps > 20);
  const EnergyLedger& ledger = sim.result.ledger;
  tests::check_explained(ledger);
  // Steps are made to 1e-12.
  CHECK(std::abs(ledger.line(EnergyLine::truncation)) <=
        1e-9 * (ledger.kinetic() + ledger.potential()));
  CHECK(ledger.line(EnergyLine::friction) <= 0.0);
}

TEST_CASE("friction: a box comes down on one that lies on a floor which returns all of its speed",
          "[friction][slow]") {
  // The lower one rattles on its corners, and the floor takes no energy from its hops but by
  // friction.
  for (const double tilt : {1e-6, 1e-3}) {
    for (const double e : {0.0, 0.5}) {
      for (const double mu : {0.1, 0.6}) {
        const double part = tilt * std::sqrt(0.125);
        const std::string turned =
            fmt::format("orientation = [{}, {}, 0, {}]", 1.0 - tilt * tilt / 8.0, part, part);
        const std::string text = head(0.5, mu) + plane("floor") +
                                 box("lower", {0.1, 0.05, 0.1}, {0, 0.05, 0}, "", 1.0) +
                                 box("upper", {0.1, 0.1, 0.1}, {0.01, 0.25, 0.005}, turned, e);
        CAPTURE(tilt, e, mu);
        check_whole(run(text), text);
      }
    }
  }
}

TEST_CASE("friction: a box comes down on another where all speed is returned, and friction rubs",
          "[friction]") {
  // Friction alone takes energy from what rattles between the upper one and the floor.
  const std::string text =
      head(0.5, 0.6) + plane("floor") + box("lower", {0.1, 0.05, 0.1}, {0, 0.05, 0}, "", 1.0, 5.0) +
      box("upper", {0.1, 0.1, 0.1}, {0.01, 0.25, 0.005},
          "orientation = [1, 3.5355339059327375e-7, 0, 3.5355339059327375e-7]", 1.0, 5.0);
  check_whole(run(text), text);
}

// Balls in corners roll on two walls at once, where forces are redundant: some are at the edge of
// their cones, and yet nothing begins to slide.
TEST_CASE("friction: ten balls in a bin go on to the end", "[friction][slow]") {
  for (const int seed : {1, 2, 3, 4}) {
    const Simulation sim = simulate(
        parse_scene(
            "duration = 3\nframe = \"1/60\"\nG = 9.8\nfriction = 0.3\n" + plane("floor") +
                "[[body]]\nname = \"left\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = "
                "[1, 0, 0]\nposition = [-0.25, 0, 0]\n[[body]]\nname = \"right\"\nentity = "
                "\"wall\"\nshape = \"half-space\"\nnormal = [-1, 0, 0]\nposition = [0.25, 0, 0]\n"
                "[[body]]\nname = \"back\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = "
                "[0, 0, 1]\nposition = [0, 0, -0.25]\n[[body]]\nname = \"front\"\nentity = "
                "\"wall\"\nshape = \"half-space\"\nnormal = [0, 0, -1]\nposition = [0, 0, 0.25]\n" +
                fmt::format("[[many]]\nname = \"ball\"\nentity = \"body\"\nshape = \"sphere\"\n"
                            "radius = 0.04\nmass = 0.1\nrestitution = 0.6\ncount = 10\nplacement = "
                            "\"random\"\nseed = {}\nvelocity_deviation = 0.5\n[many.region]\nmin = "
                            "[-0.2, 0.05, -0.2]\nmax = [0.2, 1, 0.2]\n",
                            seed),
            "test.toml"),
        {});
    CAPTURE(seed, sim.result.reason);
    CHECK(sim.result.status == RunStatus::completed);
    tests::check_explained(sim.result.ledger);
    CHECK(sim.result.ledger.line(EnergyLine::friction) < 0.0);
  }
}
