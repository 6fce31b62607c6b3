#include "experiments/view/simulated_view.hpp"

#include "simulation/view/view_recorder.hpp"

#include <fmt/format.h>

#include <utility>

namespace kairos::experiments {

ViewRun simulated_view(const Model& model, const RunChoice& choice) {
  ViewRecorder recorder;
  const RunResult result = simulate(model, choice, recorder);
  ViewRun run = std::move(recorder).finish();
  const MethodChoice& method = choice.method;
  run.method = fmt::format("{} + {} + {} + {}", method.scheme, method.integrator, method.detector,
                           method.impact);
  if (result.status == RunStatus::stopped) {
    run.reason = result.reason;
  }
  return run;
}

}  // namespace kairos::experiments
