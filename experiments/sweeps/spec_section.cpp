#include "experiments/sweeps/spec_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kairos::experiments {

namespace {

/// As a TOML string of one line: it is put into a scene again.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) {
      out += fmt::format("\\u{:04x}", code);
      continue;
    }
    if (c == '"' || c == '\\') {
      out += '\\';
    }
    out += c;
  }
  return out + '"';
}

}  // namespace

std::string_view to_string(Size size) { return size == Size::quick ? "quick" : "full"; }

std::optional<Item> SpecSection::find(std::string_view key) const {
  const auto item = table_.find(key);
  const Table* sizes = item ? item->value().table() : nullptr;
  if (sizes != nullptr && sizes->keys.size() == 2 && sizes->find("quick") != nullptr &&
      sizes->find("full") != nullptr) {
    return Item(*sizes->find(to_string(size_)), item->path());
  }
  return item;
}

std::string SpecSection::text(std::string_view key, std::string fallback) const {
  const auto item = find(key);
  return item ? item->text() : fallback;
}

bool SpecSection::flag(std::string_view key, bool fallback) const {
  const auto item = find(key);
  return item ? item->flag() : fallback;
}

std::int64_t SpecSection::count(std::string_view key, std::int64_t fallback, std::int64_t least,
                                std::int64_t most) const {
  const auto item = find(key);
  return item ? item->whole_number(least, most) : fallback;
}

double SpecSection::number(std::string_view key, const Values& values) const {
  if (const auto item = find(key)) {
    return number_of(*item, values);
  }
  fail(key, "is missing; needed: a number, or an expression in quotes");
}

std::vector<std::string> SpecSection::texts(std::string_view key) const {
  std::vector<std::string> texts;
  if (const auto item = find(key)) {
    for (const Value& value : item->array()) {
      texts.push_back(Item(value, fmt::format("{}[{}]", item->path(), texts.size() + 1)).text());
    }
  }
  return texts;
}

std::vector<double> SpecSection::positive_numbers(std::string_view key) const {
  std::vector<double> numbers;
  if (const auto found = find(key)) {
    for (const Value& value : found->array()) {
      const Item item(value, fmt::format("{}[{}]", found->path(), numbers.size() + 1));
      numbers.push_back(number_of(item, {}));
      if (!(numbers.back() > 0.0)) {
        item.fail(fmt::format("{} is not allowed; allowed: > 0", numbers.back()));
      }
    }
  }
  return numbers;
}

std::vector<SpecSection> SpecSection::tables(std::string_view key) const {
  std::vector<SpecSection> tables;
  const auto item = table_.find(key);
  if (!item) {
    return tables;
  }
  if (item->value().table() != nullptr) {
    return {SpecSection(TableReader(*item), size_)};
  }
  if (item->array().empty()) {
    item->fail("is an empty array; allowed: a table, or an array of tables");
  }
  for (const Value& value : item->array()) {
    const std::string path = fmt::format("{}[{}]", item->path(), tables.size() + 1);
    tables.emplace_back(TableReader(Item(value, path)), size_);
  }
  return tables;
}

SpecSection SpecSection::table(std::string_view key, std::string_view form) const {
  const auto item = find(key);
  if (!item || item->value().table() == nullptr) {
    fail(key, fmt::format("must be {}", form));
  }
  return {TableReader(*item), size_};
}

std::vector<std::pair<std::string, Item>> SpecSection::entries() const {
  std::vector<std::pair<std::string, Item>> entries;
  for (const std::string& key : table_.item().value().table()->keys) {
    entries.emplace_back(key, *find(key));
  }
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.second.value().line < b.second.value().line;
  });
  return entries;
}

double number_of(const Item& item, const Values& values) {
  const auto& data = item.value().data;
  double x = 0.0;
  if (const auto* text = std::get_if<std::string>(&data)) {
    try {
      x = evaluate(expression_text(*text), values);
    } catch (const std::invalid_argument& error) {
      item.fail(error.what());
    }
  } else if (const auto* whole = std::get_if<std::int64_t>(&data)) {
    x = static_cast<double>(*whole);
  } else if (const auto* real = std::get_if<double>(&data)) {
    x = *real;
  } else {
    item.fail(fmt::format("is {}; allowed: a number, or an expression in quotes",
                          item.value().type_name()));
  }
  if (!std::isfinite(x)) {
    item.fail(fmt::format("is {}; allowed: a finite number", x));
  }
  return x;
}

std::string_view expression_text(std::string_view text) {
  return text.starts_with('=') ? text.substr(1) : text;
}

std::string toml_literal(const Item& item) {
  const auto& data = item.value().data;
  if (const auto* flag = std::get_if<bool>(&data)) {
    return *flag ? "true" : "false";
  }
  if (const auto* text = std::get_if<std::string>(&data)) {
    return in_quotes(*text);
  }
  if (std::holds_alternative<double>(data) || std::holds_alternative<std::int64_t>(data)) {
    return fmt::format("{}", number_of(item, {}));
  }
  item.fail(fmt::format("is {}; allowed: a number, text, true, false", item.value().type_name()));
}

}  // namespace kairos::experiments
