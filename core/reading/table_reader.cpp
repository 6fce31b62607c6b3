#include "core/reading/table_reader.hpp"

#include "core/error.hpp"
#include "core/nearest_name.hpp"
#include "core/reading/frame_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace kairos {
inline namespace core {

std::string Range::text() const {
  const std::string least =
      above ? fmt::format("a number > {:g}", lowest) : fmt::format("a number from {:g}", lowest);
  const std::string most =
      above ? fmt::format(" and <= {:g}", highest) : fmt::format(" to {:g}", highest);
  return least + most + (unit.empty() ? "" : fmt::format(" ({})", unit));
}

void Item::fail(const std::string& reason) const {
  throw InputError(*value_->file, value_->line, path_, reason);
}

double Item::number(const Range& range) const {
  double x = 0.0;
  if (const auto* real = std::get_if<double>(&value_->data)) {
    x = *real;
  } else if (const auto* whole = std::get_if<std::int64_t>(&value_->data)) {
    x = static_cast<double>(*whole);
  } else {
    fail(fmt::format("is {}; allowed: {}", value_->type_name(), range.text()));
  }
  if (!std::isfinite(x) || !range.contains(x)) {
    fail(fmt::format("is {}; allowed: {}", x, range.text()));
  }
  return x;
}

std::int64_t Item::whole_number(std::int64_t lowest, std::int64_t highest) const {
  const std::string allowed = fmt::format("a whole number from {} to {}", lowest, highest);
  const auto* whole = std::get_if<std::int64_t>(&value_->data);
  if (whole == nullptr) {
    fail(fmt::format("is {}; allowed: {}", value_->type_name(), allowed));
  }
  if (*whole < lowest || *whole > highest) {
    fail(fmt::format("is {}; allowed: {}", *whole, allowed));
  }
  return *whole;
}

bool Item::flag() const {
  if (const auto* flag = std::get_if<bool>(&value_->data)) {
    return *flag;
  }
  fail(fmt::format("is {}; allowed: true, false", value_->type_name()));
}

const std::string& Item::text() const {
  if (const auto* text = std::get_if<std::string>(&value_->data)) {
    return *text;
  }
  fail(fmt::format("is {}; allowed: a string in quotes", value_->type_name()));
}

std::string Item::readable_file(const std::string& folder) const {
  const std::string path = (std::filesystem::path(folder) / text()).string();
  std::error_code ignored;
  if (path.find('\0') != std::string::npos || std::filesystem::is_directory(path, ignored) ||
      !std::ifstream(path)) {
    fail(fmt::format("names no file that can be opened, '{}'; allowed: the path of a readable file",
                     path.c_str()));  // up to a zero byte
  }
  return path;
}

std::size_t Item::choice(std::span<const std::string_view> names) const {
  if (!std::holds_alternative<std::string>(value_->data)) {
    fail(fmt::format("is {}; allowed: {}", value_->type_name(), listed(names)));
  }
  const auto found = std::find(names.begin(), names.end(), text());
  if (found == names.end()) {
    fail(fmt::format("\"{}\" does not exist; {}", text(), suggestion(text(), names)));
  }
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<double> Item::numbers(std::size_t count, const Range& range) const {
  const Array* array = value_->array();
  if (array == nullptr || array->size() != count) {
    const std::string is = array == nullptr ? std::string(value_->type_name())
                                            : fmt::format("an array of {}", array->size());
    fail(fmt::format("is {}; allowed: an array of {} numbers", is, count));
  }
  std::vector<double> result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(Item((*array)[i], fmt::format("{}[{}]", path_, i)).number(range));
  }
  return result;
}

Vector3 Item::vector(const Range& range) const {
  const std::vector<double> x = numbers(3, range);
  return {x[0], x[1], x[2]};
}

double Item::duration() const {
  if (std::holds_alternative<std::string>(value_->data)) {
    return parse_duration(text(), {*value_->file, value_->line, path_});
  }
  return number({.lowest = 0.0, .highest = longest_duration, .above = true, .unit = "s"});
}

const Array& Item::array() const {
  if (const Array* array = value_->array()) {
    return *array;
  }
  fail(fmt::format("is {}; allowed: an array", value_->type_name()));
}

TableReader::TableReader(Item item) : item_(std::move(item)), table_(item_.value().table()) {
  if (table_ == nullptr) {
    item_.fail(fmt::format("is {}; allowed: a table", item_.value().type_name()));
  }
}

void TableReader::refuse_unknown(std::span<const std::string_view> known) const {
  for (std::size_t i = 0; i < table_->keys.size(); ++i) {
    const std::string& key = table_->keys[i];
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      fail(key, "unknown key; " + suggestion(key, known));
    }
  }
}

std::optional<Item> TableReader::find(std::string_view key) const {
  const Value* value = table_->find(key);
  if (value == nullptr) {
    return std::nullopt;
  }
  const std::string& path = item_.path();
  return Item(*value, path.empty() ? std::string(key) : fmt::format("{}.{}", path, key));
}

Item TableReader::need(std::string_view key, std::string_view what) const {
  if (const auto item = find(key)) {
    return *item;
  }
  fail(key, fmt::format("is missing; needed: {}", what));
}

void TableReader::fail(std::string_view key, const std::string& reason) const {
  if (const auto item = find(key)) {
    item->fail(reason);
  }
  const std::string& path = item_.path();
  const Value& value = item_.value();
  const std::string full = path.empty() || key.empty() ? fmt::format("{}{}", path, key)
                                                       : fmt::format("{}.{}", path, key);
  throw InputError(*value.file, value.line, full, reason);
}

}  // namespace core
}  // namespace kairos
