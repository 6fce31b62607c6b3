#include "integrators/catalogue/catalogue.hpp"
#include "tests/allocations.hpp"
#include "tests/catch.hpp"
#include "tests/integrators/problems.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <set>

namespace kairos::integrators::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Pairs of low order would need millions of steps at the default tolerance.
StepperOptions options_for(const StepperInfo& info) {
  return info.controlled && info.order <= 3
             ? StepperOptions{.relative_tolerance = 1e-7, .absolute_tolerance = 1e-7}
             : StepperOptions{};
}

/// The name of each entry is in the message of a failure; entries that refuse a problem are left
/// out of it, but each must accept a ball under gravity.
template <typename Check>
void for_each_stepper(const Island& island, const Check& check) {
  for (const CatalogueEntry& entry : catalogue()) {
    CAPTURE(entry.info.name);
    const std::unique_ptr<Stepper> stepper = entry.make(options_for(entry.info));
    if (stepper->refuses(island).empty()) {
      check(entry, *stepper);
    }
  }
}

Island falling_bodies(std::size_t count) {
  Island island;
  for (std::size_t i = 0; i < count; ++i) {
    const double mass = 1.0 + static_cast<double>(i);
    island.bodies.push_back(i);
    island.inertia.push_back({.mass = mass, .principal = {0.4, 0.4, 0.4}, .rotates = i % 2 == 1});
    island.constant_force.emplace_back(0.1, -9.8 * mass, 0.0);
  }
  return island;
}

std::vector<BodyState> thrown_bodies(std::size_t count) {
  std::vector<BodyState> states(count);
  for (std::size_t i = 0; i < count; ++i) {
    states[i].pose.position = {0.1, 5.0 + static_cast<double>(i), -0.3};
    states[i].pose.orientation = Quaternion(0.5, 0.5, -0.5, 0.5);
    states[i].twist.linear = {1.0, 2.0, -0.5};
    states[i].twist.angular = i % 2 == 1 ? Vector3(0.3, -2.0, 1.0) : Vector3(Vector3::Zero());
  }
  return states;
}

bool same_bits(const BodyState& a, const BodyState& b) {
  return a.pose.position == b.pose.position &&
         a.pose.orientation.coeffs() == b.pose.orientation.coeffs() &&
         a.twist.linear == b.twist.linear && a.twist.angular == b.twist.angular;
}

/// Advances by `duration` in steps of at most h; at each step hands the motions to `look`.
template <typename Look>
Instant advance(Stepper& stepper, const Island& island, Instant t, double duration, double h,
                std::vector<BodyState>& states, const Look& look) {
  std::vector<Motion> motions(states.size());
  const Instant end = t + duration;
  int steps = 0;
  while (end - t > 0.0) {
    const double asked = std::min(h, end - t);
    const std::vector<BodyState> before = states;
    const StepResult result = stepper.step(island, t, asked, states);
    REQUIRE(result.ok);
    REQUIRE(result.advanced > 0.0);
    REQUIRE(result.advanced <= asked);
    stepper.dense_output(motions);
    look(before, motions, t, result.advanced);
    t = t + result.advanced;
    REQUIRE(++steps < 200000);
  }
  return t;
}

void check_motion(const Island& island, const BodyState& before, const BodyState& after,
                  const Motion& motion, double h, std::size_t body) {
  CAPTURE(body, h);
  // Bit for bit where it starts.
  CHECK(motion.duration == h);
  CHECK(motion.position[0] == before.pose.position);
  CHECK(motion.velocity[0] == before.twist.linear);
  CHECK(motion.error_radius >= 0.0);
  // At its end, roundoff: Horner's rule rounds in proportion to the sum of its terms' sizes.
  const auto scale_of = [h](const Polynomial<3>& p) {
    double sum = 0.0;
    for (int k = p.degree(); k >= 0; --k) {
      sum = sum * h + p[k].norm();
    }
    return sum;
  };
  const double position_scale = scale_of(motion.position) + after.pose.position.norm();
  const double velocity_scale = scale_of(motion.velocity) + after.twist.linear.norm();
  const Pose end = motion.pose(h);
  const Twist twist = motion.twist(h);
  CHECK((end.position - after.pose.position).norm() <= 32.0 * eps * position_scale);
  CHECK((twist.linear - after.twist.linear).norm() <= 32.0 * eps * velocity_scale);
  const double turned = (end.orientation.conjugate() * after.pose.orientation).vec().norm();
  CHECK(turned <= 64.0 * eps + motion.error_radius);
  CHECK(std::abs(after.pose.orientation.norm() - 1.0) <= 8.0 * eps);
  if (!island.inertia[body].rotates) {
    CHECK(motion.rotation == RotationKind::fixed);
    CHECK(after.pose.orientation.coeffs() == before.pose.orientation.coeffs());
  } else {
    const double scale = scale_of(motion.angular_velocity) + after.twist.angular.norm();
    CHECK((twist.angular - after.twist.angular).norm() <= 32.0 * eps * scale);
  }
}

