#include "experiments/accuracy/accuracy.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace kairos::experiments {

namespace {

/// The peers keep a shape of their own for each of ours.
constexpr std::size_t most_shape_pairs = std::size_t{1} << 14U;

struct BenchCommand {
  std::string name;
  int rounds = 3;
  int rallies = 200;
  std::size_t pairs = std::size_t{1} << 18;  // more than a branch predictor learns
  std::vector<std::size_t> balls{64, 512, 4096};
  std::vector<std::size_t> boxes{64, 512};
  bool kinds = false;
  AccuracyOptions accuracy;

  void run() const {
    if (name == "accuracy") {
      const std::size_t broken = measure_accuracy(accuracy);
      if (broken > 0) {
        throw RunError(fmt::format("{} answers break a promise", broken));
      }
      return;
    }
    if (name == "gas") {
      bench_gas(balls, boxes, rounds, kinds);
      return;
    }
    if (name == "contact") {
      bench_contact(rounds);
      return;
    }
    if (name == "vfee") {
      bench_vfee(pairs, rounds);
      return;
    }
    if (name == "meshes") {
      bench_meshes(rounds);
      return;
    }
    if (name == "shapes") {
      bench_shapes(std::min(pairs, most_shape_pairs), rounds);
      return;
    }
    if (name == "bats") {
      bench_bats(rallies);
      return;
    }
    if (name != "ccd") {
      bench_stepping(rounds);
    }
    if (name != "bounce") {
      bench_queries(pairs, rounds);
    }
  }
};

}  // namespace

void add_bench_command(Command& app) {
  const auto options = std::make_shared<BenchCommand>();
  Command bench = app.add_subcommand(
      "bench", "Time it: ratios within one run, interleaved, the least of several rounds");
  bench
      .add_option("name", options->name,
                  "bounce, ccd, contact, vfee, meshes, shapes, bats or gas: times; without it the "
                  "first two; accuracy: answers against a reference")
      .one_of({"bounce", "ccd", "contact", "vfee", "meshes", "shapes", "bats", "gas", "accuracy"});
  bench.add_option("--rounds", options->rounds, "how often each is timed")
      .check(whole_number(1, 1000))
      .capture_default_str();
  bench
      .add_option("--pairs", options->pairs,
                  "ccd, vfee, shapes (at most 16384): how many distinct pairs")
      .check(whole_number(1, 1 << 22))
      .capture_default_str();
  bench.add_option("--rallies", options->rallies, "bats: how many")
      .check(whole_number(1, 100'000))
      .capture_default_str();
  bench.add_option("--balls", options->balls, "gas: how many, one gas for each number")
      .check(whole_number(2, 10'000'000))
      .type_name("N...")
      .capture_default_str();
  bench.add_option("--boxes", options->boxes, "gas: how many boxes, one gas for each number")
      .check(whole_number(2, 10'000'000))
      .type_name("N...")
      .capture_default_str();
  bench.add_flag(
      "--kinds", options->kinds,
      "gas: also under gravity, of radii from 1 to 2, of both, and at a fraction of .49");
  AccuracyOptions& accuracy = options->accuracy;
  bench.add_option("--queries", accuracy.queries, "accuracy: how many")
      .check(whole_number(1, 1'000'000'000))
      .capture_default_str();
  bench.add_option("--seed", accuracy.seed, "accuracy: of the queries")
      .check(seed_number())
      .capture_default_str();
  bench.add_option("--detector", accuracy.detectors, "accuracy: these only").type_name("D...");
  bench
      .add_option("--judge-every", accuracy.judge_every,
                  "accuracy: hold only one in N against the reference")
      .check(whole_number(1, 1'000'000'000))
      .type_name("N");
  bench.add_option("--threads", accuracy.threads, "accuracy: how many (default: one per core)")
      .check(whole_number(0, 1024));
  bench.add_option("--out", accuracy.out, "accuracy: folder for accuracy.csv and queries.csv")
      .type_name("DIR")
      .check(some_path());
  bench.add_flag("--force", accuracy.force, "accuracy: replace files that are not its own");
  bench.callback([options] { options->run(); });
}

}  // namespace kairos::experiments
