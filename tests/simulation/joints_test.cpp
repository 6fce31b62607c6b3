// Joints in event-driven runs: pendulums with known answers, impacts that joints pass on, loops,
// and that constraints hold and every joule is found.

#include "core/joint_system.hpp"
#include "core/reading/scene_reader.hpp"
#include "integrators/catalogue/ida.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_builder.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace kairos;

namespace {

constexpr double g = 9.8;

/// Tolerances of the integrator far below what is asked of the answers.
RunChoice fine(double duration) {
  RunChoice choice;
  choice.duration = duration;
  choice.stepper = {1e-13, 1e-14};
  return choice;
}

/// The largest residual of the joints in any drawn frame, relative to the size.
double largest_drift(const Simulation& run, const Model& model) {
  double largest = 0.0;
  std::vector<BodyState> states;
  for (std::size_t n = 0; n < run.trajectory.frame_times().size(); ++n) {
    for (const Island& island : model.islands()) {
      if (island.joints == nullptr) {
        continue;
      }
      states.clear();
      for (const BodyIndex i : island.bodies) {
        states.push_back(run.trajectory.frame_state(n)[i]);
      }
      largest = std::max(largest, island.joints->residual(run.trajectory.frame_times()[n], states) /
                                      island.joints->size());
    }
  }
  return largest;
}

/// A ball on a rod of 1 m at 1 rad, and a wall that it meets at 0.3 rad.
Scene pendulum_and_wall(double e) {
  return SceneBuilder("pendulum-and-wall")
      .set("duration", 3.0)
      .set("frame", 1.0 / 60.0)
      .body("bob", {{"entity", "ball"},
                    {"radius", 0.05},
                    {"mass", 1},
                    {"restitution", e},
                    {"position", Vector3(std::sin(1.0), -std::cos(1.0), 0.0)}})
      .body("wall", {{"entity", "wall"},
                     {"half_extents", Vector3(0.1, 1.0, 1.0)},
                     {"position", Vector3(std::sin(0.3) - 0.15, -1.0, 0.0)}})
      .add("joint", {{"kind", "rod"},
                     {"bodies", std::vector<std::string>{"bob"}},
                     {"anchor", Vector3(0.0, 0.0, 0.0)}})
      .scene();
}

}  // namespace

TEST_CASE("problem 15: a bar hinged at its end swings with T = 2.18050530678 s", "[joints]") {
  const Model model(read_scene(find_scene("pendulum")));
  const double T = 2.18050530678;
  Trajectory trajectory;
  const RunResult result = simulate(model, fine(T), trajectory);
  REQUIRE(result.status == RunStatus::completed);
  // At its start it is at rest for a moment: the angle is off by the square of what T is.
  const BodyState& bar = result.state[0];
  CHECK((bar.pose.position - model.initial_state()[0].pose.position).norm() < 1e-9);
  // The angular acceleration there, 3 g sin(2) / 2 L, tells T from the speed that is left.
  CHECK(std::abs(bar.twist.angular.z()) / (1.5 * g * std::sin(2.0)) < 1e-9);
  tests::check_explained(result.ledger);
}

TEST_CASE("problem 15: a double pendulum after 2 s", "[joints]") {
  const Model model(read_scene(find_scene("double-pendulum")));
  Trajectory trajectory;
  const RunResult result = simulate(model, fine(2.0), trajectory);
  REQUIRE(result.status == RunStatus::completed);
  const Vector3 inner(-0.467181020829, -0.884161689838, 0.0);
  const Vector3 outer(-1.43762056496, -1.12550603135, 0.0);
  CHECK((result.state[0].pose.position - inner).norm() < 1e-9);
  CHECK((result.state[1].pose.position - outer).norm() < 1e-9);
  tests::check_explained(result.ledger);
}

