#include "experiments/output/table.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace kairos::experiments {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) {
    return text;
  }
  std::string out = "\"";
  for (const char c : text) {
    out += c;
    if (c == '"') {
      out += c;
    }
  }
  return out + '"';
}

/// Reads one record, quoted line breaks included; false at the end of the file.
bool read_record(std::istream& in, std::vector<Cell>& cells) {
  cells.clear();
  std::string cell;
  bool inside_quotes = false;
  bool any = false;
  for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
    any = true;
    if (inside_quotes) {
      if (c == '"' && in.peek() == '"') {
        cell += static_cast<char>(in.get());
      } else if (c == '"') {
        inside_quotes = false;
      } else {
        cell += static_cast<char>(c);
      }
    } else if (c == '"') {
      inside_quotes = true;
    } else if (c == ',') {
      cells.emplace_back(std::move(cell));
      cell.clear();
    } else if (c == '\n') {
      break;
    } else if (c != '\r') {
      cell += static_cast<char>(c);
    }
  }
  if (any) {
    cells.emplace_back(std::move(cell));
  }
  return any;
}

}  // namespace

Cell number_cell(double x) { return std::isfinite(x) ? Cell(x) : Cell(); }

std::string to_text(const Cell& cell) {
  struct Writer {
    std::string operator()(std::monostate) const { return {}; }
    std::string operator()(double x) const { return fmt::format("{}", x); }
    std::string operator()(std::int64_t n) const { return fmt::format("{}", n); }
    std::string operator()(const std::string& text) const { return text; }
  };
  return std::visit(Writer{}, cell);
}

std::string csv_line(const std::vector<Cell>& row) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    line += i == 0 ? "" : ",";
    line += quoted(to_text(row[i]));
  }
  return line + '\n';
}

std::string Table::csv() const {
  std::string out = csv_line({columns.begin(), columns.end()});
  for (const auto& row : rows) {
    out += csv_line(row);
  }
  return out;
}

std::size_t Table::column(const std::string& name) const {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i] == name) {
      return i;
    }
  }
  throw std::out_of_range(
      fmt::format("no column '{}'; there are: {}", name, fmt::join(columns, ", ")));
}

Table read_csv(const std::string& path) {
  std::error_code none;
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path, none)) {  // what has no end is no table
    throw InputError(path, 0, "", "cannot be read");
  }
  Table table;
  std::vector<Cell> cells;
  if (!read_record(in, cells)) {
    throw InputError(path, 1, "", "is empty; a table starts with the names of its columns");
  }
  for (const Cell& cell : cells) {
    table.columns.push_back(to_text(cell));
  }
  while (read_record(in, cells)) {
    if (cells.size() != table.columns.size()) {
      throw InputError(path, static_cast<int>(table.rows.size()) + 2, "",
                       fmt::format("has {} cells; the header names {} columns", cells.size(),
                                   table.columns.size()));
    }
    table.rows.push_back(cells);
  }
  return table;
}

}  // namespace kairos::experiments
