// SUNDIALS' own rootfinding through the port `GapFunction`: what it finds, and the traps that it
// shares with every method that looks for changes of sign from step to step.

#include "core/forces/spring.hpp"
#include "integrators/catalogue/catalogue.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

namespace kairos::integrators::test {
namespace {

constexpr std::string_view watcher = "cvode-adams";

std::unique_ptr<Stepper> make(std::string_view name, const StepperOptions& options = {}) {
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.info.name == name) {
      return entry.make(options);
    }
  }
  return nullptr;  // a build without the library
}

/// Gaps as functions of the time and x of the first body.
class Gaps final : public GapFunction {
 public:
  using Gap = std::function<double(double t, double x)>;
  explicit Gaps(std::vector<Gap> gaps) : gaps_(std::move(gaps)) {}
  [[nodiscard]] std::size_t size() const override { return gaps_.size(); }
  void evaluate(Instant t, std::span<const BodyState> states,
                std::span<double> gaps) const override {
    for (std::size_t k = 0; k < gaps_.size(); ++k) {
      gaps[k] = gaps_[k](t.seconds, states[0].pose.position.x());
    }
  }

 private:
  std::vector<Gap> gaps_;
};

const Spring& unit_spring() {
  static const Spring spring({.stiffness = 1.0,
                              .damping = 0.0,
                              .rest_length = 0.0,
                              .point_A = Vector3::Zero(),
                              .point_B = Vector3::Zero(),
                              .anchor_W = Vector3::Zero()});
  return spring;
}

/// One body of 1 kg, on a spring of 1 N/m or free.
Island one_body(bool on_spring) {
  Island island{.bodies = {0},
                .inertia = {{.mass = 1.0, .principal = Vector3::Zero(), .rotates = false}},
                .constant_force = {Vector3::Zero()},
                .forces = {}};
  if (on_spring) {
    island.forces.push_back(&unit_spring());
  }
  return island;
}

/// Ends of the steps within `duration` at which the gap is 0 within a tolerance; the run goes on
/// there.
std::vector<double> roots(const Island& island, double x, double v, double duration,
                          const Gaps::Gap& gap, double tolerance = 1e-9) {
  std::vector<double> found;
  const std::unique_ptr<Stepper> stepper = make(watcher);
  REQUIRE(stepper->watch(std::make_shared<const Gaps>(std::vector<Gaps::Gap>{gap})));
  std::vector<BodyState> states(1);
  states[0].pose.position.x() = x;
  states[0].twist.linear.x() = v;
  stepper->start(island, Instant{}, states);
  for (Instant t; duration - t.seconds > 1e-12;) {
    const StepResult result = stepper->step(island, t, duration - t.seconds, states);
    REQUIRE(result.ok);
    t = t + result.advanced;
    if (std::abs(gap(t.seconds, states[0].pose.position.x())) <= tolerance) {
      found.push_back(t.seconds);
    }
  }
  return found;
}

bool without_sundials() { return make(watcher) == nullptr; }

}  // namespace

TEST_CASE("cvode finds a gap that falls through zero, and steps end there") {
  if (without_sundials()) {
    return;
  }
  // x = cos t meets -0.3 from above at acos(-0.3) and once every period.
  const std::vector<double> found =
      roots(one_body(true), 1.0, 0.0, 14.0, [](double, double x) { return x + 0.3; });
  REQUIRE(found.size() == 2);
  const double first = std::acos(-0.3);
  CHECK(std::abs(found[0] - first) <= 1e-8);  // the tolerance of 1e-10, gathered
  CHECK(std::abs(found[1] - first - 2.0 * std::numbers::pi) <= 1e-8);
}

TEST_CASE("only steppers with rootfinding of their own can watch") {
  for (const CatalogueEntry& entry : catalogue()) {
    CAPTURE(entry.info.name);
    const bool cvode = entry.info.name.substr(0, 5) == "cvode";
    CHECK(entry.make({})->watch(std::make_shared<const Gaps>(std::vector<Gaps::Gap>{})) == cvode);
  }
}

