#pragma once

#include "experiments/output/table.hpp"
#include "experiments/tradeoff/candidates.hpp"
#include "experiments/tradeoff/reference.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// One candidate on one scene.
struct Assessed {
  Candidate candidate;
  MeasuredRun run;
  Errors errors;  ///< of a run that completed
};

/// All candidates on one scene, and what they were compared with.
struct Assessment {
  std::string scene;
  Reference reference;
  std::vector<Assessed> methods;
};

/// Runs all sensible candidates. The same on any machine and number of threads. Throws `RunError`
/// where the scene has no reference.
[[nodiscard]] Assessment assess(const Model& model, double duration, std::size_t threads);

/// Which methods are on the Pareto front of counted work and the given error: none is both cheaper
/// and better. Only runs that completed, with an error that is finite, can be; one that ends
/// farther off than anything moves has `diverged`, and is an answer to nothing.
[[nodiscard]] std::vector<bool> pareto_front(const Assessment& assessment, double Errors::*error);

/// One row per candidate: errors, counted work, fronts.
[[nodiscard]] Table assessment_table(const Assessment& assessment);
/// What each scene was compared with, a row each.
[[nodiscard]] Table reference_table(const std::vector<Assessment>& assessments);
/// Seconds per candidate, measured in turn within one run: the least of some rounds, and the
/// spread.
[[nodiscard]] Table timing_table(const Model& model, const Assessment& assessment, int rounds);

}  // namespace kairos::experiments
