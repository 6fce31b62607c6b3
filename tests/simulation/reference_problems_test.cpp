// Problems with known answers, run: each scene of the library that has one against it.

#include "core/exact_solution.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace kairos;

namespace {

Scene shipped(const std::string& name, const std::vector<Override>& overrides = {}) {
  return read_scene(find_scene(name), overrides);
}

Simulation run(const Scene& scene, const MethodChoice& method, const StepperOptions& stepper = {}) {
  RunChoice choice;
  choice.method = method;
  choice.stepper = stepper;
  Simulation sim = simulate(scene, choice);
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  return sim;
}

Simulation run(const std::string& name) {
  return run(shipped(name), MethodChoice{"event-driven", "auto", "certified", "newton"});
}

std::vector<Event> impacts_of(const Simulation& sim) {
  return tests::of_kind(sim.trajectory, EventKind::impact);
}

/// Times of impact against the scene's exact solution, relative; returns how many there were.
std::size_t check_times(const Simulation& sim, const Scene& scene, double tolerance) {
  const auto exact = solve_exactly(scene);
  REQUIRE(exact != nullptr);
  const std::vector<Event> impacts = impacts_of(sim);
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    const auto time = exact->impact_time(static_cast<std::int64_t>(k) + 1);
    REQUIRE(time.has_value());
    CAPTURE(scene.name, k, *time);
    CHECK(std::abs(impacts[k].time.seconds / *time - 1.0) <= tolerance);
  }
  return impacts.size();
}

}  // namespace

TEST_CASE("reference: elastic drop, the k-th impact at (2k-1) sqrt(2H/g)", "[reference]") {
  const Scene scene =
      shipped("bounce", {{"G", "9.81"}, {"body.ball.position[1]", "5.4"}, {"duration", "200"}});
  const Simulation sim = run(scene, {});
  CHECK(check_times(sim, scene, 1e-12) == 100);
  CHECK(impacts_of(sim).front().time.seconds == Approx(0.9994901860).epsilon(1e-10));
}

TEST_CASE("reference: Zeno, FMI's bouncing ball and Siconos' ball", "[reference]") {
  const auto rest = [](const Simulation& sim) {
    for (const Event& event : sim.trajectory.events()) {
      if (event.kind == EventKind::contact_begins) {
        return event.time.seconds;
      }
    }
    return 0.0;
  };
  // Hops below 1e-10 of the ball's size are summed up; the last of them begin and end as exactly as
  // coordinates of 0.1 m resolve at their speed.
  CHECK(rest(run("bounce-inelastic")) == Approx(1.3552618543578769).epsilon(1e-12));
  const Simulation fmi = run("bouncing-ball");
  CHECK(rest(fmi) == Approx(2.558633965586).epsilon(1e-11));
  CHECK(impacts_of(fmi).front().time.seconds == Approx(0.4515236409857309).epsilon(1e-14));
  const Simulation siconos = run("nonsmooth-ball");
  CHECK(check_times(siconos, shipped("nonsmooth-ball"), 1e-12) == 44);
  CHECK(impacts_of(siconos).back().time.seconds == Approx(8.49137402565).epsilon(1e-11));
}

TEST_CASE("reference: quadratic drag, every bounce, with every controlled stepper at its tightest",
          "[reference][slow]") {
  const Scene scene = shipped("drag-drop", {{"duration", "1.9"}});
  std::size_t steppers = 0;
  for (const IntegratorEntry& entry : integrator_entries()) {
    if (!entry.info.controlled) {
      continue;
    }
    CAPTURE(entry.info.name);
    // Order 2 would take 7e6 steps a second at 1e-13; at 1e-10 its 2e5 are enough.
    const double tolerance = entry.info.order == 2 ? 1e-10 : 1e-15;
    const Simulation sim =
        run(scene, {"event-driven", std::string(entry.info.name), "certified", "newton"},
            {.relative_tolerance = tolerance, .absolute_tolerance = tolerance});
    const std::vector<Event> impacts = impacts_of(sim);
    REQUIRE(impacts.size() == 3);
    CHECK(std::abs(impacts[0].time.seconds - 0.4610370640415288) <= 1e-10);
    CHECK(std::abs(impacts[0].before_b.twist.linear.y() + impacts[0].before_a.twist.linear.y() +
                   4.165174324051543) <= 1e-10);
    check_times(sim, scene, 1e-10);
    ++steppers;
  }
  CHECK(steppers >= 1);
}

