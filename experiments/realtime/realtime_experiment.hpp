#pragma once

#include "experiments/sweeps/experiment_program.hpp"

namespace kairos::experiments {

/// Which methods keep up with 60 frames a second at how many bodies (measured: `timings.csv`), with
/// how much counted work a frame (`work.csv`); and what each does when frames come late
/// (`stalls.csv`): a falling ball and a bullet, frames with jitter and with stalls of ten frames.
[[nodiscard]] ProgramOutput run_realtime(const ExperimentSpec& spec, Size size,
                                         std::size_t threads);

/// A box full of elastic balls, a tenth of its volume, in a fixed arrangement: as scene text.
[[nodiscard]] std::string gas_scene(int balls);

}  // namespace kairos::experiments
