#include "experiments/extremes/extremes_experiment.hpp"

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/extremes/thesis_explanation.hpp"
#include "experiments/named_method.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/progress_bar.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <span>
#include <vector>

namespace kairos::experiments {
namespace {

constexpr double right_within = 1e-6;
constexpr double degraded_within = 0.1;

struct Hung {};

class Watch : public Recorder {
 public:
  void frame(const Frame& /*frame*/) override { count(); }
  void event(const Event& event) override {
    count();
    if (event.kind == EventKind::impact) {
      ++impacts;
      if (run.impacts.size() < most_kept) {
        run.impacts.push_back(event.time.seconds);
      }
    }
  }
  void stage(Stage /*stage*/, double /*fraction*/) override { count(); }
  ExtremeRun run;
  std::size_t impacts = 0;

 private:
  static constexpr std::size_t most_kept = 16;
  static constexpr std::int64_t most_calls = 30'000'000;
  void count() {
    if (++calls_ > most_calls) {
      throw Hung{};
    }
  }
  std::int64_t calls_ = 0;
};

std::vector<NamedMethod> methods() {
  std::vector<NamedMethod> all = compared_methods();
  all.back().name = "event-driven, certified";
  all.insert(all.end() - 1,
             {"event-driven, conservative",
              {.method = {"event-driven", "auto", "conservative-advancement", "newton"}}});
  all.insert(all.begin() + 1, {"original", {.method = {"original", "auto", "sat", "newton"}}});
  for (std::size_t m = 1; m < all.size(); ++m) {
    all[m].choice.stepper = {1e-10, 1e-8};
    all[m].choice.max_substeps = 2000;
  }
  return all;
}

Table map_table(const std::vector<ExtremeCase>& cases, std::span<const NamedMethod> all,
                const std::vector<Judged>& judged) {
  Table table{{"family", "x_name", "x", "y_name", "y", "method", "verdict", "error", "impacts",
               "reason", "explanation"},
              {}};
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const ExtremeCase& c = cases[i / all.size()];
    const NamedMethod& method = all[i % all.size()];
    const Judged& cell = judged[i];
    const bool explained = method.name == "thesis" && cell.verdict != Verdict::right;
    table.rows.push_back({c.family, c.x_name, c.x, c.y_name,
                          c.y_name.empty() ? Cell() : number_cell(c.y), std::string(method.name),
                          std::string(to_string(cell.verdict)),
                          cell.verdict == Verdict::reported ? Cell() : number_cell(cell.error),
                          static_cast<std::int64_t>(cell.impacts), cell.reason,
                          explained ? Cell(why_thesis_is_wrong(c, cell)) : Cell()});
  }
  return table;
}

Table verdict_table(std::span<const NamedMethod> all, const std::vector<Judged>& judged) {
  Table table{
      {"method", "cells", "right", "degraded", "wrong but reported", "wrong in silence", "hung"},
      {}};
  for (std::size_t m = 0; m < all.size(); ++m) {
    std::array<std::int64_t, 5> tally{};
    for (std::size_t i = m; i < judged.size(); i += all.size()) {
      ++tally[static_cast<std::size_t>(judged[i].verdict)];
    }
    std::vector<Cell> row{std::string(all[m].name),
                          static_cast<std::int64_t>(judged.size() / all.size())};
    row.insert(row.end(), tally.begin(), tally.end());
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// What was refused or stopped, counted by the word before the colon.
Table reason_table(std::span<const NamedMethod> all, const std::vector<Judged>& judged) {
  std::map<std::pair<std::string, std::string>, std::int64_t> counts;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (judged[i].verdict == Verdict::reported) {
      const std::string& reason = judged[i].reason;
      ++counts[{std::string(all[i % all.size()].name), reason.substr(0, reason.find(':'))}];
    }
  }
  Table table{{"method", "reason", "cells"}, {}};
  for (const auto& [key, count] : counts) {
    table.rows.push_back({key.first, key.second, count});
  }
  return table;
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::right:
      return "right";
    case Verdict::degraded:
      return "degraded";
    case Verdict::reported:
      return "wrong but reported";
    case Verdict::wrong_in_silence:
      return "wrong in silence";
    case Verdict::hung:
      return "hung";
  }
  return "";
}

Judged judge(const ExtremeCase& extreme, const RunChoice& choice) {
  Judged judged;
  Watch watch;
  try {
    const Model model(parse_scene(extreme.toml, extreme.family + ".toml"));
    RunResult result = simulate(model, choice, watch);
    judged.impacts = watch.impacts;
    if (result.status == RunStatus::stopped) {
      judged.verdict = Verdict::reported;
      judged.reason = result.reason;
      return judged;
    }
    watch.run.end = std::move(result.state);
    judged.error = extreme.error(watch.run);
    judged.verdict = judged.error <= right_within      ? Verdict::right
                     : judged.error <= degraded_within ? Verdict::degraded
                                                       : Verdict::wrong_in_silence;
  } catch (const InputError& error) {
    judged.verdict = Verdict::reported;
    judged.reason = "refused: " + error.reason();
  } catch (const Hung&) {
    judged.verdict = Verdict::hung;
  }
  return judged;
}

ProgramOutput run_extremes(const ExperimentSpec& spec, Size size, std::size_t threads) {
  const std::vector<ExtremeCase> cases = extreme_cases(size);
  const std::vector<NamedMethod> all = methods();
  std::vector<Judged> judged(cases.size() * all.size());
  std::vector<double> seconds(judged.size());
  {
    ProgressBar bar(spec.name, judged.size());
    parallel_for(judged.size(), threads, [&](std::size_t i) {
      const auto start = std::chrono::steady_clock::now();
      judged[i] = judge(cases[i / all.size()], all[i % all.size()].choice);
      seconds[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      bar.advance();
    });
  }
  ProgramOutput output;
  output.tables.emplace_back("map", map_table(cases, all, judged));
  output.tables.emplace_back("verdicts", verdict_table(all, judged));
  output.tables.emplace_back("reasons", reason_table(all, judged));
  output.shown = {"verdicts", "reasons"};
  output.timings.columns = {"family", "x", "y", "method", "seconds"};
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const ExtremeCase& c = cases[i / all.size()];
    output.timings.rows.push_back(
        {c.family, c.x, c.y, std::string(all[i % all.size()].name), number_cell(seconds[i])});
  }
  output.runs = judged.size();
  return output;
}

}  // namespace kairos::experiments
