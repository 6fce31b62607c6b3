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

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>

namespace kairos::experiments {
namespace {

/// Simulates and measures one planned run; everything that can go wrong becomes a status.
RunRecord run_one(const SweepSpec& spec, const std::string& scene, const PlannedRun& planned) {
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

/// A spec none of whose runs can even be read is wrong; one of whose runs cannot, has a row that
/// says so.
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

}  // namespace

SweepResult run_sweep(const SweepSpec& spec, std::size_t threads, const std::string& journal) {
  using Clock = std::chrono::steady_clock;
  const SweepPlan plan(spec);
  plan.check();
  const std::string scene = scene_path(spec);
  check_readable(spec, scene, plan);

  std::vector<RunRecord> records(plan.size());
  std::vector<char> finished(plan.size(), 0);
  std::optional<SweepJournal> kept;
  if (!journal.empty()) {
    kept.emplace(journal, sweep_key(spec, plan, scene));
    for (auto& [index, record] : kept->found()) {
      if (index >= records.size()) {
        continue;  // not written by us
      }
      records[index] = std::move(record);
      finished[index] = 1;
    }
  }
  {
    ProgressBar bar(spec.name, plan.size());
    parallel_for(plan.size(), threads, [&](std::size_t i) {
      if (finished[i] == 0) {
        const auto start = Clock::now();
        records[i] = run_one(spec, scene, plan[i]);
        records[i].seconds = std::chrono::duration<double>(Clock::now() - start).count();
        if (kept) {
          kept->add(i, records[i]);
        }
      }
      bar.advance();
    });
  }
  return sweep_tables(spec, plan, records);
}

}  // namespace kairos::experiments
