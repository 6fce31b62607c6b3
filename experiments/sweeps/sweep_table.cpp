#include "experiments/sweeps/sweep_table.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace kairos::experiments {
namespace {

Cell axis_cell(const AxisValue& value) {
  return value.number ? number_cell(*value.number) : Cell(value.text);
}

bool is_drawn(const Axis& axis) { return axis.kind != Axis::Kind::listed; }

/// What all tables start with: the method and the axes; without those that are drawn per repeat in
/// tables over points.
void add_point_columns(const SweepSpec& spec, bool drawn_too, Table& table) {
  table.columns.emplace_back("method");
  for (const Axis& axis : spec.axes) {
    if (drawn_too || !is_drawn(axis)) {
      table.columns.push_back(axis.name);
    }
  }
}

std::vector<Cell> point_cells(const SweepSpec& spec, const RunPlace& run, bool drawn_too) {
  std::vector<Cell> cells{spec.methods[run.method].name};
  for (std::size_t i = 0; i < spec.axes.size(); ++i) {
    if (drawn_too || !is_drawn(spec.axes[i])) {
      cells.push_back(axis_cell(run.axis_values[i]));
    }
  }
  return cells;
}

std::optional<double> metric_of(const RunRecord& record, std::size_t i) {
  return i < record.metrics.size() ? record.metrics[i] : std::nullopt;
}

/// Predictions of a run; empty where they use a metric that the run does not have.
std::optional<double> derived_of(const SweepSpec& spec, const Derived& derived,
                                 const PlannedRun& run, const RunRecord& record) {
  Values values = run.values;
  for (std::size_t i = 0; i < spec.metrics.size(); ++i) {
    if (const auto metric = metric_of(record, i)) {
      values[spec.metrics[i]] = *metric;
    } else if (uses_name(derived.expression, spec.metrics[i])) {
      return std::nullopt;
    }
  }
  try {
    const double x = evaluate(derived.expression, values);
    return std::isfinite(x) ? std::optional(x) : std::nullopt;
  } catch (const std::invalid_argument& error) {
    throw InputError(spec.file, derived.line, "derive." + derived.name, error.what());
  }
}

/// Differences to the reference method at the same point and repeat.
class Reference {
 public:
  Reference(const SweepSpec& spec, const SweepPlan& plan, const std::vector<RunRecord>& records)
      : records_(records), per_method_(plan.size() / spec.methods.size()) {
    for (std::size_t m = 0; m < spec.methods.size(); ++m) {
      first_ = spec.methods[m].name == spec.reference ? m * per_method_ : first_;
    }
  }
  [[nodiscard]] std::optional<double> error(std::size_t run, std::size_t metric) const {
    const auto ours = metric_of(records_[run], metric);
    const auto theirs = metric_of(records_[first_ + run % per_method_], metric);
    return ours && theirs ? std::optional(std::abs(*ours - *theirs)) : std::nullopt;
  }

