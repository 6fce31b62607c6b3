#include "simulation/option.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/nearest_name.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/frame_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

namespace kairos {
inline namespace simulation {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double large = 1e300;
constexpr double most_tolerance = 1e12;  // as `simulate` takes: no scene reaches farther
constexpr double most_count = 1e15;

std::string text_of(double value) { return fmt::format("{}", value); }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const std::optional<double>& value) { return value ? text_of(*value) : ""; }

/// Sets a member of jittered frames; fixed ones become jittered where that changes anything.
template <typename Member>
void put_jitter(RunChoice& choice, std::string_view option, Member JitteredFrames::*member,
                Member value) {
  auto* frames = choice.frames ? std::get_if<JitteredFrames>(&*choice.frames) : nullptr;
  if (frames == nullptr && value == JitteredFrames{}.*member) {
    return;
  }
  if (frames == nullptr) {
    const auto* fixed = choice.frames ? std::get_if<FixedFrames>(&*choice.frames) : nullptr;
    if (fixed == nullptr) {
      throw InputError("", 0, std::string(option), "needs a frame, a duration");
    }
    choice.frames = JitteredFrames{.mean = fixed->duration};
    frames = std::get_if<JitteredFrames>(&*choice.frames);
  }
  frames->*member = value;
}

/// A member of jittered frames, of those that a choice has or of the default.
template <typename Member>
std::string jitter_text(const RunChoice& choice, Member JitteredFrames::*member) {
  const auto* frames = choice.frames ? std::get_if<JitteredFrames>(&*choice.frames) : nullptr;
  return fmt::format("{}", (frames != nullptr ? *frames : JitteredFrames{}).*member);
}

std::string frames_text(const RunChoice& choice) {
  struct Writer {
    std::string operator()(const FixedFrames& f) const { return text_of(f.duration); }
    std::string operator()(const ListedFrames& f) const { return f.path; }
    std::string operator()(const JitteredFrames& f) const { return text_of(f.mean); }
  };
  return choice.frames ? std::visit(Writer{}, *choice.frames) : "";
}

void put_frames(RunChoice& choice, double /*number*/, const std::string& text) {
  std::error_code error;
  if (std::filesystem::is_regular_file(text, error) || text.ends_with(".csv")) {
    choice.frames = read_frame_csv(text);
  } else {
    choice.frames = FixedFrames{parse_duration(text, {"", 0, "frame"})};
  }
}

constexpr Range any_duration{
    .lowest = 0.0, .highest = longest_duration, .above = true, .unit = "s"};

constexpr Option name_option(std::string_view name, std::string_view help,
                             std::string (*get)(const RunChoice&),
                             void (*put)(RunChoice&, double, const std::string&)) {
  return {name, name, OptionKind::name, {}, help, get, put};
}

template <auto Member>
constexpr Option stepping_number(std::string_view name, std::string_view flag, Range range,
                                 std::string_view help) {
  return {name,
          flag,
          OptionKind::number,
          range,
          help,
          [](const RunChoice& c) { return text_of(c.stepping.*Member); },
          [](RunChoice& c, double x, const std::string&) { c.stepping.*Member = x; }};
}

template <auto Member>
constexpr Option stepping_count(std::string_view name, std::string_view flag,
                                std::string_view help) {
  return {name,
          flag,
          OptionKind::count,
          {.lowest = 0.0, .highest = most_count},
          help,
          [](const RunChoice& c) { return fmt::format("{}", c.stepping.*Member); },
          [](RunChoice& c, double x, const std::string&) {
            c.stepping.*Member = static_cast<std::int64_t>(x);
          }};
}

const std::array<Option, 34> table{{
    name_option(
        "scheme", "when the world is looked at, and how contacts are kept",
        [](const RunChoice& c) { return c.method.scheme; },
        [](RunChoice& c, double, const std::string& text) { c.method.scheme = text; }),
    name_option(
        "integrator", "how the state moves in between; auto: the scene decides",
        [](const RunChoice& c) { return c.method.integrator; },
        [](RunChoice& c, double, const std::string& text) { c.method.integrator = text; }),
    name_option(
        "detector", "whether two bodies touch, and since when",
        [](const RunChoice& c) { return c.method.detector; },
        [](RunChoice& c, double, const std::string& text) { c.method.detector = text; }),
    name_option(
        "impact", "what two bodies do to each other",
        [](const RunChoice& c) { return c.method.impact; },
        [](RunChoice& c, double, const std::string& text) { c.method.impact = text; }),
    {"frame", "frame", OptionKind::frames, any_duration,
     "frame time: 1/60, 16ms, or a CSV of frame times (default: the scene's)", frames_text,
     put_frames},
    {"frame_jitter",
     "frame-jitter",
     OptionKind::number,
     {.lowest = 0.0, .highest = 0.999},
     "frames last frame * (1 + jitter u), u uniform in [-1, 1); needs a frame",
     [](const RunChoice& c) { return jitter_text(c, &JitteredFrames::jitter); },
     [](RunChoice& c, double x, const std::string&) {
       put_jitter(c, "frame_jitter", &JitteredFrames::jitter, x);
     }},
    {"spike_probability",
     "spike-probability",
     OptionKind::number,
     {.lowest = 0.0, .highest = 1.0},
     "of a frame that stalls; needs a frame",
     [](const RunChoice& c) { return jitter_text(c, &JitteredFrames::spike_probability); },
     [](RunChoice& c, double x, const std::string&) {
       put_jitter(c, "spike_probability", &JitteredFrames::spike_probability, x);
     }},
    {"spike_factor",
     "spike-factor",
     OptionKind::number,
     {.lowest = 1.0, .highest = 1e6},
     "how many frames a stall lasts",
     [](const RunChoice& c) { return jitter_text(c, &JitteredFrames::spike_factor); },
     [](RunChoice& c, double x, const std::string&) {
       put_jitter(c, "spike_factor", &JitteredFrames::spike_factor, x);
     }},
    {"frame_seed",
     "frame-seed",
     OptionKind::count,
     {.lowest = 0.0, .highest = most_count},
     "draws jitter and stalls",
     [](const RunChoice& c) { return jitter_text(c, &JitteredFrames::seed); },
     [](RunChoice& c, double x, const std::string&) {
       put_jitter(c, "frame_seed", &JitteredFrames::seed, static_cast<std::uint64_t>(x));
     }},
    {"duration", "duration", OptionKind::duration, any_duration,
     "how long, s or with a unit (default: the scene's)",
     [](const RunChoice& c) { return text_of(c.duration); },
     [](RunChoice& c, double x, const std::string&) { c.duration = x; }},
    {"step", "step", OptionKind::duration, any_duration,
     "longest integrator step of event-driven (default: a frame)",
     [](const RunChoice& c) { return text_of(c.step); },
     [](RunChoice& c, double x, const std::string&) { c.step = x; }},
    {"threshold",
     "threshold",
     OptionKind::number,
     {.lowest = 0.0, .highest = large, .unit = "m"},
     "largest movement of a substep; 0: half of the smallest sum of two extents",
     [](const RunChoice& c) { return text_of(c.threshold); },
     [](RunChoice& c, double x, const std::string&) { c.threshold = x; }},
    {"equal_substeps",
     "equal-substeps",
     OptionKind::flag,
     {},
     "substepped: a frame in equal parts",
     [](const RunChoice& c) { return text_of(c.equal_substeps); },
     [](RunChoice& c, double x, const std::string&) { c.equal_substeps = x != 0.0; }},
    {"max_substeps",
     "max-substeps",
     OptionKind::count,
     {.lowest = 1.0, .highest = most_count},
     "in one frame; more stop the run",
     [](const RunChoice& c) { return fmt::format("{}", c.max_substeps); },
     [](RunChoice& c, double x, const std::string&) {
       c.max_substeps = static_cast<std::int64_t>(x);
     }},
    {"max_events",
     "max-events",
     OptionKind::count,
     {.lowest = 0.0, .highest = most_count},
     "of event-driven in one frame; more stop the run; 0: 1,000,000, and 1000 a body where that is "
     "more",
     [](const RunChoice& c) { return fmt::format("{}", c.max_events); },
     [](RunChoice& c, double x, const std::string&) {
       c.max_events = static_cast<std::int64_t>(x);
     }},
    {"toi_tolerance",
     "tolerance",
     OptionKind::number,
     {.lowest = 0.0, .highest = most_tolerance, .unit = "m"},
     "of times of impact; 0: 1e-9 of the smaller extent and the roundoff of the coordinates",
     [](const RunChoice& c) { return text_of(c.toi_tolerance); },
     [](RunChoice& c, double x, const std::string&) { c.toi_tolerance = x; }},
    {"relative_tolerance",
     "relative-tolerance",
     OptionKind::number,
     {.lowest = 0.0, .highest = 1.0, .above = true},
     "of controlled integrators",
     [](const RunChoice& c) { return text_of(c.stepper.relative_tolerance); },
     [](RunChoice& c, double x, const std::string&) { c.stepper.relative_tolerance = x; }},
    {"absolute_tolerance",
     "absolute-tolerance",
     OptionKind::number,
     {.lowest = 0.0, .highest = most_tolerance, .above = true, .unit = "m, m/s"},
     "of controlled integrators",
     [](const RunChoice& c) { return text_of(c.stepper.absolute_tolerance); },
     [](RunChoice& c, double x, const std::string&) { c.stepper.absolute_tolerance = x; }},
    {"fixed_step",
     "fixed-step",
     OptionKind::flag,
     {},
     "controlled integrators take each step as it is asked for",
     [](const RunChoice& c) { return text_of(std::isinf(c.stepper.relative_tolerance)); },
     [](RunChoice& c, double x, const std::string&) {
       if (x != 0.0) {
         c.stepper = {infinite, infinite};
       } else if (std::isinf(c.stepper.relative_tolerance)) {
         c.stepper = {};
       }
     }},
    {"cold_restarts",
     "cold-restarts",
     OptionKind::flag,
     {},
     "steppers forget all they know at every impact",
     [](const RunChoice& c) { return text_of(c.cold_restarts); },
     [](RunChoice& c, double x, const std::string&) { c.cold_restarts = x != 0.0; }},
    {"roundoff",
     "roundoff",
     OptionKind::flag,
     {},
     "replay every step in double-double for the ledger's line roundoff",
     [](const RunChoice& c) { return text_of(c.roundoff); },
     [](RunChoice& c, double x, const std::string&) { c.roundoff = x != 0.0; }},
    stepping_count<&TimeSteppingOptions::substeps>(
        "substeps", "substeps", "steps in a frame; 0: moreau-jean and pgs 1, xpbd 20, penalty 100"),
    stepping_count<&TimeSteppingOptions::iterations>(
        "iterations", "iterations",
        "sweeps over all contacts in a step; 0: moreau-jean at most 1000, pgs 10, xpbd 1"),
    stepping_number<&TimeSteppingOptions::theta>("theta", "theta", {.lowest = 0.5, .highest = 1.0},
                                                 "moreau-jean: weight of the end of a step"),
    stepping_number<&TimeSteppingOptions::solver_tolerance>(
        "solver_tolerance", "solver-tolerance", {.lowest = 0.0, .highest = 1.0},
        "moreau-jean: sweeps end where velocities change by less, relatively"),
    stepping_number<&TimeSteppingOptions::beta>(
        "beta", "beta", {.lowest = 0.0, .highest = 1.0},
        "pgs: share of a penetration that a step is to undo (Baumgarte)"),
    stepping_number<&TimeSteppingOptions::slop>(
        "slop", "slop", {.lowest = 0.0, .highest = most_tolerance, .unit = "m"},
        "pgs: penetration that is left alone"),
    stepping_number<&TimeSteppingOptions::restitution_threshold>(
        "restitution_threshold", "restitution-threshold",
        {.lowest = 0.0, .highest = most_tolerance, .unit = "m/s"},
        "pgs: slower approaches do not rebound"),
    {"cold_starts",
     "cold-starts",
     OptionKind::flag,
     {},
     "pgs: no warm starting from the impulses of the last step",
     [](const RunChoice& c) { return text_of(!c.stepping.warm_starting); },
     [](RunChoice& c, double x, const std::string&) { c.stepping.warm_starting = x == 0.0; }},
    stepping_number<&TimeSteppingOptions::compliance>(
        "compliance", "compliance", {.lowest = 0.0, .highest = 1e30, .unit = "m/N"},
        "xpbd: of contacts"),
    stepping_number<&TimeSteppingOptions::stiffness>(
        "stiffness", "stiffness",
        {.lowest = 0.0, .highest = 1e30, .above = true, .unit = "N/m^exponent"},
        "penalty: of a contact point"),
    stepping_number<&TimeSteppingOptions::exponent>(
        "exponent", "exponent", {.lowest = 1.0, .highest = 4.0},
        "penalty: of the depth; 1.5 after Hertz, 1 a linear spring"),
    {"dissipation",
     "dissipation",
     OptionKind::number,
     {.lowest = 0.0, .highest = most_tolerance, .unit = "s/m"},
     "penalty: alpha of Hunt and Crossley (default: from the pair's restitution)",
     [](const RunChoice& c) { return text_of(c.stepping.dissipation); },
     [](RunChoice& c, double x, const std::string&) { c.stepping.dissipation = x; }},
    stepping_number<&TimeSteppingOptions::stiction_velocity>(
        "stiction_velocity", "stiction-velocity",
        {.lowest = 0.0, .highest = most_tolerance, .above = true, .unit = "m/s"},
        "penalty: slower slip has less friction"),
}};

std::string allowed_by(const Option& option) {
  return option.kind == OptionKind::count ? fmt::format("a whole number from {:g} to {:g}",
                                                        option.range.lowest, option.range.highest)
                                          : option.range.text();
}

[[noreturn]] void refuse(const Option& option, std::string_view given, std::string_view allowed) {
  throw InputError("", 0, std::string(option.name),
                   fmt::format("is {}; allowed: {}", given, allowed));
}

double truth(const Option& option, const OptionValue& value) {
  if (const bool* given = std::get_if<bool>(&value)) {
    return *given ? 1.0 : 0.0;
  }
  if (const double* given = std::get_if<double>(&value)) {
    if (*given == 0.0 || *given == 1.0) {
      return *given;
    }
    refuse(option, text_of(*given), "true or false");
  }
  const std::string& text = std::get<std::string>(value);
  if (text == "true" || text == "1") {
    return 1.0;
  }
  if (text == "false" || text == "0") {
    return 0.0;
  }
  refuse(option, fmt::format("'{}'", text), "true or false");
}

double number(const Option& option, const OptionValue& value) {
  double x = 0.0;
  if (const double* given = std::get_if<double>(&value)) {
    x = *given;
  } else if (const std::string* text = std::get_if<std::string>(&value)) {
    const std::optional<double> read = parse_number(trimmed(*text));
    if (!read) {
      refuse(option, fmt::format("'{}'", *text), allowed_by(option));
    }
    x = *read;
  } else {
    refuse(option, text_of(std::get<bool>(value)), allowed_by(option));
  }
  const bool whole = option.kind != OptionKind::count || x == std::floor(x);
  if (!std::isfinite(x) || !option.range.contains(x) || !whole) {
    refuse(option, text_of(x), allowed_by(option));
  }
  return x;
}

std::string words(const Option& option, const OptionValue& value) {
  if (const std::string* text = std::get_if<std::string>(&value)) {
    return *text;
  }
  if (const double* x = std::get_if<double>(&value); x && option.kind != OptionKind::name) {
    return text_of(*x);
  }
  refuse(option, std::holds_alternative<bool>(value) ? "true or false" : "a number",
         option.kind == OptionKind::name ? "a name" : "a duration");
}

}  // namespace