TEST_CASE("problem 16: a pendulum strikes a wall, again and again, and rests", "[joints]") {
  const Model model(pendulum_and_wall(0.5));
  Trajectory trajectory;
  const RunResult result = simulate(model, fine(3.0), trajectory);
  CAPTURE(result.reason);
  REQUIRE(result.status == RunStatus::completed);
  const std::vector<Event>& events = trajectory.events();
  REQUIRE(events.size() > 3);
  CHECK(events[0].time.seconds == Approx(0.433414362252).margin(1e-9));
  const Vector3 v = events[0].before_a.twist.linear;
  CHECK(v.norm() == Approx(2.85213428713).margin(1e-9));
  // Half of it back, along the circle: the rod takes up the rest.
  CHECK((events[0].after_a.twist.linear.dot(Vector3(-std::cos(0.3), -std::sin(0.3), 0.0))) ==
        Approx(-0.5 * 2.85213428713).margin(1e-9));
  CHECK(events[1].time.seconds == Approx(1.08397570721).margin(1e-9));
  // Infinitely many more, of which those below roundoff are summed up.
  CHECK(events.back().kind == EventKind::contact_begins);
  CHECK(events.back().time.seconds == Approx(1.98661353087).margin(1e-9));
  CHECK(result.state[0].twist.linear.norm() == 0.0);
  CHECK(result.ledger.line(EnergyLine::restitution_loss) < 0.0);
  tests::check_explained(result.ledger);
  CHECK(largest_drift({result, trajectory}, model) < 1e-9);  // an impact acts between steps
}

TEST_CASE("joints: what one body at rest passes on is predicted of all that hang on it",
          "[joints]") {
  // A block on a vertical slider rests on a post until a ball strikes it from below, beside the
  // post; a plate that is welded to it then meets a ceiling 14 mm above, within the first step.
  SceneBuilder builder("outrigger");
  builder.set("duration", 2.1).set("frame", 1.0 / 60.0).set("G", g);
  builder
      .body("block", {{"entity", "body"},
                      {"half_extents", Vector3(0.1, 0.1, 0.1)},
                      {"mass", 1},
                      {"restitution", 0.7},
                      {"position", Vector3(0.0, 0.21, 0.0)}})
      .body("plate", {{"entity", "body"},
                      {"half_extents", Vector3(0.1, 0.02, 0.1)},
                      {"mass", 1},
                      {"position", Vector3(1.0, 0.21, 0.0)}})
      .body("post", {{"entity", "wall"},
                     {"half_extents", Vector3(0.1, 0.1, 0.1)},
                     {"position", Vector3(0.0, 0.0, -0.15)}})
      .body("ceiling", {{"entity", "wall"},
                        {"half_extents", Vector3(0.2, 0.001, 0.2)},
                        {"position", Vector3(1.0, 0.235, 0.0)}})
      .body("ball", {{"entity", "ball"},
                     {"radius", 0.04},
                     {"mass", 5},
                     {"position", Vector3(0.0, -39.53, 0.06)},
                     {"velocity", Vector3(0.0, 29.6, 0.0)}})
      .add("joint", {{"kind", "slider"},
                     {"bodies", std::vector<std::string>{"block"}},
                     {"anchor", Vector3(0.0, 0.21, 0.0)},
                     {"axis", Vector3(0.0, 1.0, 0.0)}})
      .add("joint", {{"kind", "weld"}, {"bodies", std::vector<std::string>{"block", "plate"}}});
  const Model model(builder.scene());
  Trajectory trajectory;
  const RunResult result = simulate(model, fine(2.1), trajectory);
  CAPTURE(result.reason);
  REQUIRE(result.status == RunStatus::completed);
  int struck = 0;
  for (const Event& event : trajectory.events()) {
    if (event.kind == EventKind::impact &&
        (model.body(event.a).name == "ceiling" || model.body(event.b).name == "ceiling")) {
      ++struck;
      // At t_lo of a proven bracket: above minus the roundoff of the coordinates.
      CHECK(event.contact.gap > -1e-14);
    }
  }
  CHECK(struck > 0);
}

