#include "integrators/catalogue/catalogue.hpp"
#include "integrators/closed_form.hpp"
#include "integrators/dormand_prince.hpp"
#include "integrators/splitting.hpp"
#include "integrators/top_splitting.hpp"
#include "tests/catch.hpp"
#include "tests/integrators/problems.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace kairos::integrators::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A box that is thrown to turn about its middle axis, nearly: it flips over and over
/// [Ashbaugh1991].
const Vector3 moments(1.0, 2.0, 3.0);
Island flipping_box() {
  return {.bodies = {0},
          .inertia = {{.mass = 1.0, .principal = moments, .rotates = true}},
          .constant_force = {Vector3::Zero()},
          .forces = {}};
}
BodyState flipping_state() {
  BodyState state;
  state.twist.angular = {0.01, 1.0, 0.0};
  return state;
}

double rotational_energy(const BodyState& state) {
  const Vector3 w_B = state.pose.orientation.conjugate() * state.twist.angular;
  return 0.5 * w_B.dot(moments.cwiseProduct(w_B));
}

/// What a free top must keep, over a run.
struct Drifts {
  double momentum = 0.0;  ///< relative
  double energy = 0.0;    ///< relative
  int flips = 0;          ///< of the middle axis against the angular momentum
};

Drifts run_free_top(Stepper& stepper, double duration, double h) {
  const Island island = flipping_box();
  const BodyInertia& inertia = island.inertia[0];
  std::vector<BodyState> states{flipping_state()};
  stepper.start(island, Instant{}, states);
  const Vector3 L0 = angular_momentum(inertia, states[0].pose.orientation, states[0].twist.angular);
  const double E0 = rotational_energy(states[0]);
  Drifts drifts;
  double side = 1.0;
  Instant t;
  while (t.seconds < duration) {
    const StepResult result = stepper.step(island, t, h, states);
    REQUIRE(result.ok);
    t = t + result.advanced;
    const Vector3 L =
        angular_momentum(inertia, states[0].pose.orientation, states[0].twist.angular);
    drifts.momentum = std::max(drifts.momentum, (L - L0).norm() / L0.norm());
    drifts.energy = std::max(drifts.energy, std::abs(rotational_energy(states[0]) / E0 - 1.0));
    const double now = (states[0].pose.orientation * Vector3::UnitY()).dot(L0) > 0.0 ? 1.0 : -1.0;
    drifts.flips += now != side ? 1 : 0;
    side = now;
  }
  return drifts;
}

TEST_CASE(
    "The splitting keeps the angular momentum of a flipping box for 1e4 s, its energy to h^2") {
  const std::unique_ptr<Stepper> stepper = make_free_top_splitting({});
  const Drifts coarse = run_free_top(*stepper, 1e4, 0.02);
  CHECK(coarse.flips > 400);  // one every 20 s or so
  CHECK(coarse.momentum <= 1e-12);
  // Bounded: no larger over 1e4 s than over 100 s, but for where its maxima fall; a quarter with
  // h/2.
  const Drifts short_run = run_free_top(*stepper, 100.0, 0.02);
  CHECK(coarse.energy <= 1.1 * short_run.energy);
  const Drifts fine = run_free_top(*stepper, 100.0, 0.01);
  CHECK(fine.energy == Approx(short_run.energy / 4.0).epsilon(0.05));
}

TEST_CASE("The exact solution keeps momentum and energy of a flipping box within 1e-12 for 1e4 s") {
  const std::unique_ptr<Stepper> stepper = make_closed_form({});
  std::vector<BodyState> states{flipping_state()};
  const Island island = flipping_box();
  stepper->start(island, Instant{}, states);
  if (!stepper->step(island, Instant{}, 1.0, states).ok) {
    return;  // a build without GSL
  }
  const Drifts drifts = run_free_top(*stepper, 1e4, 10.0);
  CHECK(drifts.flips > 400);
  CHECK(drifts.momentum <= 1e-12);
  CHECK(drifts.energy <= 1e-12);
}

TEST_CASE("The exact solution of a free top agrees with the extrapolated one, fit bound included") {
  const Problem& problem = free_top();
  const std::unique_ptr<Stepper> stepper = make_closed_form({});
  Island island = problem.island;
  island.inertia[0].bounding_radius = 1.0;
  std::vector<BodyState> states{problem.initial};
  std::vector<Motion> motions(1);
  stepper->start(island, Instant{}, states);
  Instant t;
  std::size_t sample = 0;
  while (problem.duration - t.seconds > 1e-12) {
    const StepResult result = stepper->step(island, t, problem.duration - t.seconds, states);
    if (!result.ok) {
      return;  // a build without GSL
    }
    stepper->dense_output(motions);
    for (; sample < problem.times.size() && problem.times[sample] <= t.seconds + result.advanced;
         ++sample) {
      const double s = problem.times[sample] - t.seconds;
      const BodyState& truth = problem.solution[sample];
      const Quaternion q = motions[0].pose(s).orientation;
      // Roundoff of elliptic functions and of the reference's double, a few turns in.
      CHECK(2.0 * (q.conjugate() * truth.pose.orientation).vec().norm() <= 5e-13);
      CHECK((motions[0].twist(s).angular - truth.twist.angular).norm() <= 2e-12);
    }
    CHECK(motions[0].error_radius > 0.0);
    CHECK(motions[0].error_radius < 1e-12);
    t = t + result.advanced;
  }
  CHECK(sample >= problem.times.size() - 1);
}

