#include "experiments/tradeoff/tradeoff_experiment.hpp"

#include "experiments/scene_library.hpp"

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
  Table timings;
  for (const std::string& name : spec.scenes) {
    const Model model(read_scene(find_scene(name)));
    assessments.push_back(assess(model, model.scene().duration, threads));
    const Table times = timing_table(model, assessments.back(), size == Size::quick ? 3 : 9);
    timings.columns = times.columns;
    timings.rows.insert(timings.rows.end(), times.rows.begin(), times.rows.end());
  }
  return tradeoff_output(assessments, std::move(timings));
}

}  // namespace kairos::experiments
