#include "experiments/sweeps/sweep_table.hpp"

#include "core/error.hpp"
#include "experiments/sweeps/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace kairos::experiments {
namespace {

Cell axis_cell(const AxisValue& value) {
  return value.number ? number_cell(*value.number) : Cell(value.text);
}

bool is_drawn(const Axis& axis) { return axis.kind != Axis::Kind::listed; }

/// Adds the columns that all tables start with: method and axes, without those that are drawn per
/// repeat in tables over points.
void add_point_columns(const SweepSpec& spec, bool drawn_too, std::vector<Cell>& row) {
  row.emplace_back(std::string("method"));
  for (const Axis& axis : spec.axes) {
    if (drawn_too || !is_drawn(axis)) {
      row.emplace_back(axis.name);
    }
  }
}

void add_point_cells(const SweepSpec& spec, const RunPlace& run, bool drawn_too,
                     std::vector<Cell>& row) {
  row.emplace_back(spec.methods[run.method].name);
  for (std::size_t i = 0; i < spec.axes.size(); ++i) {
    if (drawn_too || !is_drawn(spec.axes[i])) {
      row.push_back(axis_cell(run.axis_values[i]));
    }
  }
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

/// The numbers of a run: metrics, differences to the reference, predictions.
class Numbers {
 public:
  Numbers(const SweepSpec& spec, const SweepPlan& plan, const RecordSource& records)
      : spec_(spec),
        plan_(plan),
        records_(records),
        per_method_(plan.size() / spec.methods.size()) {
    names_ = spec.metrics;
    for (const std::string& metric : spec.metrics) {
      if (!spec.reference.empty()) {
        names_.push_back(metric + "_error");
      }
    }
    for (const Derived& derived : spec.derived) {
      names_.push_back(derived.name);
    }
    for (std::size_t m = 0; m < spec.methods.size(); ++m) {
      reference_ = spec.methods[m].name == spec.reference ? m * per_method_ : reference_;
    }
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  void of(std::size_t run, const RunRecord& record,
          std::vector<std::optional<double>>& numbers) const {
    numbers.clear();
    for (std::size_t i = 0; i < spec_.metrics.size(); ++i) {
      numbers.push_back(metric_of(record, i));
    }
    if (!spec_.reference.empty()) {
      add_errors(run, record, numbers);
    }
    if (!spec_.derived.empty()) {
      const PlannedRun planned = plan_[run];
      for (const Derived& derived : spec_.derived) {
        numbers.push_back(derived_of(spec_, derived, planned, record));
      }
    }
  }

 private:
  /// Differences to the reference method at the same point and repeat.
  void add_errors(std::size_t run, const RunRecord& record,
                  std::vector<std::optional<double>>& numbers) const {
    const std::size_t other = reference_ + run % per_method_;
    const RunRecord reference = other == run ? record : records_(other);
    for (std::size_t i = 0; i < spec_.metrics.size(); ++i) {
      const auto ours = metric_of(record, i);
      const auto theirs = metric_of(reference, i);
      numbers.push_back(ours && theirs ? std::optional(std::abs(*ours - *theirs)) : std::nullopt);
    }
  }

  const SweepSpec& spec_;
  const SweepPlan& plan_;
  const RecordSource& records_;
  std::size_t per_method_;
  std::size_t reference_ = 0;  ///< where the runs of the reference method begin
  std::vector<std::string> names_;
};

Cell optional_cell(const std::optional<double>& x) { return x ? number_cell(*x) : Cell(); }

/// Mean and quartiles of one column over the repeats of a point; `values` are sorted.
void append_distribution(std::vector<double>& values, std::vector<Cell>& row) {
  CompensatedSum sum;
  for (const double x : values) {
    sum.add(x);
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

/// Gathers the repeats of one point into one row.
class Summary {
 public:
  Summary(const SweepSpec& spec, const std::vector<std::string>& names, const RowSink& sink)
      : spec_(spec), sink_(sink), values_(names.size()) {
    std::vector<Cell> header;
    add_point_columns(spec, false, header);
    header.insert(header.end(), {std::string("runs"), std::string("completed")});
    for (const std::string& name : names) {
      for (const char* statistic : {"mean", "min", "q1", "median", "q3", "max"}) {
        header.emplace_back(fmt::format("{}.{}", name, statistic));
      }
    }
    sink_(header);
  }

  void add(const RunPlace& place, const RunRecord& record,
           const std::vector<std::optional<double>>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i]) {
        values_[i].push_back(*numbers[i]);
      }
    }
    completed_ += record.status == "completed" ? 1 : 0;
    if (place.repeat + 1 == spec_.repeats) {
      finish(place);
    }
  }

 private:
  void finish(const RunPlace& place) {
    std::vector<Cell> row;
    add_point_cells(spec_, place, false, row);
    row.insert(row.end(), {spec_.repeats, completed_});
    for (std::vector<double>& values : values_) {
      append_distribution(values, row);
      values.clear();
    }
    completed_ = 0;
    sink_(row);
  }

  const SweepSpec& spec_;
  const RowSink& sink_;
  std::vector<std::vector<double>> values_;  ///< of the point, by number
  std::int64_t completed_ = 0;
};

/// The tables with a row per run, or several.
class RunTables {
 public:
  RunTables(const SweepSpec& spec, const std::vector<std::string>& names, const SweepSinks& sinks)
      : spec_(spec), sinks_(sinks) {
    tell_header(sinks.runs, [&](std::vector<Cell>& row) {
      row.insert(row.end(), {std::string("repeat"), std::string("status"), std::string("reason")});
      row.insert(row.end(), names.begin(), names.end());
    });
    tell_header(sinks.series, [](std::vector<Cell>& row) {
      for (const char* name : {"t", "frame", "kinetic", "potential", "gain"}) {
        row.emplace_back(std::string(name));
      }
      for (std::size_t i = 0; i < energy_line_count; ++i) {
        row.emplace_back(std::string(to_string(static_cast<EnergyLine>(i))));
      }
      row.emplace_back(std::string("unexplained"));
    });
    tell_header(sinks.apexes, [](std::vector<Cell>& row) {
      row.insert(row.end(), {std::string("apex"), std::string("t"), std::string("height")});
    });
    if (sinks.timings) {
      sinks.timings({std::string("run"), std::string("method"), std::string("seconds")});
    }
  }

  void add(const RunPlace& place, const RunRecord& record,
           const std::vector<std::optional<double>>& numbers) {
    std::vector<Cell> point{static_cast<std::int64_t>(place.index)};
    add_point_cells(spec_, place, true, point);
    if (sinks_.runs) {
      row_ = point;
      row_.insert(row_.end(), {place.repeat, record.status, record.reason});
      for (const auto& x : numbers) {
        row_.push_back(optional_cell(x));
      }
      sinks_.runs(row_);
    }
    if (sinks_.series) {
      add_series(point, record);
    }
    if (sinks_.apexes) {
      add_apexes(point, record);
    }
    if (sinks_.timings) {
      sinks_.timings({static_cast<std::int64_t>(place.index), spec_.methods[place.method].name,
                      number_cell(record.seconds)});
    }
  }

 private:
  template <typename AddColumns>
  void tell_header(const RowSink& sink, const AddColumns& add_columns) const {
    if (sink) {
      std::vector<Cell> row{std::string("run")};
      add_point_columns(spec_, true, row);
      add_columns(row);
      sink(row);
    }
  }

  void add_series(const std::vector<Cell>& point, const RunRecord& record) {
    for (const auto& sample : record.samples) {
      row_ = point;
      row_.insert(row_.end(), {sample.time, sample.frame, number_cell(sample.kinetic),
                               number_cell(sample.potential), number_cell(sample.gain)});
      for (const double line : sample.lines) {
        row_.push_back(number_cell(line));
      }
      row_.push_back(number_cell(sample.unexplained));
      sinks_.series(row_);
    }
  }

  void add_apexes(const std::vector<Cell>& point, const RunRecord& record) {
    std::int64_t n = 0;
    for (const auto& apex : record.apexes) {
      row_ = point;
      row_.insert(row_.end(), {++n, number_cell(apex.time), number_cell(apex.height)});
      sinks_.apexes(row_);
    }
  }

  const SweepSpec& spec_;
  const SweepSinks& sinks_;
  std::vector<Cell> row_;
};

}  // namespace

double quantile(const std::vector<double>& sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (at - static_cast<double>(below));
}

std::size_t write_sweep_tables(const SweepSpec& spec, const SweepPlan& plan,
                               const RecordSource& records, const SweepSinks& sinks) {
  const Numbers numbers(spec, plan, records);
  RunTables tables(spec, numbers.names(), sinks);
  std::optional<Summary> summary;
  if (sinks.summary) {
    summary.emplace(spec, numbers.names(), sinks.summary);
  }
  std::vector<std::optional<double>> of_run;
  std::size_t failed = 0;
  for (std::size_t r = 0; r < plan.size(); ++r) {
    const RunPlace place = plan.place(r);
    const RunRecord record = records(r);
    numbers.of(r, record, of_run);
    tables.add(place, record, of_run);
    if (summary) {
      summary->add(place, record, of_run);
    }
    failed += record.status == "completed" ? 0U : 1U;
  }
  return failed;
}

}  // namespace kairos::experiments
