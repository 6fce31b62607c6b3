// Friction of bodies that hang on joints, in event-driven runs: against closed forms, and against
// equations of motion in the fewest coordinates, which know nothing of contacts and joints.

#include "core/reading/scene_reader.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"
#include "tests/simulation/ledger_check.hpp"
#include "tests/simulation/whole_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

using namespace kairos;

namespace {

constexpr double g = 9.8;

std::string head(double duration, double mu) {
  return fmt::format("duration = {}\nframe = \"1/60\"\nG = {}\nfriction = {}\n", duration, g, mu);
}

std::string floor_below(double e = 0.0) {
  return fmt::format(
      "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n"
      "restitution = {}\n",
      e);
}

/// A floor whose surface runs along x.
std::string belt_below(double speed) {
  return fmt::format(
      "[[body]]\nname = \"belt\"\nentity = \"conveyor\"\nshape = \"half-space\"\n"
      "belt_speed = {}\nrestitution = 0\n",
      speed);
}

std::string ball(const std::string& name, double r, const Vector3& x, const Vector3& v) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"ball\"\nradius = {}\nmass = 1.0\n"
      "position = [{}, {}, {}]\nvelocity = [{}, {}, {}]\n",
      name, r, x.x(), x.y(), x.z(), v.x(), v.y(), v.z());
}

std::string box(const std::string& name, const Vector3& half, double mass, const Vector3& x,
                const Vector3& v, double angle = 0.0) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = [{}, {}, {}]\nmass = {}\n"
      "position = [{}, {}, {}]\nvelocity = [{}, {}, {}]\naxis_angle = [0, 0, 1, {}]\n",
      name, half.x(), half.y(), half.z(), mass, x.x(), x.y(), x.z(), v.x(), v.y(), v.z(), angle);
}

std::string hinge(const std::string& bodies, double x, double y) {
  return fmt::format(
      "[[joint]]\nkind = \"hinge\"\nbodies = [{}]\nanchor = [{}, {}, 0]\naxis = [0, 0, 1]\n",
      bodies, x, y);
}

Simulation run(const std::string& text, const std::string& impact = "newton") {
  RunChoice choice;
  choice.method.impact = impact;
  return simulate(parse_scene(text, "test.toml"), choice);
}

/// It ends whole, and friction takes.
void check_whole(const Simulation& sim, const std::string& text, double truncated = 1e-9) {
  tests::check_whole(sim, text, truncated);
  const EnergyLedger& ledger = sim.result.ledger;
  CHECK(ledger.line(EnergyLine::friction) <= 0.0);
  CHECK(ledger.line(EnergyLine::impact_friction) <= 0.0);
}

/// About z.
double angle_of(const BodyState& body) {
  const Quaternion& q = body.pose.orientation;
  return 2.0 * std::atan2(q.z(), q.w());
}

/// The classical method of order 4, in steps so many that it is exact to 1e-12.
template <std::size_t n>
std::array<long double, n> integrate(
    std::array<long double, n> x, double duration,
    const std::function<std::array<long double, n>(const std::array<long double, n>&)>& rate) {
  constexpr int steps = 4000;
  const long double h = static_cast<long double>(duration) / steps;
  const auto moved = [](const auto& from, const auto& along, long double by) {
    auto to = from;
    for (std::size_t k = 0; k < n; ++k) {
      to[k] += by * along[k];
    }
    return to;
  };
  for (int k = 0; k < steps; ++k) {
    const auto k1 = rate(x);
    const auto k2 = rate(moved(x, k1, 0.5L * h));
    const auto k3 = rate(moved(x, k2, 0.5L * h));
    const auto k4 = rate(moved(x, k3, h));
    x = moved(moved(moved(moved(x, k1, h / 6.0L), k2, h / 3.0L), k3, h / 3.0L), k4, h / 6.0L);
  }
  return x;
}

}  // namespace

