#include "experiments/rally/rally_run.hpp"

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kairos::experiments {
namespace {

/// A body of the scene follows a recording, as `[body.drive] track` would make it.
void follow(Scene& scene, const std::string& name, const Recording& recording) {
  const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                 [&](const Body& b) { return b.name == name; });
  std::vector<TrackSample> samples = recording.samples;
  for (TrackSample& sample : samples) {
    sample.pose.orientation.normalize();  // the files hold seven digits
  }
  const double reach = bounding_radius(bounding_box(body->shape));
  body->drive = std::make_shared<const Track>(
      std::move(samples), Track::Options{.reach = reach, .gestures = recording.gestures});
  const Motion motion = body->drive->motion(Instant{}, 1.0);
  body->initial = {motion.pose(0.0), motion.twist(0.0)};
}

RallyMethod thesis_with(std::string name, const char* scheme, const char* detector) {
  return {.name = std::move(name),
          .choice = {.method = {scheme, "thesis-euler", detector, "thesis"}}};
}

/// `original` without the nudge, and with it at five factors in both readings.
void add_nudges(const std::string& name, double bat_mass, std::vector<RallyMethod>& methods) {
  const auto add = [&](const std::string& more) -> RallyMethod& {
    methods.push_back(thesis_with(name + more, "original", "sat"));
    methods.back().bat_mass = bat_mass;
    return methods.back();
  };
  constexpr double factors[] = {0.001, 0.0025, 0.005, 0.01, 0.02};
  add("");
  for (const double factor : factors) {
    add(fmt::format(", nudge {}", factor)).nudge = factor;
  }
  for (const double factor : factors) {
    add(fmt::format(", nudge {} (prose)", factor)).nudge_prose = factor;
  }
}

}  // namespace

std::vector<RallyMethod> rally_methods() {
  std::vector<RallyMethod> methods;
  add_nudges("original", 0.18, methods);
  add_nudges("original, equal masses", 0.0027, methods);
  methods.push_back(thesis_with("geometric", "geometric", "bisection"));
  // Bat and ball are 5.5 cm through: all of it, half of it, a fifth of it.
  for (const bool equal : {false, true}) {
    for (const double threshold : {0.055, 0.0275, 0.011}) {
      methods.push_back(
          thesis_with(fmt::format("{}, {} m", equal ? "equal substeps" : "substepped", threshold),
                      "substepped", "sat"));
      methods.back().choice.threshold = threshold;
      methods.back().choice.equal_substeps = equal;
    }
  }
  methods.push_back(thesis_with("bisected", "bisected", "bisection"));
  methods.push_back({.name = "event-driven", .choice = {}});
  methods.push_back(thesis_with("original, boxes", "original", "sat"));
  methods.back().boxes = true;
  methods.push_back(thesis_with("substepped, 0.0275 m, boxes", "substepped", "sat"));
  methods.back().choice.threshold = 0.0275;
  methods.back().boxes = true;
  return methods;
}

Scene rally_scene(const RallyRecording& rally, const RallyMethod& method) {
  std::vector<Override> values{{"body.bat.nudge", fmt::format("{}", method.nudge)},
                               {"body.bat.nudge_prose", fmt::format("{}", method.nudge_prose)},
                               {"body.bat.mass", fmt::format("{}", method.bat_mass)},
                               {"duration", fmt::format("{}", rally.duration())}};
  if (method.boxes) {
    constexpr double mass = 0.0027;  // kg, of the ball
    values.insert(values.end(), {{"bounds", "\"obb\""},
                                 {"gravity", "\"force\""},
                                 {"body.ball.G", fmt::format("{}", 9.8 * mass)}});
  }
  Scene scene = read_scene(find_scene("table-tennis"), values);
  follow(scene, "bat", rally.bat);
  follow(scene, "hand", rally.hand);
  return scene;
}

Cluster RallyOutcome::passed() const {
  const auto passes = std::count_if(strokes.begin(), strokes.end(),
                                    [](const StrokeOutcome& stroke) { return stroke.passed(); });
  return {passes, static_cast<std::int64_t>(strokes.size())};
}

RallyOutcome play(const RallyRecording& rally, const RallyMethod& method) {
  const Model model(rally_scene(rally, method));
  StrokeWatch watch(rally);
  const RunResult result = simulate(model, method.choice, watch);
  return {result.status, result.reason, watch.strokes(), watch.speeds()};
}

}  // namespace kairos::experiments
