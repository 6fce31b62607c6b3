#include "experiments/sweeps/sweep_spec.hpp"

#include "core/error.hpp"
#include "core/reading/scene_name.hpp"
#include "experiments/metrics/metrics.hpp"
#include "experiments/output/plain_file_name.hpp"
#include "experiments/sweeps/axis_reader.hpp"
#include "experiments/sweeps/experiment_program.hpp"
#include "experiments/sweeps/spec_section.hpp"
#include "simulation/option.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace kairos::experiments {
namespace {

constexpr std::int64_t max_repeats = 10000000;

using Keys = std::vector<std::string_view>;

/// A literal as TOML text; text that starts with '=' is an expression.
Setting::Part read_part(const Item& item) {
  const auto* text = std::get_if<std::string>(&item.value().data);
  if (text != nullptr && text->starts_with('=')) {
    return {text->substr(1), true};
  }
  return {toml_literal(item), false};
}

Setting read_setting(const std::string& key, const Item& item) {
  const Array* array = item.value().array();
  Setting setting{key, {}, array != nullptr, item.value().line};
  if (array == nullptr) {
    setting.parts.push_back(read_part(item));
    return setting;
  }
  for (const Value& value : *array) {
    setting.parts.push_back(
        read_part(Item(value, fmt::format("{}[{}]", item.path(), setting.parts.size() + 1))));
  }
  return setting;
}

/// Adds a setting; it replaces an earlier one with the same key.
void put(Setting setting, std::vector<Setting>& settings) {
  std::erase_if(settings, [&setting](const Setting& old) { return old.key == setting.key; });
  settings.push_back(std::move(setting));
}

/// Settings of `[set]`; later ones replace earlier ones with the same key.
void read_settings(const SpecSection& section, std::vector<Setting>& out) {
  for (const auto& [key, item] : section.entries()) {
    put(read_setting(key, item), out);
  }
}

/// A mark of a line, as matplotlib writes it.
void check_mark(const Item& item, const std::string& mark) {
  constexpr std::string_view marks = "os^DvPX*<>hpd8H";
  if (mark.size() != 1 || marks.find(mark) == std::string_view::npos) {
    item.fail(fmt::format("'{}' is no mark; allowed: one of {}", mark, marks));
  }
}

MethodSpec read_method(const SpecSection& section) {
  MethodSpec method;
  for (const auto& [key, item] : section.entries()) {
    if (key == "name") {
      method.name = section.text("name");
    } else if (key == "mark") {
      method.mark = section.text("mark");
      check_mark(item, method.mark);
    } else if (key == "set") {
      for (const SpecSection& set : section.tables("set")) {
        read_settings(set, method.set);
      }
    } else if (find_option(key) != nullptr) {
      put(read_setting(key, item), method.options);
    } else {
      item.fail(fmt::format("unknown key; allowed: name, mark, set, {}", option_names()));
    }
  }
  return method;
}

/// The text by which a table names a method that has no name: its scheme, or its integrator.
std::string default_name(const MethodSpec& method) {
  for (const Setting& option : method.options) {
    if (option.key == "scheme" && option.parts.size() == 1 && !option.parts[0].expression) {
      const std::string& quoted = option.parts[0].text;
      return quoted.size() > 2 ? quoted.substr(1, quoted.size() - 2) : quoted;
    }
  }
  return "default";
}

void check_names(const SpecSection& section, const SweepSpec& sweep) {
  std::set<std::string> names;
  const auto add = [&](const std::string& name, int line, const std::string& what) {
    if (!names.insert(name).second) {
      throw InputError(sweep.file, line, what, fmt::format("'{}' is used twice", name));
    }
  };
  for (const auto& [name, value] : sweep.constants) {
    add(name, sweep.line, "constants");
  }
  for (const Axis& axis : sweep.axes) {
    add(axis.name, axis.line, "axis");
  }
  for (const std::string& metric : sweep.metrics) {
    if (!is_metric(metric)) {
      section.fail("metrics",
                   fmt::format("there is no metric '{}'; allowed: {}", metric, metric_names()));
    }
    add(metric, sweep.line, "metrics");
  }
  for (const Derived& derived : sweep.derived) {
    add(derived.name, derived.line, "derive");
  }
  std::set<std::string> methods;
  for (const MethodSpec& method : sweep.methods) {
    if (!methods.insert(method.name).second) {
      section.fail("method", fmt::format("the name '{}' is used twice", method.name));
    }
  }
  if (!sweep.reference.empty() && methods.count(sweep.reference) == 0) {
    section.fail("reference", fmt::format("there is no method '{}'; there are: {}", sweep.reference,
                                          fmt::join(methods, ", ")));
  }
}

const Keys& sweep_keys() {
  static const Keys keys = {"scene",   "subject", "seed",      "repeats",   "metrics", "series",
                            "samples", "axis",    "method",    "set",       "derive",  "caption",
                            "x",       "y",       "constants", "reference", "options", "log"};
  return keys;
}

/// What the file says for all sweeps, or one `[[sweep]]` says for itself on top of that.
SweepSpec read_sweep(const SpecSection& section, SweepSpec sweep) {
  sweep.line = section.line();
  sweep.caption = section.text("caption", sweep.caption);
  sweep.scene = section.text("scene", sweep.scene);
  sweep.subject = section.text("subject", sweep.subject);
  sweep.reference = section.text("reference", sweep.reference);
  sweep.x = section.text("x", sweep.x);
  sweep.y = section.text("y", sweep.y);
  sweep.seed = static_cast<std::uint64_t>(
      section.count("seed", static_cast<std::int64_t>(sweep.seed), 0, INT64_MAX));
  sweep.repeats = section.count("repeats", sweep.repeats, 1, max_repeats);
  sweep.series = section.flag("series", sweep.series);
  sweep.logarithmic = section.flag("log", sweep.logarithmic);
  sweep.samples = section.count("samples", sweep.samples, 2, 1000000);
  if (section.find("metrics")) {
    sweep.metrics = section.texts("metrics");
  }
  for (const SpecSection& constants : section.tables("constants")) {
    for (const auto& [name, item] : constants.entries()) {
      sweep.constants[name] = number_of(item, sweep.constants);
    }
  }
  for (const SpecSection& set : section.tables("set")) {
    read_settings(set, sweep.set);
  }
  for (const SpecSection& options : section.tables("options")) {
    for (const auto& [key, item] : options.entries()) {
      if (find_option(key) == nullptr) {
        item.fail(fmt::format("unknown key; allowed: {}", option_names()));
      }
    }
    read_settings(options, sweep.options);
  }
  if (const auto axes = section.tables("axis"); !axes.empty()) {
    sweep.axes.clear();
    for (const SpecSection& axis : axes) {
      sweep.axes.push_back(read_axis(axis, sweep.constants));
    }
  }
  if (const auto methods = section.tables("method"); !methods.empty()) {
    sweep.methods.clear();
    for (const SpecSection& method : methods) {
      sweep.methods.push_back(read_method(method));
      if (sweep.methods.back().name.empty()) {
        sweep.methods.back().name = default_name(sweep.methods.back());
      }
    }
  }
  for (const SpecSection& derive : section.tables("derive")) {
    for (const auto& [name, item] : derive.entries()) {
      std::erase_if(sweep.derived, [&name = name](const Derived& d) { return d.name == name; });
      sweep.derived.push_back(
          {name, "", std::string(expression_text(item.text())), item.value().line});
    }
  }
  return sweep;
}

void check_sweep(const SpecSection& section, SweepSpec& sweep) {
  if (sweep.scene.empty()) {
    section.fail("scene", "is missing; the name of a scene or the path of its file");
  }
  if (sweep.metrics.empty()) {
    section.fail("metrics", fmt::format("is missing; allowed: {}", metric_names()));
  }
  if (sweep.methods.empty()) {
    sweep.methods.push_back({"default", {}, {}, {}});
  }
  if (sweep.samples == 0) {
    sweep.samples = 400;
  }
  check_names(section, sweep);
}

/// Names that differ in case alone are those of one file on some disks.
std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c;
  });
  return text;
}

