#include "experiments/thesis/figure_data.hpp"

#include "experiments/output/output_folder.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace kairos::experiments {

Table& FigureData::table(const std::string& name, const std::vector<FigureColumn>& columns) {
  tables_.push_back({name, {}});
  Table& table = tables_.back().table;
  for (const FigureColumn& column : columns) {
    table.columns.push_back(column.name);
    columns_.rows.push_back({name, column.name, std::string("data"), column.unit, column.meaning,
                             std::string("linear")});
  }
  return table;
}

void FigureData::add_value(std::string_view name, Cell value, std::string_view unit,
                           std::string quoted, std::string_view meaning) {
  if (!unit.empty()) {
    quoted += fmt::format(" {}", unit);
  }
  values_.rows.push_back({std::string(name), std::move(value), std::string(unit), std::move(quoted),
                          std::string(meaning)});
}

void FigureData::value(std::string_view name, double x, std::string_view unit,
                       std::string_view meaning, int digits) {
  add_value(name, number_cell(x), unit, fmt::format("{:.{}g}", x, digits), meaning);
}

void FigureData::count(std::string_view name, std::int64_t n, std::string_view meaning) {
  add_value(name, n, "", fmt::format("{}", n), meaning);
}

void FigureData::text(std::string_view name, std::string_view value, std::string_view meaning) {
  add_value(name, std::string(value), "", std::string(value), meaning);
}

const std::vector<Cell>& FigureData::row(std::string_view name) const {
  for (const auto& cells : values_.rows) {
    if (std::get<std::string>(cells[0]) == name) {
      return cells;
    }
  }
  throw std::out_of_range(fmt::format("no value '{}' to quote", name));
}

double FigureData::number(std::string_view name) const {
  const auto* x = std::get_if<double>(&row(name)[1]);
  if (x == nullptr) {
    throw std::out_of_range(fmt::format("the value '{}' is no number", name));
  }
  return *x;
}

std::string FigureData::filled(std::string_view text) const {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find('{', at);
    const std::size_t close = text.find('}', open);
    if (close == std::string_view::npos) {
      return out.append(text.substr(at));
    }
    out.append(text.substr(at, open - at));
    out += to_text(row(text.substr(open + 1, close - open - 1))[3]);
    at = close + 1;
  }
  return out;
}

void FigureData::write(OutputFolder& out) const {
  for (const Named& named : tables_) {
    out.file(named.name + ".csv").write(named.table.csv());
  }
  out.file("values.csv").write(values_.csv());
  out.file("columns.csv").write(columns_.csv());
}

}  // namespace kairos::experiments
