#include "core/reading/overrides.hpp"

#include "core/error.hpp"
#include "core/nearest_name.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

constexpr std::string_view origin = "override";

/// One step of a path: a key of a table, or the index of an array.
struct Step {
  std::string key;
  std::optional<std::size_t> index;
};

[[noreturn]] void refuse(const Override& change, const std::string& reason) {
  throw InputError(std::string(origin), 0, change.key, reason);
}

Step index_step(std::string_view digits, const Override& change) {
  std::size_t index = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (digits.empty() || error != std::errc() || stop != digits.data() + digits.size()) {
    refuse(change, fmt::format("[{}] is no index; allowed: a whole number from 0", digits));
  }
  return {"", index};
}

/// `body.ball.half_extents[0]` as its steps.
std::vector<Step> steps_of(const Override& change) {
  std::vector<Step> steps;
  std::string_view rest = change.key;
  while (true) {
    const std::size_t end = rest.find_first_of(".[");
    const std::string_view key = rest.substr(0, end);
    if (key.empty()) {
      refuse(change, "is no path; allowed: keys joined by dots, such as body.ball.radius");
    }
    steps.push_back({std::string(key), std::nullopt});
    rest.remove_prefix(key.size());
    while (rest.starts_with('[')) {
      const std::size_t close = rest.find(']');
      if (close == std::string_view::npos) {
        refuse(change, "has a [ without a ]");
      }
      steps.push_back(index_step(rest.substr(1, close - 1), change));
      rest.remove_prefix(close + 1);
    }
    if (rest.empty()) {
      return steps;
    }
    if (!rest.starts_with('.')) {
      refuse(change, "is no path; a . is needed after ]");
    }
    rest.remove_prefix(1);
  }
}

/// Element of an array of tables with this `name`.
Value& named_element(Array& array, const std::string& name, const Override& change) {
  std::vector<std::string_view> names;
  for (Value& element : array) {
    const Table* table = element.table();
    const Value* value = table == nullptr ? nullptr : table->find("name");
    const auto* text = value == nullptr ? nullptr : std::get_if<std::string>(&value->data);
    if (text != nullptr && *text == name) {
      return element;
    }
    if (text != nullptr) {
      names.push_back(*text);
    }
  }
  refuse(change, fmt::format("the scene has no \"{}\"; {}", name, suggestion(name, names)));
}

Value& indexed_element(Value& value, std::size_t index, const Override& change) {
  auto* array = std::get_if<Array>(&value.data);
  if (array == nullptr || index >= array->size()) {
    refuse(change, fmt::format("the scene has no element [{}] here", index));
  }
  return (*array)[index];
}

/// The value that a step leads to; nullptr where a table has no such key.
Value* follow(Value& value, const Step& step, const Override& change) {
  if (step.index) {
    return &indexed_element(value, *step.index, change);
  }
  if (auto* array = std::get_if<Array>(&value.data)) {
    return &named_element(*array, step.key, change);
  }
  if (auto* table = std::get_if<Table>(&value.data)) {
    return table->find(step.key);
  }
  refuse(change, fmt::format("the scene has no \"{}\" here: {} holds no keys", step.key,
                             value.type_name()));
}

void apply(Value& root, const Override& change) {
  const std::vector<Step> steps = steps_of(change);
  Value* parent = &root;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    parent = follow(*parent, steps[i], change);
    if (parent == nullptr) {
      refuse(change, fmt::format("the scene has no \"{}\" to set a value in", steps[i].key));
    }
  }
  Value value = parse_value(change.value, std::string(origin));
  if (Value* present = follow(*parent, steps.back(), change)) {
    *present = std::move(value);
  } else {
    std::get<Table>(parent->data).set(steps.back().key, std::move(value));
  }
}

}  // namespace

void apply_overrides(Value& root, const std::vector<Override>& overrides) {
  for (const Override& change : overrides) {
    apply(root, change);
  }
}

}  // namespace core
}  // namespace kairos
