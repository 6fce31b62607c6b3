#pragma once

#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "experiments/metrics/metrics.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <string>
#include <vector>

namespace kairos::experiments::thesis {

// What the measurements of the errata share: shipped scenes, run as the thesis would.

inline constexpr double G = 9.8;             // of the shipped scenes
inline constexpr double frame = 1.0 / 60.0;  // s
inline constexpr double epsilon = 0x1p-52;
inline constexpr std::uint64_t seed = 20260107;

[[nodiscard]] inline Scene shipped(const std::string& name,
                                   const std::vector<Override>& overrides = {}) {
  return read_scene(find_scene(name), overrides);
}

[[nodiscard]] inline RunChoice thesis_choice(double h, double duration) {
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  choice.frames = FixedFrames{h};
  choice.duration = duration;
  return choice;
}

/// A run and one of its metrics, which must have a meaning in it.
struct Measured {
  RunResult result;
  double value = 0.0;
};

[[nodiscard]] inline Measured measured_run(const Scene& scene, const RunChoice& choice,
                                           const std::string& metric) {
  const Model model(scene);
  MetricRecorder recorder({{metric}, ""});
  Measured measured{simulate(model, choice, recorder), 0.0};
  measured.value = recorder.value(metric, measured.result).value();
  return measured;
}

[[nodiscard]] inline double gained(const RunResult& result) {
  return result.ledger.energy() - result.ledger.initial_energy();
}

}  // namespace kairos::experiments::thesis