TEST_CASE("reference: steps may be asked for far beyond what a tight tolerance allows",
          "[reference]") {
  const Scene scene = shipped("stroke");
  for (const IntegratorEntry& entry : integrator_entries()) {
    if (!entry.info.controlled || entry.info.order < 5) {
      continue;  // lower orders take 1e6 steps
    }
    CAPTURE(entry.info.name);
    RunChoice choice;
    choice.method = {"event-driven", std::string(entry.info.name), "certified", "newton"};
    choice.step = 1.0;
    choice.stepper = {.relative_tolerance = 1e-14, .absolute_tolerance = 1e-14};
    const Simulation sim = simulate(scene, choice);
    CAPTURE(sim.result.reason);
    CHECK(sim.result.status == RunStatus::completed);
  }
}

TEST_CASE("reference: x'' = -x with a wall at -0.3, by auto and by rootfinding of cvode",
          "[reference]") {
  const Scene scene = shipped("oscillator");
  const Simulation sim = run("oscillator");
  CHECK(impacts_of(sim).front().time.seconds == Approx(1.8754889808103).epsilon(1e-12));
  CHECK(check_times(sim, scene, 1e-10) == 5);
  const auto all = detectors();
  if (std::any_of(all.begin(), all.end(),
                  [](const auto& d) { return d->info().name == "cvode-rootfinding"; })) {
    CHECK(check_times(run(scene, {"event-driven", "auto", "cvode-rootfinding", "newton"}), scene,
                      1e-7) == 5);
  }
}

TEST_CASE("reference: what cvode's rootfinding misses, the certified detector finds",
          "[reference]") {
  const auto all = detectors();
  if (std::none_of(all.begin(), all.end(),
                   [](const auto& d) { return d->info().name == "cvode-rootfinding"; })) {
    return;
  }
  // A bullet enters and leaves a thin wall within one step of the solver.
  const Scene bullet = shipped("bullet");
  CHECK(impacts_of(run(bullet, {"event-driven", "auto", "certified", "newton"})).size() == 1);
  CHECK(impacts_of(run(bullet, {"event-driven", "auto", "cvode-rootfinding", "newton"})).empty());
}

TEST_CASE("reference: two of the cradle in, two out", "[reference]") {
  const Simulation sim = run("cradle");
  int moving = 0;
  for (const BodyState& state : sim.result.state) {
    const double speed = state.twist.linear.norm();
    CHECK((speed <= 1e-15 || std::abs(speed - 1.0) <= 1e-15));
    moving += speed > 0.5 ? 1 : 0;
  }
  CHECK(moving == 2);
}

TEST_CASE("reference: L (v + u) of a ball before a slow piston stays, over 45 hits",
          "[reference]") {
  constexpr BodyIndex piston = 1;  // of wall, piston, ball
  std::vector<Event> hits = impacts_of(run("piston"));
  std::erase_if(hits, [](const Event& e) { return e.a != piston && e.b != piston; });
  REQUIRE(hits.size() >= 45);
  const double u = 0.01;
  for (std::size_t k = 0; k < 45; ++k) {
    const BodyState& ball = hits[k].a == 2 ? hits[k].after_a : hits[k].after_b;
    const double length = ball.pose.position.x(), v = std::abs(ball.twist.linear.x());
    CAPTURE(k);
    CHECK(length * (v + u) == Approx(1.01).epsilon(1e-12));
  }
  const BodyState& last = hits[44].a == 2 ? hits[44].after_a : hits[44].after_b;
  CHECK(std::abs(last.twist.linear.x()) == Approx(0.1).epsilon(1e-9));
  CHECK(last.pose.position.x() == Approx(1.01 / 0.11).epsilon(1e-9));
}

