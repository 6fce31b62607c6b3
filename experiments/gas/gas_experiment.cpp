#include "experiments/gas/gas_experiment.hpp"

#include "core/reading/scene_reader.hpp"
#include "experiments/gas/hard_sphere_theory.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/tradeoff/measured_run.hpp"
#include "simulation/gas_averages.hpp"
#include "simulation/penetration.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {
namespace {

constexpr std::array<double, 3> fractions{0.1, 0.3, 0.45};

/// How much of it is done.
struct Amount {
  std::int64_t balls;
  std::int64_t blocks;
  std::int64_t boxes;
  std::int64_t balls_between_walls;
};
constexpr Amount quick{2048, 12, 216, 64};
constexpr Amount full{10976, 40, 1000, 512};

double radius_of(double fraction, std::int64_t balls) {
  return std::cbrt(fraction * 3.0 / (4.0 * std::numbers::pi * static_cast<double>(balls)));
}

/// The shipped scene with other numbers.
Model periodic_gas(double fraction, std::int64_t balls) {
  return Model(
      read_scene(find_scene("gas-periodic"),
                 {{"many.ball.count", fmt::format("{}", balls)},
                  {"many.ball.radius", fmt::format("{:.17g}", radius_of(fraction, balls))}}));
}

/// A sixth of the slope of the mean square way from `from` (s) on, by least squares.
double diffusion(const GasBlock& block, const std::vector<double>& times, double from) {
  double n = 0.0;
  double t = 0.0;
  double w = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (times[k] >= from) {
      n += 1.0;
      t += times[k];
      w += block.way[k];
    }
  }
  double up = 0.0;
  double down = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (times[k] >= from) {
      up += (times[k] - t / n) * (block.way[k] - w / n);
      down += (times[k] - t / n) * (times[k] - t / n);
    }
  }
  return up / (6.0 * down);
}

struct Fluid {
  std::vector<Cell> row;
  std::vector<std::vector<Cell>> pairs;
  std::string status;
};

/// Blocks of 40 mean free times, each looked at 80 times, after 100 in which the lattice is
/// forgotten; diffusion from 15 of them on, when a ball has forgotten its velocity.
Fluid measure_fluid(double fraction, const Amount& amount) {
  constexpr double looks_a_free_time = 2.0;
  constexpr double free_times_a_block = 40.0;
  constexpr double free_times_skipped = 100.0;
  constexpr double forgotten = 15.0;
  const Model model = periodic_gas(fraction, amount.balls);
  HardSpheres theory{.fraction = fraction, .diameter = 2.0 * radius_of(fraction, amount.balls)};
  // The temperature that the drawn velocities have.
  const auto n = static_cast<double>(amount.balls);
  Vector3 drift = Vector3::Zero();
  double squares = 0.0;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    drift += model.body(i).initial.twist.linear / n;
    squares += model.body(i).initial.twist.linear.squaredNorm();
  }
  theory.kT = (squares - n * drift.squaredNorm()) / (3.0 * (n - 1.0));
  const double free_time = theory.mean_free_time();
  const double frame = free_time / looks_a_free_time;
  const auto frames_a_block = static_cast<std::int64_t>(free_times_a_block * looks_a_free_time);
  const auto skipped = static_cast<std::int64_t>(free_times_skipped * looks_a_free_time);
  GasAverages averages({.skipped_frames = skipped,
                        .frames_a_block = frames_a_block,
                        .greatest_distance = 3.0 * theory.diameter,
                        .distances = 120});
  const RunChoice choice{
      .frames = FixedFrames{frame},
      .duration = frame * static_cast<double>(skipped + frames_a_block * amount.blocks)};
  const RunResult result = simulate(model, choice, averages);
  std::vector<double> pressures;
  std::vector<double> free_times;
  std::vector<double> diffusions;
  std::int64_t impacts = 0;
  for (const GasBlock& block : averages.blocks()) {
    pressures.push_back(1.0 + block.virial / (3.0 * n * theory.kT * block.duration));
    free_times.push_back(n * block.duration / (2.0 * static_cast<double>(block.impacts)));
    diffusions.push_back(diffusion(block, averages.times(), forgotten * free_time));
    impacts += block.impacts;
  }
  const BlockMean z = block_mean(pressures);
  const BlockMean t = block_mean(free_times);
  const BlockMean d = block_mean(diffusions);
  // Enskog's time with the density of pairs at contact that the better equation of state tells.
  const double better_time =
      free_time * (theory.carnahan_starling() - 1.0) / (theory.kolafa() - 1.0);
  Fluid fluid;
  fluid.status = result.status == RunStatus::completed ? "completed" : result.reason;
  fluid.row = {number_cell(fraction),
               amount.balls,
               impacts,
               number_cell(z.mean),
               number_cell(z.error),
               number_cell(theory.carnahan_starling()),
               number_cell(theory.kolafa()),
               number_cell(t.mean),
               number_cell(t.error),
               number_cell(free_time),
               number_cell(better_time),
               number_cell(d.mean),
               number_cell(d.error),
               number_cell(theory.enskog_diffusion()),
               number_cell(theory.speedy_diffusion() - theory.diffusion_lost_in_box(1.0)),
               number_cell(theory.speedy_diffusion()),
               number_cell(result.ledger.unexplained() / result.ledger.kinetic()),
               fluid.status};
  const std::vector<std::int64_t>& pairs = averages.pairs();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double width = 3.0 * theory.diameter / static_cast<double>(pairs.size());
    const double low = width * static_cast<double>(k);
    const double shell =
        4.0 / 3.0 * std::numbers::pi * (std::pow(low + width, 3) - std::pow(low, 3));
    const double expected =
        0.5 * n * (n - 1.0) * shell * static_cast<double>(averages.blocks().size());
    fluid.pairs.push_back({number_cell(fraction),
                           number_cell((low + 0.5 * width) / theory.diameter),
                           number_cell(static_cast<double>(pairs[k]) / expected)});
  }
  return fluid;
}

