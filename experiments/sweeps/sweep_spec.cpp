#include "experiments/sweeps/sweep_spec.hpp"

#include "core/error.hpp"
#include "experiments/metrics/metrics.hpp"
#include "experiments/programs/experiment_program.hpp"
#include "experiments/sweeps/sweep_method.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace kairos::experiments {
namespace {

constexpr std::int64_t max_values = 100000;  // of one axis
constexpr std::int64_t max_repeats = 10000000;

using Keys = std::vector<std::string_view>;

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

/// Reads one table of a spec and says where it is wrong. `{quick = .., full = ..}` may stand for
/// any value.
class Section {
 public:
  Section(const toml::table& table, std::string where, std::string path, Size size)
      : table_(&table), where_(std::move(where)), path_(std::move(path)), size_(size) {}

  [[nodiscard]] int line() const { return line_of(*table_); }

  [[noreturn]] void fail(int line, const std::string& key, const std::string& reason) const {
    throw InputError(path_, line, where_.empty() ? key : fmt::format("{}.{}", where_, key), reason);
  }
  void allow(const Keys& keys) const {
    for (const auto& [key, node] : *table_) {
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) {
        fail(static_cast<int>(key.source().begin.line), std::string(key.str()),
             fmt::format("unknown key; allowed: {}", fmt::join(keys, ", ")));
      }
    }
  }
  [[nodiscard]] const toml::node* find(std::string_view key) const {
    const toml::node* node = table_->get(key);
    if (node != nullptr && node->is_table()) {
      const toml::table& sizes = *node->as_table();
      if (sizes.size() == 2 && sizes.contains("quick") && sizes.contains("full")) {
        return sizes.get(to_string(size_));
      }
    }
    return node;
  }
  [[nodiscard]] std::string text(std::string_view key, std::string fallback = {}) const {
    const toml::node* node = find(key);
    if (node == nullptr) {
      return fallback;
    }
    if (!node->is_string()) {
      fail(line_of(*node), std::string(key), "must be text in quotes");
    }
    return node->as_string()->get();
  }
  [[nodiscard]] bool flag(std::string_view key, bool fallback) const {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_boolean()) {
      fail(line_of(*node), std::string(key), "must be true or false");
    }
    return node == nullptr ? fallback : node->as_boolean()->get();
  }
  [[nodiscard]] std::int64_t count(std::string_view key, std::int64_t fallback, std::int64_t least,
                                   std::int64_t most) const {
    const toml::node* node = find(key);
    if (node == nullptr) {
      return fallback;
    }
    const auto* n = node->as_integer();
    if (n == nullptr || n->get() < least || n->get() > most) {
      fail(line_of(*node), std::string(key),
           fmt::format("must be a whole number from {} to {}", least, most));
    }
    return n->get();
  }
  /// A finite number, or an expression over `values`.
  [[nodiscard]] double number(std::string_view key, const Values& values) const {
    const toml::node* node = find(key);
    if (node == nullptr) {
      fail(line(), std::string(key), "is missing; a number or an expression is needed");
    }
    return number_of(*node, key, values);
  }
  [[nodiscard]] double number_of(const toml::node& node, std::string_view key,
                                 const Values& values) const {
    double x = 0.0;
    if (node.is_string()) {
      try {
        x = evaluate(expression_text(node.as_string()->get()), values);
      } catch (const std::invalid_argument& error) {
        fail(line_of(node), std::string(key), error.what());
      }
    } else if (node.is_number()) {
      x = *node.value<double>();
    } else {
      fail(line_of(node), std::string(key), "must be a number or an expression in quotes");
    }
    if (!std::isfinite(x)) {
      fail(line_of(node), std::string(key), "must be finite");
    }
    return x;
  }
  [[nodiscard]] std::vector<std::string> texts(std::string_view key) const {
    std::vector<std::string> out;
    const toml::node* node = find(key);
    if (node == nullptr) {
      return out;
    }
    if (!node->is_array()) {
      fail(line_of(*node), std::string(key), "must be a list of texts");
    }
    for (const toml::node& item : *node->as_array()) {
      if (!item.is_string()) {
        fail(line_of(item), std::string(key), "must be a list of texts");
      }
      out.push_back(item.as_string()->get());
    }
    return out;
  }
  /// The tables of `[[key]]`, or the one table of `[key]`.
  [[nodiscard]] std::vector<Section> tables(std::string_view key) const {
    std::vector<Section> out;
    const toml::node* node = table_->get(key);
    if (node == nullptr) {
      return out;
    }
    if (node->is_table()) {
      out.emplace_back(*node->as_table(), std::string(key), path_, size_);
      return out;
    }
    if (!node->is_array()) {
      fail(line_of(*node), std::string(key), fmt::format("must be tables: [[{}]]", key));
    }
    for (const toml::node& item : *node->as_array()) {
      if (!item.is_table()) {
        fail(line_of(item), std::string(key), fmt::format("must be tables: [[{}]]", key));
      }
      out.emplace_back(*item.as_table(), fmt::format("{}[{}]", key, out.size() + 1), path_, size_);
    }
    return out;
  }
  [[nodiscard]] Section child(const std::string& key, const toml::table& table) const {
    return {table, key, path_, size_};
  }
  /// Entries in the order in which they are written.
  [[nodiscard]] std::vector<std::pair<std::string, const toml::node*>> entries() const {
    std::vector<std::pair<std::string, const toml::node*>> out;
    for (const auto& [key, node] : *table_) {
      out.emplace_back(std::string(key.str()), find(key.str()));
    }
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
      return line_of(*a.second) < line_of(*b.second);
    });
    return out;
  }

  [[nodiscard]] static std::string_view expression_text(std::string_view text) {
    return text.starts_with('=') ? text.substr(1) : text;
  }

 private:
  const toml::table* table_;
  std::string where_;
  std::string path_;
  Size size_;
};

