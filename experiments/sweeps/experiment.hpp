#pragma once

#include "experiments/output/output_folder.hpp"
#include "experiments/sweeps/experiment_program.hpp"
#include "experiments/sweeps/sweep_spec.hpp"
#include "experiments/sweeps/sweep_table.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace kairos::experiments {

struct ExperimentOptions {
  Size size = Size::quick;
  std::size_t threads = 0;  ///< 0: one per core
  std::string command;      ///< that repeats it, for the report
  bool force = false;       ///< replaces whatever the folder holds
};

/// What an experiment made.
struct ExperimentOutcome {
  std::size_t runs = 0;
  std::size_t failed = 0;  ///< refused, stopped or failed; rows all the same
  double run_seconds = 0.0;
  double figure_seconds = 0.0;
  std::string figure_problem;  ///< empty if the figures are drawn
};

/// What the folder of an experiment or a figure looks like: `manifest.csv` seals it.
[[nodiscard]] OutputSet experiment_output(bool replace);

/// Runs the sweeps of a spec, writes their tables to `folder`, then draws the figures.
///
/// Files: `SWEEP_runs.csv` (a row per run), `SWEEP_summary.csv` (quartiles over repeats),
/// `SWEEP_series.csv` and `SWEEP_apexes.csv` where asked for, `columns.csv` (what the columns
/// mean), `manifest.csv` (question, method, command, seed, versions), `spec.toml` (a copy of the
/// spec), `timings.csv` (the only file that differs between two runs), and from the figure script
/// `NAME.svg`, `NAME.png` and `figures.csv`. Throws `InputError` and `RunError`.
ExperimentOutcome run_sweeps(const ExperimentSpec& spec, const ExperimentOptions& options,
                             const std::string& folder);

/// Gives the rows of a sweep to its tables; returns how many runs were refused, stopped or failed.
using WriteTables = std::function<std::size_t(const SweepSpec& sweep, const SweepSinks& sinks)>;

/// What `run_sweeps` writes, whatever the rows come from. `text`: of the spec.
ExperimentOutcome publish_sweeps(const ExperimentSpec& spec, const ExperimentOptions& options,
                                 const std::string& text, const WriteTables& write_tables,
                                 const std::string& folder);

/// The same for what a program made: its tables, `manifest.csv`, `columns.csv`, `spec.toml`,
/// `timings.csv`, then the figures.
ExperimentOutcome publish_program(const ExperimentSpec& spec, const ExperimentOptions& options,
                                  const ProgramOutput& made, const std::string& folder);

}  // namespace kairos::experiments
