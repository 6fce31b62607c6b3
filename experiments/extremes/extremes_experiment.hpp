#pragma once

#include "experiments/extremes/extreme_case.hpp"
#include "experiments/sweeps/experiment_program.hpp"
#include "simulation/simulate.hpp"

#include <string>
#include <string_view>

namespace kairos::experiments {

/// How a method fared in a cell.
enum class Verdict {
  right,     ///< within 1e-6 of the truth
  degraded,  ///< within 0.1; the table says by how much
  reported,  ///< it stopped or was refused, with a reason
  wrong_in_silence,
  hung,  ///< more frames and events than any of these scenes can need
};
[[nodiscard]] std::string_view to_string(Verdict verdict);

struct Judged {
  Verdict verdict = Verdict::right;
  double error = 0.0;
  std::size_t impacts = 0;
  std::string reason;
};

/// Runs one cell by one method.
[[nodiscard]] Judged judge(const ExtremeCase& extreme, const RunChoice& choice);

/// The stability map: every cell with every method.
[[nodiscard]] ProgramOutput run_extremes(const ExperimentSpec& spec, Size size,
                                         std::size_t threads);

}  // namespace kairos::experiments
