#include "core/reading/scene_reader.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/bench/gas_halves.hpp"
#include "experiments/bench/gas_peers.hpp"
#include "experiments/processor_time.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <thread>

namespace kairos::experiments {
namespace {

/// Part of the room that the balls fill.
constexpr double fraction = 0.1;
/// A run has about so many impacts at least: fewer are over too soon to be timed.
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

/// Tumbling boxes of 4 : 5 : 6 that fill the same part of the same room.
Model box_gas(std::size_t boxes) {
  const double unit = std::cbrt(fraction / (960.0 * static_cast<double>(boxes)));
  std::string text = fmt::format(
      "duration = 2.0\nG = 0.0\n[[many]]\nname = \"box\"\nentity = \"body\"\ncount = {}\n"
      "mass = 1.0\nhalf_extents = [{:.17g}, {:.17g}, {:.17g}]\norientations = \"random\"\n"
      "velocity_deviation = 1.0\nangular_velocity_deviation = {:.17g}\n"
      "region = {{min = [0, 0, 0], max = [1, 1, 1]}}\n",
      boxes, 4.0 * unit, 5.0 * unit, 6.0 * unit, 0.1 / unit);
  for (std::size_t side = 0; side < 6; ++side) {
    std::array<int, 3> normal{};
    normal[side / 2] = side % 2 == 0 ? 1 : -1;
    const int at = side % 2 == 0 ? 0 : 1;
    text += fmt::format(
        "[[body]]\nname = \"wall {0}\"\nentity = \"wall\"\nshape = \"half-space\"\n"
        "position = [{1}, {1}, {1}]\nnormal = [{2}, {3}, {4}]\n",
        side, at, normal[0], normal[1], normal[2]);
  }
  return Model(parse_scene(text, "boxes"));
}

/// The most memory that the process has held so far, bytes.
double most_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Watches a run at every impact and at its end.
class Watch : public Recorder {
 public:
  void event(const Event& event) override { least_gap = std::min(least_gap, event.contact.gap); }
  void frame(const Frame& frame) override {
    const double now = frame.ledger.kinetic();
    first = first > 0.0 ? first : now;
    energy_error = now / first - 1.0;
  }
  double least_gap = std::numeric_limits<double>::infinity();  ///< m
  double energy_error = 0.0;  ///< of the kinetic energy, as a part of it

