#include "core/reading/document.hpp"

#include "core/error.hpp"
#include "core/reading/toml_nesting.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

using FileName = std::shared_ptr<const std::string>;

Value convert(const toml::node& node, const FileName& file);

Table convert(const toml::table& source, const FileName& file) {
  Table table;
  for (const auto& [key, node] : source) {
    table.keys.emplace_back(key.str());  // a table of toml++ has each key once, in order
    table.values.push_back(convert(node, file));
  }
  return table;
}

Array convert(const toml::array& source, const FileName& file) {
  Array array;
  for (const toml::node& node : source) {
    array.push_back(convert(node, file));
  }
  return array;
}

Value convert(const toml::node& node, const FileName& file) {
  Value value;
  value.file = file;
  value.line = static_cast<int>(node.source().begin.line);
  if (const auto* table = node.as_table()) {
    value.data = convert(*table, file);
  } else if (const auto* array = node.as_array()) {
    value.data = convert(*array, file);
  } else if (const auto* text = node.as_string()) {
    value.data = text->get();
  } else if (const auto* whole = node.as_integer()) {
    value.data = whole->get();
  } else if (const auto* real = node.as_floating_point()) {
    value.data = real->get();
  } else if (const auto* flag = node.as_boolean()) {
    value.data = flag->get();
  } else {
    value.data = DateOrTime{};
  }
  return value;
}

// From our documents to those of toml++.
toml::table to_foreign(const Table& table);

toml::array to_foreign(const Array& array) {
  toml::array foreign;
  for (const Value& element : array) {
    if (const Table* table = element.table()) {
      foreign.push_back(to_foreign(*table));
    } else if (const Array* inner = element.array()) {
      foreign.push_back(to_foreign(*inner));
    } else if (const auto* text = std::get_if<std::string>(&element.data)) {
      foreign.push_back(*text);
    } else if (const auto* whole = std::get_if<std::int64_t>(&element.data)) {
      foreign.push_back(*whole);
    } else if (const auto* real = std::get_if<double>(&element.data)) {
      foreign.push_back(*real);
    } else if (const auto* flag = std::get_if<bool>(&element.data)) {
      foreign.push_back(*flag);
    }
  }
  return foreign;
}

toml::table to_foreign(const Table& table) {
  toml::table foreign;
  for (std::size_t i = 0; i < table.keys.size(); ++i) {
    toml::array one = to_foreign(Array{table.values[i]});
    if (!one.empty()) {
      foreign.insert_or_assign(table.keys[i], std::move(*one.get(0)));
    }
  }
  return foreign;
}

}  // namespace

const Value* Table::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == key) {
      return &values[i];
    }
  }
  return nullptr;
}

Value* Table::find(std::string_view key) {
  return const_cast<Value*>(static_cast<const Table*>(this)->find(key));
}

void Table::set(const std::string& key, Value value) {
  if (Value* present = find(key)) {
    *present = std::move(value);
    return;
  }
  keys.push_back(key);
  values.push_back(std::move(value));
}

std::string_view Value::type_name() const {
  constexpr std::string_view names[] = {"a truth value", "a whole number", "a number",
                                        "a string",      "an array",       "a table",
                                        "a date or time"};
  return names[data.index()];
}

Value parse_document(std::string_view text, const std::string& file) {
  refuse_deep_nesting(text, file);
  try {
    const toml::table root = toml::parse(text, file);
    return convert(static_cast<const toml::node&>(root), std::make_shared<const std::string>(file));
  } catch (const toml::parse_error& error) {
    throw InputError(file, static_cast<int>(error.source().begin.line), "",
                     "not TOML: " + std::string(error.description()));
  }
}

Value parse_value(std::string_view text, const std::string& origin) {
  const auto file = std::make_shared<const std::string>(origin);
  Value value{std::string(text), file, 0};
  if (text.find_first_of("\n\r") != std::string_view::npos) {
    return value;
  }
  refuse_deep_nesting(text, origin);
  try {
    const toml::table root = toml::parse("value = " + std::string(text), origin);
    value = convert(*root.get("value"), file);
  } catch (const toml::parse_error&) {
    // A bare string.
  }
  value.line = 0;
  return value;
}

std::string to_toml(const Table& root) {
  std::ostringstream text;
  text << to_foreign(root) << '\n';
  return std::move(text).str();
}

std::string read_text_file(const std::string& path, std::size_t longest) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(path, 0, "", "is a directory; a file is needed");
  }
  if (path.find('\0') != std::string::npos) {
    throw InputError(path, 0, "", "is no path: it holds a zero byte");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(path, 0, "", "cannot be opened; a readable file is needed");
  }
  // The file is read by blocks. A copy from stream to stream takes a lack of memory for its end.
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    if (text.size() + count > longest) {
      throw InputError(path, 0, "", fmt::format("is longer than {} bytes, or has no end", longest));
    }
    text.append(block.data(), count);
  }
  if (file.bad()) {
    throw InputError(path, 0, "", "cannot be read to its end");
  }
  return text;
}

}  // namespace core
}  // namespace kairos
