#include "experiments/references/references_experiment.hpp"

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/references/reference_problem.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {
namespace {

/// Of the steps' end, in `auto` and in controlled steppers: what problems with joints are solved
/// to.
constexpr StepperOptions fine{1e-13, 1e-14};

constexpr std::array<std::string_view, 5> schemes{"event-driven", "moreau-jean", "pgs", "xpbd",
                                                  "penalty"};

struct Answer {
  double value = std::numeric_limits<double>::quiet_NaN();
  Grade grade = Grade::exact;  ///< the weakest of all events
  std::string reason;          ///< why there is no value; "" where there is one
  double seconds = 0.0;        ///< of computing
};

RunChoice choice_of(const ReferenceProblem& problem, std::string_view scheme) {
  RunChoice choice;
  choice.method.scheme = scheme;
  if (scheme == "event-driven") {
    choice.method.impact = problem.impact;
    choice.stepper = fine;
  }
  return choice;
}

Answer answer(const ReferenceProblem& problem, std::string_view scheme) {
  Answer answer;
  if (problem.of_moment && scheme != "event-driven") {
    answer.reason = "tells no such moment";
    return answer;
  }
  const auto began = std::chrono::steady_clock::now();
  try {
    const Simulation run =
        simulate(parse_scene(problem.toml, "reference.toml"), choice_of(problem, scheme));
    for (const Event& event : run.trajectory.events()) {
      answer.grade = std::max(answer.grade, event.grade);
    }
    if (run.result.status == RunStatus::stopped) {
      answer.reason = "stopped: " + run.result.reason;
    } else {
      answer.value = problem.measured(run);
      answer.reason = std::isnan(answer.value) ? "tells no such moment" : "";
    }
  } catch (const InputError& error) {
    answer.reason = "refused: " + error.reason();
  }
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return answer;
}

Table truth_table(const std::vector<ReferenceProblem>& problems,
                  const std::vector<Answer>& answers) {
  Table table{{"problem", "quantity", "unit", "truth", "measured", "difference", "grade", "reason"},
              {}};
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const ReferenceProblem& p = problems[i];
    const Answer& a = answers[i * schemes.size()];
    table.rows.push_back(
        {p.name, p.quantity, p.unit, p.truth, number_cell(a.value), number_cell(a.value - p.truth),
         a.reason.empty() ? Cell(std::string(to_string(a.grade))) : Cell(), a.reason});
  }
  return table;
}

/// How far each scheme is off, as a share of the truth where there is one that is not zero.
Table error_table(const std::vector<ReferenceProblem>& problems,
                  const std::vector<Answer>& answers) {
  Table table{{"problem", "quantity", "scheme", "error", "reason"}, {}};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const ReferenceProblem& p = problems[i / schemes.size()];
    const double scale = p.truth == 0.0 ? 1.0 : std::abs(p.truth);
    table.rows.push_back({p.name, p.quantity, std::string(schemes[i % schemes.size()]),
                          number_cell(std::abs(answers[i].value - p.truth) / scale),
                          answers[i].reason});
  }
  return table;
}

}  // namespace

ProgramOutput run_references(const ExperimentSpec& spec, Size /*size*/, std::size_t threads) {
  const std::vector<ReferenceProblem> problems = reference_problems();
  std::vector<Answer> answers(problems.size() * schemes.size());
  {
    ProgressBar bar(spec.name, answers.size());
    parallel_for(answers.size(), threads, [&](std::size_t i) {
      answers[i] = answer(problems[i / schemes.size()], schemes[i % schemes.size()]);
      bar.advance();
    });
  }
  ProgramOutput output;
  output.tables.emplace_back("problems", truth_table(problems, answers));
  output.tables.emplace_back("errors", error_table(problems, answers));
  output.shown = {"problems"};
  output.timings.columns = {"problem", "scheme", "seconds"};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    output.timings.rows.push_back({problems[i / schemes.size()].name,
                                   std::string(schemes[i % schemes.size()]),
                                   number_cell(answers[i].seconds)});
  }
  output.runs = answers.size();
  return output;
}

}  // namespace kairos::experiments