ExperimentSpec read_root(const SpecSection& section, const std::string& path) {
  Keys keys = sweep_keys();
  keys.insert(keys.end(), {"name", "title", "asks", "how", "finding", "figure", "sweep", "program",
                           "scenes", "durations"});
  section.allow(keys);
  ExperimentSpec experiment;
  experiment.path = path;
  // Names become those of files and folders.
  const auto name = section.find("name");
  experiment.name =
      name ? read_name(*name) : plain_file_name(std::filesystem::path(path).stem().string());
  experiment.title = section.text("title", experiment.name);
  experiment.asks = section.text("asks");
  experiment.how = section.text("how");
  experiment.finding = section.text("finding");
  if (const auto figure = section.find("figure"); figure && !figure->text().empty()) {
    experiment.figure = read_name(*figure);  // of a script, which is run
  }
  experiment.program = section.text("program");
  if (section.find("scenes")) {
    experiment.scenes = section.texts("scenes");
  }
  if (section.find("durations")) {
    experiment.durations = section.positive_numbers("durations");
    if (experiment.durations.size() != experiment.scenes.size()) {
      section.fail("durations",
                   fmt::format("{} are not allowed; allowed: one for each of {} scenes",
                               experiment.durations.size(), experiment.scenes.size()));
    }
  }
  if (!experiment.program.empty()) {
    experiment.program_line = section.find("program")->value().line;
    return experiment;
  }
  SweepSpec shared;
  shared.file = path;
  shared.name = experiment.name;
  shared = read_sweep(section, shared);
  const auto sweeps = section.tables("sweep");
  std::map<std::string, int> lines;
  for (const SpecSection& own : sweeps) {
    Keys own_keys = sweep_keys();
    own_keys.push_back("name");
    own.allow(own_keys);
    SweepSpec sweep = read_sweep(own, shared);
    const auto given = own.find("name");
    sweep.name = given ? read_name(*given) : fmt::format("sweep{}", experiment.sweeps.size() + 1);
    const auto [first, is_new] = lines.emplace(lower_case(sweep.name), own.line());
    if (!is_new) {
      own.fail("name", fmt::format("\"{}\" is the name of the sweep of line {} already; allowed: a "
                                   "name of its own, for it names its tables",
                                   sweep.name, first->second));
    }
    check_sweep(own, sweep);
    experiment.sweeps.push_back(std::move(sweep));
  }
  if (sweeps.empty()) {
    check_sweep(section, shared);
    experiment.sweeps.push_back(std::move(shared));
  }
  return experiment;
}

}  // namespace

ExperimentSpec parse_experiment(std::string_view text, const std::string& path, Size size) {
  const Value document = parse_document(text, path);
  return read_root(SpecSection(TableReader(Item(document, "")), size), path);
}

ExperimentSpec read_experiment(const std::string& path, Size size) {
  return parse_experiment(read_text_file(path), path, size);
}

}  // namespace kairos::experiments