TEST_CASE("joints: constraints hold to 1e-12 of the size at the end of every step", "[joints]") {
  for (const char* name : {"pendulum", "double-pendulum", "slider-crank", "aero"}) {
    CAPTURE(name);
    const Model model(read_scene(find_scene(name)));
    // Frames end where steps of fixed length do.
    RunChoice choice;
    choice.duration = 10.0;
    choice.frames = FixedFrames{1.0 / 64.0};
    const double infinite = std::numeric_limits<double>::infinity();
    choice.stepper = {infinite, infinite};
    Simulation run;
    run.result = simulate(model, choice, run.trajectory);
    REQUIRE(run.result.status == RunStatus::completed);
    CHECK(largest_drift(run, model) <= 1e-12);
    tests::check_explained(run.result.ledger);
  }
}

TEST_CASE("joints: the energy of a pendulum drifts as the order of the stepper says", "[joints]") {
  const Model model(read_scene(find_scene("pendulum")));
  const auto drift = [&](const std::string& integrator, double h) {
    RunChoice choice;
    choice.method.integrator = integrator;
    choice.duration = 2.0;
    choice.frames = FixedFrames{h};
    const double infinite = std::numeric_limits<double>::infinity();
    choice.stepper = {infinite, infinite};
    Trajectory trajectory;
    const RunResult result = simulate(model, choice, trajectory);
    REQUIRE(result.status == RunStatus::completed);
    return std::abs(result.ledger.energy() - result.ledger.initial_energy());
  };
  for (const auto& [name, order] :
       {std::pair{"explicit-euler", 1}, std::pair{"rk4", 4}, std::pair{"dopri5", 5}}) {
    CAPTURE(name);
    const double coarse = drift(name, 1.0 / 32.0);
    const double fine_drift = drift(name, 1.0 / 64.0);
    CAPTURE(coarse, fine_drift);
    // Errors C h^p, and some more of the next order.
    CHECK(coarse / fine_drift > 0.7 * std::pow(2.0, order));
  }
}

TEST_CASE("joints: every stepper keeps a pendulum on its rod, or says why not", "[joints]") {
  const Model model(read_scene(find_scene("double-pendulum")));
  int own = 0;  // there may be neither GSL nor SUNDIALS
  for (const IntegratorEntry& entry : simulation::integrator_entries()) {
    CAPTURE(entry.info.name);
    RunChoice choice;
    choice.method.integrator = std::string(entry.info.name);
    choice.duration = 0.5;
    choice.step = 1.0 / 240.0;
    if (entry.info.name == "arkode-2") {  // of order 2: a minute at the default tolerance
      choice.stepper = {1e-7, 1e-7};
    }
    if (const std::string reason = why_refused(model, choice); !reason.empty()) {
      CHECK(reason.find(entry.info.name) != std::string::npos);
      continue;
    }
    Simulation run;
    run.result = simulate(model, choice, run.trajectory);
    CAPTURE(run.result.reason);
    REQUIRE(run.result.status == RunStatus::completed);
    // At the end of the run a step of a controlled stepper need not end: between, the dense output
    // is off by what its order says.
    CHECK(largest_drift(run, model) < (entry.info.order > 2 ? 1e-7 : 1e-3));
    tests::check_explained(run.result.ledger);
    own += entry.info.library == "kairos" ? 1 : 0;
  }
  CHECK(own >= 7);
}

