#include "core/reading/csv.hpp"

#include "core/error.hpp"
#include "core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

namespace kairos {
inline namespace core {
namespace {

/// Where in a row the wanted columns are.
std::vector<std::size_t> positions(const std::vector<std::string_view>& header,
                                   std::span<const std::string_view> columns,
                                   const std::string& path, int line) {
  std::vector<std::size_t> result;
  for (const std::string_view column : columns) {
    const auto found = std::find(header.begin(), header.end(), column);
    if (found == header.end()) {
      throw InputError(path, line, std::string(column),
                       "column is missing; the header needs: " + listed(columns));
    }
    if (std::find(found + 1, header.end(), column) != header.end()) {
      throw InputError(path, line, std::string(column), "column is there twice");
    }
    result.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return result;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  double x = 0.0;
#ifdef __cpp_lib_to_chars
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, x);
  const bool whole = error == std::errc() && stop == end;
#else  // libc++ reads whole numbers only; strtod also takes what `from_chars` does not
  const std::string copy(text);
  char* stop = nullptr;
  x = std::strtod(copy.c_str(), &stop);
  const bool whole = !copy.empty() && stop == copy.c_str() + copy.size() &&
                     copy.find_first_not_of("+-.0123456789eE") == std::string::npos &&
                     copy.front() != '+';
#endif
  if (!whole || !std::isfinite(x)) {
    return std::nullopt;
  }
  return x;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r";
  const std::size_t first = text.find_first_not_of(space);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(space) - first + 1);
}

std::string_view unquoted(std::string_view field) {
  const std::string_view text = trimmed(field);
  return text.size() >= 2 && text.front() == '"' && text.back() == '"'
             ? text.substr(1, text.size() - 2)
             : text;
}

bool split_fields(std::string_view row, std::vector<std::string_view>& fields) {
  fields.clear();
  bool quoted = false;
  std::size_t start = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] == '"') {
      quoted = !quoted;
    } else if (row[i] == ',' && !quoted) {
      fields.push_back(row.substr(start, i - start));
      start = i + 1;
    }
  }
  fields.push_back(row.substr(start));
  return !quoted;
}

CsvNumbers::CsvNumbers(const std::string& path, std::string_view text,
                       std::span<const std::string_view> columns, int first_line)
    : width_(columns.size()) {
  if (text.starts_with("\xEF\xBB\xBF")) {
    text.remove_prefix(3);  // byte order mark
  }
  std::size_t header_width = 0;
  std::vector<std::size_t> where;
  std::vector<std::string_view> fields;
  for (int line = first_line; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view row = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (row.empty() || row.front() == '#') {
      continue;
    }
    if (!split_fields(row, fields)) {
      throw InputError(path, line, "", "has a quote that does not end");
    }
    std::transform(fields.begin(), fields.end(), fields.begin(), unquoted);
    if (header_width == 0) {
      header_width = fields.size();
      where = positions(fields, columns, path, line);
      continue;
    }
    if (fields.size() != header_width) {
      throw InputError(path, line, "",
                       fmt::format("has {} fields; the header has {} (is the file truncated?)",
                                   fields.size(), header_width));
    }
    for (std::size_t c = 0; c < width_; ++c) {
      const std::optional<double> number = parse_number(fields[where[c]]);
      if (!number) {
        throw InputError(
            path, line, std::string(columns[c]),
            fmt::format("\"{}\" is no number; allowed: a finite number", fields[where[c]]));
      }
      fields_.push_back(*number);
    }
    lines_.push_back(line);
  }
  if (header_width == 0) {
    throw InputError(path, 0, "", "is empty; needed: a header with " + listed(columns));
  }
}

}  // namespace core
}  // namespace kairos