 private:
  double first = 0.0;
};

struct GasRun {
  std::int64_t impacts = 0;
  double seconds = std::numeric_limits<double>::infinity();  ///< of the processor, least of all
  double simulated = 0.0;                                    ///< s
  double queries = 0.0;                                      ///< of the detector, per impact
  double segments = 0.0;                                     ///< of motions, per impact
  double least_gap = 0.0;                                    ///< at an impact, m
  double energy_error = 0.0;                                 ///< a part of all
};

/// Runs once without a watcher; the first launch and predictions are part of the time.
void run_once(const Model& model, double duration, GasRun& run) {
  const RunChoice choice{.frames = FixedFrames{duration}, .duration = duration};
  Watch watch;
  const double start = processor_seconds();
  const RunResult result = simulate(model, choice, watch);
  run.seconds = std::min(run.seconds, processor_seconds() - start);
  run.impacts = result.cost.impacts;
  run.simulated = result.end.seconds;
  run.queries = static_cast<double>(result.cost.toi_queries) /
                static_cast<double>(std::max<std::int64_t>(run.impacts, 1));
  run.segments = static_cast<double>(result.cost.steps) /
                 static_cast<double>(std::max<std::int64_t>(run.impacts, 1));
  run.least_gap = watch.least_gap;
  run.energy_error = watch.energy_error;
}

/// The balls that a model has, without its walls.
State balls_of(const Model& model) {
  State all = model.initial_state();
  State balls;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (model.is_free(i)) {
      balls.push_back(all[i]);
    }
  }
  return balls;
}

/// ODE with the same balls, in steps in which a ball goes a radius, and a tenth of one.
void print_ode(std::size_t balls) {
  constexpr double mean_speed = 1.6;  // m/s
  constexpr double most_steps = 3000.0;
  const Model model = gas(balls, "cells");
  const State start = balls_of(model);
  const double radius = radius_of(balls);
  for (const double way : {1.0, 0.1}) {
    const double frame = way * radius / mean_speed;
    const double duration = std::min(0.5, most_steps * frame);
    if (const auto outcome =
            ode_gas({.start = start, .radius = radius, .duration = duration, .frame = frame})) {
      fmt::print(
          "  {:>9} ODE, quick step, {:.1f} radii a step: {:.3f} s a simulated s, energy {:+.2g}, "
          "deepest {:.3f} radii\n",
          balls, way, outcome->seconds / duration, outcome->energy_ratio - 1.0,
          outcome->deepest / radius);
    }
  }
}

/// What a second core could do for such a run; 0: there is no second one.
void print_halves(std::size_t balls, double duration, const GasRun& run, double hand_over) {
  if (!(hand_over > 0.0)) {
    return;
  }
  GasHalves halves;
  const RunChoice choice{.frames = FixedFrames{duration}, .duration = duration};
  (void)simulate(gas(balls, "cells"), choice, halves);
  const double impact = run.seconds / static_cast<double>(std::max<std::int64_t>(run.impacts, 1));
  fmt::print(
      "  {:>9} two cores, at best: {:.2f} times as fast were handing over for nothing, {:.2f} as "
      "it "
      "takes {:.2f} us (every {:.0f} impacts)\n",
      balls, halves.speedup(impact, 0.0), halves.speedup(impact, hand_over), 1e6 * hand_over,
      static_cast<double>(halves.impacts()) /
          static_cast<double>(std::max<std::int64_t>(halves.across(), 1)));
}

void print_boxes(std::size_t boxes, int rounds) {
  constexpr double least_box_impacts = 4000.0;
  const auto n = static_cast<double>(boxes);
  const double a_second = 0.9 * n * std::cbrt(n);  // about as many impacts as balls have
  GasRun run;
  for (int round = 0; round < rounds; ++round) {
    const Model model = box_gas(boxes);
    run_once(model, std::max(least_box_impacts, n) / a_second, run);
  }
  fmt::print("  {:>9} {:<14}{:>10}{:>14.1f}{:>14.2f}{:>17.3f}{:>13.1e}{:>14.1f}{:>10.1e}\n", boxes,
             "cells", run.impacts, 1e-3 * static_cast<double>(run.impacts) / run.seconds,
             run.queries, run.seconds / run.simulated, run.least_gap, run.segments,
             run.energy_error);
}

}  // namespace

void bench_gas(std::vector<std::size_t> counts, const std::vector<std::size_t>& boxes, int rounds) {
  std::sort(counts.begin(), counts.end());
  fmt::print(
      "A gas of hard balls, fraction {}, from impact to impact, proven; processor time, the least "
      "of {} rounds in turn\n  {:>9} {:<14}{:>10}{:>14}{:>14}{:>17}{:>13}{:>14}{:>10}\n",
      fraction, rounds, "balls", "broad phase", "impacts", "thousand a s", "queries each",
      "s a simulated s", "least gap", "bytes a ball", "energy");
  const double hand_over = std::thread::hardware_concurrency() > 1 ? hand_over_seconds() : 0.0;
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
      fmt::print("  {:>9} {:<14}{:>10}{:>14.1f}{:>14.2f}{:>17.3f}{:>13.1e}{:>14}{:>10.1e}\n", balls,
                 names[k], run.impacts, 1e-3 * static_cast<double>(run.impacts) / run.seconds,
                 run.queries, run.seconds / run.simulated, run.least_gap,
                 k == 0 ? fmt::format("{:.0f}", bytes) : "", run.energy_error);
    }
    print_halves(balls, duration, runs.front(), hand_over);
    constexpr std::size_t too_many_for_ode = 10'000;
    if (balls <= too_many_for_ode) {
      print_ode(balls);
    }
  }
  if (!boxes.empty()) {
    fmt::print(
        "Tumbling boxes, the same way\n  {:>9} {:<14}{:>10}{:>14}{:>14}{:>17}{:>13}{:>14}{:>10}\n",
        "boxes", "broad phase", "impacts", "thousand a s", "queries each", "s a simulated s",
        "least gap", "segments each", "energy");
  }
  for (const std::size_t n : boxes) {
    print_boxes(n, rounds);
  }
}

}  // namespace kairos::experiments