TEST_CASE("joints: a hinge that is driven does work, and the ledger finds it", "[joints]") {
  // A bar hangs on a block that goes to and fro.
  const Scene scene =
      SceneBuilder("driven")
          .set("duration", 3.0)
          .set("frame", 1.0 / 60.0)
          .body("block", {{"entity", "bat"},
                          {"half_extents", Vector3(0.05, 0.05, 0.05)},
                          {"mass", 1},
                          {"drive", {{"amplitude", Vector3(0.2, 0.0, 0.0)}, {"frequency", 0.8}}}})
          .body("bar", {{"entity", "body"},
                        {"half_extents", Vector3(0.05, 0.5, 0.05)},
                        {"mass", 1},
                        {"velocity", Vector3(0.2 * 2.0 * std::numbers::pi * 0.8, 0.0, 0.0)},
                        {"position", Vector3(0.0, -0.5, 0.0)}})
          .add("joint", {{"kind", "hinge"},
                         {"bodies", std::vector<std::string>{"block", "bar"}},
                         {"anchor", Vector3(0.0, 0.0, 0.0)},
                         {"axis", Vector3(0.0, 0.0, 1.0)}})
          .scene();
  const Model model(scene);
  Trajectory trajectory;
  const RunResult result = simulate(model, fine(3.0), trajectory);
  REQUIRE(result.status == RunStatus::completed);
  const EnergyLedger& ledger = result.ledger;
  CHECK(std::abs(ledger.line(EnergyLine::driven_work)) > 1e-2);
  // Nothing else but what the integrator lost: of 8-point quadrature over steps of 1/60 s.
  CHECK(std::abs(ledger.line(EnergyLine::truncation)) < 1e-9);
  CHECK(ledger.energy() - ledger.initial_energy() ==
        Approx(ledger.line(EnergyLine::driven_work)).margin(1e-9));
  tests::check_explained(ledger);
}

TEST_CASE("joints: an impact is passed on through a chain as Newton's hypothesis asks",
          "[joints]") {
  // A ball hits the lower of two welded bars at rest: together they are one body.
  const auto scene = [](bool welded) {
    SceneBuilder builder("chain");
    builder.set("duration", 0.2).set("frame", 1.0 / 60.0).set("G", 0.0);
    builder.body("ball", {{"entity", "ball"},
                          {"radius", 0.1},
                          {"mass", 1},
                          {"position", Vector3(-0.5, 0.25, 0.0)},
                          {"velocity", Vector3(4.0, 0.0, 0.0)}});
    if (welded) {
      builder
          .body("low", {{"entity", "body"},
                        {"half_extents", Vector3(0.1, 0.5, 0.1)},
                        {"mass", 1},
                        {"position", Vector3(0.0, 0.0, 0.0)}})
          .body("high", {{"entity", "body"},
                         {"half_extents", Vector3(0.1, 0.5, 0.1)},
                         {"mass", 1},
                         {"position", Vector3(0.0, 1.0, 0.0)}})
          .add("joint", {{"kind", "weld"}, {"bodies", std::vector<std::string>{"low", "high"}}});
    } else {
      builder.body("low", {{"entity", "body"},
                           {"half_extents", Vector3(0.1, 1.0, 0.1)},
                           {"mass", 2},
                           {"position", Vector3(0.0, 0.5, 0.0)}});
    }
    return builder.scene();
  };
  const Simulation one = simulate(scene(false), fine(0.2));
  const Simulation two = simulate(scene(true), fine(0.2));
  REQUIRE(two.result.status == RunStatus::completed);
  REQUIRE(one.trajectory.events().size() == 1);
  REQUIRE(two.trajectory.events().size() == 1);
  // The ball cannot tell them apart: roundoff of a solve of six rows.
  CHECK((one.result.state[0].twist.linear - two.result.state[0].twist.linear).norm() < 1e-12);
  CHECK((one.result.state[1].twist.angular - two.result.state[1].twist.angular).norm() < 1e-12);
  // Elastic: nothing is lost.
  CHECK(std::abs(two.result.ledger.energy() - two.result.ledger.initial_energy()) < 1e-12);
  tests::check_explained(two.result.ledger);
}

