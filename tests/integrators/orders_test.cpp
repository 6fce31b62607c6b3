#include "integrators/catalogue.hpp"
#include "tests/catch.hpp"
#include "tests/integrators/problems.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kairos::integrators::test {
namespace {

/// Largest errors of one run with a fixed step against the reference.
struct Errors {
  double step = 0.0;           ///< position and velocity at the end of the run
  double step_rotation = 0.0;  ///< orientation (rad) and angular velocity there
  double position = 0.0;       ///< of the dense output, over all samples
  double velocity = 0.0;
  double orientation = 0.0;
  double angular_velocity = 0.0;
};

double angle(const Quaternion& a, const Quaternion& b) {
  return 2.0 * (a.conjugate() * b).vec().norm();
}

StepperOptions fixed_step() {
  return {.relative_tolerance = std::numeric_limits<double>::infinity(),
          .absolute_tolerance = std::numeric_limits<double>::infinity()};
}

Errors run(const CatalogueEntry& entry, const Problem& problem, int steps) {
  const std::unique_ptr<Stepper> stepper = entry.make(fixed_step());
  std::vector<BodyState> states{problem.initial};
  std::vector<Motion> motions(1);
  stepper->start(problem.island, Instant{}, states);
  const double h = problem.duration / steps;
  Errors errors;
  std::size_t sample = 0;
  Instant t;
  for (int k = 0; k < steps; ++k) {
    const StepResult result = stepper->step(problem.island, t, h, states);
    REQUIRE(result.ok);
    REQUIRE(result.advanced == h);
    stepper->dense_output(motions);
    for (; sample < problem.times.size() &&
           (problem.times[sample] <= t.seconds + h || k + 1 == steps);
         ++sample) {
      const double s = std::min(problem.times[sample] - t.seconds, h);
      const BodyState& truth = problem.solution[sample];
      const Pose pose = motions[0].pose(s);
      const Twist twist = motions[0].twist(s);
      const auto raise = [](double& largest, double value) { largest = std::max(largest, value); };
      raise(errors.position, (pose.position - truth.pose.position).norm());
      raise(errors.velocity, (twist.linear - truth.twist.linear).norm());
      raise(errors.orientation, angle(pose.orientation, truth.pose.orientation));
      raise(errors.angular_velocity, (twist.angular - truth.twist.angular).norm());
    }
    t = t + h;
  }
  const BodyState& end = problem.solution.back();
  errors.step = (states[0].pose.position - end.pose.position).norm() +
                (states[0].twist.linear - end.twist.linear).norm();
  errors.step_rotation = angle(states[0].pose.orientation, end.pose.orientation) +
                         (states[0].twist.angular - end.twist.angular).norm();
  return errors;
}

/// Steps at which a method of some order is in its asymptotic regime and above roundoff.
int first_steps(int order) { return order <= 2 ? 256 : order <= 4 ? 48 : order == 5 ? 28 : 12; }

/// Errors must fall as h^order: from C h^order, calibrated at the largest step, by 2^order with
/// each halving, down to roundoff. The slope over all halvings is within 0.1 of the order up to
/// order 5 (4 halvings), 0.3 above (2 halvings); more is allowed where `exact_order` is false.
void check_slope(const char* what, const std::vector<double>& errors, int order, int steps) {
  // Each step rounds; scale: 20 m, m/s, rad or rad/s, the largest that the problems reach.
  const double roundoff = (100.0 + 0.25 * steps) * std::numeric_limits<double>::epsilon() * 20.0;
  const double slack = order <= 5 ? 0.1 : 0.3;
  const double C = errors.front();
  CAPTURE(what, order, errors);
  double bound = C;
  std::size_t used = 0;
  for (std::size_t k = 1; k < errors.size(); ++k) {
    bound *= std::pow(2.0, -(order - slack));
    CHECK(errors[k] <= std::max(bound, roundoff));
    used = errors[k] > 10.0 * roundoff ? k : used;
  }
  if (used > 0) {
    const double slope = std::log2(errors.front() / errors[used]) / static_cast<double>(used);
    CHECK(slope > order - slack);
  }
}

void check_orders(const CatalogueEntry& entry, const Problem& problem) {
  const StepperInfo& info = entry.info;
  const int halvings = info.order <= 5 ? 4 : 2;
  std::vector<Errors> runs;
  for (int k = 0; k <= halvings; ++k) {
    runs.push_back(run(entry, problem, first_steps(info.order) << k));
  }
  const auto column = [&](double Errors::*field) {
    std::vector<double> values;
    for (const Errors& errors : runs) {
      values.push_back(errors.*field);
    }
    return values;
  };
  CAPTURE(info.name, problem.name);
  const int steps = first_steps(info.order) << halvings;
  check_slope("step", column(&Errors::step), info.order, steps);
  check_slope("position", column(&Errors::position), info.position_order, steps);
  check_slope("velocity", column(&Errors::velocity), info.velocity_order, steps);
  if (problem.island.inertia[0].rotates) {
    check_slope("step, rotation", column(&Errors::step_rotation), info.order, steps);
    check_slope("orientation", column(&Errors::orientation), info.position_order, steps);
    check_slope("angular velocity", column(&Errors::angular_velocity), info.velocity_order, steps);
  }
}

TEST_CASE("Every stepper has its declared order, in its steps and in its dense output") {
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.info.order == 0 || entry.info.variable_order) {
      continue;
    }
    for (const Problem* problem : {&kepler_top(), &free_top(), &shaken_spring()}) {
      if (entry.make(fixed_step())->refuses(problem->island).empty()) {
        check_orders(entry, *problem);
      }
    }
  }
}

}  // namespace
}  // namespace kairos::integrators::test
