#include "experiments/sweeps/axis_reader.hpp"

#include "simulation/option.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace kairos::experiments {
namespace {

constexpr std::int64_t max_values = 100000;  // of one axis

AxisValue numeric(double x) { return {fmt::format("{}", x), fmt::format("{}", x), x}; }

/// A number, an expression, or text; text that is an expression over the constants counts as one.
AxisValue axis_value(const Item& item, const Values& constants) {
  const auto* text = std::get_if<std::string>(&item.value().data);
  if (text == nullptr) {
    return std::holds_alternative<bool>(item.value().data)
               ? AxisValue{toml_literal(item), toml_literal(item), std::nullopt}
               : numeric(number_of(item, constants));
  }
  if (text->starts_with('=')) {
    return numeric(number_of(item, constants));
  }
  try {
    return numeric(evaluate(*text, constants));
  } catch (const std::invalid_argument&) {
    return {*text, toml_literal(item), std::nullopt};
  }
}

/// `{from, to, count}`: evenly spaced, in the value or in its logarithm; both ends included.
void read_range(const SpecSection& range, const Values& constants, Axis& axis) {
  range.allow({"from", "to", "count"});
  const double from = range.number("from", constants);
  const double to = range.number("to", constants);
  const std::int64_t count = range.count("count", 0, 1, max_values);
  if (count == 0) {
    range.fail("count", "is missing; needed: how many values there are");
  }
  if (axis.logarithmic && !(from > 0.0 && to > 0.0)) {
    range.fail("from", "a logarithmic range needs from > 0 and to > 0");
  }
  for (std::int64_t k = 0; k + 1 < count; ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(count - 1);
    axis.values.push_back(
        numeric(axis.logarithmic ? from * std::pow(to / from, s) : from + (to - from) * s));
  }
  axis.values.push_back(numeric(count > 1 ? to : from));
}

void read_drawn(const SpecSection& range, const Values& constants, Axis& axis) {
  range.allow({"from", "to"});
  axis.from = range.number("from", constants);
  axis.to = range.number("to", constants);
  if (!(axis.from < axis.to)) {
    range.fail("from", "must be less than 'to'");
  }
}

/// The one of list, linear, log, random, stratified that the axis has.
std::string kind_of(const SpecSection& section) {
  std::vector<std::string> kinds;
  for (const char* kind : {"list", "linear", "log", "random", "stratified"}) {
    if (section.find(kind)) {
      kinds.emplace_back(kind);
    }
  }
  if (kinds.size() != 1) {
    section.fail("", fmt::format("an axis has exactly one of list, linear, log, random, "
                                 "stratified; this one has {}",
                                 kinds.size()));
  }
  return kinds.front();
}

}  // namespace

Axis read_axis(const SpecSection& section, const Values& constants) {
  section.allow({"name", "unit", "label", "key", "list", "linear", "log", "random", "stratified"});
  Axis axis;
  axis.key = section.text("key");
  axis.name = section.text("name", axis.key.substr(axis.key.rfind('.') + 1));
  axis.unit = section.text("unit");
  axis.label = section.text("label", axis.name);
  axis.line = section.line();
  if (axis.name.empty()) {
    section.fail("name", "is missing; an axis needs a name or a key");
  }
  if (axis.key.starts_with("method.") && find_option(axis.key.substr(7)) == nullptr) {
    section.fail("key", fmt::format("unknown; allowed: a key of the scene, or method. "
                                    "followed by {}",
                                    option_names()));
  }
  const std::string kind = kind_of(section);
  axis.logarithmic = kind == "log";
  if (kind == "list") {
    const Item list = *section.find(kind);
    for (const Value& value : list.array()) {
      const std::string path = fmt::format("{}[{}]", list.path(), axis.values.size() + 1);
      axis.values.push_back(axis_value(Item(value, path), constants));
    }
    if (axis.values.empty()) {
      list.fail("must be a list of at least one value");
    }
  } else if (kind == "linear" || kind == "log") {
    read_range(section.table(kind, "{from = .., to = .., count = ..}"), constants, axis);
  } else {
    axis.kind = kind == "random" ? Axis::Kind::random : Axis::Kind::stratified;
    read_drawn(section.table(kind, "{from = .., to = ..}"), constants, axis);
  }
  return axis;
}

}  // namespace kairos::experiments
