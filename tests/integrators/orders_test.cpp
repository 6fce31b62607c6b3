#include "integrators/catalogue/catalogue.hpp"
#include "tests/catch.hpp"
#include "tests/integrators/problems.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace kairos::integrators::test {
namespace {

/// Root mean square errors of one run with a fixed step against the reference: of its steps where
/// they end a quarter of the run, of its dense output over all samples.
struct Errors {
  double step = 0.0;           ///< position and velocity
  double step_rotation = 0.0;  ///< orientation (rad) and angular velocity
  double position = 0.0;
  double velocity = 0.0;
  double orientation = 0.0;
  double angular_velocity = 0.0;
};

struct Quantity {
  const char* name;
  double Errors::*error;
  int StepperInfo::*order;
  bool rotation;
};
constexpr Quantity quantities[] = {
    {"step", &Errors::step, &StepperInfo::order, false},
    {"position", &Errors::position, &StepperInfo::position_order, false},
    {"velocity", &Errors::velocity, &StepperInfo::velocity_order, false},
    {"step, rotation", &Errors::step_rotation, &StepperInfo::order, true},
    {"orientation", &Errors::orientation, &StepperInfo::position_order, true},
    {"angular velocity", &Errors::angular_velocity, &StepperInfo::velocity_order, true},
};

double angle(const Quaternion& a, const Quaternion& b) {
  return 2.0 * (a.conjugate() * b).vec().norm();
}

StepperOptions fixed_step() {
  return {.relative_tolerance = std::numeric_limits<double>::infinity(),
          .absolute_tolerance = std::numeric_limits<double>::infinity()};
}

/// `steps` is a multiple of 4.
Errors run(const CatalogueEntry& entry, const Problem& problem, int steps) {
  const std::unique_ptr<Stepper> stepper = entry.make(fixed_step());
  std::vector<BodyState> states{problem.initial};
  std::vector<Motion> motions(1);
  stepper->start(problem.island, Instant{}, states);
  const double h = problem.duration / steps;
  Errors errors;
  const auto add = [](double& mean, double error, const auto& all) {
    mean += error * error / static_cast<double>(all.size());
  };
  std::size_t sample = 0;
  Instant t;
  for (int k = 1; k <= steps; ++k) {
    const StepResult result = stepper->step(problem.island, t, h, states);
    REQUIRE(result.ok);
    REQUIRE(result.advanced == h);
    stepper->dense_output(motions);
    for (; sample < problem.times.size() && (problem.times[sample] <= t.seconds + h || k == steps);
         ++sample) {
      const double s = std::min(problem.times[sample] - t.seconds, h);
      const BodyState& truth = problem.solution[sample];
      const Pose pose = motions[0].pose(s);
      const Twist twist = motions[0].twist(s);
      const auto& all = problem.times;
      add(errors.position, (pose.position - truth.pose.position).norm(), all);
      add(errors.velocity, (twist.linear - truth.twist.linear).norm(), all);
      add(errors.orientation, angle(pose.orientation, truth.pose.orientation), all);
      add(errors.angular_velocity, (twist.angular - truth.twist.angular).norm(), all);
    }
    t = t + h;
    if (4 * k % steps == 0) {
      const BodyState& truth = problem.quarters[static_cast<std::size_t>(4 * k / steps - 1)];
      const auto& all = problem.quarters;
      add(errors.step,
          (states[0].pose.position - truth.pose.position).norm() +
              (states[0].twist.linear - truth.twist.linear).norm(),
          all);
      add(errors.step_rotation,
          angle(states[0].pose.orientation, truth.pose.orientation) +
              (states[0].twist.angular - truth.twist.angular).norm(),
          all);
    }
  }
  for (const Quantity& quantity : quantities) {
    errors.*quantity.error = std::sqrt(errors.*quantity.error);
  }
  return errors;
}

/// Errors below are not clear of roundoff: every step rounds numbers of the size 1 of the problems,
/// and the flow stretches that.
double roundoff(int steps) { return std::numeric_limits<double>::epsilon() * (40.0 + steps); }

/// Runs of one stepper on one problem, each made once.
class Ladder {
 public:
  Ladder(const CatalogueEntry& entry, const Problem& problem) : entry_(entry), problem_(problem) {}

  /// Errors of n, 2 n, 4 n ... steps, as many as halvings and one: of the largest n up to which
  /// all of them are clear of roundoff. Empty if there is none.
  std::vector<double> finest(const Quantity& quantity, int halvings) {
    static const int starts[] = {256, 224, 192, 160, 144, 128, 112, 96, 80, 72, 64, 56, 48,
                                 40,  36,  32,  28,  24,  20,  18,  16, 14, 12, 10, 8};
    for (const int start : starts) {
      std::vector<double> errors;
      for (int k = halvings; k >= 0 && at(start << k).*quantity.error > roundoff(start << k); --k) {
        errors.insert(errors.begin(), at(start << k).*quantity.error);
      }
      if (errors.size() == static_cast<std::size_t>(halvings) + 1) {
        return errors;
      }
    }
    return {};
  }

 private:
  const Errors& at(int steps) {
    const auto [found, missing] = runs_.try_emplace(steps);
    if (missing) {
      found->second = run(entry_, problem_, steps);
    }
    return found->second;
  }

  const CatalogueEntry& entry_;
  const Problem& problem_;
  std::map<int, Errors> runs_;
};

/// Least-squares slope of the logarithms of errors at halved steps.
double measured_order(const std::vector<double>& errors) {
  const double middle = 0.5 * static_cast<double>(errors.size() - 1);
  double xy = 0.0, xx = 0.0;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const double x = static_cast<double>(k) - middle;
    xy -= x * std::log2(errors[k]);
    xx += x * x;
  }
  return xy / xx;
}

struct Problems {
  Problem planet, top, spring;
};

/// High orders need a longer run for errors of as many halvings to be clear of roundoff, in which
/// low orders would lose their way.
const Problems& problems_for(int order) {
  const auto make = [](double duration) {
    return Problems{make_kepler_top(duration), make_free_top(duration),
                    make_shaken_spring(duration)};
  };
  static const Problems low = make(2.0), high = make(6.0);
  return order <= 4 ? low : high;
}

TEST_CASE("Every stepper has its declared orders, no less and no more, down to roundoff") {
  for (const CatalogueEntry& entry : catalogue()) {
    const StepperInfo& info = entry.info;
    if (info.order == 0 || info.variable_order) {
      continue;
    }
    CAPTURE(info.name);
    const int halvings = info.order <= 5 ? 4 : 2;
    const double slack = info.order <= 5 ? 0.1 : 0.3;
    const Problems& problems = problems_for(info.order);
    std::set<std::string> measured;
    for (const Problem* problem : {&problems.planet, &problems.top, &problems.spring}) {
      if (!entry.make(fixed_step())->refuses(problem->island).empty()) {
        continue;
      }
      Ladder ladder(entry, *problem);
      for (const Quantity& quantity : quantities) {
        const bool parabola = problem == &problems.top;  // all but Euler's are exact
        if (quantity.rotation ? !problem->island.inertia[0].rotates : parabola) {
          continue;
        }
        const std::vector<double> errors = ladder.finest(quantity, halvings);
        if (errors.empty()) {
          continue;
        }
        CAPTURE(problem->name, quantity.name, errors);
        CHECK(measured_order(errors) == Approx(info.*quantity.order).margin(slack));
        measured.insert(quantity.name);
      }
    }
    CAPTURE(measured);
    CHECK(measured.size() == std::size(quantities));
  }
}

}  // namespace
}  // namespace kairos::integrators::test
