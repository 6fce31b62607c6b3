#include "experiments/thesis/errata.hpp"
#include "experiments/thesis/errata_runs.hpp"
#include "experiments/thesis/literal_bounce.hpp"

#include <cmath>

// Errata about energy: predictions 1, 3 and 5.

namespace kairos::experiments::thesis {

std::vector<Check> energy_gain(Size size) {
  const double seconds = size == Size::full ? 600.0 : 60.0;
  std::vector<Check> checks;
  for (const int per_second : {30, 60, 240}) {
    const double h = 1.0 / per_second;
    const RunResult run =
        measured_run(shipped("bounce"), thesis_choice(h, seconds), "frames").result;
    const double predicted = static_cast<double>(run.cost.steps - 1) * G * G * h * h / 2.0;
    const std::string at = " in " + std::to_string(static_cast<int>(seconds)) + " s at 1/" +
                           std::to_string(per_second) + " s";
    checks.push_back({"energy gained" + at, "J", predicted, gained(run), Agreement::equal,
                      1e-10 * predicted, "roundoff of n additions"});
    checks.push_back({"of it booked as truncation" + at, "J", predicted,
                      run.ledger.line(EnergyLine::truncation), Agreement::equal, 1e-10 * predicted,
                      "roundoff of n additions"});
  }
  return checks;
}

std::vector<Check> energy_of_other_integrators(Size) {
  RunChoice choice = thesis_choice(frame, 60.0);
  choice.method.integrator = "symplectic-euler";
  const double predicted = -3600.0 * G * G * frame * frame / 2.0;
  const double lost = gained(measured_run(shipped("bounce"), choice, "frames").result);
  std::vector<Check> checks = {{"energy gained by symplectic Euler in 60 s", "J", predicted, lost,
                                Agreement::equal, -predicted / 3000.0, "one frame"}};
  for (const char* integrator : {"velocity-verlet", "rk4", "dopri5"}) {
    choice.method.integrator = integrator;
    const RunResult run = measured_run(shipped("bounce"), choice, "frames").result;
    checks.push_back({std::string("energy gained by ") + integrator + " in 60 s", "J", 0.0,
                      gained(run), Agreement::equal, 8.0 * epsilon * run.ledger.flow(),
                      "8 eps of the flows"});
  }
  return checks;
}

std::vector<Check> roundoff_share(Size) {
  const BounceSetting setting;
  BounceState<double> usual{setting.height, 0.0, 0.0, 0};
  BounceState<long double> longer{setting.height, 0.0L, 0.0L, 0};
  long double largest = 0.0L;
  long double impact = 0.0L;
  for (int n = 0; n < 3600; ++n) {
    const BounceState<double> before = usual;
    literal_frame(setting, usual);
    literal_frame(setting, longer);
    const BounceState<long double> widened{usual.height, usual.velocity, usual.acceleration, 0};
    largest = std::max(largest, std::abs(widened.energy(setting) - longer.energy(setting)));
    if (usual.impacts != before.impacts) {
      const BounceState<double> reflected{before.height, -before.velocity, 0.0, 0};
      impact = std::max<long double>(impact,
                                     std::abs(reflected.energy(setting) - before.energy(setting)));
    }
  }
  RunChoice choice = thesis_choice(frame, 60.0);
  choice.roundoff = true;
  const RunResult run = measured_run(shipped("bounce"), choice, "frames").result;
  const double scale = setting.mass * setting.G * setting.height;
  return {
      {"energy in double minus in long double, relative, 60 s", "", 1e-14,
       static_cast<double>(largest) / scale, Agreement::at_most, 0.0, ""},
      {"roundoff line of the ledger, relative, 60 s", "", 1e-14,
       std::abs(run.ledger.line(EnergyLine::roundoff)) / scale, Agreement::at_most, 0.0, ""},
      {"largest change of energy in an impact", "J", 0.0, static_cast<double>(impact),
       Agreement::equal, 0.0, "exact"},
      {"largest difference to the scheme `original`, same arithmetic", "m", 0.0,
       std::abs(run.state[1].pose.position.y() - usual.height), Agreement::equal, 0.0, "exact"}};
}

std::vector<Check> knife_edge(Size) {
  // From H = 4.9 m the floor is reached at 1 s exactly, a multiple of either frame time.
  const auto gap_at_1s = [](int frames_per_second) {
    RunChoice choice = thesis_choice(1.0 / frames_per_second, 1.0);
    choice.method.integrator = "velocity-verlet";
    const Simulation run = simulate(
        shipped("bounce", {{"body.ball.position", "[0, 5, 0]"}, {"body.ball.radius", "0.1"}}),
        choice);
    return run.trajectory.frame_state(static_cast<std::size_t>(frames_per_second))[1]
               .pose.position.y() -
           0.1;
  };
  const double at_60 = gap_at_1s(60);
  const double at_64 = gap_at_1s(64);
  const double reach = 60.0 * epsilon * 5.0;
  return {
      {"gap after 60 frames of 1/60 s", "m", 0.0, at_60, Agreement::equal, reach,
       "roundoff of 60 additions"},
      {"gap after 64 frames of 1/64 s", "m", 0.0, at_64, Agreement::equal, reach,
       "roundoff of 64 additions"},
      {"frame times of the two at which the ball is inside", "", 1.0,
       (at_60 <= 0.0 ? 1.0 : 0.0) + (at_64 <= 0.0 ? 1.0 : 0.0), Agreement::equal, 0.0, "exact"}};
}

std::vector<Check> pushed_out(Size) {
  // A bat that swings upwards hits a ball and moves it out of its way (7.4).
  RunChoice choice = thesis_choice(frame, 1.0);
  const Scene scene = shipped("bat", {{"G", "9.8"},
                                      {"body.bat.nudge", "0.0025"},
                                      {"body.bat.half_extents", "[0.08, 0.0075, 0.08]"},
                                      {"body.bat.drive.amplitude", "[0, 0.4, 0]"},
                                      {"body.ball.position", "[0, 0.4, 0]"}});
  const Simulation run = simulate(scene, choice);
  const double mass = scene.bodies[1].mass;
  double predicted = 0.0;
  for (const Event& event : run.trajectory.events()) {
    predicted += mass * G * (event.after_b.pose.position - event.before_b.pose.position).y();
  }
  return {{"energy of the ball that was moved, sum of m g d", "J", predicted,
           run.result.ledger.line(EnergyLine::position_correction), Agreement::equal,
           1e-12 * std::abs(predicted), "roundoff of sums"},
          {"times that it was moved", "", 0.0, static_cast<double>(run.result.cost.impacts),
           Agreement::more_than, 0.0, "", Evidence::observation}};
}

std::vector<Check> gravity_as_a_force(Size) {
  std::vector<Check> checks;
  for (const double mass : {0.5, 1.0, 4.0}) {
    const Scene world =
        shipped("bounce", {{"gravity", "\"force\""}, {"body.ball.mass", std::to_string(mass)}});
    const RunResult run = measured_run(world, thesis_choice(frame, 0.5), "frames").result;
    const double predicted = -29.0 * frame * G / mass;  // the first of 30 frames has a = 0
    checks.push_back({"speed of " + std::to_string(mass).substr(0, 3) + " kg after 0.5 s", "m/s",
                      predicted, run.state[1].twist.linear.y(), Agreement::equal,
                      -30.0 * epsilon * predicted, "roundoff of 30 additions"});
  }
  return checks;
}

std::vector<Check> energy_proves_nothing(Size) {
  RunChoice late = thesis_choice(frame, 60.0);
  late.method.integrator = "rk4";
  const RunResult literal = measured_run(shipped("bounce"), late, "frames").result;
  RunChoice exact;
  exact.duration = 60.0;
  const RunResult located = measured_run(shipped("bounce"), exact, "frames").result;
  return {
      {"energy error of late flips with RK4, 60 s, relative", "", 1e-14,
       std::abs(gained(literal)) / literal.ledger.initial_energy(), Agreement::at_most, 0.0, ""},
      {"error of their position", "m", 0.1,
       std::abs(literal.state[1].pose.position.y() - located.state[1].pose.position.y()),
       Agreement::more_than, 0.0, "", Evidence::observation}};
}

}  // namespace kairos::experiments::thesis
