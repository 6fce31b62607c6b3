#pragma once

#include "core/reading/scene_reader.hpp"
#include "experiments/sweeps/sweep_spec.hpp"
#include "simulation/simulate.hpp"

#include <functional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// Where a run stands in its sweep.
struct RunPlace {
  std::size_t index = 0;
  std::size_t method = 0;              ///< into `SweepSpec::methods`
  std::size_t point = 0;               ///< combination of the listed axes, the same for all methods
  std::int64_t repeat = 0;             ///< of `SweepSpec::repeats`
  std::vector<AxisValue> axis_values;  ///< one per axis
};

/// One run of a sweep, ready to go: a pure function of the spec and its index.
struct PlannedRun : RunPlace {
  Values values;                    ///< what expressions see: constants, axes, repeat, repeats
  std::vector<Override> overrides;  ///< of the scene
  RunChoice choice;
  std::string refused;  ///< why it cannot even be tried; empty if it can
};

/// All runs, each made when it is asked for: a grid of ten million takes no memory. Methods
/// outermost, then axes in the order of the file, then repeats. Drawn values depend on (seed, axis,
/// point, repeat) and not on the method, so that methods are compared on the same draws.
class SweepPlan {
 public:
  /// Throws `InputError` for more runs than 10 million.
  explicit SweepPlan(const SweepSpec& spec);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] PlannedRun operator[](std::size_t index) const;
  [[nodiscard]] RunPlace place(std::size_t index) const;
  /// Goes through all runs, or those that `of` picks by their index. Throws `InputError` for specs
  /// that cannot be meant: unknown schemes, wrong expressions, options out of range.
  void check(const std::function<bool(std::size_t index)>& of = {}) const;

 private:
  SweepSpec spec_;
  std::size_t points_ = 0;
  std::size_t size_ = 0;
};

/// The scene file of a sweep: a path relative to the spec, or the name of a scene of the project.
[[nodiscard]] std::string scene_path(const SweepSpec& spec);

}  // namespace kairos::experiments
