#include "experiments/realtime/realtime_experiment.hpp"

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/metrics/metrics.hpp"
#include "experiments/named_method.hpp"
#include "experiments/parallel_for.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

namespace kairos::experiments {
namespace {

constexpr double frame = 1.0 / 60.0;  // s: what the thesis' system had to keep

/// Seconds of work between one drawn frame and the next; gives up where real time is lost anyway.
class FrameClock : public Recorder {
 public:
  struct GivenUp {};
  void frame(const Frame& /*frame*/) override {
    const Clock::time_point now = Clock::now();
    if (since_) {
      seconds.push_back(std::chrono::duration<double>(now - *since_).count());
      total_ += seconds.back();
    }
    since_ = now;
    if (total_ > most) {
      throw GivenUp{};
    }
  }
  std::vector<double> seconds;

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double most = 3.0;  // s for one second of the scene
  double total_ = 0.0;
  std::optional<Clock::time_point> since_;
};

struct Measured {
  std::string status;
  std::vector<double> frames{};
  Cost cost{};
};

Measured one_second(const Model& model, RunChoice choice) {
  choice.duration = 1.0;
  choice.frames = FixedFrames{frame};
  FrameClock clock;
  Measured measured;
  try {
    const RunResult result = simulate(model, choice, clock);
    measured.status = result.status == RunStatus::completed ? "completed" : "stopped";
    measured.cost = result.cost;
  } catch (const FrameClock::GivenUp&) {
    measured.status = "given up";
  }
  measured.frames = std::move(clock.seconds);
  std::sort(measured.frames.begin(), measured.frames.end());
  return measured;
}

double quantile_of(const std::vector<double>& sorted, double p) {
  return sorted.empty()
             ? 0.0
             : sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))];
}

void measure_bodies(int most, ProgramOutput& output) {
  Table timings{{"bodies", "method", "status", "median_frame", "p99_frame", "worst_frame", "frames",
                 "keeps_60"},
                {}};
  const std::vector<NamedMethod> all = compared_methods();
  std::vector<bool> lost(all.size(), false);
  for (int n = 4; n <= most; n *= 4) {
    const Model model(parse_scene(gas_scene(n), "gas.toml"));
    for (std::size_t m = 0; m < all.size(); ++m) {
      if (lost[m]) {
        continue;  // fewer bodies were too many
      }
      const Measured run = one_second(model, all[m].choice);
      ++output.runs;
      const double p99 = quantile_of(run.frames, 0.99);
      const bool keeps = run.status == "completed" && p99 <= frame;
      lost[m] = run.status != "completed";
      timings.rows.push_back({std::int64_t{n}, std::string(all[m].name), run.status,
                              number_cell(quantile_of(run.frames, 0.5)), number_cell(p99),
                              number_cell(quantile_of(run.frames, 1.0)),
                              static_cast<std::int64_t>(run.frames.size()),
                              std::string(keeps ? "yes" : "no")});
    }
  }
  output.timings = std::move(timings);
}

/// The same, counted; where a method is given up depends on the machine, so few bodies are taken.
Table work_table(int most, std::size_t threads) {
  Table table{{"bodies", "method", "status", "right_hand_sides", "overlap_tests", "toi_evaluations",
               "work_a_frame"},
              {}};
  const std::vector<NamedMethod> all = compared_methods();
  std::vector<int> counts;
  for (int n = 4; n <= most; n *= 4) {
    counts.push_back(n);
  }
  table.rows.resize(counts.size() * all.size());
  parallel_for(table.rows.size(), threads, [&](std::size_t i) {
    const int n = counts[i / all.size()];
    const NamedMethod& method = all[i % all.size()];
    RunChoice choice = method.choice;
    choice.duration = 10.0 * frame;
    choice.frames = FixedFrames{frame};
    Recorder nobody;
    const RunResult result = simulate(Model(parse_scene(gas_scene(n), "gas.toml")), choice, nobody);
    const Cost& cost = result.cost;
    const auto work = cost.right_hand_sides + cost.overlap_tests + cost.toi_evaluations;
    table.rows[i] = {std::int64_t{n},
                     std::string(method.name),
                     std::string(result.status == RunStatus::completed ? "completed" : "stopped"),
                     cost.right_hand_sides,
                     cost.overlap_tests,
                     cost.toi_evaluations,
                     number_cell(static_cast<double>(work) / 10.0)};
  });
  return table;
}

