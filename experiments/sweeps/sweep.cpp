#include "experiments/sweeps/sweep.hpp"

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/metrics/metric_series.hpp"
#include "experiments/metrics/metrics.hpp"
#include "experiments/output/broadcast.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/sweeps/sweep_journal.hpp"
#include "experiments/sweeps/sweep_plan.hpp"
#include "experiments/sweeps/sweep_table.hpp"
#include "experiments/way_of_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>

namespace kairos::experiments {
namespace {

/// Simulates and measures one planned run; everything that can go wrong becomes a status.
RunRecord run_one(const SweepSpec& spec, const std::string& scene, const PlannedRun& planned,
                  ProgressBar& bar) {
  RunRecord record;
  if (!planned.refused.empty()) {
    record.status = "refused";
    record.reason = planned.refused;
    return record;
  }
  try {
    const Model model(read_scene(scene, planned.overrides));
    const double duration = planned.choice.duration.value_or(model.scene().duration);
    MetricRecorder metrics({spec.metrics, spec.subject});
    SeriesRecorder series(subject_of(model, spec.subject), spec.samples, duration);
    std::vector<Recorder*> listeners{&metrics};
    if (spec.series) {
      listeners.push_back(&series);
    }
    WayOfRun way(bar, duration);
    if (bar.is_drawn()) {
      listeners.push_back(&way);
    }
    Broadcast recorder(listeners);
    const RunResult result = simulate(model, planned.choice, recorder);
    record.status = result.status == RunStatus::completed ? "completed" : "stopped";
    record.reason = result.reason;
    for (const std::string& metric : spec.metrics) {
      record.metrics.push_back(metrics.value(metric, result));
    }
    record.samples = series.samples();
    record.apexes = series.apexes();
  } catch (const InputError& error) {
    record.status = "refused";
    record.reason = error.key().empty() ? error.reason() : error.key() + ": " + error.reason();
  } catch (const std::exception& error) {
    record.status = "failed";
    record.reason = error.what();
  }
  return record;
}

/// Refuses a spec if none of its runs can be read; if only some cannot, their rows say so.
void check_readable(const SweepSpec& spec, const std::string& scene, const SweepPlan& plan) {
  std::optional<InputError> first;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    try {
      (void)subject_of(Model(read_scene(scene, plan[i].overrides)), spec.subject);
      return;
    } catch (const InputError& error) {
      first = first ? first : std::optional(error);
    }
  }
  if (first) {
    throw InputError(spec.file, spec.line, "scene", first->what());
  }
}

RunRecord timed_run(const SweepSpec& spec, const std::string& scene, const PlannedRun& planned,
                    ProgressBar& bar) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  RunRecord record = run_one(spec, scene, planned, bar);
  record.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return record;
}

/// The scene of a sweep whose spec makes sense.
std::string checked_scene(const SweepSpec& spec, const SweepPlan& plan, const Shard& shard = {}) {
  const std::size_t per_method = plan.size() / spec.methods.size();
  plan.check([&](std::size_t i) { return shard.holds(i % per_method, per_method); });
  const std::string scene = scene_path(spec);
  check_readable(spec, scene, plan);
  return scene;
}

/// Runs the part of a shard that its journal does not have; returns its number of rows then.
std::size_t run_missing(const SweepSpec& spec, const SweepPlan& plan, const std::string& scene,
                        std::size_t threads, const Shard& shard, SweepJournal& journal) {
  const std::size_t per_method = plan.size() / spec.methods.size();
  ProgressBar bar(spec.name, plan.size() / shard.count);
  parallel_for(plan.size(), threads, [&](std::size_t i) {
    if (!shard.holds(i % per_method, per_method)) {
      return;
    }
    if (!journal.has(i)) {
      RunRecord record = timed_run(spec, scene, plan[i], bar);
      journal.add(i, record);
    }
    bar.advance();
  });
  return journal.size();
}

RowSink into(Table& table) {
  return [&table](const std::vector<Cell>& row) {
    if (!table.columns.empty()) {
      table.rows.push_back(row);
      return;
    }
    for (const Cell& name : row) {
      table.columns.push_back(to_text(name));
    }
  };
}

}  // namespace

SweepSinks tables_in(SweepResult& result, bool series) {
  SweepSinks sinks{into(result.runs), into(result.summary), {}, {}, into(result.timings)};
  if (series) {
    sinks.series = into(result.series);
    sinks.apexes = into(result.apexes);
  }
  return sinks;
}

SweepResult run_sweep(const SweepSpec& spec, std::size_t threads) {
  const SweepPlan plan(spec);
  const std::string scene = checked_scene(spec, plan);
  std::vector<RunRecord> records(plan.size());
  {
    ProgressBar bar(spec.name, plan.size());
    parallel_for(plan.size(), threads, [&](std::size_t i) {
      records[i] = timed_run(spec, scene, plan[i], bar);
      bar.advance();
    });
  }
  SweepResult result;
  result.failed = write_sweep_tables(
      spec, plan, [&records](std::size_t i) { return records[i]; }, tables_in(result, spec.series));
  return result;
}

std::size_t run_rows(const SweepSpec& spec, std::size_t threads, const std::string& journal,
                     const std::string& key, const Shard& shard) {
  const SweepPlan plan(spec);
  const std::string scene = checked_scene(spec, plan, shard);
  SweepJournal kept(journal, key, plan.size());
  return run_missing(spec, plan, scene, threads, shard, kept);
}

std::size_t stream_sweep(const SweepSpec& spec, std::size_t threads, const std::string& journal,
                         const SweepSinks& sinks) {
  const SweepPlan plan(spec);
  const std::string scene = checked_scene(spec, plan);
  SweepJournal kept(journal, sweep_key(spec, plan, scene), plan.size());
  run_missing(spec, plan, scene, threads, {}, kept);
  const RecordFile rows(journal);
  return write_sweep_tables(
      spec, plan,
      [&](std::size_t i) {
        std::size_t index = 0;
        return read_row(rows.at(kept.places()[i]), index);
      },
      sinks);
}

}  // namespace kairos::experiments