TEST_CASE("jointed friction: two blocks on a rod brake as one", "[turning][joints][friction]") {
  // One rubs twice as much as the other: the rod passes that on.
  const double v = 2.0;
  const std::string text =
      head(2.0, 0.2) + floor_below() +
      box("near", {0.1, 0.1, 0.1}, 1.0, {0.0, 0.1, 0.0}, {v, 0.0, 0.0}) + "friction = 0.2\n" +
      box("far", {0.1, 0.1, 0.1}, 3.0, {0.5, 0.1, 0.0}, {v, 0.0, 0.0}) + "friction = 0.8\n" +
      "[[joint]]\nkind = \"rod\"\nbodies = [\"near\", \"far\"]\n";
  const Simulation sim = run(text);
  check_whole(sim, text);
  const double braking = g * (0.2 * 1.0 + 0.4 * 3.0) / 4.0;
  CHECK(sim.result.state[1].pose.position.x() ==
        Approx(v * v / (2.0 * braking)).epsilon(0.0).margin(1e-9));
  CHECK(sim.result.ledger.line(EnergyLine::friction) ==
        Approx(-0.5 * 4.0 * v * v).epsilon(0.0).margin(1e-8));
  const auto sticks = tests::of_kind(sim.trajectory, EventKind::stick_begins);
  REQUIRE_FALSE(sticks.empty());
  CHECK(sticks[0].time.seconds == Approx(v / braking).epsilon(0.0).margin(1e-8));
}

TEST_CASE("jointed friction: a ball on a rod circles on a rough floor until it stops",
          "[turning][joints][friction]") {
  // The faster it is the more the rod carries of its weight.
  const double r = 0.05;
  const double R = 0.6;  // of the circle
  const double H = 0.8;  // of the anchor over the ball
  const double v = 1.5;
  const double mu = 0.3;
  const double k = H / (R * R);
  const double stops = std::atanh(v * std::sqrt(k / g)) / (mu * std::sqrt(g * k));
  const double way = -std::log(1.0 - k * v * v / g) / (2.0 * mu * k);
  const std::string text =
      head(stops + 0.2, mu) + floor_below() + ball("bob", r, {R, r, 0.0}, {0.0, 0.0, v}) +
      fmt::format("[[joint]]\nkind = \"rod\"\nbodies = [\"bob\"]\nanchor = [0, {}, 0]\n", r + H);
  const Simulation sim = run(text);
  check_whole(sim, text);
  const Vector3& x = sim.result.state[1].pose.position;
  CHECK(x.x() == Approx(R * std::cos(way / R)).epsilon(0.0).margin(1e-8));
  CHECK(x.z() == Approx(R * std::sin(way / R)).epsilon(0.0).margin(1e-8));
  CHECK(sim.result.ledger.line(EnergyLine::friction) ==
        Approx(-0.5 * v * v).epsilon(0.0).margin(1e-8));
  const auto sticks = tests::of_kind(sim.trajectory, EventKind::stick_begins);
  REQUIRE_FALSE(sticks.empty());
  CHECK(sticks[0].time.seconds == Approx(stops).epsilon(0.0).margin(1e-7));
}

namespace {

/// One leg of a step-ladder of two boxes on a hinge, from the floor up: as it leans.
struct Leg {
  double a = 0.5;  // half of its length, m
  double b = 0.02;
  double m = 1.0;

  [[nodiscard]] double height(double angle) const {
    return 2.0 * a * std::sin(angle) + b * std::cos(angle);
  }
  [[nodiscard]] double foot(double angle) const {
    return 2.0 * a * std::cos(angle) - b * std::sin(angle);
  }
  /// Friction that it takes to stand.
  [[nodiscard]] double least(double angle) const {
    return (foot(angle) - a * std::cos(angle)) / height(angle);
  }
};

std::string step_ladder(const Leg& leg, double angle, double duration, double mu) {
  const double h = leg.height(angle);
  const Vector3 half(leg.a, leg.b, 0.1);
  const auto middle = [&](double side) {
    return Vector3(side * leg.a * std::cos(angle), h - leg.a * std::sin(angle), 0.0);
  };
  return head(duration, mu) + floor_below() +
         box("left", half, leg.m, middle(-1.0), Vector3::Zero(), angle) +
         box("right", half, leg.m, middle(1.0), Vector3::Zero(), -angle) +
         hinge("\"left\", \"right\"", 0.0, h);
}

}  // namespace