TEST_CASE("joints: an over-determined loop moves as its one degree of freedom says", "[joints]") {
  // Kinetic energy as a function of the crank angle alone: without gravity it is kept.
  const Model model(read_scene(find_scene("slider-crank"), {{"G", "0"}}));
  Trajectory trajectory;
  const RunResult result = simulate(model, fine(2.0), trajectory);
  REQUIRE(result.status == RunStatus::completed);
  const auto kinetic = [&](const State& state) {
    double sum = 0.0;
    for (BodyIndex i = 0; i < model.size(); ++i) {
      sum += model.kinetic_energy(i, state[i]);
    }
    return sum;
  };
  CHECK(kinetic(result.state) == Approx(kinetic(model.initial_state())).epsilon(1e-9));
  // The piston is where the crank's angle puts it, and nothing leaves its plane.
  const Vector3 pin = result.state[0].pose.to_world({0.0, 0.1, 0.0});
  CHECK(result.state[2].pose.position.x() ==
        Approx(pin.x() + std::sqrt(0.36 - pin.y() * pin.y())).margin(1e-9));
  CHECK(std::abs(result.state[1].pose.position.z()) < 1e-12);
  tests::check_explained(result.ledger);
}

TEST_CASE("joints: a chain stretched straight between two points stops at once where it is pushed",
          "[joints]") {
  // Two balls and three rods of 0.4 m between fixed points. Where these are 1.2 m apart, the balls
  // have no other position near by: what pushes them across asks for a force without a bound.
  const auto chain = [](const Vector3& first, const Vector3& second, const Vector3& end) {
    SceneBuilder builder("chain");
    builder.set("duration", 0.2);
    for (const auto& [name, position] : {std::pair("one", first), std::pair("two", second)}) {
      builder.body(name,
                   {{"entity", "ball"}, {"radius", 0.05}, {"mass", 1}, {"position", position}});
    }
    using Names = std::vector<std::string>;
    builder.add("joint", {{"kind", "rod"}, {"bodies", Names{"one"}}, {"anchor", Vector3(0, 0, 0)}});
    builder.add("joint", {{"kind", "rod"}, {"bodies", Names{"one", "two"}}});
    builder.add("joint", {{"kind", "rod"}, {"bodies", Names{"two"}}, {"anchor", end}});
    Trajectory trajectory;
    return simulate(Model(builder.scene()), fine(0.2), trajectory);
  };
  const RunResult across = chain({0.4, 0.0, 0.0}, {0.8, 0.0, 0.0}, {1.2, 0.0, 0.0});
  CHECK(across.status != RunStatus::completed);
  CHECK(across.end.seconds == 0.0);
  CHECK_THAT(across.reason, Catch::Contains("dead centre"));
  CHECK(across.state[0].pose.position == Vector3(0.4, 0.0, 0.0));  // it ends where it began
  CHECK(across.state[1].pose.position == Vector3(0.8, 0.0, 0.0));
  tests::check_explained(across.ledger);
  // Gravity along it pushes nothing across, and with slack it hangs.
  const RunResult along = chain({0.0, 0.4, 0.0}, {0.0, 0.8, 0.0}, {0.0, 1.2, 0.0});
  CHECK(along.status == RunStatus::completed);
  CHECK((along.state[0].pose.position - Vector3(0.0, 0.4, 0.0)).norm() < 1e-14);
  CHECK(chain({0.32, -0.24, 0.0}, {0.72, -0.24, 0.0}, {1.04, 0.0, 0.0}).status ==
        RunStatus::completed);
}

TEST_CASE("joints: what cannot treat them says so", "[joints]") {
  const Model model(read_scene(find_scene("pendulum")));
  for (const auto& scheme : schemes()) {
    RunChoice choice;
    choice.method.scheme = std::string(scheme->info().name);
    CAPTURE(choice.method.scheme);
    const std::string reason = why_refused(model, choice);
    CHECK(reason.empty() == scheme->info().joints);
    if (!scheme->info().joints) {
      CHECK(reason.find("joints") != std::string::npos);
    }
  }
  RunChoice thesis;
  thesis.method.impact = "thesis";
  CHECK(why_refused(model, thesis).find("joints") != std::string::npos);
}