/// Boxes start without turning; in the end each way of moving has the same energy.
std::vector<std::vector<Cell>> measure_shares(std::int64_t boxes, std::string& status) {
  const double room = 0.22 * std::cbrt(static_cast<double>(boxes));
  const Scene scene = parse_scene(
      fmt::format("duration = {0}\nG = 0.0\n[periodic]\nmin = [0, 0, 0]\nmax = [{1}, {1}, {1}]\n"
                  "[[many]]\nname = \"box\"\nentity = \"body\"\ncount = {2}\nmass = 1.0\n"
                  "half_extents = [0.04, 0.05, 0.06]\norientations = \"random\"\n"
                  "velocity_deviation = 1.0\nregion = {{min = [0, 0, 0], max = [{1}, {1}, {1}]}}\n",
                  4.0, room, boxes),
      "boxes");
  const Model model(scene);
  constexpr double frame = 0.02;
  GasAverages averages({.frames_a_block = 10});
  const RunChoice choice{.frames = FixedFrames{frame}, .duration = 4.0};
  const RunResult result = simulate(model, choice, averages);
  status = result.status == RunStatus::completed ? "completed" : result.reason;
  std::vector<std::vector<Cell>> rows;
  std::int64_t impacts = 0;
  double t = 0.0;
  const double half_of_all = 1.0 / static_cast<double>(boxes);
  for (const GasBlock& block : averages.blocks()) {
    impacts += block.impacts;
    t += block.duration;
    // The centre of mass takes three of the translations.
    const double degrees = 3.0 * static_cast<double>(boxes - 1);
    rows.push_back({boxes, number_cell(t - 0.5 * block.duration),
                    number_cell(2.0 * static_cast<double>(impacts) * half_of_all),
                    number_cell(2.0 * block.kinetic / degrees),
                    number_cell(2.0 * block.spin.x() * half_of_all),
                    number_cell(2.0 * block.spin.y() * half_of_all),
                    number_cell(2.0 * block.spin.z() * half_of_all)});
  }
  return rows;
}

/// Counts what is wrong in the frames of a run.
class FrameFaults : public Recorder {
 public:
  void begin(const Model& model) override { probe_ = std::make_unique<PenetrationProbe>(model); }
  void frame(const Frame& frame) override {
    const auto found = probe_->deepest(frame.bodies);
    const double depth = found ? found->depth : 0.0;
    deepest = std::max(deepest, depth);
    ++frames;
    inside += found ? 1 : 0;
    energy = frame.ledger.kinetic();
    first = frames == 1 ? energy : first;
  }
  double deepest = 0.0;
  double first = 0.0;
  double energy = 0.0;
  std::int64_t frames = 0;
  std::int64_t inside = 0;

 private:
  std::unique_ptr<PenetrationProbe> probe_;
};

struct SchemeCase {
  std::string_view scheme;
  double way = 1.0;  ///< of a ball in a frame, at the mean speed, in radii
};

std::vector<SchemeCase> scheme_cases() {
  std::vector<SchemeCase> cases{{"event-driven", 1.0}};
  for (const std::string_view scheme : {"original", "substepped", "pgs", "penalty"}) {
    for (const double way : {1.0, 0.3, 0.1, 0.03, 0.01}) {
      cases.push_back({scheme, way});
    }
  }
  return cases;
}

