#include "experiments/tradeoff/assessment.hpp"

#include "experiments/output/plain_file_name.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/progress_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::experiments {
namespace {

RunChoice up_to(const RunChoice& choice, double until) {
  RunChoice cut = choice;
  cut.duration = until;
  return cut;
}

}  // namespace

Assessment assess(const Model& model, double duration, std::size_t threads) {
  Assessment assessment;
  assessment.scene = plain_file_name(model.scene().name);  // it names a table
  assessment.reference = find_reference(model, duration);
  for (Candidate& candidate : sensible_candidates(model)) {
    assessment.methods.push_back({std::move(candidate), {}, {}});
  }
  ProgressBar bar("methods", assessment.methods.size());
  parallel_for(assessment.methods.size(), threads, [&](std::size_t i) {
    Assessed& method = assessment.methods[i];
    method.run = measure(model, up_to(method.candidate.choice, assessment.reference.until), &bar);
    method.errors = errors_of(method.run, assessment.reference);
    if (method.run.completed() && !(method.errors.position <= assessment.reference.scale)) {
      method.run.status = "diverged";
      method.run.reason = fmt::format("ends {:.1e} m off where nothing gets farther than {:.1e} m",
                                      method.errors.position, assessment.reference.scale);
    }
    bar.advance();
  });
  return assessment;
}

std::vector<bool> pareto_front(const Assessment& assessment, double Errors::*error) {
  const auto dominated = [&](const Assessed& by, const Assessed& method) {
    const bool no_worse =
        by.run.work() <= method.run.work() && by.errors.*error <= method.errors.*error;
    const bool better =
        by.run.work() < method.run.work() || by.errors.*error < method.errors.*error;
    return by.run.completed() && no_worse && better;
  };
  std::vector<bool> front;
  for (const Assessed& method : assessment.methods) {
    front.push_back(method.run.completed() && std::isfinite(method.errors.*error) &&
                    std::none_of(assessment.methods.begin(), assessment.methods.end(),
                                 [&](const Assessed& by) { return dominated(by, method); }));
  }
  return front;
}

Table assessment_table(const Assessment& assessment) {
  Table table{{"scene",
               "method",
               "scheme",
               "integrator",
               "detector",
               "impact",
               "frame",
               "step",
               "relative_tolerance",
               "status",
               "reason",
               "position_error",
               "event_time_error",
               "events_missed",
               "penetration",
               "energy_error",
               "impacts",
               "right_hand_sides",
               "overlap_tests",
               "toi_evaluations",
               "work",
               "front_position",
               "front_event_time",
               "front_penetration",
               "front_energy"},
              {}};
  const std::vector<std::vector<bool>> fronts{
      pareto_front(assessment, &Errors::position), pareto_front(assessment, &Errors::event_time),
      pareto_front(assessment, &Errors::penetration), pareto_front(assessment, &Errors::energy)};
  for (std::size_t i = 0; i < assessment.methods.size(); ++i) {
    const auto& [candidate, run, errors] = assessment.methods[i];
    const RunChoice& choice = candidate.choice;
    std::vector<Cell> row{assessment.scene,
                          candidate.name,
                          choice.method.scheme,
                          choice.method.integrator,
                          choice.method.detector,
                          choice.method.impact,
                          number_cell(mean_frame_duration(*choice.frames)),
                          choice.step ? number_cell(*choice.step) : Cell(),
                          number_cell(choice.stepper.relative_tolerance),
                          run.status,
                          run.reason};
    const bool whole = run.completed();
    const auto known = [&row, whole](double x) {
      row.push_back(number_cell(whole ? x : std::numeric_limits<double>::quiet_NaN()));
    };
    known(errors.position);
    known(errors.event_time);
    known(static_cast<double>(errors.missed));
    known(errors.penetration);
    known(errors.energy);
    for (const std::int64_t n : {run.cost.impacts, run.cost.right_hand_sides,
                                 run.cost.overlap_tests, run.cost.toi_evaluations, run.work()}) {
      row.emplace_back(n);
    }
    for (const auto& front : fronts) {
      row.emplace_back(std::int64_t{front[i] ? 1 : 0});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table reference_table(const std::vector<Assessment>& assessments) {
  Table table{{"scene", "reference", "compared", "until", "lyapunov_time", "position_uncertainty",
               "time_uncertainty", "impacts"},
              {}};
  for (const auto& [scene, reference, methods] : assessments) {
    std::int64_t impacts = 0;
    for (const auto& [pair, times] : reference.impacts) {
      impacts += static_cast<std::int64_t>(times.size());
    }
    table.rows.push_back({scene, reference.kind, reference.sentence, number_cell(reference.until),
                          reference.lyapunov > 0.0 ? number_cell(reference.lyapunov) : Cell(),
                          number_cell(reference.position_uncertainty),
                          number_cell(reference.time_uncertainty), impacts});
  }
  return table;
}

Table timing_table(const Model& model, const Assessment& assessment, int rounds) {
  const std::size_t n = assessment.methods.size();
  std::vector<double> least(n, std::numeric_limits<double>::infinity());
  std::vector<double> most(n, 0.0);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < n; ++i) {
      if (assessment.methods[i].run.completed()) {
        const double seconds = time_run(
            model, up_to(assessment.methods[i].candidate.choice, assessment.reference.until));
        least[i] = std::min(least[i], seconds);
        most[i] = std::max(most[i], seconds);
      }
    }
  }
  Table table{{"scene", "method", "seconds", "slowest", "rounds"}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    if (most[i] > 0.0) {
      table.rows.push_back({assessment.scene, assessment.methods[i].candidate.name,
                            number_cell(least[i]), number_cell(most[i]), std::int64_t{rounds}});
    }
  }
  return table;
}

}  // namespace kairos::experiments