std::span<const Option> options() { return table; }

const Option* find_option(std::string_view name) {
  for (const Option& option : table) {
    if (option.name == name) {
      return &option;
    }
  }
  return nullptr;
}

std::string option_names() {
  std::string names;
  for (const Option& option : table) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", option.name);
  }
  return names;
}

void set_option(RunChoice& choice, std::string_view name, const OptionValue& value) {
  const Option* option = find_option(name);
  if (option == nullptr) {
    std::vector<std::string_view> names;
    for (const Option& known : table) {
      names.push_back(known.name);
    }
    throw InputError("", 0, std::string(name),
                     fmt::format("is no option of a run; {}", suggestion(name, names)));
  }
  switch (option->kind) {
    case OptionKind::name:
    case OptionKind::frames:
      option->put(choice, 0.0, words(*option, value));
      return;
    case OptionKind::duration:
      option->put(choice, parse_duration(words(*option, value), {"", 0, std::string(option->name)}),
                  "");
      return;
    case OptionKind::flag:
      option->put(choice, truth(*option, value), "");
      return;
    case OptionKind::number:
    case OptionKind::count:
      option->put(choice, number(*option, value), "");
      return;
  }
}

void set_options(RunChoice& choice, std::span<const OptionSetting> settings) {
  for (const auto& [name, value] : settings) {
    if (find_option(name) == nullptr) {
      set_option(choice, name, value);  // which says so
    }
  }
  for (const Option& option : table) {
    for (auto setting = settings.rbegin(); setting != settings.rend(); ++setting) {
      if (setting->first == option.name) {
        set_option(choice, option.name, setting->second);
        break;
      }
    }
  }
}

std::vector<std::pair<std::string, std::string>> identity_of(const RunChoice& choice) {
  std::vector<std::pair<std::string, std::string>> identity;
  for (const Option& option : table) {
    identity.emplace_back(option.name, option.get(choice));
  }
  if (choice.frames) {
    if (const auto* listed = std::get_if<ListedFrames>(&*choice.frames)) {
      identity.emplace_back("listed frames",
                            fingerprint(fmt::format("{}", fmt::join(listed->durations, " "))));
    }
  }
  return identity;
}

}  // namespace simulation
}  // namespace kairos