TEST_CASE("reference: period-1 bouncing on a vibrating table", "[reference]") {
  const std::vector<Event> impacts = impacts_of(run("table"));
  REQUIRE(impacts.size() == 50);
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    CAPTURE(k);
    // The table's motion is a fit with an error radius; the orbit is stable, so it does not grow.
    CHECK(std::abs(impacts[k].time.seconds - (0.05 + 0.1 * static_cast<double>(k))) <= 1e-9);
  }
}

namespace {

/// Root mean square of the error of energy over the frames.
class EnergyError : public Recorder {
 public:
  void frame(const Frame& frame) override {
    const double error = frame.ledger.energy() - frame.ledger.initial_energy();
    sum_ += error * error;
    ++frames_;
  }
  [[nodiscard]] double root_mean_square() const {
    return std::sqrt(sum_ / static_cast<double>(frames_));
  }

 private:
  double sum_ = 0.0;
  std::int64_t frames_ = 0;
};

}  // namespace

TEST_CASE("reference: SimBenchmark's 49 balls gain M g^2 h T/(2 sqrt 3) with explicit Euler",
          "[reference]") {
  const Model model(shipped("balls"));
  const auto error_with = [&](const char* scheme, const char* integrator, const char* detector) {
    RunChoice choice;
    choice.method = {scheme, integrator, detector, "newton"};
    EnergyError error;
    REQUIRE(simulate(model, choice, error).status == RunStatus::completed);
    return error.root_mean_square();
  };
  const double predicted = 490.0 * 9.81 * 9.81 * 0.01 * 20.0 / (2.0 * std::sqrt(3.0));
  CHECK(predicted == Approx(2722.0).epsilon(1e-3));
  // The gain is a ramp of 2000 steps: its root mean square is that of a line within 1/2000.
  CHECK(error_with("original", "explicit-euler", "sat") == Approx(predicted).epsilon(1e-3));
  CHECK(error_with("event-driven", "auto", "certified") <= 1e-9);
}

TEST_CASE("reference: Runge-Kutta 4 has slope 1, 2 or 4, as impacts are located",
          "[reference][slow]") {
  // 20 s with five or six impacts. Where an impact falls into its step is spread evenly, of the
  // first by the start phase, of the others by the remainder that the step leaves of the time
  // between impacts (see the experiment `order`): 64 draws are enough then, for each halving.
  constexpr int draws = 64;
  const double wall = std::acos(-0.3), period = 2.0 * wall;
  const auto fraction = [](double x) { return x - std::floor(x); };
  const auto error = [&](const MethodChoice& method, int steps_between_impacts) {
    double sum = 0.0;
    for (int k = 0; k < draws; ++k) {
      const double remainder = fraction((k + 0.5) * 0.7548776662466927);
      const double place = fraction((k + 0.5) * 0.5698402909980532);
      const double h = period / (steps_between_impacts + remainder);
      const double phase =
          wall - h * (std::floor(steps_between_impacts * (k + 0.5) / draws) + place);
      Scene scene = shipped("oscillator");
      BodyState& start = scene.bodies[1].initial;
      start.pose.position.x() = std::cos(phase);
      start.twist.linear.x() = -std::sin(phase);
      RunChoice choice;
      choice.method = method;
      choice.frames = FixedFrames{h};
      const Simulation sim = simulate(scene, choice);
      REQUIRE(sim.result.status == RunStatus::completed);
      const BodyState truth = *solve_exactly(scene)->state(1, sim.result.end);
      sum += (sim.result.state[1].pose.position - truth.pose.position).squaredNorm();
    }
    return std::sqrt(sum / draws);
  };
  const auto check_slope = [&](const MethodChoice& method, double order) {
    CAPTURE(method.scheme, method.detector);
    std::vector<double> errors;
    for (const int n : {75, 150, 300, 600}) {
      errors.push_back(error(method, n));
    }
    for (std::size_t k = 1; k < errors.size(); ++k) {
      CHECK(std::log2(errors[k - 1] / errors[k]) == Approx(order).margin(0.2));
    }
    CHECK(std::log2(errors.front() / errors.back()) / 3.0 == Approx(order).margin(0.1));
  };
  check_slope({"original", "rk4", "sat", "newton"}, 1.0);
  check_slope({"event-driven", "rk4", "linear", "newton"}, 2.0);
  check_slope({"event-driven", "rk4", "certified", "newton"}, 4.0);
}