TEST_CASE("Tops near and at the edges of the elliptic functions") {
  // Symmetric, oblate and prolate; nearly steady about each axis; near the separatrix.
  struct Case {
    Vector3 principal, w;
  };
  const Case cases[] = {{{1, 1, 2}, {0.3, 0.4, 1.0}},           {{2, 2, 1}, {0.3, 0.4, 1.0}},
                        {{2, 1, 1}, {0.3, 0.4, 1.0}},           {{1, 2, 3}, {1.0, 1e-6, 1e-6}},
                        {{1, 2, 3}, {1e-6, 1e-6, 1.0}},         {{1, 2, 3}, {1e-4, 1.0, 1e-4}},
                        {{3, 1, 2}, {-0.4, 0.7, -0.2}},         {{2, 3, 1}, {0.4, -0.7, -0.2}},
                        {{1, 2, 3}, {std::sqrt(3.0), 1.0, 1.0}}};
  for (const Case& c : cases) {
    CAPTURE(c.principal.transpose(), c.w.transpose());
    const Island island{.bodies = {0},
                        .inertia = {{.mass = 1.0, .principal = c.principal, .rotates = true}},
                        .constant_force = {Vector3::Zero()},
                        .forces = {}};
    BodyState initial;
    initial.pose.orientation = Quaternion(0.5, -0.5, 0.5, 0.5);
    initial.twist.angular = initial.pose.orientation * c.w;
    std::vector<BodyState> exact{initial}, reference{initial};
    const std::unique_ptr<Stepper> closed = make_closed_form({});
    const std::unique_ptr<Stepper> dopri =
        make_dopri5({.relative_tolerance = 1e-13, .absolute_tolerance = 1e-14});
    const auto run = [&](Stepper& stepper, std::vector<BodyState>& states) {
      stepper.start(island, Instant{}, states);
      Instant t;
      while (5.0 - t.seconds > 1e-12) {
        const StepResult result = stepper.step(island, t, 5.0 - t.seconds, states);
        if (!result.ok) {
          return false;
        }
        t = t + result.advanced;
      }
      return true;
    };
    if (!run(*closed, exact)) {
      return;  // a build without GSL
    }
    REQUIRE(run(*dopri, reference));
    // The tolerance of the reference, gathered over its steps.
    CHECK((exact[0].twist.angular - reference[0].twist.angular).norm() <= 1e-10);
    CHECK((exact[0].pose.orientation.conjugate() * reference[0].pose.orientation).vec().norm() <=
          1e-10);
  }
}

TEST_CASE("A flip that hangs on roundoff is not foretold but refused with a reason") {
  const Island island = flipping_box();
  std::vector<BodyState> states(1);
  states[0].twist.angular = {1e-9, 1.0, 1e-9};
  const std::unique_ptr<Stepper> stepper = make_closed_form({});
  stepper->start(island, Instant{}, states);
  const StepResult result = stepper->step(island, Instant{}, 1.0, states);
  CHECK(!result.ok);
  CHECK(!result.reason.empty());
}

TEST_CASE("A body that turns about a principal axis keeps its rate, however it is stepped") {
  const Island island = flipping_box();
  for (const CatalogueEntry& entry : catalogue()) {
    CAPTURE(entry.info.name);
    const std::unique_ptr<Stepper> stepper = entry.make({});
    if (!stepper->refuses(island).empty() || (entry.info.controlled && entry.info.order <= 3)) {
      continue;
    }
    std::vector<BodyState> states(1);
    states[0].twist.angular = {0.0, 0.0, 2.0};
    stepper->start(island, Instant{}, states);
    Instant t;
    while (t.seconds < 0.5) {
      const StepResult result = stepper->step(island, t, 0.01, states);
      REQUIRE(result.ok);
      t = t + result.advanced;
    }
    // The rate is constant to the roundoff of each step; solvers hold it to their tolerance.
    const double allowed = entry.info.controlled ? 1e-8 : 400.0 * eps;
    CHECK((states[0].twist.angular - Vector3(0.0, 0.0, 2.0)).norm() <= allowed);
  }
}

}  // namespace
}  // namespace kairos::integrators::test
