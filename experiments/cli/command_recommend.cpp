#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/frame_reader.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/output/table.hpp"
#include "experiments/run_error.hpp"
#include "experiments/tradeoff/recommend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace kairos::experiments {
namespace {

struct RecommendCommand {
  SceneOptions scene;
  std::string error;
  std::string csv;
  std::optional<std::string> penetration, budget, duration;
  std::size_t threads = 0;

  void run() const;
  [[nodiscard]] Requirements requirements() const;
};

double number(const std::string& text, const char* option, bool zero_allowed) {
  const auto x = parse_number(text);
  if (!x || *x < 0.0 || (*x == 0.0 && !zero_allowed)) {
    throw InputError(
        "", 0, option,
        fmt::format("'{}' is not a finite number {} 0 (m)", text, zero_allowed ? ">=" : ">"));
  }
  return *x;
}

/// `1ms/frame`, or `1ms`.
double budget_of(std::string text) {
  constexpr std::string_view per_frame = "/frame";
  if (text.ends_with(per_frame)) {
    text.resize(text.size() - per_frame.size());
  }
  return parse_duration(text, {"", 0, "--budget"});
}

Requirements RecommendCommand::requirements() const {
  Requirements wanted{.error = number(error, "--error", false)};
  if (penetration) {
    wanted.penetration = number(*penetration, "--penetration", true);
  }
  if (budget) {
    wanted.budget = budget_of(*budget);
  }
  return wanted;
}

void print_evidence(const Assessment& assessment, const Recommendation& found) {
  fmt::print("{:<44}{:>12}{:>11}{:>11}{:>11}  {}\n", "method", "work", "end / m", "depth / m",
             "energy", "");
  const char* const does = found.refused.empty() ? "does" : "does up to there";
  for (const std::size_t i : found.ranked) {
    const auto& [candidate, run, errors] = assessment.methods[i];
    const bool whole = run.completed();
    const auto cell = [whole](double x) { return whole ? fmt::format("{:.2e}", x) : "-"; };
    fmt::print("{:<44}{:>12}{:>11}{:>11}{:>11}  {}\n", candidate.name, run.work(),
               cell(errors.position), cell(errors.penetration), cell(errors.energy),
               found.pick == i                 ? "<- cheapest that does"
               : found.shortcomings[i].empty() ? does
                                               : found.shortcomings[i]);
  }
}

/// A row per method in the order of its work; `recommended` is 1 for the cheapest that does, and
/// `shortcoming` says why one does not. Errors are empty where a method did not come to its end.
Table evidence_table(const Assessment& assessment, const Recommendation& found) {
  Table table{{"method", "options", "work", "end_error", "penetration", "energy_error",
               "recommended", "shortcoming"},
              {}};
  for (const std::size_t i : found.ranked) {
    const auto& [candidate, run, errors] = assessment.methods[i];
    const auto cell = [whole = run.completed()](double x) {
      return whole ? number_cell(x) : Cell();
    };
    table.rows.push_back({candidate.name, candidate.options(),
                          static_cast<std::int64_t>(run.work()), cell(errors.position),
                          cell(errors.penetration), cell(errors.energy),
                          std::int64_t{found.pick == i ? 1 : 0},
                          found.refused.empty() ? found.shortcomings[i] : found.refused});
  }
  return table;
}

void RecommendCommand::run() const {
  const Requirements wanted = requirements();
  const Model model(scene.scene());
  const double length =
      duration ? parse_duration(*duration, {"", 0, "--duration"}) : model.scene().duration;
  const Assessment assessment = assess(model, length, threads);
  const double frame = mean_frame_duration(model.scene().frames);
  if (wanted.budget && *wanted.budget > frame) {
    warn(
        fmt::format("--budget is {} s for a frame of {} s: no real time; a number without a unit "
                    "is in seconds: --budget 1ms/frame",
                    *wanted.budget, frame));
  }
  const Recommendation found =
      recommend(assessment, wanted, frame, whole_run_of(model, assessment.reference, wanted));
  std::string asked = fmt::format("{} m at the end", wanted.error);
  if (wanted.penetration) {
    asked += fmt::format(", at most {} m deep", *wanted.penetration);
  }
  if (wanted.budget) {
    asked += fmt::format(", {} s of work a frame ({} s per counted operation)", *wanted.budget,
                         nominal_operation);
  }
  if (found.pick) {
    const Assessed& pick = assessment.methods[*found.pick];
    fmt::print("{}: {}\n  kairos run {} {}{}\n", assessment.scene, pick.candidate.name,
               scene.arguments(), pick.candidate.options(),
               duration ? " --duration " + shell_word(*duration) : std::string());
  } else if (!found.refused.empty()) {
    fmt::print("{}: no advice: {}\n", assessment.scene, found.refused);
  } else {
    fmt::print("{}: none of {} methods does\n", assessment.scene, assessment.methods.size());
  }
  fmt::print("asked: {}\nevidence: {}; reference: {}, itself uncertain by {:.1e} m\n\n", asked,
             assessment.reference.sentence, assessment.reference.kind,
             assessment.reference.position_uncertainty);
  print_evidence(assessment, found);
  if (!csv.empty()) {
    write_file(csv, evidence_table(assessment, found).csv());
  }
  if (!found.pick) {
    throw RunError(found.refused.empty()
                       ? fmt::format("{}: no method meets {}", assessment.scene, asked)
                       : fmt::format("{}: {}", assessment.scene, found.refused));
  }
}

}  // namespace

void add_recommend_command(Command& app) {
  const auto command = std::make_shared<RecommendCommand>();
  Command recommend = app.add_subcommand(
      "recommend", "The cheapest method that meets a bound on a scene, with the evidence");
  command->scene.add_to(recommend);
  recommend.add_option("--error", command->error, "largest error of a position at the end, m")
      .required()
      .type_name("X");
  recommend.add_option("--penetration", command->penetration, "deepest penetration, m")
      .type_name("P");
  recommend
      .add_option("--budget", command->budget,
                  "work for a frame, such as 1ms/frame; counted, 100 ns an operation")
      .type_name("T");
  recommend.add_option("--duration", command->duration, "how long, s or with a unit")
      .type_name("T");
  recommend.add_option("--csv", command->csv, "the evidence as a table, a row per method")
      .type_name("FILE");
  recommend
      .add_option("--threads", command->threads,
                  "0: one per core; the answer does not depend on it")
      .check(whole_number(0, 1024))
      .capture_default_str();
  recommend.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
