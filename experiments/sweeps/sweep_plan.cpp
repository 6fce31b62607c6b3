#include "experiments/sweeps/sweep_plan.hpp"

#include "core/error.hpp"
#include "core/random.hpp"
#include "simulation/option.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace kairos::experiments {
namespace {

constexpr std::size_t max_runs = 10'000'000;

/// Evaluates an expression of a spec; errors name the line it was written on.
double value_of(const SweepSpec& spec, const std::string& key, int line, const std::string& text,
                const Values& values) {
  try {
    return evaluate(text, values);
  } catch (const std::invalid_argument& error) {
    throw InputError(spec.file, line, key, error.what());
  }
}

std::string literal(const SweepSpec& spec, const Setting& setting, const Setting::Part& part,
                    const Values& values, std::string& refused) {
  if (!part.expression) {
    return part.text;
  }
  const double x = value_of(spec, setting.key, setting.line, part.text, values);
  if (!std::isfinite(x)) {
    refused = fmt::format("{}: '{}' is not finite here", setting.key, part.text);
  }
  return fmt::format("{}", x);
}

/// A setting as TOML text, its expressions evaluated.
std::string toml_text(const SweepSpec& spec, const Setting& setting, const Values& values,
                      std::string& refused) {
  if (!setting.array) {
    return literal(spec, setting, setting.parts.front(), values, refused);
  }
  std::string out = "[";
  for (const Setting::Part& part : setting.parts) {
    out += out.size() > 1 ? ", " : "";
    out += literal(spec, setting, part, values, refused);
  }
  return out + "]";
}

std::string unquoted(const std::string& toml) {
  return toml.size() >= 2 && (toml.front() == '"' || toml.front() == '\'')
             ? toml.substr(1, toml.size() - 2)
             : toml;
}

/// A method option from a spec: names and flags as they stand, numbers as expressions.
void read_option(const SweepSpec& spec, const Setting& setting, const Values& values,
                 std::vector<OptionSetting>& options, std::string& refused) {
  if (setting.array) {
    throw InputError(spec.file, setting.line, setting.key, "must be one value, not a list");
  }
  const Option& option = *find_option(setting.key);
  const std::string text = unquoted(toml_text(spec, setting, values, refused));
  if (!refused.empty()) {
    return;
  }
  const bool as_written = option.kind == OptionKind::name || text == "true" || text == "false";
  const OptionValue value =
      as_written ? OptionValue(text)
                 : OptionValue(value_of(spec, setting.key, setting.line, text, values));
  try {
    RunChoice alone{.frames = FixedFrames{}};  // so that a message has the line of its setting
    set_option(alone, setting.key, value);
  } catch (const InputError& error) {
    throw InputError(spec.file, setting.line, setting.key, error.reason());
  }
  options.emplace_back(setting.key, value);
}

/// Names that do not exist are wrong in the spec, not refused run by run.
void check_method(const SweepSpec& spec, const MethodSpec& method, const RunChoice& choice) {
  const int line = method.options.empty() ? spec.line : method.options.front().line;
  try {
    (void)find_scheme(choice.method.scheme);
    (void)find_integrator(choice.method.integrator);
    (void)find_detector(choice.method.detector);
    (void)find_impact_law(choice.method.impact);
  } catch (const InputError& error) {
    throw InputError(spec.file, line, error.key().empty() ? "method" : error.key(), error.reason());
  }
}

/// Stream of a name (FNV-1a): an axis keeps its numbers when other axes are added.
std::uint64_t stream_of(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return hash;
}

AxisValue drawn(const SweepSpec& spec, const Axis& axis, std::size_t point, std::int64_t repeat) {
  const auto n = static_cast<std::uint64_t>(spec.repeats);
  const auto k = static_cast<std::uint64_t>(repeat);
  const std::uint64_t stream = stream_of(axis.name);
  double u = 0.0;
  if (axis.kind == Axis::Kind::random) {
    u = Random(spec.seed, stream, point * n + k).uniform();
  } else {
    u = (static_cast<double>(k) + Random(spec.seed, stream, point).uniform()) /
        static_cast<double>(n);
  }
  const double x = axis.from + (axis.to - axis.from) * u;
  return {fmt::format("{}", x), fmt::format("{}", x), x};
}

std::size_t point_count(const SweepSpec& spec) {
  std::size_t points = 1;
  for (const Axis& axis : spec.axes) {
    points *= axis.kind == Axis::Kind::listed ? axis.values.size() : 1;
    if (points > max_runs) {
      break;
    }
  }
  const double runs = static_cast<double>(points) * static_cast<double>(spec.repeats) *
                      static_cast<double>(spec.methods.size());
  if (runs > static_cast<double>(max_runs)) {
    throw InputError(
        spec.file, spec.line, "axis",
        fmt::format("the sweep would be {:.3g} runs; at most {} are allowed", runs, max_runs));
  }
  return points;
}

/// Axis values of a combination: the last axis runs fastest.
std::vector<AxisValue> values_at(const SweepSpec& spec, std::size_t point, std::int64_t repeat) {
  std::vector<AxisValue> out(spec.axes.size());
  std::size_t rest = point;
  for (std::size_t i = spec.axes.size(); i-- > 0;) {
    const Axis& axis = spec.axes[i];
    if (axis.kind == Axis::Kind::listed) {
      out[i] = axis.values[rest % axis.values.size()];
      rest /= axis.values.size();
    } else {
      out[i] = drawn(spec, axis, point, repeat);
    }
  }
  return out;
}

/// Jittered frames are drawn anew for each run, unless the spec names their seed.
void draw_frames(RunChoice& choice, const std::vector<OptionSetting>& options, std::uint64_t seed) {
  const bool named = std::any_of(options.begin(), options.end(),
                                 [](const auto& option) { return option.first == "frame_seed"; });
  if (auto* frames = choice.frames ? std::get_if<JitteredFrames>(&*choice.frames) : nullptr;
      frames != nullptr && !named) {
    frames->seed = seed;
  }
}

/// Turns axis values into scene values and method options.
void fill(const SweepSpec& spec, PlannedRun& run) {
  const MethodSpec& method = spec.methods[run.method];
  run.values = spec.constants;
  run.values["repeat"] = static_cast<double>(run.repeat);
  run.values["repeats"] = static_cast<double>(spec.repeats);
  for (std::size_t i = 0; i < spec.axes.size(); ++i) {
    if (run.axis_values[i].number) {
      run.values[spec.axes[i].name] = *run.axis_values[i].number;
    }
  }
  std::vector<OptionSetting> options;
  for (const auto* settings : {&spec.options, &method.options}) {
    for (const Setting& option : *settings) {
      read_option(spec, option, run.values, options, run.refused);
    }
  }
  for (std::size_t i = 0; i < spec.axes.size(); ++i) {
    const Axis& axis = spec.axes[i];
    const AxisValue& value = run.axis_values[i];
    if (axis.key.starts_with("method.")) {
      const Setting option{axis.key.substr(7), {{value.toml, false}}, false, axis.line};
      read_option(spec, option, run.values, options, run.refused);
    } else if (!axis.key.empty()) {
      run.overrides.push_back({axis.key, value.toml});
    }
  }
  for (const auto* settings : {&spec.set, &method.set}) {
    for (const Setting& setting : *settings) {
      run.overrides.push_back({setting.key, toml_text(spec, setting, run.values, run.refused)});
    }
  }
  const std::size_t draw =
      run.point * static_cast<std::size_t>(spec.repeats) + static_cast<std::size_t>(run.repeat);
  try {
    set_options(run.choice, options);
  } catch (const InputError& error) {
    throw InputError(spec.file, spec.line, error.key(), error.reason());
  }
  draw_frames(run.choice, options, Random(spec.seed, stream_of("frames"), draw).bits());
}

}  // namespace

