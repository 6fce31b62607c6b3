#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/random/scene_survey.hpp"
#include "experiments/run_error.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace kairos::experiments {
namespace {

/// At most this share of valid scenes may stop with a reason.
constexpr double most_stops = 0.05;

struct RandomScenesCommand {
  SceneSurvey survey;
  std::map<SceneKind, bool> asked;  ///< by its flag, at most one
  std::string out;
  bool print = false;

  void run() const;
  [[nodiscard]] Tally watched() const;
  void shrink_failures(const Tally& tally) const;
};

/// The survey, with its finished blocks and its summary so far in the folder, if there is one.
Tally RandomScenesCommand::watched() const {
  using Clock = std::chrono::steady_clock;
  ProgressBar bar("random scenes", survey.count);
  if (out.empty()) {
    return run_survey(survey, "", [&](const Tally& tally) { bar.reach(tally.scenes); });
  }
  const std::filesystem::path folder = out;
  std::error_code ignored;  // what cannot be made is told of by name when the journal is
  std::filesystem::create_directories(folder, ignored);
  const auto summarise = [&](const Tally& tally) {
    write_file((folder / "random-scenes.json").string(), survey_summary(survey, tally));
  };
  Clock::time_point summarised{};
  const Tally tally =
      run_survey(survey, (folder / "random-scenes.blocks").string(), [&](const Tally& so_far) {
        bar.reach(so_far.scenes);
        if (Clock::now() - summarised > std::chrono::seconds(5)) {
          summarised = Clock::now();
          summarise(so_far);
        }
      });
  summarise(tally);
  return tally;
}

void RandomScenesCommand::shrink_failures(const Tally& tally) const {
  constexpr std::size_t most_files = 10;
  std::size_t files = 0;
  for (const auto& [number, trial] : tally.failures) {
    fmt::print("scene {}: {} at {} s: {}\n", number, to_string(trial.fate), trial.time,
               trial.reason);
    if (files++ < most_files) {
      const RandomScene small = shrink(scene_of(survey, number), trial.fate);
      const std::string path =
          (std::filesystem::path(out) / fmt::format("random-{}-{}.toml", survey.seed, number))
              .string();
      write_file(path,
                 fmt::format("# {}: {}\n{}", to_string(trial.fate), trial.reason, small.toml()));
      fmt::print("  shrunk to {} bodies: {}\n", small.bodies.size(), path);
    }
  }
}

void RandomScenesCommand::run() const {
  if (print) {
    for (std::uint64_t k = 0; k < survey.count; ++k) {
      fmt::print("{}", scene_of(survey, survey.first + k).toml());
    }
    return;
  }
  const Tally tally = watched();
  fmt::print("scenes                {} (seed {}, numbers {} to {})\n", tally.scenes, survey.seed,
             survey.first, survey.first + survey.count - 1);
  fmt::print("impacts               {}\n", tally.impacts);
  for (const Fate fate : all_fates) {
    fmt::print("{:<22}{}\n", to_string(fate), tally.of(fate));
  }
  for (const auto& [reason, stops] : tally.stops) {
    fmt::print("  {:<6}{} (first: {})\n", stops.scenes, reason, stops.first);
  }
  fmt::print(stderr, "{:.1f} s of processor time\n", tally.seconds);

  shrink_failures(tally);
  if (!tally.failures.empty()) {
    throw RunError(
        fmt::format("{} of {} scenes broke a promise", tally.failures.size(), tally.scenes));
  }
  // What starts in touch mostly ends in a contact that lasts, and balls that lose energy collapse
  // in clusters: stops are what is right there.
  const bool few_stop = survey.kind == SceneKind::any || survey.kind == SceneKind::shapes;
  if (few_stop && static_cast<double>(tally.of(Fate::stopped)) >
                      most_stops * static_cast<double>(tally.scenes)) {
    throw RunError(fmt::format("more than {} % of the scenes stopped", 100.0 * most_stops));
  }
}

}  // namespace

void add_random_scenes_command(Command& app) {
  const auto command = std::make_shared<RandomScenesCommand>();
  Command random = app.add_subcommand(
      "random-scenes", "Run random valid scenes, watch for NaN, overlap, hangs; shrink what fails");
  random.add_option("--count", command->survey.count, "how many")
      .check(whole_number(1, 1000000000))
      .capture_default_str();
  random.add_option("--seed", command->survey.seed, "of the scenes")
      .check(seed_number())
      .capture_default_str();
  random.add_option("--first", command->survey.first, "number of the first one")
      .check(whole_number(0, std::uint64_t{1} << 62))
      .capture_default_str();
  std::vector<Argument> kinds;
  const auto flag = [&](SceneKind of, const std::string& what) {
    kinds.push_back(random.add_flag(fmt::format("--{}", to_string(of)), command->asked[of], what));
  };
  flag(SceneKind::shapes,
       "scenes of all shapes: capsules, cylinders, cones, hulls, compounds, height fields, meshes");
  flag(SceneKind::touching,
       "scenes that start in touch, or come to it: stacks, rows, grooves, corners, inclines, "
       "presses, inelastic clusters");
  flag(SceneKind::rough, "the same with friction between bodies, from none to rough");
  flag(SceneKind::jointed,
       "scenes of bodies on joints: pendulums, chains, doors, cradles, what slides on a rail");
  flag(SceneKind::balls,
       "scenes of many balls, some in a box that is repeated; each is run twice, with neighbours "
       "from cells and with every pair asked, to the same bits");
  for (std::size_t a = 0; a < kinds.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      kinds[a].excludes(kinds[b]);
    }
  }
  random
      .add_option("--threads", command->survey.threads,
                  "0: one per core; results do not depend on it")
      .check(whole_number(0, 1024))
      .capture_default_str();
  random
      .add_option("--out", command->out,
                  "folder: a summary, the scene files of failures, and the finished scenes, from "
                  "which the same command goes on when it was killed; without it, failures are "
                  "written here and nothing else is kept")
      .type_name("DIR")
      .check(some_path());
  random.add_flag("--print", command->print,
                  "only write these scenes to stdout, as scene files: --first N --count 1 --print");
  random.callback([command] {
    for (const auto& [kind, is_asked] : command->asked) {
      if (is_asked) {
        command->survey.kind = kind;
      }
    }
    command->run();
  });
}

}  // namespace kairos::experiments
