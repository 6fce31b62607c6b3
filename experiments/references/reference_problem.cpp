#include "experiments/references/reference_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace kairos::experiments {
namespace {

using Measure = std::function<double(const Simulation&)>;

std::string head(double duration, double friction, double gravity = 9.8) {
  return fmt::format("duration = {}\nframe = \"1/60\"\nG = {}\nfriction = {}\n", duration, gravity,
                     friction);
}

std::string plane(std::string_view name, std::string_view normal = "[0, 1, 0]") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = {}\n", name,
      normal);
}

std::string box(std::string_view name, std::string_view half, std::string_view position,
                std::string_view rest = "") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = {}\nmass = 1\nrestitution = 0\n"
      "position = {}\n{}\n",
      name, half, position, rest);
}

std::string ball(std::string_view name, double radius, std::string_view position,
                 std::string_view rest = "", double restitution = 0.0) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nshape = \"sphere\"\nradius = {}\nmass = 1\n"
      "restitution = {}\nposition = {}\n{}\n",
      name, radius, restitution, position, rest);
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::string_view up_30 = "[0.5, 0.8660254037844387, 0]";
constexpr std::string_view turned_30 = "axis_angle = [0, 0, 1, -0.5235987755982988]\n";
const Vector3 down_30(std::sqrt(3.0) / 2.0, -0.5, 0.0);

/// A body at the end of the run, by its place in the scene.
Measure at_end(BodyIndex body, std::function<double(const BodyState&)> value) {
  return [=](const Simulation& run) { return value(run.result.state[body]); };
}

Measure position(BodyIndex body, const Vector3& along) {
  return at_end(body, [=](const BodyState& s) { return s.pose.position.dot(along); });
}

Measure velocity(BodyIndex body, const Vector3& along) {
  return at_end(body, [=](const BodyState& s) { return s.twist.linear.dot(along); });
}

Measure surface_speed(BodyIndex body, double radius) {
  return at_end(body, [=](const BodyState& s) { return -radius * s.twist.angular.z(); });
}

Measure line(EnergyLine of) {
  return [=](const Simulation& run) { return run.result.ledger.line(of); };
}