/// A literal as TOML text; text that starts with '=' is an expression.
Setting::Part read_part(const Section& section, const std::string& key, const toml::node& node) {
  if (node.is_string() && node.as_string()->get().starts_with('=')) {
    return {node.as_string()->get().substr(1), true};
  }
  if (node.is_floating_point() || node.is_integer()) {
    return {fmt::format("{}", section.number_of(node, key, {})), false};
  }
  if (node.is_string() || node.is_boolean()) {
    std::ostringstream out;
    node.visit([&out](const auto& value) { out << value; });
    return {out.str(), false};
  }
  section.fail(line_of(node), key, "must be a number, text, true/false, or a list of these");
}

Setting read_setting(const Section& section, const std::string& key, const toml::node& node) {
  Setting setting{key, {}, node.is_array(), line_of(node)};
  if (!node.is_array()) {
    setting.parts.push_back(read_part(section, key, node));
    return setting;
  }
  for (const toml::node& item : *node.as_array()) {
    setting.parts.push_back(read_part(section, key, item));
  }
  return setting;
}

/// Settings of `[set]`; later ones replace earlier ones with the same key.
void read_settings(const Section& section, std::vector<Setting>& out) {
  for (const auto& [key, node] : section.entries()) {
    std::erase_if(out, [&key = key](const Setting& old) { return old.key == key; });
    out.push_back(read_setting(section, key, *node));
  }
}