TEST_CASE("jointed friction: a step-ladder stands where friction suffices, and slides where not",
          "[turning][joints][friction]") {
  const Leg leg;
  const double angle = M_PI / 3.0;
  {
    const std::string text = step_ladder(leg, angle, 2.0, 1.001 * leg.least(angle));
    const Simulation sim = run(text);
    check_whole(sim, text);
    CHECK(angle_of(sim.result.state[2]) == Approx(-angle).epsilon(0.0).margin(1e-9));
    CHECK(std::abs(sim.result.ledger.line(EnergyLine::friction)) < 1e-9);
  }
  const double mu = 0.7 * leg.least(angle);
  const double duration = 0.5;
  const std::string text = step_ladder(leg, angle, duration, mu);
  const Simulation sim = run(text);
  check_whole(sim, text);
  // The two are mirror images of each other, so that the hinge carries nothing upright.
  const auto end =
      integrate<2>({angle, 0.0L}, duration,
                   [&](const std::array<long double, 2>& x) -> std::array<long double, 2> {
                     const long double s = std::sin(x[0]);
                     const long double c = std::cos(x[0]);
                     const long double a = leg.a;
                     const long double b = leg.b;
                     const long double foot = -2.0L * a * s - b * c;  // derivatives by the angle
                     const long double xg1 = -a * s;
                     const long double xg2 = -a * c;
                     const long double yg1 = a * c - b * s;
                     const long double yg2 = -a * s - b * c;
                     const long double inertia = xg1 * xg1 + yg1 * yg1 + (a * a + b * b) / 3.0L;
                     const long double w2 = x[1] * x[1];
                     const long double asked =
                         -(xg1 * xg2 + yg1 * yg2) * w2 - g * yg1 - mu * foot * (g + yg2 * w2);
                     return {x[1], asked / (inertia + mu * foot * yg1)};
                   });
  CHECK(angle_of(sim.result.state[2]) ==
        Approx(static_cast<double>(-end[0])).epsilon(0.0).margin(1e-9));
  CHECK(sim.result.state[2].twist.angular.z() ==
        Approx(static_cast<double>(-end[1])).epsilon(0.0).margin(1e-8));
  CHECK(angle_of(sim.result.state[1]) ==
        Approx(static_cast<double>(end[0])).epsilon(0.0).margin(1e-9));
}

TEST_CASE("jointed friction: a bar on a hinge falls and pushes a block by a rod",
          "[turning][joints][friction]") {
  const double a = 0.3;
  const double H = 0.8;
  const double half = 0.1;
  const double x0 = 1.2;
  const double m_bar = 2.0;
  const double m_block = 0.7;
  const double mu = 0.25;
  const double duration = 0.25;  // then the rod draws the block up
  const std::string text =
      head(duration, mu) + floor_below() +
      box("bar", {a, 0.02, 0.05}, m_bar, {a, H, 0.0}, Vector3::Zero()) +
      box("block", {half, half, half}, m_block, {x0, half, 0.0}, Vector3::Zero()) +
      hinge("\"bar\"", 0.0, H) +
      fmt::format(
          "[[joint]]\nkind = \"rod\"\nbodies = [\"bar\", \"block\"]\npoint_a = [{}, 0, 0]\n", a);
  const Simulation sim = run(text);
  check_whole(sim, text);
  const long double inertia =
      m_bar * ((a * a + 0.02L * 0.02L) / 3.0L + static_cast<long double>(a) * a);
  using Known = std::array<long double, 4>;  // angle, its rate, place of the block, its velocity
  const Known end = integrate<4>({0.0L, 0.0L, x0, 0.0L}, duration, [&](const Known& x) -> Known {
    const long double s = std::sin(x[0]);
    const long double c = std::cos(x[0]);
    const long double w = x[1];
    const long double rx = 2.0L * a * c;
    const long double ry = 2.0L * a * s;
    const long double dx = x[2] - rx;
    const long double dy = half - H - ry;
    const long double L = std::sqrt(dx * dx + dy * dy);
    const long double ux = dx / L;
    const long double uy = dy / L;
    // The rod pushes the block with f along u, and the bar against it.
    const long double bar0 = -m_bar * g * a * c / inertia;
    const long double bar1 = -(rx * uy - ry * ux) / inertia;
    const long double block0 = -mu * g;
    const long double block1 = (ux + mu * uy) / m_block;
    const long double vx = x[3] + w * ry;  // of the block against the end of the bar
    const long double vy = -w * rx;
    const long double squares = (vx * vx + vy * vy) / L + w * w * (rx * ux + ry * uy);
    // u . (acceleration of the block - that of the end) + squares = 0
    const long double end_by_spin = -ry * ux + rx * uy;
    const long double f =
        -(ux * block0 - end_by_spin * bar0 + squares) / (ux * block1 - end_by_spin * bar1);
    return {w, bar0 + bar1 * f, x[3], block0 + block1 * f};
  });
  CHECK(static_cast<double>(end[3]) > 0.1);
  CHECK(angle_of(sim.result.state[1]) ==
        Approx(static_cast<double>(end[0])).epsilon(0.0).margin(1e-9));
  CHECK(sim.result.state[2].pose.position.x() ==
        Approx(static_cast<double>(end[2])).epsilon(0.0).margin(1e-9));
  CHECK(sim.result.state[2].twist.linear.x() ==
        Approx(static_cast<double>(end[3])).epsilon(0.0).margin(1e-8));
}