/// Measures each scheme when a frame comes late.
Table stall_table(int repeats, std::size_t threads) {
  struct Setting {
    std::string_view name;
    double jitter, spikes;
  };
  constexpr std::array<Setting, 5> settings{{{"steady", 0.0, 0.0},
                                             {"jitter 20 %", 0.2, 0.0},
                                             {"jitter 50 %", 0.5, 0.0},
                                             {"1 in 50 takes ten", 0.0, 0.02},
                                             {"both", 0.5, 0.02}}};
  const std::vector<NamedMethod> all = compared_methods();
  const std::array<std::string_view, 2> scenes{"bounce", "bounce-inelastic"};
  const std::vector<std::string> metrics{"max_penetration", "overlap_time", "energy_error"};
  Table table{
      {"scene", "frames", "method", "runs", "max_penetration", "overlap_time", "energy_error"}, {}};
  table.rows.resize(scenes.size() * settings.size() * all.size());
  parallel_for(table.rows.size(), threads, [&](std::size_t i) {
    const NamedMethod& method = all[i % all.size()];
    const Setting& setting = settings[i / all.size() % settings.size()];
    const std::string scene(scenes[i / all.size() / settings.size()]);
    const Model model(read_scene(find_scene(scene)));
    std::vector<double> worst(metrics.size(), 0.0);
    for (int k = 0; k < repeats; ++k) {
      RunChoice choice = method.choice;
      choice.frames = JitteredFrames{.mean = frame,
                                     .jitter = setting.jitter,
                                     .spike_probability = setting.spikes,
                                     .spike_factor = 10.0,
                                     .seed = static_cast<std::uint64_t>(k + 1)};
      MetricRecorder recorder({metrics, ""});
      const RunResult result = simulate(model, choice, recorder);
      for (std::size_t j = 0; j < metrics.size(); ++j) {
        worst[j] = std::max(worst[j], std::abs(recorder.value(metrics[j], result).value()));
      }
    }
    table.rows[i] = {scene,
                     std::string(setting.name),
                     std::string(method.name),
                     std::int64_t{repeats},
                     number_cell(worst[0]),
                     number_cell(worst[1]),
                     number_cell(worst[2])};
  });
  return table;
}

}  // namespace

std::string gas_scene(int balls) {
  constexpr double radius = 0.1, fraction = 0.1;
  const double volume = balls * 4.0 / 3.0 * 3.14159265358979 * radius * radius * radius / fraction;
  const double half = 0.5 * std::cbrt(volume);
  const int side = static_cast<int>(std::ceil(std::cbrt(balls)));
  const double spacing = 2.0 * half / side;
  std::string text = "name = \"gas\"\nsummary = \"elastic balls\"\nduration = 1.0\nG = 0.0\n";
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sign : {-1, 1}) {
      Vector3 normal = Vector3::Zero();
      normal[axis] = -sign;
      const Vector3 place = -half * normal;
      text += fmt::format(
          "[[body]]\nname = \"wall{}{}\"\nentity = \"wall\"\nshape = \"half-space\"\n"
          "normal = [{}, {}, {}]\nposition = [{}, {}, {}]\n",
          axis, sign < 0 ? 0 : 1, normal[0], normal[1], normal[2], place[0], place[1], place[2]);
    }
  }
  Random random(1);
  for (int k = 0; k < balls; ++k) {
    const Vector3 cell(k % side, k / side % side, k / side / side);
    const Vector3 p = (cell.array() + 0.5) * spacing - half;
    const Vector3 v(random.normal(), random.normal(), random.normal());
    text += fmt::format(
        "[[body]]\nname = \"b{:05}\"\nentity = \"ball\"\nradius = {}\nmass = 1.0\n"
        "position = [{}, {}, {}]\nvelocity = [{}, {}, {}]\n",
        k, radius, p[0], p[1], p[2], v[0], v[1], v[2]);
  }
  return text;
}

ProgramOutput run_realtime(const ExperimentSpec& /*spec*/, Size size, std::size_t threads) {
  const bool full = size == Size::full;
  ProgramOutput output;
  Table stalls = stall_table(full ? 32 : 4, threads);
  Table work = work_table(full ? 256 : 64, threads);
  output.runs = stalls.rows.size() + work.rows.size();
  output.tables.emplace_back("stalls", std::move(stalls));
  output.tables.emplace_back("work", std::move(work));
  output.shown = {"work"};
  measure_bodies(full ? 16384 : 1024, output);  // alone on the machine, after all else
  return output;
}

}  // namespace kairos::experiments
