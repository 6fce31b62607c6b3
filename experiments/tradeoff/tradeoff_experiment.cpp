#include "experiments/tradeoff/tradeoff_experiment.hpp"

#include "core/reading/scene_reader.hpp"
#include "experiments/tradeoff/recommend.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace kairos::experiments {
namespace {

/// The methods on the front of position at the end: what one would choose from.
Table front_table(const std::vector<Assessment>& assessments) {
  Table table{{"scene", "method", "work", "position_error", "event_time_error", "events_missed",
               "penetration", "energy_error"},
              {}};
  for (const Assessment& assessment : assessments) {
    const std::vector<bool> front = pareto_front(assessment, &Errors::position);
    for (std::size_t i = 0; i < front.size(); ++i) {
      const auto& [candidate, run, errors] = assessment.methods[i];
      if (front[i]) {
        table.rows.push_back({assessment.scene, candidate.name, run.work(),
                              number_cell(errors.position), number_cell(errors.event_time),
                              errors.missed, number_cell(errors.penetration),
                              number_cell(errors.energy)});
      }
    }
  }
  return table;
}

constexpr std::array<Requirements, 6> asked{{{.error = 1e-3},
                                             {.error = 1e-6},
                                             {.error = 1e-9},
                                             {.error = 1e-6, .penetration = 0.0},
                                             {.error = 1e-6, .penetration = 0.0, .budget = 1e-3},
                                             {.error = 1e-6, .penetration = {}, .budget = 1e-6}}};

/// What `kairos recommend` answers: rows of one scene. `frame`: s.
void add_recommended(Table& table, const Model& model, const Assessment& assessment) {
  const double frame = mean_frame_duration(model.scene().frames);
  table.columns = {"scene",  "error",          "penetration", "budget", "does",
                   "method", "work_per_frame", "ends_off",    "depth"};
  const double frames = std::max(1.0, assessment.reference.until / frame);
  for (const Requirements& wanted : asked) {
    const Recommendation found =
        recommend(assessment, wanted, frame, whole_run_of(model, assessment.reference, wanted));
    const auto does = std::count(found.shortcomings.begin(), found.shortcomings.end(), "");
    std::vector<Cell> row{assessment.scene, wanted.error,
                          wanted.penetration ? Cell(*wanted.penetration) : Cell(),
                          wanted.budget ? Cell(*wanted.budget) : Cell(),
                          fmt::format("{} of {}", does, assessment.methods.size())};
    if (found.pick) {
      const auto& [candidate, run, errors] = assessment.methods[*found.pick];
      row.insert(row.end(), {candidate.name, number_cell(static_cast<double>(run.work()) / frames),
                             number_cell(errors.position), number_cell(errors.penetration)});
    } else {
      row.insert(row.end(), {std::string(found.refused.empty() ? "none" : "not representative"),
                             Cell(), Cell(), Cell()});
    }
    table.rows.push_back(std::move(row));
  }
}

}  // namespace

ProgramOutput tradeoff_output(const std::vector<Assessment>& assessments, Table timings) {
  ProgramOutput output;
  output.tables.emplace_back("references", reference_table(assessments));
  output.tables.emplace_back("fronts", front_table(assessments));
  output.shown = {"references", "fronts"};
  for (const Assessment& assessment : assessments) {
    output.tables.emplace_back(assessment.scene + "_methods", assessment_table(assessment));
    output.runs += assessment.methods.size();
    for (const Assessed& method : assessment.methods) {
      output.failed += method.run.completed() ? 0U : 1U;
    }
  }
  output.timings = std::move(timings);
  return output;
}

ProgramOutput run_tradeoff(const ExperimentSpec& spec, Size size, std::size_t threads) {
  std::vector<Assessment> assessments;
  Table timings, recommended;
  for (std::size_t k = 0; k < spec.scenes.size(); ++k) {
    const Model model(read_scene(find_scene(spec.scenes[k])));
    const double duration = spec.durations.empty() ? model.scene().duration : spec.durations[k];
    assessments.push_back(assess(model, duration, threads));
    const Table times = timing_table(model, assessments.back(), size == Size::quick ? 3 : 9);
    timings.columns = times.columns;
    timings.rows.insert(timings.rows.end(), times.rows.begin(), times.rows.end());
    add_recommended(recommended, model, assessments.back());
  }
  ProgramOutput output = tradeoff_output(assessments, std::move(timings));
  output.tables.emplace_back("recommended", std::move(recommended));
  output.shown.emplace_back("recommended");
  return output;
}

}  // namespace kairos::experiments