TEST_CASE("joints: schemes of frames hold them as event-driven does, where nothing meets",
          "[joints]") {
  const Model model(read_scene(find_scene("double-pendulum")));
  RunChoice choice;
  choice.duration = 1.0;
  choice.frames = FixedFrames{1.0 / 64.0};
  const double infinite = std::numeric_limits<double>::infinity();
  choice.stepper = {infinite, infinite};
  choice.method.integrator = "rk4";
  Trajectory reference;
  const RunResult expected = simulate(model, choice, reference);
  for (const char* scheme : {"original", "geometric", "substepped", "bisected"}) {
    CAPTURE(scheme);
    choice.method.scheme = scheme;
    choice.threshold = 10.0;  // m: no substeps
    Simulation run;
    run.result = simulate(model, choice, run.trajectory);
    REQUIRE(run.result.status == RunStatus::completed);
    // The same steps of the same method, and nothing else.
    CHECK(run.result.state[1].pose.position == expected.state[1].pose.position);
    CHECK(largest_drift(run, model) <= 1e-12);
    CHECK(run.result.ledger.line(EnergyLine::projection) ==
          Approx(expected.ledger.line(EnergyLine::projection)).epsilon(1e-9));
    CHECK(run.result.ledger.line(EnergyLine::position_correction) != 0.0);
    tests::check_explained(run.result.ledger);
  }
  const Model struck(pendulum_and_wall(0.5));
  choice.method.scheme = "original";
  CHECK(why_refused(struck, choice).find("event-driven only") != std::string::npos);
}

TEST_CASE("joints: IDA solves the differential-algebraic equations to the same motion",
          "[joints]") {
  if (integrators::make_ida({}) == nullptr) {
    SUCCEED("built without IDA");
    return;
  }
  const Model model(read_scene(find_scene("double-pendulum")));
  Trajectory projected;
  const RunResult ours = simulate(model, fine(2.0), projected);
  PlugIns own;
  own.integrator = [](const Model&, std::size_t) {
    return integrators::make_ida({.relative_tolerance = 1e-10, .absolute_tolerance = 1e-10});
  };
  RunChoice choice;
  choice.duration = 2.0;
  Simulation other;
  other.result = simulate(model, choice, other.trajectory, {}, own);
  CAPTURE(other.result.reason);
  REQUIRE(other.result.status == RunStatus::completed);
  for (BodyIndex i = 0; i < model.size(); ++i) {
    CAPTURE(model.body(i).name);
    // The global error of BDF at 1e-10 a step over thousands of steps, and of chaos.
    CHECK((other.result.state[i].pose.position - ours.state[i].pose.position).norm() < 1e-6);
    CHECK((other.result.state[i].twist.linear - ours.state[i].twist.linear).norm() < 1e-5);
  }
  // GGL keeps positions on the constraints within its tolerance, without any projection.
  CHECK(largest_drift(other, model) < 1e-8);
  CHECK(other.result.ledger.line(EnergyLine::position_correction) == 0.0);
}

TEST_CASE("joints: the order in which a scene tells them changes no bit", "[joints]") {
  const Scene told = read_scene(find_scene("slider-crank"));
  Scene shuffled = told;
  std::reverse(shuffled.joints.begin(), shuffled.joints.end());
  REQUIRE(told.joints.size() > 2);
  RunChoice choice;
  choice.duration = 1.0;
  const Simulation a = simulate(told, choice), b = simulate(shuffled, choice);
  for (BodyIndex i = 0; i < told.bodies.size(); ++i) {
    CHECK(a.result.state[i].pose.position == b.result.state[i].pose.position);
    CHECK(a.result.state[i].twist.angular == b.result.state[i].twist.angular);
  }
}

TEST_CASE("joints: an integrator that throws a mechanism off its joints ends the run", "[joints]") {
  // Explicit Euler feeds a pendulum energy, until a step moves it farther than the joint is long.
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  choice.duration = 2.0;
  const Simulation run = simulate(read_scene(find_scene("pendulum")), choice);
  CHECK(run.result.status == RunStatus::stopped);
  CHECK(run.result.reason.find("farther off the joints than they are long") != std::string::npos);
  tests::check_explained(run.result.ledger);
}