void check_run(Stepper& stepper, const Island& island, std::vector<BodyState> states,
               double duration, double h) {
  stepper.start(island, Instant{}, states);
  advance(stepper, island, Instant{}, duration, h, states,
          [&](const std::vector<BodyState>& before, const std::vector<Motion>& motions, Instant t,
              double advanced) {
            for (std::size_t i = 0; i < states.size(); ++i) {
              CHECK(motions[i].start == t);
              check_motion(island, before[i], states[i], motions[i], advanced, i);
            }
          });
  CHECK(stepper.evaluations() > 0);
}

TEST_CASE("The catalogue names each stepper once and tells what it tells") {
  std::set<std::string_view> names;
  for (const CatalogueEntry& entry : catalogue()) {
    CAPTURE(entry.info.name);
    CHECK(names.insert(entry.info.name).second);
    const StepperInfo info = entry.make({})->info();
    CHECK(info.name == entry.info.name);
    CHECK(info.order == entry.info.order);
    CHECK((info.variable_order || info.position_order >= info.order));
    CHECK((info.variable_order || info.velocity_order >= info.order));
    CHECK(!info.library.empty());
    CHECK(!info.source.empty());
    CHECK(entry.make({})->refuses(falling_bodies(3)).empty());
  }
  CHECK(names.count("thesis-euler") == 1);
}

TEST_CASE("Motions start at the state bit for bit and end where the step left it") {
  const auto check = [](const Problem& problem) {
    for_each_stepper(problem.island, [&](const CatalogueEntry&, Stepper& stepper) {
      check_run(stepper, problem.island, {problem.initial}, 0.5, 1.0 / 60.0);
    });
  };
  check(kepler_top());
  check(free_top());
  check(shaken_spring());
  const Island island = falling_bodies(3);
  for_each_stepper(island, [&](const CatalogueEntry&, Stepper& stepper) {
    check_run(stepper, island, thrown_bodies(3), 0.5, 1.0 / 60.0);
  });
}

TEST_CASE("Steps may be tiny: nothing overflows and motions stay finite") {
  const Problem& problem = kepler_top();
  for_each_stepper(problem.island, [&](const CatalogueEntry&, Stepper& stepper) {
    for (const double h : {1e-6, 1e-9, 1e-12, 1e-15}) {
      std::vector<BodyState> states{problem.initial};
      std::vector<Motion> motions(1);
      stepper.start(problem.island, Instant{}, states);
      const StepResult result = stepper.step(problem.island, Instant{}, h, states);
      REQUIRE(result.ok);
      stepper.dense_output(motions);
      CAPTURE(h);
      const double end = result.advanced;
      CHECK(motions[0].pose(0.5 * end).position.allFinite());
      CHECK(motions[0].twist(0.5 * end).linear.allFinite());
      CHECK((motions[0].pose(end).position - problem.initial.pose.position).norm() <=
            2.0 * h + 32.0 * eps);
      CHECK((motions[0].twist(end).linear - problem.initial.twist.linear).norm() <=
            10.0 * h + 32.0 * eps);
    }
  });
}

TEST_CASE("The same steps twice give the same bits") {
  const Problem& problem = kepler_top();
  for_each_stepper(problem.island, [&](const CatalogueEntry& entry, Stepper& stepper) {
    std::vector<BodyState> first{problem.initial}, second{problem.initial};
    const auto ignore = [](const auto&...) {};
    stepper.start(problem.island, Instant{}, first);
    advance(stepper, problem.island, Instant{}, 0.3, 0.01, first, ignore);
    const std::unique_ptr<Stepper> other = entry.make(options_for(entry.info));
    other->start(problem.island, Instant{}, second);
    advance(*other, problem.island, Instant{}, 0.3, 0.01, second, ignore);
    CHECK(same_bits(first[0], second[0]));
    // And again on the instance that was used before: `start` forgets everything.
    second[0] = problem.initial;
    stepper.start(problem.island, Instant{}, second);
    advance(stepper, problem.island, Instant{}, 0.3, 0.01, second, ignore);
    CHECK(same_bits(first[0], second[0]));
  });
}

