#include "core/reading/scene_reader.hpp"
#include "experiments/thesis/errata.hpp"
#include "experiments/thesis/errata_runs.hpp"
#include "experiments/thesis/phase_runs.hpp"

#include <fmt/format.h>

#include <cmath>

// Errata about when and how contacts are handled: predictions 2, 4, 6, 7 and 8.

namespace kairos::experiments::thesis {
namespace {

/// E[max(0, 1 - h2/h1)] for two frame times uniform in 1 +- j, by the midpoint rule.
double expected_turns(double jitter) {
  constexpr int n = 400;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const double h1 = 1.0 + jitter * (2.0 * (i + 0.5) / n - 1.0);
      const double h2 = 1.0 + jitter * (2.0 * (k + 0.5) / n - 1.0);
      sum += std::max(0.0, 1.0 - h2 / h1);
    }
  }
  return sum / (n * n);
}

/// Two balls of equal mass, the second hit with the line of centres at `theta` off the velocity of
/// the first; `shared`: both move, with opposite velocities (the centre-of-mass frame).
Scene two_balls(double theta, bool shared) {
  const double reach = 0.2001;
  return parse_scene(
      fmt::format("name = \"two\"\nsummary = \"\"\nduration = 0.04\nframe = 0.01\nG = 0.0\n"
                  "[[body]]\nname = \"a\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\n"
                  "position = [{}, {}, 0]\nvelocity = [0.1, 0, 0]\n"
                  "[[body]]\nname = \"b\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\n"
                  "velocity = [{}, 0, 0]\n",
                  -reach * std::cos(theta), -reach * std::sin(theta), shared ? -0.1 : 0.0),
      "two-balls.toml");
}

/// Angle between what the thesis makes of the second ball's velocity and what is right.
double direction_error(double theta, bool shared) {
  RunChoice choice = thesis_choice(0.01, 0.04);
  const Simulation literal = simulate(two_balls(theta, shared), choice);
  choice.method = {"event-driven", "auto", "certified", "newton"};
  const Simulation right = simulate(two_balls(theta, shared), choice);
  const Vector3 v = literal.trajectory.events().at(0).after_b.twist.linear;
  const Vector3 w = right.trajectory.events().at(0).after_b.twist.linear;
  return std::atan2(v.cross(w).norm(), v.dot(w));
}

}  // namespace

std::vector<Check> jiggle(Size size) {
  const int n = size == Size::full ? 6000 : 1500;
  std::vector<Check> checks;
  for (const double jitter : {0.0, 0.1, 0.3}) {
    const double expected = expected_turns(jitter);
    checks.push_back({fmt::format("fraction turned back in, frame time ±{:g} %", 100.0 * jitter),
                      "", expected, turned_fraction(jitter, n), Agreement::equal,
                      4.0 * std::sqrt(expected * (1.0 - expected) / n), "4 standard deviations"});
  }
  for (const double e : {0.9, 0.5}) {
    // Gravity between two frames changes the speed by G h / v = 1.7 %.
    checks.push_back({fmt::format("fraction turned back in, restitution {:g}", e), "", 1.0 - e,
                      turned_fraction_lossy(e, n / 4), Agreement::equal, 0.02,
                      "physical: gravity in one frame"});
  }
  return checks;
}

std::vector<Check> tunnelling(Size size) {
  const int n = size == Size::full ? 512 : 128;
  std::vector<Check> checks;
  for (const double speed : {3.0, 6.0, 20.0, 200.0}) {
    checks.push_back({fmt::format("fraction through the wall at {:g} m/s", speed), "",
                      std::max(0.0, 1.0 - bullet_length / (speed * frame)),
                      tunnelled_fraction(substep_choice("original"), speed, n), Agreement::equal,
                      1.0 / n, "one phase"});
  }
  checks.push_back({"the same at 200 m/s, event-driven", "", 0.0, tunnelled_fraction({}, 200.0, n),
                    Agreement::equal, 0.0, "exact"});
  return checks;
}

std::vector<Check> swallowing_conveyor(Size) {
  const auto run = [](double mass, double seconds) {
    return simulate(shipped("conveyor", {{"body.ball.mass", fmt::format("{}", mass)}}),
                    thesis_choice(frame, seconds));
  };
  const auto outwards = [&](double mass) {  // after the first collision
    return run(mass, 1.5).trajectory.events().at(0).after_b.twist.linear.y() > 0.0;
  };
  double light = 1.0;
  double heavy = 20.0;
  while (heavy - light > 1e-6) {
    const double middle = 0.5 * (light + heavy);
    (outwards(middle) ? heavy : light) = middle;
  }
  std::vector<Check> checks{{"mass from which a ball leaves the first collision outwards", "kg",
                             10.0, heavy, Agreement::equal, 1e-6, "width of the bisection"}};
  // Each frame inside turns the sinking speed u into c u, c = (10-m)/(10+m), and gravity adds G h:
  // at rest with itself where c (u + G h) = u.
  for (const double mass : {3.0, 5.0, 7.0, 9.9}) {
    const Simulation inside = run(mass, 1.0);
    const auto height = [&](std::size_t n) {
      return inside.trajectory.frame_state(n)[1].pose.position.y();
    };
    const double predicted = (10.0 - mass) * G * frame / (2.0 * mass);
    checks.push_back({fmt::format("speed at which {:g} kg sink through the belt", mass), "m/s",
                      predicted, (height(50) - height(60)) / (10.0 * frame), Agreement::equal,
                      0.01 * predicted, "the approach to it, a factor c a frame"});
  }
  return checks;
}

std::vector<Check> whole_vector_exchange(Size) {
  std::vector<Check> checks;
  for (const double theta : {0.3, 0.7}) {
    // Physical: the line of centres turns by (distance flown in the overlap)/(2r) until they meet.
    checks.push_back({fmt::format("error of direction, target at rest, θ = {:g}", theta), "rad",
                      theta, direction_error(theta, false), Agreement::equal, 0.01,
                      "physical: one frame of flight"});
    checks.push_back({fmt::format("error of direction, centre-of-mass frame, θ = {:g}", theta),
                      "rad", 2.0 * theta, direction_error(theta, true), Agreement::equal, 0.02,
                      "physical: one frame of flight"});
  }
  return checks;
}

std::vector<Check> one_collision_a_frame(Size) {
  // Two balls reach the same floor in the same frame; the floor is created last.
  const Scene scene = parse_scene(
      "name = \"guard\"\nsummary = \"\"\nduration = 1\nframe = \"1/60\"\nG = 0.0\n"
      "[[body]]\nname = \"a\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\n"
      "position = [-1, 0.15, 0]\nvelocity = [0, -6, 0]\n"
      "[[body]]\nname = \"b\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\n"
      "position = [1, 0.15, 0]\nvelocity = [0, -6, 0]\n"
      "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n",
      "two-balls-one-floor.toml");
  const auto later = [&](const RunChoice& choice) {
    const Simulation run = simulate(scene, choice);
    const auto& events = run.trajectory.events();
    return (events.at(1).time - events.at(0).time) / frame;
  };
  RunChoice exact;
  exact.duration = 0.5;
  return {{"how much later the second ball is handled", "frames", 1.0,
           later(thesis_choice(frame, 0.5)), Agreement::equal, 1e-9, "roundoff of times"},
          {"the same, event-driven", "frames", 0.0, later(exact), Agreement::equal, 1e-9,
           "roundoff of times"}};
}

}  // namespace kairos::experiments::thesis
