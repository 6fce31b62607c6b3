#include "core/forces/drag.hpp"
#include "core/forces/spring.hpp"
#include "integrators/catalogue/catalogue.hpp"
#include "tests/catch.hpp"
#include "tests/integrators/problems.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace kairos::integrators::test {
namespace {

const CatalogueEntry& find(std::string_view name) {
  const auto entries = catalogue();
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const CatalogueEntry& entry) {
    return entry.info.name == name;
  });
  REQUIRE(found != entries.end());
  return *found;
}

/// Local time at which a motion's height first falls to `height`; it must within the motion.
double time_of_height(const Motion& motion, double height) {
  double low = 0.0, high = motion.duration;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (motion.position(middle).y() > height ? low : high) = middle;
  }
  return high;
}

/// Drops a table-tennis ball of 2.7 g and radius 20 mm by 1 m through air of 1.2 kg/m^3, Cd 0.45, g
/// = 9.81: it lands after acosh(exp(k H / m)) / sqrt(g k / m), k = rho Cd A / 2.
void check_landing(const CatalogueEntry& entry) {
  const double exact_time = 0.4610370640415288, exact_speed = 4.165174324051543;
  const QuadraticDrag drag({.density = 1.2,
                            .drag_coefficient = 0.45,
                            .area = std::numbers::pi * 0.02 * 0.02,
                            .wind = Vector3::Zero()});
  const double mass = 2.7e-3;
  const Island island{.bodies = {0},
                      .inertia = {{.mass = mass, .principal = Vector3::Zero(), .rotates = false}},
                      .constant_force = {{0.0, -9.81 * mass, 0.0}},
                      .forces = {&drag}};
  CAPTURE(entry.info.name);
  const std::unique_ptr<Stepper> stepper =
      entry.make({.relative_tolerance = 1e-13, .absolute_tolerance = 1e-13});
  std::vector<BodyState> states(1);
  states[0].pose.position.y() = 1.0;
  std::vector<Motion> motions(1);
  stepper->start(island, Instant{}, states);
  Instant t;
  for (bool landed = false; !landed;) {
    const StepResult result = stepper->step(island, t, 1.0 / 60.0, states);
    if (!result.ok || !(t.seconds < 1.0)) {
      FAIL("does not land: " << result.reason);
    }
    landed = states[0].pose.position.y() <= 0.0;
    if (!landed) {
      t = t + result.advanced;
    }
  }
  stepper->dense_output(motions);
  const double s = time_of_height(motions[0], 0.0);
  CHECK(std::abs((t + s).seconds - exact_time) <= 1e-10);
  CHECK(std::abs(motions[0].velocity(s).y() + exact_speed) <= 1e-10);
}

TEST_CASE(
    "Every controlled stepper at its tightest finds the table-tennis ball's landing to 1e-10") {
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.info.controlled && entry.info.order > 2) {
      check_landing(entry);
    }
  }
}

TEST_CASE("So does the pair of order 2, in more than three million steps", "[slow]") {
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.info.controlled && entry.info.order == 2) {
      check_landing(entry);
    }
  }
}

TEST_CASE("A tighter tolerance makes a smaller error: one meaning for all controlled steppers") {
  for (const Problem* problem : {&kepler_top(), &shaken_spring()}) {
    for (const CatalogueEntry& entry : catalogue()) {
      if (!entry.info.controlled) {
        continue;
      }
      CAPTURE(entry.info.name, problem->name);
      for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11}) {
        if (entry.info.order <= 3 && tolerance < 1e-7) {
          continue;  // pairs of order 2 would take 1e6 steps
        }
        CAPTURE(tolerance);
        const std::unique_ptr<Stepper> stepper =
            entry.make({.relative_tolerance = tolerance, .absolute_tolerance = tolerance});
        std::vector<BodyState> states{problem->initial};
        std::vector<Motion> motions(1);
        stepper->start(problem->island, Instant{}, states);
        Instant t;
        double error = 0.0;
        std::size_t sample = 0;
        for (int steps = 0; problem->duration - t.seconds > 1e-12; ++steps) {
          const StepResult result =
              stepper->step(problem->island, t, problem->duration - t.seconds, states);
          REQUIRE(result.ok);
          REQUIRE(steps < 20000);
          stepper->dense_output(motions);
          const double end = t.seconds + result.advanced;
          for (; sample < problem->times.size() && problem->times[sample] <= end; ++sample) {
            const double s = problem->times[sample] - t.seconds;
            const BodyState& truth = problem->solution[sample];
            error = std::max({error, (motions[0].position(s) - truth.pose.position).norm(),
                              (motions[0].velocity(s) - truth.twist.linear).norm()});
          }
          t = t + result.advanced;
        }
        // Local errors add up over the steps and the flow stretches them, 20-fold on these
        // problems; multistep estimates and interpolants are looser than those of one-step pairs.
        CHECK(error <= (entry.info.variable_order ? 3000.0 : 300.0) * tolerance);
      }
    }
  }
}