TEST_CASE("After a jump of the state a restarted stepper is as good as a new one") {
  const Problem& problem = kepler_top();
  for_each_stepper(problem.island, [&](const CatalogueEntry& entry, Stepper& stepper) {
    if (entry.info.name == "thesis-euler") {
      return;  // its acceleration lags across impacts: see its own test
    }
    const auto ignore = [](const auto&...) {};
    std::vector<BodyState> states{problem.initial};
    stepper.start(problem.island, Instant{}, states);
    Instant t = advance(stepper, problem.island, Instant{}, 0.3, 0.002, states, ignore);
    states[0].twist.linear *= -0.9;
    std::vector<BodyState> fresh = states;
    stepper.restart(problem.island, t, states);
    advance(stepper, problem.island, t, 0.3, 0.002, states, ignore);
    const std::unique_ptr<Stepper> other = entry.make(options_for(entry.info));
    other->start(problem.island, t, fresh);
    advance(*other, problem.island, t, 0.3, 0.002, fresh, ignore);
    // Solver tolerance of controlled steppers, roundoff of the others.
    const double allowed = entry.info.controlled ? 1e-7 : 64.0 * eps;
    CHECK((states[0].pose.position - fresh[0].pose.position).norm() <= allowed);
    CHECK((states[0].twist.linear - fresh[0].twist.linear).norm() <= allowed);
  });
}

TEST_CASE("Steps and dense output do not allocate") {
  for (const Problem* problem : {&kepler_top(), &free_top(), &shaken_spring()}) {
    for_each_stepper(problem->island, [&](const CatalogueEntry& entry, Stepper& stepper) {
      if (entry.info.library != "kairos") {
        return;  // what libraries do inside is theirs
      }
      std::vector<BodyState> states{problem->initial};
      std::vector<Motion> motions(1);
      stepper.start(problem->island, Instant{}, states);
      stepper.step(problem->island, Instant{}, 0.001, states);
      const std::size_t before = kairos::test::allocations();
      Instant t = Instant{} + 0.001;
      for (int k = 0; k < 10; ++k) {
        const StepResult result = stepper.step(problem->island, t, 0.001, states);
        t = t + result.advanced;
        stepper.dense_output(motions);
        stepper.restart(problem->island, t, states);
      }
      CHECK(kairos::test::allocations() == before);
    });
  }
}

TEST_CASE("A step replayed in double-double differs from the computed one by roundoff") {
  const Island island = falling_bodies(2);
  for_each_stepper(island, [&](const CatalogueEntry& entry, Stepper& stepper) {
    if (entry.info.variable_order) {
      return;
    }
    std::vector<BodyState> states = thrown_bodies(2);
    std::vector<ReplayedStep> replayed(2);
    stepper.start(island, Instant{}, states);
    for (int k = 0; k < 3; ++k) {
      const std::vector<BodyState> before = states;
      const double h = 1.0 / 60.0;
      const StepResult result = stepper.step(island, Instant{} + k * h, h, states);
      REQUIRE(stepper.replay(island, result.advanced, before, replayed));
      for (std::size_t i = 0; i < states.size(); ++i) {
        CHECK((replayed[i].position_high - states[i].pose.position).norm() <=
              8.0 * eps * states[i].pose.position.norm());
        CHECK((replayed[i].velocity_high - states[i].twist.linear).norm() <=
              8.0 * eps * before[i].twist.linear.norm());
        CHECK(replayed[i].position_low.norm() <= eps * replayed[i].position_high.norm());
      }
    }
  });
  const Problem& problem = kepler_top();
  for_each_stepper(problem.island, [&](const CatalogueEntry&, Stepper& stepper) {
    std::vector<BodyState> states{problem.initial};
    std::vector<ReplayedStep> replayed(1);
    stepper.start(problem.island, Instant{}, states);
    const std::vector<BodyState> before = states;
    stepper.step(problem.island, Instant{}, 0.001, states);
    CHECK(!stepper.replay(problem.island, 0.001, before, replayed));
  });
}

}  // namespace
}  // namespace kairos::integrators::test