TEST_CASE("jointed friction: the end of a bar on a hinge strikes a rough floor",
          "[joints][friction]") {
  // It moves along one line: the normal impulse is felt with what friction adds as it comes down,
  // without that as it goes up. Where friction is more than the line is steep it goes up no more.
  const double e = 0.6;
  for (const std::string impact : {"newton", "routh"}) {
    for (const double mu : {0.3, 2.0}) {
      CAPTURE(impact, mu);
      const std::string text =
          head(0.6, mu) + floor_below(1.0) +
          box("bar", {0.5, 0.02, 0.05}, 1.0, {0.5, 0.6, 0.0}, Vector3::Zero()) +
          fmt::format("restitution = {}\n", e) + hinge("\"bar\"", 0.0, 0.6);
      const Simulation sim = run(text, impact);
      check_whole(sim, text);
      const auto impacts = tests::of_kind(sim.trajectory, EventKind::impact);
      REQUIRE_FALSE(impacts.empty());
      const Event& first = impacts[0];
      const bool bar_is_a = first.a == 1;
      const double before = (bar_is_a ? first.before_a : first.before_b).twist.angular.z();
      const double after = (bar_is_a ? first.after_a : first.after_b).twist.angular.z();
      const double up = first.contact.point.x();
      const double along = 0.6;  // the floor is so far below the hinge
      const double share = (up - mu * along) / (up + mu * along);
      CHECK(after ==
            Approx(share > 0.0 ? -e * std::sqrt(share) * before : 0.0).epsilon(0.0).margin(1e-11));
      CHECK(sim.result.ledger.line(EnergyLine::impact_friction) < 0.0);
    }
  }
}

TEST_CASE("jointed friction: a block on an upright slider is rubbed by a belt",
          "[turning][joints][friction]") {
  const double mu = 0.4;
  const double speed = 1.5;
  const double duration = 1.0;
  const std::string text = head(duration, mu) + belt_below(speed) +
                           box("block", {0.1, 0.1, 0.1}, 2.0, {0.0, 0.1, 0.0}, Vector3::Zero()) +
                           "[[joint]]\nkind = \"slider\"\nbodies = [\"block\"]\n"
                           "anchor = [0, 0.1, 0]\naxis = [0, 1, 0]\n";
  const Simulation sim = run(text);
  check_whole(sim, text);
  const double rubbed = mu * 2.0 * g * speed * duration;
  CHECK(sim.result.ledger.line(EnergyLine::friction) == Approx(-rubbed).epsilon(1e-9));
  CHECK(sim.result.ledger.line(EnergyLine::conveyor_and_hand) == Approx(rubbed).epsilon(1e-9));
  CHECK((sim.result.state[1].pose.position - Vector3(0.0, 0.1, 0.0)).norm() < 1e-9);
}

TEST_CASE("jointed friction: a lever brakes a belt, the more where the belt draws it in",
          "[turning][joints][friction]") {
  const Leg lever{0.4, 0.03, 1.5};
  const double angle = 0.5;
  const double h = lever.height(angle);
  const double x = lever.foot(angle);
  const double mu = 0.5;
  const double duration = 0.7;
  for (const double speed : {1.2, -1.2}) {
    CAPTURE(speed);
    const std::string text = head(duration, mu) + belt_below(speed) +
                             box("lever", {lever.a, lever.b, 0.1}, lever.m,
                                 {lever.a * std::cos(angle), h - lever.a * std::sin(angle), 0.0},
                                 Vector3::Zero(), -angle) +
                             hinge("\"lever\"", 0.0, h);
    const Simulation sim = run(text);
    check_whole(sim, text);
    const double turning = speed > 0.0 ? mu * h : -mu * h;
    const double pressed = lever.m * g * lever.a * std::cos(angle) / (x + turning);
    const double rubbed = mu * pressed * std::abs(speed) * duration;
    CHECK(sim.result.ledger.line(EnergyLine::friction) == Approx(-rubbed).epsilon(1e-8));
    CHECK(sim.result.ledger.line(EnergyLine::conveyor_and_hand) == Approx(rubbed).epsilon(1e-8));
    CHECK(angle_of(sim.result.state[1]) == Approx(-angle).epsilon(0.0).margin(1e-9));
  }
}

