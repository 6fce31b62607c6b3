#include "core/reading/scene_reader.hpp"
#include "experiments/bench/bench.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace kairos::experiments {
namespace {

/// Of the box that the balls fill.
constexpr double fraction = 0.1;
/// Impacts of one run, at least about so many: fewer are over too soon to be timed.
constexpr double least_impacts = 40'000.0;

double radius_of(std::size_t balls) {
  return std::cbrt(fraction * 3.0 / (4.0 * std::numbers::pi * static_cast<double>(balls)));
}

Model gas(std::size_t balls, std::string_view broad_phase) {
  ModelOptions options;
  options.broad_phase = broad_phase;
  return Model(read_scene(find_scene("gas"),
                          {{"many.ball.count", fmt::format("{}", balls)},
                           {"many.ball.radius", fmt::format("{:.17g}", radius_of(balls))}}),
               options);
}

/// Most that the process has held so far, bytes.
double most_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

struct GasRun {
  std::int64_t impacts = 0;
  double seconds = std::numeric_limits<double>::infinity();  ///< of the processor, least of all
  double simulated = 0.0;                                    ///< s
  double queries = 0.0;                                      ///< of the detector, per impact
};

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

/// Once through, nobody looking in between; the first launch and predictions are part of it.
void run_once(const Model& model, double duration, GasRun& run) {
  const RunChoice choice{.frames = FixedFrames{duration}, .duration = duration};
  Recorder nobody;
  const double start = processor_seconds();
  const RunResult result = simulate(model, choice, nobody);
  run.seconds = std::min(run.seconds, processor_seconds() - start);
  run.impacts = result.cost.impacts;
  run.simulated = result.end.seconds;
  run.queries = static_cast<double>(result.cost.toi_queries) /
                static_cast<double>(std::max<std::int64_t>(run.impacts, 1));
}

}  // namespace

void bench_gas(std::vector<std::size_t> counts, int rounds) {
  std::sort(counts.begin(), counts.end());
  fmt::print(
      "A gas of hard balls, fraction {}, from impact to impact, proven; processor time, the least "
      "of {} rounds in turn\n  {:>9} {:<14}{:>10}{:>14}{:>16}{:>18}{:>16}\n",
      fraction, rounds, "balls", "broad phase", "impacts", "thousand a s", "queries each",
      "s a simulated s", "bytes a ball");
  const double before = most_memory();
  for (const std::size_t balls : counts) {
    // A ball has some 1 / (2 r) impacts a second at this fraction, its speed being about 1.6 m/s.
    const double r = radius_of(balls);
    const double a_second = 0.25 * static_cast<double>(balls) / r;
    const double duration = std::max(8.0 * r, least_impacts / a_second);
    constexpr std::size_t too_many_for_a_tree = 10'000;
    std::vector<std::string_view> names{"cells"};
    if (balls <= too_many_for_a_tree) {
      names.emplace_back("dynamic-tree");
    }
    std::vector<GasRun> runs(names.size());
    double bytes = 0.0;
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t k = 0; k < names.size(); ++k) {
        const Model model = gas(balls, names[k]);
        run_once(model, duration, runs[k]);
        if (round == 0 && k == 0) {
          bytes = (most_memory() - before) / static_cast<double>(balls);
        }
      }
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      const GasRun& run = runs[k];
      fmt::print("  {:>9} {:<14}{:>10}{:>14.1f}{:>16.2f}{:>18.3f}{:>16}\n", balls, names[k],
                 run.impacts, 1e-3 * static_cast<double>(run.impacts) / run.seconds, run.queries,
                 run.seconds / run.simulated, k == 0 ? fmt::format("{:.0f}", bytes) : "");
    }
  }
}

}  // namespace kairos::experiments
