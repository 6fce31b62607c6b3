#include "experiments/cli/run_options.hpp"

#include "core/csv.hpp"
#include "core/error.hpp"
#include "experiments/registry.hpp"
#include "experiments/scene_library.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <system_error>

namespace kairos::experiments {
namespace {

template <typename Port>
std::string names_of(std::span<const std::shared_ptr<const Port>> entries) {
  std::vector<std::string_view> names;
  for (const auto& entry : entries) {
    names.push_back(entry->info().name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

double number(const std::string& text, const char* option) {
  if (const std::optional<double> value = parse_number(text)) {
    return *value;
  }
  throw InputError("", 0, option, fmt::format("'{}' is not a finite number", text));
}

std::int64_t whole_number(const std::string& text, const char* option) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end) {
    throw InputError("", 0, option, fmt::format("'{}' is not a whole number", text));
  }
  return value;
}

/// `1/60`, `16ms`, or the path of a CSV of frame times.
FrameTimes frame_times(const std::string& text) {
  std::error_code error;
  if (std::filesystem::is_regular_file(text, error) || text.ends_with(".csv")) {
    return read_frame_csv(text);
  }
  return FixedFrames{parse_duration(text, {"", 0, "--frame"})};
}

/// Scene values that a person sets on the command line.
Override parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("", 0, "--set",
                     fmt::format("'{}' sets nothing; needed: KEY=VALUE, such as "
                                 "body.ball.radius=0.2",
                                 text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void replace(std::string& name, const std::optional<std::string>& given) {
  if (given) {
    name = *given;
  }
}

}  // namespace

void SceneOptions::add_to(CLI::App& command) {
  command.add_option("scene", scene_, "a scene file, or the name of a shipped scene")
      ->required()
      ->type_name("SCENE");
  command
      .add_option("--set", settings_,
                  "replace a value of the scene, such as body.ball.radius=0.2; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all()
      ->trigger_on_parse(false);
}

Scene SceneOptions::scene() const { return read_scene(find_scene(scene_), overrides()); }

std::vector<Override> SceneOptions::overrides() const {
  std::vector<Override> overrides;
  for (const std::string& setting : settings_) {
    overrides.push_back(parse_setting(setting));
  }
  return overrides;
}

void RunOptions::add_to(CLI::App& command) {
  const auto option = [&command](const char* name, std::optional<std::string>& value,
                                 const std::string& meaning, const char* type) {
    command.add_option(name, value, meaning)->type_name(type);
  };
  const MethodChoice defaults;
  option("--scheme", scheme_, fmt::format("{} (default {})", names_of(schemes()), defaults.scheme),
         "S");
  option(
      "--integrator", integrator_,
      fmt::format("a name of `kairos list` (default {}: the scene decides)", defaults.integrator),
      "I");
  option("--detector", detector_,
         fmt::format("{} (default {})", names_of(detectors()), defaults.detector), "D");
  option("--impact", impact_,
         fmt::format("{} (default {})", names_of(impact_laws()), defaults.impact), "L");
  command.add_flag("--thesis", thesis_,
                   "the thesis' own method, where no other option says otherwise: original, "
                   "thesis-euler, sat, thesis");
  option("--frame", frame_,
         "frame time: 1/60, 16ms, or a CSV of frame times (default: the scene's)", "H");
  option("--duration", duration_, "how long, s or with a unit (default: the scene's)", "T");
  option("--step", step_, "longest integrator step of event-driven (default: a frame)", "H");
  option("--threshold", threshold_,
         "largest movement of a substep, m (default: half of the smallest extent)", "X");
  command.add_flag("--equal-substeps", equal_substeps_, "substepped: a frame in equal parts");
  option("--max-substeps", max_substeps_, "in one frame; more stop the run (default 100000)", "N");
  option("--tolerance", tolerance_, "of times of impact, m (default: 1e-9 of the smaller extent)",
         "X");
  option("--relative-tolerance", relative_tolerance_, "of controlled integrators (default 1e-10)",
         "X");
  option("--absolute-tolerance", absolute_tolerance_,
         "of controlled integrators, m and m/s (default 1e-12)", "X");
  command.add_flag("--roundoff", roundoff_,
                   "replay every step in double-double for the ledger's line roundoff");
}

RunChoice RunOptions::choice() const {
  RunChoice choice;
  if (thesis_) {
    choice.method = MethodChoice::thesis();
  }
  replace(choice.method.scheme, scheme_);
  replace(choice.method.integrator, integrator_);
  replace(choice.method.detector, detector_);
  replace(choice.method.impact, impact_);
  if (frame_) {
    choice.frames = frame_times(*frame_);
  }
  if (duration_) {
    choice.duration = parse_duration(*duration_, {"", 0, "--duration"});
  }
  if (step_) {
    choice.step = parse_duration(*step_, {"", 0, "--step"});
  }
  if (threshold_) {
    choice.threshold = number(*threshold_, "--threshold");
  }
  if (max_substeps_) {
    choice.max_substeps = whole_number(*max_substeps_, "--max-substeps");
  }
  if (tolerance_) {
    choice.toi_tolerance = number(*tolerance_, "--tolerance");
  }
  if (relative_tolerance_) {
    choice.stepper.relative_tolerance = number(*relative_tolerance_, "--relative-tolerance");
  }
  if (absolute_tolerance_) {
    choice.stepper.absolute_tolerance = number(*absolute_tolerance_, "--absolute-tolerance");
  }
  choice.equal_substeps = equal_substeps_;
  choice.roundoff = roundoff_;
  return choice;
}

}  // namespace kairos::experiments
