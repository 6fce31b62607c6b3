#pragma once

#include "core/pose.hpp"
#include "core/reading/document.hpp"
#include "core/reading/frame_reader.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// The numbers that a key takes.
struct Range {
  double lowest = 0.0;
  double highest = 0.0;
  bool above = false;          ///< `lowest` itself is not allowed
  std::string_view unit = "";  ///< for messages

  /// Whether x is allowed; not a number never is.
  [[nodiscard]] bool contains(double x) const {
    return (above ? x > lowest : x >= lowest) && x <= highest;
  }
  /// "a number from 0 to 1 (m)".
  [[nodiscard]] std::string text() const;
};

/// A value of a document and the path of its key: typed access whose every complaint is an
/// `InputError` with file, line, key, what is wrong and what is allowed.
class Item {
 public:
  /// `path`: its keys from the root, "body.ball.radius"; the value must outlive it.
  Item(const Value& value, std::string path) : value_(&value), path_(std::move(path)) {}

  /// What was written.
  [[nodiscard]] const Value& value() const { return *value_; }
  /// Its keys from the root.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Throws `InputError` with file, line, path and this reason.
  [[noreturn]] void fail(const std::string& reason) const;

  /// A finite number in the range.
  [[nodiscard]] double number(const Range& range) const;
  /// A whole number from `lowest` to `highest`.
  [[nodiscard]] std::int64_t whole_number(std::int64_t lowest, std::int64_t highest) const;
  /// true or false.
  [[nodiscard]] bool flag() const;
  /// A string.
  [[nodiscard]] const std::string& text() const;
  /// A path, relative to this folder or absolute, of a file that can be opened.
  [[nodiscard]] std::string readable_file(const std::string& folder) const;
  /// Index of the text among `names`.
  [[nodiscard]] std::size_t choice(std::span<const std::string_view> names) const;
  /// A list of `count` finite numbers in the range.
  [[nodiscard]] std::vector<double> numbers(std::size_t count, const Range& range) const;
  /// A list of three finite numbers in the range.
  [[nodiscard]] Vector3 vector(const Range& range) const;
  /// Seconds: a number, or a text such as "1/60" or "16ms" (see `parse_duration`).
  [[nodiscard]] double duration() const;
  /// A list.
  [[nodiscard]] const Array& array() const;

 private:
  const Value* value_;
  std::string path_;
};

/// A table of a document, of which every key must be known.
class TableReader {
 public:
  /// Throws if `item` is no table.
  explicit TableReader(Item item);

  /// The table itself.
  [[nodiscard]] const Item& item() const { return item_; }
  /// Refuses every key that is not in `known`, and suggests the nearest.
  void refuse_unknown(std::span<const std::string_view> known) const;
  /// Whether the key is there.
  [[nodiscard]] bool has(std::string_view key) const { return table_->find(key) != nullptr; }
  /// The value of a key, if it is there.
  [[nodiscard]] std::optional<Item> find(std::string_view key) const;
  /// The value of a key that must be there; `what` says what it is, for the message.
  [[nodiscard]] Item need(std::string_view key, std::string_view what) const;
  /// Complains about the table itself, or about one of its keys if it is there.
  [[noreturn]] void fail(std::string_view key, const std::string& reason) const;

 private:
  Item item_;
  const Table* table_;
};

}  // namespace core
}  // namespace kairos