TEST_CASE("trap: a root of even multiplicity is no change of sign, and cvode misses it") {
  if (without_sundials()) {
    return;
  }
  // x = cos t touches -1 at pi and opens again. A gap that goes 1e-3 deeper is found.
  const auto touching = [](double, double x) { return x + 1.0; };
  CHECK(roots(one_body(true), 1.0, 0.0, 5.0, touching).empty());
  const auto crossing = [](double, double x) { return x + 0.999; };
  CHECK(roots(one_body(true), 1.0, 0.0, 5.0, crossing).size() == 1);
}

TEST_CASE("trap: two roots in one step cancel, and cvode misses both") {
  if (without_sundials()) {
    return;
  }
  // A body that flies freely is integrated in steps as long as one likes: a wall of 0.2 m on its
  // way is entered and left within one. Where the way is short the steps are, and it is found.
  const auto wall_at = [](double place) {
    return [place](double, double x) { return std::abs(x - place) - 0.1; };
  };
  CHECK(roots(one_body(false), 0.0, 1.0, 1e4, wall_at(5000.05)).empty());
  CHECK(roots(one_body(false), 0.0, 1.0, 1e4, wall_at(0.11)).size() == 1);
}

TEST_CASE("trap: the product of two tiny gaps of different sign is no less than zero") {
  if (without_sundials()) {
    return;
  }
  // 1e-200 times 1e-200 underflows to 0, and a sign test on it sees no change (SUNDIALS 6.4 makes
  // it). What CVODE is shown keeps its sign, and a size whose square is a number.
  const auto scaled = [](double factor) {
    return [factor](double, double x) { return factor * (x + 0.3); };
  };
  const double first = std::acos(-0.3);
  for (const double factor : {1e200, 1.0, 1e-100, 1e-200}) {
    CAPTURE(factor);
    const std::vector<double> found =
        roots(one_body(true), 1.0, 0.0, 3.0, scaled(factor), 1e-9 * factor);
    REQUIRE(found.size() == 1);
    CHECK(std::abs(found[0] - first) <= 1e-8);
  }
}

TEST_CASE("trap: cvode's interpolant is valid on its last step only; motions are copies") {
  if (without_sundials()) {
    return;
  }
  const Island island = one_body(true);
  const std::unique_ptr<Stepper> stepper = make(watcher);
  std::vector<BodyState> states(1);
  states[0].pose.position.x() = 1.0;
  stepper->start(island, Instant{}, states);
  std::vector<Motion> kept;
  for (Instant t; t.seconds < 20.0;) {
    std::vector<Motion> motions(1);
    const StepResult result = stepper->step(island, t, 20.0, states);
    REQUIRE(result.ok);
    stepper->dense_output(motions);
    kept.push_back(motions[0]);
    t = t + result.advanced;
  }
  REQUIRE(kept.size() > 20);
  for (const Motion& motion : kept) {
    for (const double part : {0.0, 0.3, 0.7, 1.0}) {
      const double s = part * motion.duration;
      CHECK(std::abs(motion.position(s).x() - std::cos((motion.start + s).seconds)) <= 1e-7);
    }
  }
}

TEST_CASE("trap: ERKStep's reset keeps its last step, which must not leap over the next bounce") {
  for (const char* name :
       {"arkode-2", "arkode-3", "arkode-4", "arkode-5", "arkode-6", "arkode-8"}) {
    const std::unique_ptr<Stepper> stepper = make(name);
    if (stepper == nullptr) {
      return;
    }
    CAPTURE(name);
    // Free flight: nothing limits the step, so that the last one is very long.
    const Island island = one_body(false);
    std::vector<BodyState> states(1);
    states[0].twist.linear.x() = 1.0;
    stepper->start(island, Instant{}, states);
    Instant t;
    double longest = 0.0;
    while (t.seconds < 1e6) {
      const StepResult result = stepper->step(island, t, 1e6 - t.seconds, states);
      REQUIRE(result.ok);
      longest = std::max(longest, result.advanced);
      t = t + result.advanced;
    }
    CHECK(longest > 1e3);
    states[0].twist.linear.x() = -1.0;
    stepper->restart(island, t, states);
    const StepResult after = stepper->step(island, t, 0.01, states);
    REQUIRE(after.ok);
    CHECK(after.advanced <= 0.01);
    CHECK(std::abs(states[0].pose.position.x() - 1e6 + after.advanced) <= 1e-9);
    std::vector<Motion> motions(1);
    stepper->dense_output(motions);
    CHECK(motions[0].duration == after.advanced);
  }
}

}  // namespace kairos::integrators::test
