#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kairos {
inline namespace core {

/// A TOML document as a plain tree, every value with the place where it was written, so that a
/// message can name it. Made by `parse_document`; read through `TableReader`.
struct Value;

/// Values in order; not all need be of one type.
using Array = std::vector<Value>;

/// Keys and values in alphabetical order of the keys.
struct Table {
  std::vector<std::string> keys;
  std::vector<Value> values;

  /// nullptr if there is no such key.
  [[nodiscard]] const Value* find(std::string_view key) const;
  /// nullptr if there is no such key.
  [[nodiscard]] Value* find(std::string_view key);
  /// Adds or replaces.
  void set(const std::string& key, Value value);
};

/// A date or a time: TOML knows them, no document of ours takes one.
struct DateOrTime {};

/// A value and where it was written.
struct Value {
  std::variant<bool, std::int64_t, double, std::string, Array, Table, DateOrTime> data;
  std::shared_ptr<const std::string> file;  ///< never null in a parsed document
  int line = 0;                             ///< 0: not from a line of a file

  /// nullptr if it is no table.
  [[nodiscard]] const Table* table() const { return std::get_if<Table>(&data); }
  /// nullptr if it is no array.
  [[nodiscard]] const Array* array() const { return std::get_if<Array>(&data); }
  /// "a string", "a whole number", ...: for messages.
  [[nodiscard]] std::string_view type_name() const;
};

/// A TOML text as a tree whose root is a table. `file` is used in messages. Throws `InputError`.
[[nodiscard]] Value parse_document(std::string_view text, const std::string& file);
/// One TOML value (`1.5`, `[1, 2]`, `"text"`); what is no TOML value is taken as a bare string, so
/// that a person can write `frame=1/60` in a shell. `origin` is used in messages.
[[nodiscard]] Value parse_value(std::string_view text, const std::string& origin);
/// A table as TOML: plain keys first, then tables, then lists of tables. `parse_document` reads the
/// same values back, to the last bit.
[[nodiscard]] std::string to_toml(const Table& root);
/// The whole content of a file. Throws `InputError` if it cannot be read, or is longer than
/// `longest` bytes: a device without an end is not read for ever.
[[nodiscard]] std::string read_text_file(const std::string& path,
                                         std::size_t longest = std::size_t{1} << 28);

}  // namespace core
}  // namespace kairos
