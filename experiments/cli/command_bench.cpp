#include "experiments/bench/bench.hpp"
#include "experiments/cli/commands.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace kairos::experiments {

void add_bench_command(CLI::App& app) {
  struct BenchCommand {
    std::string name;
    int rounds = 3;
    std::size_t pairs = std::size_t{1} << 18;  // more than a branch predictor learns
  };
  const auto options = std::make_shared<BenchCommand>();
  CLI::App* bench = app.add_subcommand(
      "bench", "Time it: ratios within one run, interleaved, the least of several rounds");
  bench->add_option("name", options->name, "bounce or ccd; without it both")
      ->check(CLI::IsMember({"bounce", "ccd"}));
  bench->add_option("--rounds", options->rounds, "how often each is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  bench->add_option("--pairs", options->pairs, "ccd: how many distinct pairs")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 22))
      ->capture_default_str();
  bench->callback([options] {
    if (options->name != "ccd") {
      bench_stepping(options->rounds);
    }
    if (options->name != "bounce") {
      bench_queries(options->pairs, options->rounds);
    }
  });
}

}  // namespace kairos::experiments
