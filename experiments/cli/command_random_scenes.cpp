#include "experiments/cli/commands.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/random/scene_trial.hpp"
#include "experiments/run_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>

namespace kairos::experiments {
namespace {

/// At most this share of valid scenes may stop with a reason.
constexpr double most_stops = 0.05;

struct RandomScenesCommand {
  std::uint64_t count = 1000;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::size_t threads = 0;
  std::string out = ".";

  void run() const;
};

/// What all the trials came to.
struct Tally {
  std::map<Fate, std::uint64_t> fates;
  std::map<std::string, std::uint64_t> stops;  ///< by the word before the colon
  std::map<std::uint64_t, Trial> failures;     ///< by index
  std::int64_t impacts = 0;

  void add(std::uint64_t index, const Trial& trial) {
    ++fates[trial.fate];
    impacts += trial.impacts;
    if (trial.fate == Fate::stopped) {
      ++stops[trial.reason.substr(0, trial.reason.find(':'))];
    } else if (trial.failed()) {
      failures[index] = trial;
    }
  }
  [[nodiscard]] std::uint64_t of(Fate fate) const {
    const auto found = fates.find(fate);
    return found == fates.end() ? 0 : found->second;
  }
};

void RandomScenesCommand::run() const {
  const auto start = std::chrono::steady_clock::now();
  Tally tally;
  std::mutex mutex;
  {
    ProgressBar bar("random scenes", count);
    parallel_for(count, threads, [&](std::size_t i) {
      const Trial trial = try_scene(random_scene(seed, first + i));
      const std::lock_guard lock(mutex);
      tally.add(first + i, trial);
      bar.advance();
    });
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  fmt::print("scenes                {} (seed {}, numbers {} to {})\n", count, seed, first,
             first + count - 1);
  fmt::print("impacts               {}\n", tally.impacts);
  for (const Fate fate : {Fate::right, Fate::not_finite, Fate::overlap, Fate::ledger, Fate::hang,
                          Fate::invalid, Fate::stopped}) {
    fmt::print("{:<22}{}\n", to_string(fate), tally.of(fate));
  }
  for (const auto& [reason, n] : tally.stops) {
    fmt::print("  {:<20}{}\n", reason, n);
  }
  fmt::print(stderr, "{:.1f} s\n", seconds);

  constexpr std::size_t most_files = 10;
  std::size_t files = 0;
  for (const auto& [index, trial] : tally.failures) {
    fmt::print("scene {}: {} at {} s: {}\n", index, to_string(trial.fate), trial.time,
               trial.reason);
    if (files++ < most_files) {
      const RandomScene small = shrink(random_scene(seed, index), trial.fate);
      const std::string path =
          (std::filesystem::path(out) / fmt::format("random-{}-{}.toml", seed, index)).string();
      write_file(path,
                 fmt::format("# {}: {}\n{}", to_string(trial.fate), trial.reason, small.toml()));
      fmt::print("  shrunk to {} bodies: {}\n", small.bodies.size(), path);
    }
  }
  if (!tally.failures.empty()) {
    throw RunError(fmt::format("{} of {} scenes broke a promise", tally.failures.size(), count));
  }
  if (static_cast<double>(tally.of(Fate::stopped)) > most_stops * static_cast<double>(count)) {
    throw RunError(fmt::format("more than {} % of the scenes stopped", 100.0 * most_stops));
  }
}

}  // namespace

void add_random_scenes_command(CLI::App& app) {
  const auto command = std::make_shared<RandomScenesCommand>();
  CLI::App* random = app.add_subcommand(
      "random-scenes", "Run random valid scenes, watch for NaN, overlap, hangs; shrink what fails");
  random->add_option("--count", command->count, "how many")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  random->add_option("--seed", command->seed, "of the scenes")->capture_default_str();
  random->add_option("--first", command->first, "number of the first one")->capture_default_str();
  random->add_option("--threads", command->threads, "0: one per core; results do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  random->add_option("--out", command->out, "folder for the scene files of failures")
      ->type_name("DIR")
      ->capture_default_str();
  random->callback([command] { command->run(); });
}

}  // namespace kairos::experiments
