#include "experiments/sweeps/experiment.hpp"

#include "experiments/figures/draw_figures.hpp"
#include "experiments/metrics/metrics.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/output/table.hpp"
#include "experiments/output/text_or_nothing.hpp"
#include "experiments/sweeps/sweep.hpp"
#include "experiments/sweeps/sweep_plan.hpp"
#include "simulation/version.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <system_error>

namespace kairos::experiments {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What the columns of a sweep's tables mean: all that a figure needs to label its axes.
void describe_columns(const SweepSpec& sweep, Table& table) {
  const auto add = [&](const std::string& name, const std::string& role, const std::string& unit,
                       const std::string& label, bool logarithmic) {
    table.rows.push_back(
        {sweep.name, name, role, unit, label, std::string(logarithmic ? "log" : "linear")});
  };
  for (const Axis& axis : sweep.axes) {
    add(axis.name, axis.kind == Axis::Kind::listed ? "axis" : "drawn", axis.unit, axis.label,
        axis.logarithmic);
  }
  for (const std::string& metric : sweep.metrics) {
    add(metric, "metric", std::string(metric_unit(metric)), metric, false);
  }
  for (const std::string& metric : sweep.metrics) {
    if (!sweep.reference.empty()) {
      add(metric + "_error", "error", std::string(metric_unit(metric)),
          fmt::format("|{} - {}|", metric, sweep.reference), true);
    }
  }
  for (const Derived& derived : sweep.derived) {
    add(derived.name, "derived", derived.unit, derived.name, false);
  }
}

Table manifest_of(const ExperimentSpec& spec, const ExperimentOptions& options) {
  Table table;
  table.columns = {"key", "value"};
  const auto add = [&table](const std::string& key, const std::string& value) {
    table.rows.push_back({key, value});
  };
  add("name", spec.name);
  add("title", spec.title);
  add("asks", spec.asks);
  add("how", spec.how);
  add("finding", spec.finding);
  add("command", options.command);
  add("size", std::string(to_string(options.size)));
  for (const SweepSpec& sweep : spec.sweeps) {
    add("sweep", sweep.name);
    add("caption:" + sweep.name, sweep.caption);
    add("scene:" + sweep.name, sweep.scene);
    add("seed:" + sweep.name, fmt::format("{}", sweep.seed));
    add("repeats:" + sweep.name, fmt::format("{}", sweep.repeats));
    add("x:" + sweep.name, sweep.x);
    add("y:" + sweep.name, sweep.y);
    if (sweep.logarithmic) {
      add("log:" + sweep.name, "true");
    }
    for (const MethodSpec& method : sweep.methods) {
      if (!method.mark.empty()) {
        add(fmt::format("mark:{}:{}", sweep.name, method.name), method.mark);
      }
    }
  }
  for (const auto& [name, version] : versions()) {
    add("version:" + name, version);
  }
  return table;
}

}  // namespace

OutputSet experiment_output(bool replace) {
  return {.seal = "manifest.csv", .begins = "key,value\nname,", .replace = replace};
}

namespace {

RowSink into(AtomicFile& file) {
  return [&file](const std::vector<Cell>& row) { file.write(csv_line(row)); };
}

/// Of one sweep, each table as a file of the folder; times of all sweeps are one table.
SweepSinks files_in(OutputFolder& out, const SweepSpec& sweep, AtomicFile& timings) {
  SweepSinks sinks;
  sinks.runs = into(out.file(sweep.name + "_runs.csv"));
  sinks.summary = into(out.file(sweep.name + "_summary.csv"));
  if (sweep.series) {
    sinks.series = into(out.file(sweep.name + "_series.csv"));
    sinks.apexes = into(out.file(sweep.name + "_apexes.csv"));
  }
  sinks.timings = [&timings, name = sweep.name,
                   first = true](const std::vector<Cell>& row) mutable {
    if (!first) {
      timings.write(csv_line({name, row[0], row[1], row[2]}));
    }
    first = false;
  };
  return sinks;
}

}  // namespace

ExperimentOutcome publish_sweeps(const ExperimentSpec& spec, const ExperimentOptions& options,
                                 const std::string& text, const WriteTables& write_tables,
                                 const std::string& folder) {
  ExperimentOutcome outcome;
  const auto start = Clock::now();
  OutputFolder out(folder, experiment_output(options.force));
  AtomicFile& timings = out.file("timings.csv");
  timings.write("sweep,run,method,seconds\n");
  Table columns{{"sweep", "column", "role", "unit", "label", "scale"}, {}};
  for (const SweepSpec& sweep : spec.sweeps) {
    outcome.failed += write_tables(sweep, files_in(out, sweep, timings));
    outcome.runs += SweepPlan(sweep).size();
    describe_columns(sweep, columns);
  }
  out.file("columns.csv").write(columns.csv());
  out.file("manifest.csv").write(manifest_of(spec, options).csv());
  out.file("spec.toml").write(text);
  out.publish();
  outcome.run_seconds = seconds_since(start);

  const auto drawing = Clock::now();
  outcome.figure_problem = draw_figures(spec.figure, folder);
  outcome.figure_seconds = seconds_since(drawing);
  return outcome;
}

ExperimentOutcome run_sweeps(const ExperimentSpec& spec, const ExperimentOptions& options,
                             const std::string& folder) {
  std::vector<std::string> journals;
  const ExperimentOutcome outcome = publish_sweeps(
      spec, options, text_or_nothing(spec.path),
      [&](const SweepSpec& sweep, const SweepSinks& sinks) {
        journals.push_back((std::filesystem::path(folder) / ("." + sweep.name + ".rows")).string());
        return stream_sweep(sweep, options.threads, journals.back(), sinks);
      },
      folder);
  for (const std::string& journal : journals) {
    std::error_code ignored;  // its rows are in the tables
    std::filesystem::remove(journal, ignored);
  }
  return outcome;
}

ExperimentOutcome publish_program(const ExperimentSpec& spec, const ExperimentOptions& options,
                                  const ProgramOutput& made, const std::string& folder) {
  OutputFolder out(folder, experiment_output(options.force));
  Table manifest = manifest_of(spec, options);
  for (const std::string& name : made.shown) {
    manifest.rows.push_back({std::string("table"), name});
  }
  for (const auto& [name, table] : made.tables) {
    out.file(name + ".csv").write(table.csv());
  }
  out.file("columns.csv")
      .write(Table{{"sweep", "column", "role", "unit", "label", "scale"}, {}}.csv());
  out.file("manifest.csv").write(manifest.csv());
  out.file("spec.toml").write(text_or_nothing(spec.path));
  if (!made.timings.columns.empty()) {
    out.file("timings.csv").write(made.timings.csv());
  }
  out.publish();
  ExperimentOutcome outcome;
  outcome.runs = made.runs;
  outcome.failed = made.failed;
  const auto drawing = Clock::now();
  outcome.figure_problem = draw_figures(spec.figure, folder);
  outcome.figure_seconds = seconds_since(drawing);
  return outcome;
}

}  // namespace kairos::experiments
