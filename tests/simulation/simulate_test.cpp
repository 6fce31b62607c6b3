// `simulate`: names become types, and what cannot work is refused before anything runs.

#include "simulation/simulate.hpp"

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/registry.hpp"
#include "simulation/run_metrics.hpp"
#include "simulation/scene_library.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace kairos;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Scene drop() { return parse_scene(tests::drop_scene, "drop.toml"); }

/// The message of the `InputError` that a choice earns; empty if it works.
std::string complaint(const RunChoice& choice, const Scene& scene = drop()) {
  try {
    (void)simulate(scene, choice);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// When it was told that work goes on, and how many frames it saw before.
class Impatient : public Recorder {
 public:
  void frame(const Frame& /*frame*/) override { ++frames_; }
  void goes_on(Instant t) override {
    told.push_back(t.seconds);
    before_second_frame += frames_ < 2 ? 1 : 0;
  }
  std::vector<double> told;
  int before_second_frame = 0;

 private:
  int frames_ = 0;
};

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the shortest way: a scene, a simulation, its events", "[simulation]") {
  const Simulation simulation = simulate(drop());
  CHECK(simulation.result.status == RunStatus::completed);
  REQUIRE(simulation.trajectory.events().size() == 1);
  // sqrt(2 * 4.9 / 9.8) = 1, and the impact acts a tolerance (1e-9 of 0.2 m at 9.8 m/s) early.
  CHECK(simulation.trajectory.events()[0].time.seconds == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("every entry of the registry is found under the name it gives itself", "[registry]") {
  for (const auto& scheme : schemes()) {
    CHECK(find_scheme(scheme->info().name) == scheme);
  }
  for (const auto& detector : detectors()) {
    CHECK(find_detector(detector->info().name) == detector);
  }
  for (const auto& law : impact_laws()) {
    CHECK(find_impact_law(law->info().name) == law);
  }
  const Model model(drop());
  for (const IntegratorEntry& entry : integrator_entries()) {
    CHECK(find_integrator(entry.info.name)(model, 0)->info().name == entry.info.name);
  }
  for (const std::string_view name : broad_phases()) {
    // Cells hold bodies as they move; their boxes are in a tree.
    CHECK(find_broad_phase(name)(2)->name() == (name == "cells" ? "dynamic-tree" : name));
  }
  CHECK(find_integrator("auto")(model, 0)->info().name == "closed-form");
}

TEST_CASE("unknown names are refused with the nearest that exists", "[registry]") {
  CHECK(mentions(complaint({.method = {.scheme = "evnt-driven"}}), "event-driven"));
  CHECK(mentions(complaint({.method = {.integrator = "rk44"}}), "rk4"));
  CHECK(mentions(complaint({.method = {.detector = "satt"}}), "sat"));
  CHECK(mentions(complaint({.method = {.impact = "newto"}}), "newton"));
  CHECK_THROWS_AS(find_broad_phase("none"), InputError);
}

TEST_CASE("numbers that make no sense are refused", "[simulation]") {
  CHECK(mentions(complaint({.duration = -1.0}), "duration"));
  CHECK(mentions(complaint({.duration = infinity}), "duration"));
  CHECK(mentions(complaint({.step = 0.0}), "step"));
  CHECK(mentions(complaint({.threshold = -1.0}), "threshold"));
  CHECK(mentions(complaint({.max_substeps = 0}), "max substeps"));
  CHECK(mentions(complaint({.toi_tolerance = infinity}), "tolerance"));
  CHECK(mentions(complaint({.frames = FixedFrames{0.0}}), "frame"));
  CHECK(mentions(complaint({.frames = FixedFrames{std::nan("")}}), "frame"));
  CHECK(mentions(complaint({.frames = FixedFrames{1e-300}}), "frames"));
}

TEST_CASE("solids that start inside each other are refused, touching ones are not",
          "[simulation]") {
  Scene scene = drop();
  Body& ball = scene.bodies[1];
  SECTION("one inside the other") {
    ball.initial.pose.position.y() = 0.05;
    const std::string text = complaint({}, scene);
    CHECK(mentions(text, "drop.toml:11: body.ball: starts 0.05 m inside body.floor (line 6)"));
  }
  SECTION("touching") {
    ball.initial.pose.position.y() = 0.1;
    CHECK(complaint({}, scene).empty());
  }
  SECTION("touching but for a rounding far from the origin") {
    scene.bodies[0].initial.pose.position.y() = 1e6;
    ball.initial.pose.position.y() = 1e6 + 0.1;  // rounds to a spacing of 1.2e-10
    CHECK(complaint({}, scene).empty());
  }
}

TEST_CASE("a run that leaves the numbers stops with a reason, and its last frame is whole",
          "[simulation]") {
  const std::string box = R"(duration = 1e3
frame = "1s"
G = 0.0
[[body]]
name = "box"
entity = "body"
half_extents = [0.1, 0.2, 0.3]
mass = 1.0
angular_velocity = [3.0, 2.0, 1.0]
)";
  const auto run = [](const std::string& text, const char* integrator) {
    return simulate(parse_scene(text, "box.toml"),
                    {.method = {.scheme = "original", .integrator = integrator}});
  };
  SECTION("explicit Euler on a stiff spring with frames far too long: it flies ever farther") {
    const RunResult result =
        run(box +
                "position = [1, 0, 0]\n[[force]]\nkind = \"spring\"\nbodies = [\"box\"]\n"
                "anchor = [0, 0, 0]\nstiffness = 10\npoint_a = [0, 0, 0.1]",
            "explicit-euler")
            .result;
    CHECK(result.status == RunStatus::stopped);
    CHECK(mentions(result.reason, "not finite"));
    CHECK(mentions(result.reason, "box"));
    CHECK(result.state[0].pose.position.allFinite());
  }
  SECTION("a tumbling box: its spin explodes, and that is told before it overflows") {
    for (const char* integrator : {"explicit-euler", "rk4", "dopri5"}) {
      const RunResult result = run(box, integrator).result;
      CAPTURE(integrator, result.reason);
      const bool controlled = std::string(integrator) == "dopri5";
      CHECK(result.status == (controlled ? RunStatus::completed : RunStatus::stopped));
      CHECK(mentions(result.reason, controlled ? "" : "unstable"));
      CHECK(mentions(result.reason, controlled ? "" : "box"));
      // At most what its angular momentum allows, twice.
      CHECK(result.state[0].twist.angular.norm() < 40.0);
    }
  }
}

TEST_CASE("the deepest penetration is that of impacts too, which no frame may show", "[metrics]") {
  const Model model(drop());
  MetricsRecorder metrics;
  metrics.begin(model);
  State bodies = model.initial_state();
  bodies[1].pose.position.y() = 0.025;  // 0.075 m inside
  Event event{.time = Instant{0.5}, .a = 0, .b = 1};
  event.before_a = event.after_a = bodies[0];
  event.before_b = event.after_b = bodies[1];
  metrics.event(event);
  bodies[1].pose.position.y() = 0.05;  // and 0.05 m in a frame
  metrics.frame({1, Instant{1.0}, bodies, EnergyLedger{}});
  const RunMetrics& found = metrics.metrics();
  CHECK(found.in_frames.depth == Approx(0.05).epsilon(1e-12));
  CHECK(found.deepest().depth == Approx(0.075).epsilon(1e-12));
  CHECK(found.deepest().time == 0.5);
  REQUIRE(found.deepest().pair);
  CHECK(*found.deepest().pair == BodyPair{0, 1});
}

TEST_CASE("a run whose energy is not finite stops, though its states are", "[simulation]") {
  Scene scene = read_scene(find_scene("flight"));
  scene.bodies[0].initial.twist.linear = {4000.0, 0.0, 0.0};
  RunChoice choice{.method = {"event-driven", "rk4", "certified", "newton"}};
  choice.duration = 2.0 / 60.0;
  const Simulation sim = simulate(scene, choice);
  CHECK(sim.result.status == RunStatus::stopped);
  CHECK(sim.result.reason.find("not finite") != std::string::npos);
  CHECK(sim.result.reason.find("energy ledger") != std::string::npos);
  CHECK(std::isfinite(sim.result.ledger.unexplained()));
}

TEST_CASE("tolerances have ranges: beyond what a scene can reach they ask for nothing",
          "[simulation][input]") {
  for (const double x : {1e308, 1e13, -1.0, std::nan("")}) {
    RunChoice located, relative, absolute;
    located.toi_tolerance = x;
    relative.stepper.relative_tolerance = x;
    absolute.stepper.absolute_tolerance = x;
    for (const RunChoice& choice : {located, relative, absolute}) {
      CHECK_THROWS_AS(simulate(drop(), choice), InputError);
    }
  }
}

TEST_CASE("metrics are what the drawn frames show", "[metrics]") {
  const Model model(drop());
  MetricsRecorder metrics;
  metrics.begin(model);
  EnergyLedger ledger;
  ledger.open(2.0, 3.0);
  State bodies = model.initial_state();
  const auto draw = [&](std::int64_t index, double t, double height) {
    bodies[1].pose.position.y() = height;
    metrics.frame({index, Instant{t}, bodies, ledger});
  };
  draw(0, 0.0, 1.0);
  ledger.balance(2.5, 3.0);
  ledger.add(EnergyLine::late_impact, 0.5);
  draw(1, 1.0, 0.075);  // 0.025 m inside, shown for 0.5 s
  draw(2, 1.5, 0.05);   // 0.05 m inside, shown for 0.25 s
  ledger.balance(2.25, 3.0);
  ledger.add(EnergyLine::truncation, -0.25);
  draw(3, 1.75, 0.2);

  const RunMetrics& found = metrics.metrics();
  CHECK(found.frames == 4);
  CHECK(found.frames_overlapping == 2);
  CHECK(found.time_overlapping == 0.75);
  CHECK(found.deepest().depth == Approx(0.05).epsilon(1e-12));  // roundoff of 0.1 - 0.05
  CHECK(found.deepest().time == 1.5);
  CHECK(found.max_energy_error == 0.5);
  CHECK(found.final_energy_error == 0.25);
  CHECK(found.energy_scale == 5.0);
}

TEST_CASE("a frame that takes long says now and then how far it is", "[simulation]") {
  Scene scene = drop();
  scene.bodies[1].initial.twist.linear = Vector3(1.0, 0.0, 0.0);
  const Model model(scene);
  Impatient recorder;
  RunChoice choice;
  choice.method = {"event-driven", "rk4", "certified", "newton"};
  choice.frames = FixedFrames{0.5};
  choice.step = 1e-5;
  choice.duration = 0.75;
  CHECK(simulate(model, choice, recorder).status == RunStatus::completed);
  // 50,000 steps of a frame are told every 1024.
  CHECK(recorder.before_second_frame == 48);
  CHECK(std::is_sorted(recorder.told.begin(), recorder.told.end()));
  CHECK(recorder.told.front() > 0.0);
  CHECK(recorder.told.back() > 0.74);
}