TEST_CASE("jointed friction: a driver drags a block to and fro over a rough floor",
          "[turning][joints][friction]") {
  const double swing = 0.2;
  const double w = 2.0 * M_PI * 0.8;
  const double mu = 0.35;
  const double mass = 2.0;
  const double duration = 1.1;
  const std::string text =
      head(duration, mu) + floor_below() +
      fmt::format(
          "[[body]]\nname = \"driver\"\nentity = \"bat\"\nhalf_extents = [0.05, 0.05, 0.05]\n"
          "mass = 1\nposition = [0, 1, 0]\ndrive = {{amplitude = [{}, 0, 0], frequency = 0.8}}\n",
          swing) +
      box("block", {0.1, 0.1, 0.1}, mass, {0.0, 0.1, 0.0}, {swing * w, 0.0, 0.0}) +
      "[[joint]]\nkind = \"slider\"\nbodies = [\"driver\", \"block\"]\nanchor = [0, 0.1, 0]\n"
      "axis = [0, 1, 0]\n";
  const Simulation sim = run(text);
  check_whole(sim, text);
  // A quarter, a half, and what is left of it after 0.88 of a turn.
  const double way = swing * (3.0 + (std::sin(w * duration) + 1.0));
  const double rubbed = mu * mass * g * way;
  const double v = swing * w * std::cos(w * duration);
  const double gained = 0.5 * mass * (v * v - swing * w * swing * w);
  const EnergyLedger& ledger = sim.result.ledger;
  CHECK(ledger.line(EnergyLine::friction) == Approx(-rubbed).epsilon(0.0).margin(1e-7));
  CHECK(ledger.line(EnergyLine::driven_work) == Approx(rubbed + gained).epsilon(0.0).margin(1e-7));
}

TEST_CASE("jointed friction: what drives and strikes a pendulum gives what it gains",
          "[joints][friction]") {
  const double speed = 0.2 * 2.0 * M_PI * 0.5;
  for (const double mu : {0.0, 0.4}) {
    for (const bool from_left : {true, false}) {
      CAPTURE(mu, from_left);
      const double side = from_left ? -1.0 : 1.0;
      const std::string text =
          head(0.2, mu) +
          fmt::format(
              "[[body]]\nname = \"{}\"\nentity = \"bat\"\nhalf_extents = [0.1, 0.2, 0.2]\n"
              "mass = 1\nrestitution = 1\nposition = [{}, 0.02, 0.01]\n"
              "drive = {{amplitude = [{}, 0.02, 0.01], frequency = 0.5}}\n",
              from_left ? "a-bat" : "z-bat", side * 0.25, -side * 0.2) +
          ball("m-bob", 0.1, Vector3::Zero(), Vector3::Zero()) + "restitution = 0.7\n" +
          "[[joint]]\nkind = \"rod\"\nbodies = [\"m-bob\"]\nanchor = [0, 1, 0]\n";
      const Simulation sim = run(text);
      check_whole(sim, text);
      const auto impacts = tests::of_kind(sim.trajectory, EventKind::impact);
      REQUIRE(impacts.size() == 1);
      const Vector3 v = sim.result.state[1].twist.linear;
      CHECK(v.x() * side < -0.9 * speed);
      const EnergyLedger& ledger = sim.result.ledger;
      const double gained = ledger.energy() - ledger.initial_energy();
      CHECK(ledger.line(EnergyLine::driven_work) > 0.0);
      CHECK(ledger.line(EnergyLine::driven_work) + ledger.line(EnergyLine::restitution_loss) +
                ledger.line(EnergyLine::impact_friction) ==
            Approx(gained).epsilon(0.0).margin(1e-9));
    }
  }
}