std::string scene_path(const SweepSpec& spec) {
  const auto beside = std::filesystem::path(spec.file).parent_path() / spec.scene;
  std::error_code error;
  if (std::filesystem::is_regular_file(beside, error)) {
    return beside.string();
  }
  // A shipped name means the shipped scene, whatever lies about where the program is started.
  const std::vector<std::string> shipped = shipped_scenes();
  if (std::find(shipped.begin(), shipped.end(), spec.scene) != shipped.end()) {
    return shipped_scene_path(spec.scene);
  }
  try {
    return find_scene(spec.scene);
  } catch (const InputError& wrong) {
    throw InputError(spec.file, spec.line, "scene",
                     fmt::format("'{}' {}", spec.scene, wrong.reason()));
  }
}

SweepPlan::SweepPlan(const SweepSpec& spec)
    : spec_(spec),
      points_(point_count(spec)),
      size_(points_ * spec.methods.size() * static_cast<std::size_t>(spec.repeats)) {}

RunPlace SweepPlan::place(std::size_t index) const {
  const auto repeats = static_cast<std::size_t>(spec_.repeats);
  RunPlace place;
  place.index = index;
  place.repeat = static_cast<std::int64_t>(index % repeats);
  place.point = index / repeats % points_;
  place.method = index / repeats / points_;
  place.axis_values = values_at(spec_, place.point, place.repeat);
  return place;
}

PlannedRun SweepPlan::operator[](std::size_t index) const {
  PlannedRun run{place(index), {}, {}, {}, {}};
  fill(spec_, run);
  return run;
}

void SweepPlan::check(const std::function<bool(std::size_t)>& of) const {
  for (std::size_t i = 0; i < size_; ++i) {
    if (of && !of(i)) {
      continue;
    }
    const PlannedRun run = (*this)[i];
    if (run.repeat == 0) {
      check_method(spec_, spec_.methods[run.method], run.choice);
    }
  }
}

}  // namespace kairos::experiments