/// Largest |E/E0 - 1| over `periods` periods of a spring, by a fixed step of 1/40 of a period.
double energy_drift(std::string_view name, int periods) {
  const Spring spring({.stiffness = 1.0,
                       .damping = 0.0,
                       .rest_length = 0.0,
                       .point_A = Vector3::Zero(),
                       .point_B = Vector3::Zero(),
                       .anchor_W = Vector3::Zero()});
  const Island island{.bodies = {0},
                      .inertia = {{.mass = 1.0, .principal = Vector3::Zero(), .rotates = false}},
                      .constant_force = {Vector3::Zero()},
                      .forces = {&spring}};
  std::vector<BodyState> states(1);
  states[0].pose.position.x() = 1.0;
  const std::unique_ptr<Stepper> stepper = find(name).make({});
  stepper->start(island, Instant{}, states);
  const double h = 2.0 * std::numbers::pi / 40.0;
  double drift = 0.0;
  Instant t;
  for (int k = 0; k < 40 * periods; ++k) {
    stepper->step(island, t, h, states);
    t = t + h;
    const double energy =
        0.5 * (states[0].twist.linear.squaredNorm() + states[0].pose.position.squaredNorm());
    drift = std::max(drift, std::abs(2.0 * energy - 1.0));
  }
  return drift;
}

TEST_CASE("Symplectic steppers keep the energy of a spring bounded; Runge-Kutta 4 loses it") {
  // A thousand periods as ten: nothing grows but roundoff.
  for (const std::string_view name :
       {"symplectic-euler", "velocity-verlet", "free-top-splitting", "forest-ruth", "suzuki4"}) {
    CAPTURE(name);
    CHECK(find(name).info.symplectic);
    CHECK(energy_drift(name, 1000) <= 1.01 * energy_drift(name, 10) + 1e-12);
  }
  // |R(i h)|^2 = 1 - h^6/72 + h^8/576 of RK4's stability function.
  const double h = 2.0 * std::numbers::pi / 40.0;
  const double per_step = std::log1p(-std::pow(h, 6) / 72.0 + std::pow(h, 8) / 576.0);
  CHECK(energy_drift("rk4", 100) == Approx(-std::expm1(4000 * per_step)).epsilon(1e-9));
}

TEST_CASE("After each restart a controlled stepper costs little more than one that starts cold") {
  const Problem& problem = kepler_top();
  for (const CatalogueEntry& entry : catalogue()) {
    if (!entry.info.controlled) {
      continue;
    }
    CAPTURE(entry.info.name);
    const auto cost_of_leg = [&](Stepper& stepper, Instant t, std::vector<BodyState>& states) {
      const std::int64_t before = stepper.evaluations();
      const Instant end = t + 0.1;
      while (end - t > 1e-13) {
        const StepResult result = stepper.step(problem.island, t, end - t, states);
        if (!result.ok) {
          FAIL(result.reason);
        }
        t = t + result.advanced;
      }
      return stepper.evaluations() - before;
    };
    const std::unique_ptr<Stepper> stepper = entry.make({}), fresh = entry.make({});
    std::vector<BodyState> states{problem.initial};
    stepper->start(problem.island, Instant{}, states);
    cost_of_leg(*stepper, Instant{}, states);
    states[0].twist.linear.x() *= -1.0;
    std::vector<BodyState> same = states;
    stepper->restart(problem.island, Instant{} + 0.1, states);
    fresh->start(problem.island, Instant{} + 0.1, same);
    const std::int64_t warm = cost_of_leg(*stepper, Instant{} + 0.1, states);
    const std::int64_t cold = cost_of_leg(*fresh, Instant{} + 0.1, same);
    CAPTURE(cold, warm);
    CHECK(warm <= cold + cold / 2);
  }
}

}  // namespace
}  // namespace kairos::integrators::test