TEST_CASE("jointed friction: the woodpecker goes down its pole by jerks, pecking",
          "[turning][joints][friction][slow]") {
  const Scene scene = read_scene(find_scene("woodpecker"));
  const Simulation sim = simulate(scene, {});
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const EnergyLedger& ledger = sim.result.ledger;
  tests::check_explained(ledger);
  CHECK(ledger.line(EnergyLine::friction) < 0.0);
  CHECK(ledger.line(EnergyLine::impact_friction) < 0.0);
  CHECK(ledger.line(EnergyLine::restitution_loss) < 0.0);
  CHECK(std::abs(ledger.line(EnergyLine::truncation)) < 1e-9 * ledger.flow());
  const std::size_t pole = 0;
  const std::size_t jaw = 2;
  const std::size_t bird = 3;
  const auto pecks = [&](const Event& event) {
    return (event.a == bird && event.b == pole) || (event.a == pole && event.b == bird);
  };
  const auto impacts = tests::of_kind(sim.trajectory, EventKind::impact);
  CHECK(std::count_if(impacts.begin(), impacts.end(), pecks) >= 3);
  CHECK_FALSE(tests::of_kind(sim.trajectory, EventKind::stick_begins).empty());
  // While friction holds the sleeve it does not move at all; it falls several of its own heights.
  const std::size_t frames = sim.trajectory.frame_times().size();
  int held = 0;
  double farthest = 0.0;  // from the plane in which all of it is
  double before = 0.0;
  for (std::size_t k = 0; k < frames; ++k) {
    const State& state = sim.trajectory.frame_state(k);
    held += k > 0 && std::abs(state[jaw].pose.position.y() - before) < 1e-12 ? 1 : 0;
    before = state[jaw].pose.position.y();
    farthest = std::max(farthest, std::abs(state[bird].pose.position.z()));
  }
  CHECK(held > static_cast<int>(frames) / 10);
  CHECK(before < -5.0 * 0.0116);
  // Roundoff grows, as the bird would turn round the pole.
  CHECK(farthest < 1e-9);
}

namespace {

/// Of all that flowed, what implicit steps are off, which are of first order.
constexpr double stepped = 1e-6;

std::string wheel(const std::string& name, double x, double z, double v) {
  constexpr double radius = 0.08;
  return fmt::format(
             "[[body]]\nname = \"{}\"\nentity = \"body\"\nshape = \"sphere\"\nradius = {}\n"
             "position = [{}, {}, {}]\nmass = 0.5\nrestitution = 0\nvelocity = [{}, 0, 0]\n"
             "angular_velocity = [0, 0, {}]\n",
             name, radius, x, radius, z, v, -v / radius) +
         fmt::format(
             "[[joint]]\nkind = \"hinge\"\nbodies = [\"cart\", \"{}\"]\nanchor = [{}, {}, {}]\n"
             "axis = [0, 0, 1]\n",
             name, x, radius, z);
}

}  // namespace

// Where no forces at an instant are verified, steps are implicit on joints as elsewhere.
TEST_CASE("jointed friction: a cart on four wheels runs into a crate and pushes it",
          "[turning][joints][friction]") {
  constexpr double v = 1.5;
  std::string text =
      head(0.6, 0.4) + floor_below() +
      box("cart", {0.3, 0.03, 0.2}, 4.0, {0.0, 0.19, 0.0}, {v, 0.0, 0.0}) + "restitution = 0\n" +
      box("crate", {0.1, 0.2, 0.2}, 2.0, {0.8, 0.2, 0.02}, Vector3::Zero()) + "restitution = 0\n";
  int next = 0;
  for (const double x : {-0.25, 0.25}) {
    for (const double z : {-0.3, 0.3}) {
      text += wheel(fmt::format("w{}", next++), x, z, v);
    }
  }
  const Simulation sim = run(text);
  check_whole(sim, text, stepped);
  CHECK(sim.result.state[2].pose.position.x() > 0.81);  // the crate went before it
}

TEST_CASE("jointed friction: a box on a ball joint swings into a standing box",
          "[turning][joints][friction]") {
  const std::string text = head(2.0, 0.8) + floor_below(0.5) +
                           box("b", {0.1, 0.1, 0.1}, 1.0, {0.62, 0.69, 0.0}, Vector3::Zero()) +
                           "restitution = 0.5\n" +
                           box("t", {0.1, 0.15, 0.1}, 1.7, {-0.17, 0.15, 0.03}, Vector3::Zero()) +
                           "restitution = 0.5\n"
                           "[[joint]]\nkind = \"ball\"\nbodies = [\"b\"]\nanchor = [0, 0.95, 0]\n";
  check_whole(run(text), text, stepped);
}