 private:
  const std::vector<RunRecord>& records_;
  std::size_t per_method_;
  std::size_t first_ = 0;
};

Cell optional_cell(const std::optional<double>& x) { return x ? number_cell(*x) : Cell(); }

/// The numbers of each run: metrics, differences to the reference, predictions.
struct Numbers {
  std::vector<std::string> names;
  std::vector<std::vector<std::optional<double>>> runs;
};

Numbers numbers_of(const SweepSpec& spec, const SweepPlan& plan,
                   const std::vector<RunRecord>& records) {
  Numbers out;
  out.names = spec.metrics;
  for (const std::string& metric : spec.metrics) {
    if (!spec.reference.empty()) {
      out.names.push_back(metric + "_error");
    }
  }
  for (const Derived& derived : spec.derived) {
    out.names.push_back(derived.name);
  }
  const Reference reference(spec, plan, records);
  for (std::size_t r = 0; r < plan.size(); ++r) {
    std::vector<std::optional<double>> row;
    for (std::size_t i = 0; i < spec.metrics.size(); ++i) {
      row.push_back(metric_of(records[r], i));
    }
    for (std::size_t i = 0; !spec.reference.empty() && i < spec.metrics.size(); ++i) {
      row.push_back(reference.error(r, i));
    }
    for (const Derived& derived : spec.derived) {
      row.push_back(derived_of(spec, derived, plan[r], records[r]));
    }
    out.runs.push_back(std::move(row));
  }
  return out;
}

Table runs_table(const SweepSpec& spec, const SweepPlan& plan,
                 const std::vector<RunRecord>& records, const Numbers& numbers) {
  Table table;
  table.columns.emplace_back("run");
  add_point_columns(spec, true, table);
  table.columns.insert(table.columns.end(), {"repeat", "status", "reason"});
  table.columns.insert(table.columns.end(), numbers.names.begin(), numbers.names.end());
  for (std::size_t r = 0; r < plan.size(); ++r) {
    const RunPlace place = plan.place(r);
    std::vector<Cell> row{static_cast<std::int64_t>(r)};
    const auto point = point_cells(spec, place, true);
    row.insert(row.end(), point.begin(), point.end());
    row.insert(row.end(), {place.repeat, records[r].status, records[r].reason});
    for (const auto& x : numbers.runs[r]) {
      row.push_back(optional_cell(x));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Mean and quartiles of the runs [first, first + count) of one point.
void append_distribution(const Numbers& numbers, std::size_t column, std::size_t first,
                         std::size_t count, std::vector<Cell>& row) {
  std::vector<double> values;
  CompensatedSum sum;
  for (std::size_t r = first; r < first + count; ++r) {
    if (const auto& x = numbers.runs[r][column]) {
      values.push_back(*x);
      sum.add(*x);
    }
  }
  if (values.empty()) {
    row.resize(row.size() + 6);
    return;
  }
  std::sort(values.begin(), values.end());
  row.push_back(number_cell(sum.value() / static_cast<double>(values.size())));
  for (const double p : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    row.push_back(number_cell(quantile(values, p)));
  }
}

Table summary_table(const SweepSpec& spec, const SweepPlan& plan,
                    const std::vector<RunRecord>& records, const Numbers& numbers) {
  Table table;
  add_point_columns(spec, false, table);
  table.columns.insert(table.columns.end(), {"runs", "completed"});
  for (const std::string& name : numbers.names) {
    for (const char* statistic : {"mean", "min", "q1", "median", "q3", "max"}) {
      table.columns.push_back(fmt::format("{}.{}", name, statistic));
    }
  }
  const auto repeats = static_cast<std::size_t>(spec.repeats);
  for (std::size_t first = 0; first < plan.size(); first += repeats) {
    std::vector<Cell> row = point_cells(spec, plan.place(first), false);
    std::int64_t completed = 0;
    for (std::size_t r = first; r < first + repeats; ++r) {
      completed += records[r].status == "completed" ? 1 : 0;
    }
    row.insert(row.end(), {spec.repeats, completed});
    for (std::size_t i = 0; i < numbers.names.size(); ++i) {
      append_distribution(numbers, i, first, repeats, row);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table series_table(const SweepSpec& spec, const SweepPlan& plan,
                   const std::vector<RunRecord>& records) {
  Table table;
  table.columns.emplace_back("run");
  add_point_columns(spec, true, table);
  table.columns.insert(table.columns.end(), {"t", "frame", "kinetic", "potential", "gain"});
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    table.columns.emplace_back(to_string(static_cast<EnergyLine>(i)));
  }
  table.columns.emplace_back("unexplained");
  for (std::size_t r = 0; r < plan.size(); ++r) {
    const RunPlace place = plan.place(r);
    for (const auto& sample : records[r].samples) {
      std::vector<Cell> row{static_cast<std::int64_t>(r)};
      const auto point = point_cells(spec, place, true);
      row.insert(row.end(), point.begin(), point.end());
      row.insert(row.end(), {sample.time, sample.frame, number_cell(sample.kinetic),
                             number_cell(sample.potential), number_cell(sample.gain)});
      for (const double line : sample.lines) {
        row.push_back(number_cell(line));
      }
      row.push_back(number_cell(sample.unexplained));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table apex_table(const SweepSpec& spec, const SweepPlan& plan,
                 const std::vector<RunRecord>& records) {
  Table table;
  table.columns.emplace_back("run");
  add_point_columns(spec, true, table);
  table.columns.insert(table.columns.end(), {"apex", "t", "height"});
  for (std::size_t r = 0; r < plan.size(); ++r) {
    const RunPlace place = plan.place(r);
    std::int64_t n = 0;
    for (const auto& apex : records[r].apexes) {
      std::vector<Cell> row{static_cast<std::int64_t>(r)};
      const auto point = point_cells(spec, place, true);
      row.insert(row.end(), point.begin(), point.end());
      row.insert(row.end(), {++n, number_cell(apex.time), number_cell(apex.height)});
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

}  // namespace

double quantile(const std::vector<double>& sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (at - static_cast<double>(below));
}

SweepResult sweep_tables(const SweepSpec& spec, const SweepPlan& plan,
                         const std::vector<RunRecord>& records) {
  SweepResult result;
  const Numbers numbers = numbers_of(spec, plan, records);
  result.runs = runs_table(spec, plan, records, numbers);
  result.summary = summary_table(spec, plan, records, numbers);
  if (spec.series) {
    result.series = series_table(spec, plan, records);
    result.apexes = apex_table(spec, plan, records);
  }
  result.timings.columns = {"run", "method", "seconds"};
  for (std::size_t r = 0; r < plan.size(); ++r) {
    result.failed += records[r].status == "completed" ? 0U : 1U;
    result.timings.rows.push_back({static_cast<std::int64_t>(r),
                                   spec.methods[plan.place(r).method].name,
                                   number_cell(records[r].seconds)});
  }
  return result;
}

}  // namespace kairos::experiments
