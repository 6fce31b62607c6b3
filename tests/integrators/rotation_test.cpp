#include "integrators/catalogue.hpp"
#include "integrators/splitting.hpp"
#include "integrators/top_splitting.hpp"
#include "tests/catch.hpp"

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
  std::vector<BodyState> states{flipping_state()};
  stepper.start(island, Instant{}, states);
  const Vector3 L0 = angular_momentum(moments, states[0].pose.orientation, states[0].twist.angular);
  const double E0 = rotational_energy(states[0]);
  Drifts drifts;
  double side = 1.0;
  Instant t;
  while (t.seconds < duration) {
    const StepResult result = stepper.step(island, t, h, states);
    REQUIRE(result.ok);
    t = t + result.advanced;
    const Vector3 L =
        angular_momentum(moments, states[0].pose.orientation, states[0].twist.angular);
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
