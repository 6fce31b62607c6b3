#pragma once

#include "core/reading/table_reader.hpp"
#include "experiments/sweeps/expression.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// How much work: `quick` for a first look (minutes for all experiments), `full` for the paper.
enum class Size { quick, full };
[[nodiscard]] std::string_view to_string(Size size);

/// One table of a sweep spec, read at one size: `{quick = .., full = ..}` may stand for any value.
/// Every complaint is an `InputError` with file, line and key.
class SpecSection {
 public:
  SpecSection(TableReader table, Size size) : table_(std::move(table)), size_(size) {}

  [[nodiscard]] int line() const { return table_.item().value().line; }
  [[nodiscard]] std::optional<Item> find(std::string_view key) const;
  void allow(const std::vector<std::string_view>& keys) const { table_.refuse_unknown(keys); }
  [[noreturn]] void fail(std::string_view key, const std::string& reason) const {
    table_.fail(key, reason);
  }

  [[nodiscard]] std::string text(std::string_view key, std::string fallback = {}) const;
  [[nodiscard]] bool flag(std::string_view key, bool fallback) const;
  [[nodiscard]] std::int64_t count(std::string_view key, std::int64_t fallback, std::int64_t least,
                                   std::int64_t most) const;
  /// A finite number, or an expression over `values`; the key must be there.
  [[nodiscard]] double number(std::string_view key, const Values& values) const;
  [[nodiscard]] std::vector<std::string> texts(std::string_view key) const;
  [[nodiscard]] std::vector<double> positive_numbers(std::string_view key) const;
  /// The tables of `[[key]]`, or the one table of `[key]`.
  [[nodiscard]] std::vector<SpecSection> tables(std::string_view key) const;
  /// The table at `key`, which must be there and be one; `form` says what is allowed.
  [[nodiscard]] SpecSection table(std::string_view key, std::string_view form) const;
  /// Keys and values in the order in which they are written.
  [[nodiscard]] std::vector<std::pair<std::string, Item>> entries() const;

 private:
  TableReader table_;
  Size size_;
};

/// A finite number, or an expression over `values`.
[[nodiscard]] double number_of(const Item& item, const Values& values);
/// The expression without the '=' that may mark it.
[[nodiscard]] std::string_view expression_text(std::string_view text);
/// A truth value, number or text as it is written in TOML; complains about anything else.
[[nodiscard]] std::string toml_literal(const Item& item);

}  // namespace kairos::experiments