RunChoice choice_of(const SchemeCase& scheme, double radius) {
  constexpr double mean_speed = 1.6;  // m/s: sqrt(8 kT / (pi m))
  RunChoice choice;
  choice.method.scheme = scheme.scheme;
  choice.stepping.restitution_threshold = 0.0;  // m/s: pgs then rebounds at all speeds
  if (scheme.scheme == "original" || scheme.scheme == "substepped") {
    choice.method.detector = "sat";
  }
  choice.frames = FixedFrames{scheme.way * radius / mean_speed};
  choice.duration = 1.0;
  return choice;
}

/// The walls that the shipped scene has, a tenth of the room filled.
Model gas_between_walls(std::int64_t balls) {
  return Model(read_scene(find_scene("gas"),
                          {{"many.ball.count", fmt::format("{}", balls)},
                           {"many.ball.radius", fmt::format("{:.17g}", radius_of(0.1, balls))}}));
}

void compare_schemes(const Amount& amount, std::size_t threads, ProgramOutput& output) {
  const std::int64_t balls = amount.balls_between_walls;
  const Model model = gas_between_walls(balls);
  const double radius = radius_of(0.1, balls);
  const std::vector<SchemeCase> cases = scheme_cases();
  Table table{{"scheme", "way", "balls", "status", "frames", "energy_ratio", "deepest",
               "share_inside", "queries", "impacts"},
              {}};
  table.rows.resize(cases.size());
  parallel_for(cases.size(), threads, [&](std::size_t k) {
    FrameFaults faults;
    const RunResult result = simulate(model, choice_of(cases[k], radius), faults);
    table.rows[k] = {
        std::string(cases[k].scheme),
        number_cell(cases[k].way),
        balls,
        std::string(result.status == RunStatus::completed ? "completed" : "stopped"),
        faults.frames,
        number_cell(faults.energy / faults.first),
        number_cell(faults.deepest / radius),
        number_cell(static_cast<double>(faults.inside) / static_cast<double>(faults.frames)),
        result.cost.overlap_tests + result.cost.toi_evaluations,
        result.cost.impacts};
  });
  output.runs += cases.size();
  for (const auto& row : table.rows) {
    output.failed += std::get<std::string>(row[3]) == "completed" ? 0 : 1;
  }
  output.tables.emplace_back("schemes", std::move(table));
  // Runs are timed one after the other, alone on the machine.
  Table timings{{"scheme", "way", "seconds"}, {}};
  for (const SchemeCase& scheme : cases) {
    timings.rows.push_back({std::string(scheme.scheme), number_cell(scheme.way),
                            time_run(model, choice_of(scheme, radius))});
  }
  output.timings = std::move(timings);
}

}  // namespace

ProgramOutput run_gas(const ExperimentSpec& /*spec*/, Size size, std::size_t threads) {
  const Amount& amount = size == Size::full ? full : quick;
  ProgramOutput output;
  std::array<Fluid, fractions.size()> fluids;
  std::string status;
  std::vector<std::vector<Cell>> shares;
  parallel_for(fluids.size() + 1, threads, [&](std::size_t k) {
    if (k < fluids.size()) {
      fluids[k] = measure_fluid(fractions[k], amount);
    } else {
      shares = measure_shares(amount.boxes, status);
    }
  });
  Table fluid{{"fraction", "balls", "impacts", "pressure", "pressure_error", "carnahan_starling",
               "kolafa", "free_time", "free_time_error", "enskog_time", "enskog_time_kolafa",
               "diffusion", "diffusion_error", "enskog_diffusion", "speedy_in_box", "speedy",
               "energy_unexplained", "status"},
              {}};
  Table pairs{{"fraction", "distance", "pair_distribution"}, {}};
  for (Fluid& one : fluids) {
    output.failed += one.status == "completed" ? 0 : 1;
    fluid.rows.push_back(std::move(one.row));
    pairs.rows.insert(pairs.rows.end(), one.pairs.begin(), one.pairs.end());
  }
  output.failed += status == "completed" ? 0 : 1;
  output.runs = fluids.size() + 1;
  output.tables.emplace_back("fluid", std::move(fluid));
  output.tables.emplace_back("pairs", std::move(pairs));
  output.tables.emplace_back(
      "shares", Table{{"boxes", "t", "impacts_a_box", "translation", "spin_x", "spin_y", "spin_z"},
                      std::move(shares)});
  compare_schemes(amount, threads, output);
  output.shown = {"fluid", "schemes"};
  return output;
}

}  // namespace kairos::experiments