MethodSpec read_method(const Section& section) {
  MethodSpec method;
  for (const auto& [key, node] : section.entries()) {
    if (key == "name") {
      method.name = section.text("name");
    } else if (key == "set") {
      read_settings(section.tables("set").front(), method.set);
    } else if (is_method_option(key)) {
      std::erase_if(method.options, [&key = key](const Setting& old) { return old.key == key; });
      method.options.push_back(read_setting(section, key, *node));
    } else {
      section.fail(line_of(*node), key,
                   fmt::format("unknown key; allowed: name, set, {}", method_option_names()));
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

AxisValue axis_value(const Section& section, const toml::node& node, const Values& constants) {
  if (node.is_number()) {
    const double x = section.number_of(node, "list", constants);
    return {fmt::format("{}", x), fmt::format("{}", x), x};
  }
  if (node.is_string()) {
    const std::string text = node.as_string()->get();
    const bool expression = text.starts_with('=');
    try {
      const double x = evaluate(Section::expression_text(text), constants);
      return {fmt::format("{}", x), fmt::format("{}", x), x};
    } catch (const std::invalid_argument& error) {
      if (expression) {
        section.fail(line_of(node), "list", error.what());
      }
    }
    return {text, read_part(section, "list", node).text, std::nullopt};
  }
  std::ostringstream out;
  node.visit([&out](const auto& value) { out << value; });
  return {out.str(), out.str(), std::nullopt};
}

/// `{from, to, count}`: evenly spaced, in the value or in its logarithm; both ends included.
void read_range(const Section& range, bool logarithmic, const Values& constants, Axis& axis) {
  range.allow({"from", "to", "count"});
  const double from = range.number("from", constants);
  const double to = range.number("to", constants);
  const std::int64_t count = range.count("count", 0, 1, max_values);
  if (count == 0) {
    range.fail(range.line(), "count", "is missing; how many values there are");
  }
  if (logarithmic && !(from > 0.0 && to > 0.0)) {
    range.fail(range.line(), "from", "a logarithmic range needs from > 0 and to > 0");
  }
  for (std::int64_t k = 0; k < count; ++k) {
    const double s = count == 1 ? 0.0 : static_cast<double>(k) / static_cast<double>(count - 1);
    double x = logarithmic ? from * std::pow(to / from, s) : from + (to - from) * s;
    x = k + 1 == count && count > 1 ? to : x;
    axis.values.push_back({fmt::format("{}", x), fmt::format("{}", x), x});
  }
}

void read_drawn(const Section& range, const Values& constants, Axis& axis) {
  range.allow({"from", "to"});
  axis.from = range.number("from", constants);
  axis.to = range.number("to", constants);
  if (!(axis.from < axis.to)) {
    range.fail(range.line(), "from", "must be less than 'to'");
  }
}

Axis read_axis(const Section& section, const Values& constants) {
  section.allow({"name", "unit", "label", "key", "list", "linear", "log", "random", "stratified"});
  Axis axis;
  axis.key = section.text("key");
  axis.name = section.text("name", axis.key.substr(axis.key.rfind('.') + 1));
  axis.unit = section.text("unit");
  axis.label = section.text("label", axis.name);
  axis.line = section.line();
  if (axis.name.empty()) {
    section.fail(axis.line, "name", "is missing; an axis needs a name or a key");
  }
  if (axis.key.starts_with("method.") && !is_method_option(axis.key.substr(7))) {
    section.fail(axis.line, "key",
                 fmt::format("unknown; allowed: a key of the scene, or method. "
                             "followed by {}",
                             method_option_names()));
  }
  std::vector<std::string> kinds;
  for (const char* kind : {"list", "linear", "log", "random", "stratified"}) {
    if (section.find(kind) != nullptr) {
      kinds.emplace_back(kind);
    }
  }
  if (kinds.size() != 1) {
    section.fail(axis.line, "list",
                 fmt::format("an axis has exactly one of list, linear, log, random, stratified; "
                             "this one has {}",
                             kinds.size()));
  }
  const std::string& kind = kinds.front();
  const toml::node& node = *section.find(kind);
  axis.logarithmic = kind == "log";
  if (kind == "list") {
    if (!node.is_array() || node.as_array()->empty()) {
      section.fail(line_of(node), kind, "must be a list of at least one value");
    }
    for (const toml::node& item : *node.as_array()) {
      axis.values.push_back(axis_value(section, item, constants));
    }
    return axis;
  }
  if (!node.is_table()) {
    section.fail(line_of(node), kind,
                 kind == "linear" || kind == "log" ? "must be {from = .., to = .., count = ..}"
                                                   : "must be {from = .., to = ..}");
  }
  const Section range = section.child(kind, *node.as_table());
  if (kind == "linear" || kind == "log") {
    read_range(range, axis.logarithmic, constants, axis);
  } else {
    axis.kind = kind == "random" ? Axis::Kind::random : Axis::Kind::stratified;
    read_drawn(range, constants, axis);
  }
  return axis;
}

Derived read_derived(const Section& section, const std::string& name, const toml::node& node) {
  if (node.is_string()) {
    return {name, "", std::string(Section::expression_text(node.as_string()->get())),
            line_of(node)};
  }
  section.fail(line_of(node), name, "must be an expression in quotes");
}

void check_names(const Section& section, const SweepSpec& sweep) {
  std::set<std::string> names;
  const auto add = [&](const std::string& name, int line, const std::string& what) {
    if (!names.insert(name).second) {
      section.fail(line, what, fmt::format("'{}' is used twice", name));
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
      section.fail(sweep.line, "metrics",
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
      section.fail(sweep.line, "method", fmt::format("the name '{}' is used twice", method.name));
    }
  }
  if (!sweep.reference.empty() && methods.count(sweep.reference) == 0) {
    section.fail(sweep.line, "reference",
                 fmt::format("there is no method '{}'; there are: {}", sweep.reference,
                             fmt::join(methods, ", ")));
  }
}

const Keys& sweep_keys() {
  static const Keys keys = {"scene",   "subject", "seed",      "repeats",   "metrics", "series",
                            "samples", "axis",    "method",    "set",       "derive",  "caption",
                            "x",       "y",       "constants", "reference", "options"};
  return keys;
}

/// What the file says for all sweeps, or one `[[sweep]]` says for itself on top of that.
SweepSpec read_sweep(const Section& section, SweepSpec sweep) {
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
  sweep.samples = section.count("samples", sweep.samples, 2, 1000000);
  if (section.find("metrics") != nullptr) {
    sweep.metrics = section.texts("metrics");
  }
  for (const Section& constants : section.tables("constants")) {
    for (const auto& [name, node] : constants.entries()) {
      sweep.constants[name] = constants.number_of(*node, name, sweep.constants);
    }
  }
  for (const Section& set : section.tables("set")) {
    read_settings(set, sweep.set);
  }
  for (const Section& options : section.tables("options")) {
    for (const auto& [key, node] : options.entries()) {
      if (!is_method_option(key)) {
        options.fail(line_of(*node), key,
                     fmt::format("unknown key; allowed: {}", method_option_names()));
      }
    }
    read_settings(options, sweep.options);
  }
  if (const auto axes = section.tables("axis"); !axes.empty()) {
    sweep.axes.clear();
    for (const Section& axis : axes) {
      sweep.axes.push_back(read_axis(axis, sweep.constants));
    }
  }
  if (const auto methods = section.tables("method"); !methods.empty()) {
    sweep.methods.clear();
    for (const Section& method : methods) {
      sweep.methods.push_back(read_method(method));
      if (sweep.methods.back().name.empty()) {
        sweep.methods.back().name = default_name(sweep.methods.back());
      }
    }
  }
  for (const Section& derive : section.tables("derive")) {
    for (const auto& [name, node] : derive.entries()) {
      std::erase_if(sweep.derived, [&name = name](const Derived& d) { return d.name == name; });
      sweep.derived.push_back(read_derived(derive, name, *node));
    }
  }
  return sweep;
}

void check_sweep(const Section& section, SweepSpec& sweep) {
  if (sweep.scene.empty()) {
    section.fail(sweep.line, "scene", "is missing; the name of a scene or the path of its file");
  }
  if (sweep.metrics.empty()) {
    section.fail(sweep.line, "metrics", fmt::format("is missing; allowed: {}", metric_names()));
  }
  if (sweep.methods.empty()) {
    sweep.methods.push_back({"default", {}, {}});
  }
  if (sweep.samples == 0) {
    sweep.samples = 400;
  }
  check_names(section, sweep);
}

ExperimentSpec read_root(const toml::table& root, const std::string& path, Size size) {
  const Section section(root, "", path, size);
  Keys keys = sweep_keys();
  keys.insert(keys.end(),
              {"name", "title", "asks", "how", "finding", "figure", "sweep", "program", "scenes"});
  section.allow(keys);
  ExperimentSpec experiment;
  experiment.path = path;
  experiment.name = section.text("name", std::filesystem::path(path).stem().string());
  experiment.title = section.text("title", experiment.name);
  experiment.asks = section.text("asks");
  experiment.how = section.text("how");
  experiment.finding = section.text("finding");
  experiment.figure = section.text("figure");
  experiment.program = section.text("program");
  if (section.find("scenes") != nullptr) {
    experiment.scenes = section.texts("scenes");
  }
  if (!experiment.program.empty()) {
    if (find_program(experiment.program) == nullptr) {
      section.fail(1, "program", fmt::format("'{}' is unknown", experiment.program));
    }
    return experiment;
  }
  SweepSpec shared;
  shared.file = path;
  shared.name = experiment.name;
  shared = read_sweep(section, shared);
  const auto sweeps = section.tables("sweep");
  for (const Section& own : sweeps) {
    Keys own_keys = sweep_keys();
    own_keys.push_back("name");
    own.allow(own_keys);
    SweepSpec sweep = read_sweep(own, shared);
    sweep.name = own.text("name", fmt::format("sweep{}", experiment.sweeps.size() + 1));
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

std::string_view to_string(Size size) { return size == Size::quick ? "quick" : "full"; }

ExperimentSpec parse_experiment(std::string_view text, const std::string& path, Size size) {
  try {
    return read_root(toml::parse(text, path), path, size);
  } catch (const toml::parse_error& error) {
    throw InputError(path, static_cast<int>(error.source().begin.line), "",
                     fmt::format("is not TOML: {}", error.description()));
  }
}

ExperimentSpec read_experiment(const std::string& path, Size size) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) {
    throw InputError(path, 0, "", "cannot be read; the path of a sweep spec (TOML) is needed");
  }
  std::ostringstream text;
  text << in.rdbuf();
  return parse_experiment(text.str(), path, size);
}

}  // namespace kairos::experiments
