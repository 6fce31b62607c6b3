#include "core/reading/scene_reader.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/bench/gas_halves.hpp"
#include "experiments/bench/gas_peers.hpp"
#include "experiments/processor_time.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace kairos::experiments {
namespace {

/// Part of the room that the balls fill.
constexpr double fraction = 0.1;
/// A run has about so many impacts at least: fewer are over too soon to be timed.
constexpr double least_impacts = 40'000.0;

/// Radius of so many equal balls that fill this part of the room, m.
double radius_of(std::size_t balls, double part = fraction) {
  return std::cbrt(part * 3.0 / (4.0 * std::numbers::pi * static_cast<double>(balls)));
}

/// In what a gas differs from the plain one.
struct GasKind {
  std::string_view name;
  double part = fraction;  ///< of the room that the balls fill
  std::size_t least = 0;   ///< fewer balls are not placed between walls so densely
  bool falls = false;      ///< under 1 m/s^2: the room is then as high as the gas would be deep
  bool sizes = false;      ///< radii uniform from one to two
};

constexpr std::array<GasKind, 4> kinds{{{.name = "gravity", .falls = true},
                                        {.name = "radii 1:2", .sizes = true},
                                        {.name = "both", .falls = true, .sizes = true},
                                        {.name = "fraction .49", .part = 0.49, .least = 500}}};

Scene gas_scene(std::size_t balls, const GasKind& kind = {}) {
  // The mean of x^3 for x uniform from 1 to 2.
  constexpr double mean_volume = 15.0 / 4.0;
  const double radius = radius_of(balls, kind.part) / (kind.sizes ? std::cbrt(mean_volume) : 1.0);
  return read_scene(find_scene("gas"), {{"many.ball.count", fmt::format("{}", balls)},
                                        {"many.ball.radius", fmt::format("{:.17g}", radius)},
                                        {"many.ball.sizes", kind.sizes ? "[1.0, 2.0]" : "[1, 1]"},
                                        {"G", kind.falls ? "1.0" : "0.0"}});
}

Model gas(std::size_t balls, std::string_view broad_phase, const GasKind& kind = {}) {
  ModelOptions options;
  options.broad_phase = broad_phase;
  return Model(gas_scene(balls, kind), options);
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

/// The memory that is allocated now, bytes.
double memory_now() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
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
    const EnergyLedger& ledger = frame.ledger;
    const double now = ledger.kinetic() + ledger.potential();
    if (!first) {
      first = now;
      kinetic = ledger.kinetic();
    }
    energy_error = (now - *first) / kinetic;
  }
  double least_gap = std::numeric_limits<double>::infinity();  ///< m
  double energy_error = 0.0;  ///< of all, as a part of the kinetic energy at the start

 private:
  std::optional<double> first;
  double kinetic = 0.0;
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

/// How long such a gas runs, s: `rounds_each` times a ball goes some diameters, and at least so
/// long that there is enough to be timed.
double duration_of(std::size_t balls, double part = fraction) {
  // A ball has some 1 / (2 r) impacts a second at this fraction, its speed being about 1.6 m/s.
  const double r = radius_of(balls);
  const double a_second = 0.25 * static_cast<double>(balls) / r * (part / fraction);
  return std::max(8.0 * r * (fraction / part), least_impacts / a_second);
}

/// Watches what the frames of a run take.
class Upkeep : public Recorder {
 public:
  void frame(const Frame& frame) override {
    (void)frame;
    if (++frames == counted_from) {
      first = processor_seconds();
    }
    last = processor_seconds();
    memory = std::max(memory, memory_now());
  }
  [[nodiscard]] double a_frame() const { return (last - first) / (frames - counted_from); }

  double memory = 0.0;  ///< the most that was allocated, bytes

 private:
  static constexpr int counted_from = 3;  // what is made once is made by then
  int frames = 0;
  double first = 0.0;
  double last = 0.0;
};

/// What a gas takes beside its impacts: to be read, to be kept, to be drawn.
void print_upkeep(std::size_t balls) {
  const auto n = static_cast<double>(balls);
  // The clock of the processor's time ticks some milliseconds apart: what is shorter is repeated.
  constexpr double enough = 400'000.0;
  const double repeats = std::ceil(enough / n);
  double reading = 0.0;
  double building = 0.0;
  for (int k = 0; k < static_cast<int>(repeats); ++k) {
    const double start = processor_seconds();
    Scene scene = gas_scene(balls);
    const double read = processor_seconds();
    const Model model(std::move(scene));
    reading += read - start;
    building += processor_seconds() - read;
  }
  const double before = memory_now();
  const Model model(gas_scene(balls));
  const double kept = memory_now() - before;

  Upkeep upkeep;
  // So short that next to nothing strikes.
  const double frames = 40.0 * repeats;
  const double duration = 1e-4 * radius_of(balls);
  (void)simulate(model, {.frames = FixedFrames{duration / frames}, .duration = duration}, upkeep);
  fmt::print(
      "  {:>9} a ball takes {:.2f} us to be read and {:.2f} us in the model, {:.0f} bytes "
      "there and {:.0f} in the run, {:.0f} ns a frame\n",
      balls, 1e6 * reading / (repeats * n), 1e6 * building / (repeats * n), kept / n,
      (upkeep.memory - kept - before) / n, 1e9 * upkeep.a_frame() / n);
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

void print_row(std::size_t bodies, std::string_view name, const GasRun& run,
               const std::string& last) {
  fmt::print("  {:>9} {:<14}{:>10}{:>14.1f}{:>14.2f}{:>17.3f}{:>13.1e}{:>14}{:>10.1e}\n", bodies,
             name, run.impacts, 1e-3 * static_cast<double>(run.impacts) / run.seconds, run.queries,
             run.seconds / run.simulated, run.least_gap, last, run.energy_error);
}

/// The gases that are not plain, of so many balls, in turn.
void print_kinds(std::size_t balls, int rounds) {
  std::array<GasRun, kinds.size()> runs;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      if (balls >= kinds[k].least) {
        run_once(gas(balls, "cells", kinds[k]), duration_of(balls, kinds[k].part), runs[k]);
      }
    }
  }
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (balls >= kinds[k].least) {
      print_row(balls, kinds[k].name, runs[k], "");
    }
  }
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
  print_row(boxes, "cells", run, fmt::format("{:.1f}", run.segments));
}

}  // namespace

void bench_gas(std::vector<std::size_t> counts, const std::vector<std::size_t>& boxes, int rounds,
               bool with_kinds) {
  std::sort(counts.begin(), counts.end());
  fmt::print(
      "A gas of hard balls, fraction {}, from impact to impact, proven; processor time, the least "
      "of {} rounds in turn\n  {:>9} {:<14}{:>10}{:>14}{:>14}{:>17}{:>13}{:>14}{:>10}\n",
      fraction, rounds, "balls", "broad phase", "impacts", "thousand a s", "queries each",
      "s a simulated s", "least gap", "bytes a ball", "energy");
  const double hand_over = std::thread::hardware_concurrency() > 1 ? hand_over_seconds() : 0.0;
  const double before = most_memory();
  for (const std::size_t balls : counts) {
    const double duration = duration_of(balls);
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
      print_row(balls, names[k], runs[k], k == 0 ? fmt::format("{:.0f}", bytes) : "");
    }
    if (with_kinds) {
      print_kinds(balls, rounds);
    }
    print_upkeep(balls);
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