/// When something of this kind happens for the n-th time, n from 1, s.
Measure when(EventKind kind, int n = 1) {
  return [=](const Simulation& run) {
    int seen = 0;
    for (const Event& event : run.trajectory.events()) {
      if (event.kind == kind && ++seen == n) {
        return event.time.seconds;
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  };
}

/// How fast the body b turns at the n-th impact, rad/s.
Measure spin_at_impact(int n) {
  return [=](const Simulation& run) {
    int seen = 0;
    for (const Event& event : run.trajectory.events()) {
      if (event.kind == EventKind::impact && ++seen == n) {
        return std::max(event.before_a.twist.angular.norm(), event.before_b.twist.angular.norm());
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  };
}

/// Of quantities that depend on the gap at which bodies that turn are held.
constexpr double turning = 1e-9;

void add_blocks(std::vector<ReferenceProblem>& all) {
  const std::string slides = head(2.0, 0.3) + plane("floor") +
                             box("block", "[0.2, 0.1, 0.2]", "[0, 0.1, 0]", "velocity = [3, 0, 0]");
  all.push_back({"block slides on a floor", "stops after", "s", 1.02040816327, slides, "newton",
                 when(EventKind::stick_begins)});
  all.push_back({"block slides on a floor", "stops at", "m", 1.53061224490, slides, "newton",
                 position(1, Vector3::UnitX())});
  all.push_back(
      {"block slides on a floor", "heat", "J", -4.5, slides, "newton", line(EnergyLine::friction)});
  const auto incline = [](double duration, double mu, std::string_view rest) {
    return head(duration, mu) + plane("incline", up_30) +
           box("block", "[0.2, 0.1, 0.2]", "[0.05, 0.08660254037844388, 0]",
               std::string(turned_30) + std::string(rest));
  };
  all.push_back({"incline of 30 degrees, mu = 0.2", "gone at 1.11758177245 s", "m", 2.0,
                 incline(1.11758177245, 0.2, ""), "newton", position(1, down_30)});
  all.push_back({"thrown up the incline at 3 m/s", "back at 1.10737916775 s with", "m/s",
                 2.09018732652,
                 incline(1.10737916775, 0.2, "velocity = [-2.598076211353316, 1.5, 0]"), "newton",
                 velocity(1, down_30)});
  all.push_back({"incline, mu = 0.6", "gone after 10 s", "m", 0.0, incline(10.0, 0.6, ""), "newton",
                 position(1, down_30)});
  const std::string plate = fmt::format(
      "[[body]]\nname = \"plate\"\nentity = \"wall\"\nhalf_extents = [2, 0.5, 2]\nposition = [0, "
      "-0.5, 0]\n[body.drive]\namplitude = [0.1, 0, 0]\nfrequency = {:.17g}\n",
      5.0 / std::numbers::pi);
  const std::string carried =
      head(0.6, 0.3) + plate +
      box("block", "[0.2, 0.1, 0.2]", "[0, 0.1, 0]", "velocity = [1, 0, 0]");
  all.push_back({"plate that swings under a block", "slips after", "s", 0.0298409112025, carried,
                 "newton", when(EventKind::slip_begins, 1)});
  all.push_back({"plate that swings under a block", "reverses after", "s", 0.444573242718, carried,
                 "newton", when(EventKind::slip_begins, 2)});
}

void add_balls(std::vector<ReferenceProblem>& all) {
  const std::string rolls =
      head(2.0, 0.2) + plane("floor") + ball("ball", 0.25, "[0, 0.25, 0]", "velocity = [7, 0, 0]");
  all.push_back({"ball slides, then rolls", "rolls after", "s", 1.02040816327, rolls, "newton",
                 when(EventKind::roll_begins)});
  all.push_back({"ball slides, then rolls", "velocity", "m/s", 5.0, rolls, "newton",
                 velocity(1, Vector3::UnitX())});
  const auto down = [](double mu) {
    return head(1.0, mu) + plane("incline", up_30) +
           ball("ball", 0.25, "[0.125, 0.21650635094610968, 0]");
  };
  all.push_back({"ball rolls down 30 degrees, mu = 0.3", "velocity after 1 s", "m/s", 3.5,
                 down(0.3), "newton", velocity(1, down_30)});
  all.push_back({"ball slides down 30 degrees, mu = 0.1", "velocity after 1 s", "m/s",
                 4.05129510429, down(0.1), "newton", velocity(1, down_30)});
  all.push_back({"ball slides down 30 degrees, mu = 0.1", "of its surface by turning", "m/s",
                 2.12176223927, down(0.1), "newton", surface_speed(1, 0.25)});
  // The sides of the groove are across the incline and level with it.
  const std::string groove = head(1.0, 0.3) + plane("left", "[0.5, 0.8660254037844387, 1]") +
                             plane("right", "[0.5, 0.8660254037844387, -1]") +
                             ball("ball", 0.1, "[0.07071067811865475, 0.1224744871391589, 0]");
  all.push_back({"ball rolls down a groove of 90 degrees at 30", "velocity after 1 s", "m/s",
                 2.72222222222, groove, "newton", velocity(2, down_30)});
  const auto thrown = [](double mu) {
    return head(0.2, mu, 0.0) + plane("floor") +
           ball("ball", 0.25, "[0, 0.65, 0]", "velocity = [3, -4, 0]", 0.8);
  };
  all.push_back({"ball thrown on a floor, mu = 0.1", "velocity along it after", "m/s", 2.28,
                 thrown(0.1), "newton", velocity(1, Vector3::UnitX())});
  all.push_back({"ball thrown on a floor, mu = 0.3", "velocity along it after", "m/s",
                 2.14285714286, thrown(0.3), "newton", velocity(1, Vector3::UnitX())});
  all.push_back({"superball thrown on a floor", "velocity along it after", "m/s", 1.28571428571,
                 thrown(infinity), "garwin", velocity(1, Vector3::UnitX())});
  const auto cradle = [&](std::string_view what, std::string impact, BodyIndex body, double truth) {
    const std::string scene =
        head(2.0, 0.0, 0.0) + ball("a", 0.1, "[-1, 0, 0]", "velocity = [1, 0, 0]", 1.0) +
        ball("b", 0.1, "[0, 0, 0]", "", 1.0) + ball("c", 0.1, "[0.2, 0, 0]", "", 1.0);
    all.push_back({"cradle in touch, " + impact, std::string(what), "m/s", truth, scene, impact,
                   velocity(body, Vector3::UnitX())});
  };
  cradle("velocity of the last", "reflections", 2, 1.0);
  cradle("velocity of the first", "moreau", 0, -1.0 / 3.0);
}

void add_stacks(std::vector<ReferenceProblem>& all) {
  std::string stack = head(10.0, 0.5) + plane("floor");
  for (int k = 0; k < 10; ++k) {
    stack +=
        box(fmt::format("box-{}", k), "[0.1, 0.1, 0.1]", fmt::format("[0, {}, 0]", 0.1 + 0.2 * k));
  }
  all.push_back({"ten boxes on each other", "height of the top one after 10 s", "m", 1.9, stack,
                 "newton", position(10, Vector3::UnitY())});
  std::string overhang = head(5.0, 0.5) +
                         "[[body]]\nname = \"table\"\nentity = \"wall\"\nhalf_extents = [1, 0.5, "
                         "1]\nposition = [-1, -0.5, 0]\n";
  double x = -0.1;
  for (int k = 4; k >= 1; --k) {
    x += 0.999 * 0.2 / (2.0 * k);
    overhang += box(fmt::format("box-{}", k), "[0.1, 0.1, 0.1]",
                    fmt::format("[{}, {}, 0]", x, 0.1 + 0.2 * (4 - k)));
  }
  all.push_back({"four boxes over an edge, 0.999 of 25/24", "height of the top one after 5 s", "m",
                 0.7, overhang, "newton", position(4, Vector3::UnitY())});
  const std::string ladder =
      head(0.8, 0.0) + plane("floor") + plane("wall", "[1, 0, 0]") +
      box("ladder", "[1, 0.05, 0.5]", "[0.543301270189222, 0.891025403784438, 0]",
          "axis_angle = [0, 0, 1, -1.0471975511965976]");
  all.push_back({"ladder slides down a wall", "leaves the wall after", "s", 0.450086985205, ladder,
                 "newton", when(EventKind::contact_ends)});
  all.push_back({"ladder slides down a wall", "lands after", "s", 0.688800470801, ladder, "newton",
                 when(EventKind::impact), turning});
  all.push_back({"ladder slides down a wall", "lands turning at", "rad/s", 3.37980593621, ladder,
                 "newton", spin_at_impact(1), turning});
}

// --- Bodies that turn while they touch ---------------------------------------------------------

void add_turning(std::vector<ReferenceProblem>& all) {
  const auto on_ball = [](double mu) {
    return head(1.5, mu) +
           "[[body]]\nname = \"under\"\nentity = \"wall\"\nshape = \"sphere\"\nradius = 1\n" +
           ball("ball", 0.25,
                fmt::format("[{:.17g}, {:.17g}, 0]", 1.25 * std::sin(0.1), 1.25 * std::cos(0.1)));
  };
  all.push_back({"ball rolls off a ball", "leaves it after", "s", 1.24979796669, on_ball(infinity),
                 "newton", when(EventKind::contact_ends), turning});
  all.push_back({"ball slides off a ball", "leaves it after", "s", 1.01469724250, on_ball(0.0),
                 "newton", when(EventKind::contact_ends), turning});
  const std::string over_edge =
      head(0.5, infinity) +
      "[[body]]\nname = \"table\"\nentity = \"wall\"\nhalf_extents = [1, 0.5, 1]\nposition = "
      "[-1, -0.5, 0]\n" +
      ball("ball", 0.1, "[-0.05, 0.1, 0]", "velocity = [0.5, 0, 0]\nangular_velocity = [0, 0, -5]");
  all.push_back({"ball rolls over the edge of a table", "leaves it after", "s",
                 0.1 + 0.132745031152, over_edge, "newton", when(EventKind::contact_ends),
                 turning});
  const double c = std::cos(0.1);
  const double s = std::sin(0.1);
  const std::string rocks =
      head(3.5, infinity) + plane("floor") +
      box("box", "[0.1, 0.4, 0.1]",
          fmt::format("[{:.17g}, {:.17g}, 0]", -0.1 * c + 0.4 * s, 0.1 * s + 0.4 * c),
          "axis_angle = [0, 0, 1, -0.1]");
  all.push_back({"box rocks", "strikes for the first time after", "s", 0.264848439164, rocks,
                 "newton", when(EventKind::impact, 1), turning});
  all.push_back({"box rocks", "turning at", "rad/s", 0.830944233655, rocks, "newton",
                 spin_at_impact(1), turning});
  all.push_back({"box rocks", "for the second time after", "s", 0.711263621508, rocks, "newton",
                 when(EventKind::impact, 2), turning});
  all.push_back({"box rocks", "for the eleventh time after", "s", 2.98013354213, rocks, "newton",
                 when(EventKind::impact, 11), 1e-8});  // adds up
  const auto domino = [](std::string_view name, double x, std::string_view rest) {
    return box(name, "[0.05, 0.25, 0.125]", fmt::format("[{}, 0.25, 0]", x), rest);
  };
  const std::string dominoes =
      head(0.3, infinity) + plane("floor") +
      domino("first", 0.0, "velocity = [0.5, 0.1, 0]\nangular_velocity = [0, 0, -2]") +
      domino("second", 0.3, "");
  all.push_back({"domino tips onto the next", "strikes it after", "s", 0.227948927079, dominoes,
                 "newton", when(EventKind::impact), turning});
  all.push_back({"domino tips onto the next", "turning at", "rad/s", 2.04866509711, dominoes,
                 "newton", spin_at_impact(1), turning});
  const std::string oscillator =
      head(3.0, 0.2) + plane("floor") + box("block", "[0.2, 0.1, 0.2]", "[0.1, 0.1, 0]") +
      "[[force]]\nkind = \"spring\"\nname = \"spring\"\nbodies = [\"block\"]\nanchor = [0, 0.1, "
      "0]\nstiffness = 100\n";
  all.push_back({"block on a spring, rubbed", "stops for good after", "s", 0.942477796077,
                 oscillator, "newton", when(EventKind::stick_begins), turning});
  all.push_back({"block on a spring, rubbed", "stops at", "m", 0.0176, oscillator, "newton",
                 position(1, Vector3::UnitX()), turning});
}

void add_joints(std::vector<ReferenceProblem>& all) {
  const std::string bob = fmt::format(
      "[[body]]\nname = \"bob\"\nentity = \"ball\"\nradius = 0.05\nmass = 1\nrestitution = 0.5\n"
      "position = [{:.17g}, {:.17g}, 0]\n[[body]]\nname = \"wall\"\nentity = \"wall\"\n"
      "half_extents = [0.1, 1, 1]\nposition = [{:.17g}, -1, 0]\n[[joint]]\nkind = \"rod\"\n"
      "bodies = [\"bob\"]\nanchor = [0, 0, 0]\n",
      std::sin(1.0), -std::cos(1.0), std::sin(0.3) - 0.15);
  const std::string strikes = head(3.0, 0.0) + bob;
  all.push_back({"pendulum strikes a wall", "for the first time after", "s", 0.433414362252,
                 strikes, "newton", when(EventKind::impact, 1)});
  all.push_back({"pendulum strikes a wall", "for the second time after", "s", 1.08397570721,
                 strikes, "newton", when(EventKind::impact, 2)});
  all.push_back({"pendulum strikes a wall", "rests after", "s", 1.98661353087, strikes, "newton",
                 when(EventKind::contact_begins)});
  const std::string two =
      head(2.0, 0.0) +
      "[[body]]\nname = \"inner\"\nentity = \"ball\"\nradius = 0.05\nmass = 1\nposition = [1, 0, "
      "0]\n[[body]]\nname = \"outer\"\nentity = \"ball\"\nradius = 0.05\nmass = 1\nposition = [2, "
      "0, 0]\n[[joint]]\nkind = \"rod\"\nbodies = [\"inner\"]\nanchor = [0, 0, 0]\n[[joint]]\nkind "
      "= \"rod\"\nbodies = [\"inner\", \"outer\"]\n";
  all.push_back({"double pendulum", "the inner ball after 2 s, x", "m", -0.467181020829, two,
                 "newton", position(0, Vector3::UnitX())});
  all.push_back({"double pendulum", "the outer ball after 2 s, x", "m", -1.43762056496, two,
                 "newton", position(1, Vector3::UnitX())});
}

}  // namespace

std::vector<ReferenceProblem> reference_problems() {
  std::vector<ReferenceProblem> all;
  add_blocks(all);
  add_balls(all);
  add_stacks(all);
  add_turning(all);
  add_joints(all);
  for (ReferenceProblem& problem : all) {
    problem.of_moment = problem.unit == "s" || problem.quantity.ends_with("turning at");
  }
  return all;
}

}  // namespace kairos::experiments
