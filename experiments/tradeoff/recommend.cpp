#include "experiments/tradeoff/recommend.hpp"

#include "experiments/progress_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace kairos::experiments {

std::string shortcoming(const Assessed& method, const Reference& reference,
                        const Requirements& wanted, double frame) {
  if (!method.run.completed()) {
    return method.run.status + ": " + method.run.reason;
  }
  const double error = method.errors.position + reference.position_uncertainty;
  if (!(error <= wanted.error)) {
    return fmt::format("ends {:.2e} m off", error);
  }
  if (wanted.penetration && !(method.errors.penetration <= *wanted.penetration)) {
    return fmt::format("{:.2e} m deep", method.errors.penetration);
  }
  const double frames = std::max(1.0, std::ceil(reference.until / frame));
  const double per_frame = nominal_operation * static_cast<double>(method.run.work()) / frames;
  if (wanted.budget && !(per_frame <= *wanted.budget)) {
    return fmt::format("{:.2e} s of work a frame", per_frame);
  }
  return {};
}

WholeRun whole_run_of(const Model& model, const Reference& reference, const Requirements& wanted) {
  double smallest = std::numeric_limits<double>::infinity();
  for (BodyIndex i = 0; i < model.size(); ++i) {
    smallest = model.is_free(i) ? std::min(smallest, smallest_extent(model.shape(i))) : smallest;
  }
  const double deepest = wanted.penetration.value_or(0.5 * smallest);
  return [&model, &reference, deepest](const Assessed& method) -> std::string {
    MeasuredRun run = method.run;
    if (reference.until < reference.whole) {
      RunChoice choice = method.candidate.choice;
      choice.duration = reference.whole;
      ProgressBar bar("over the whole duration", 1);
      run = measure(model, choice, &bar);
    }
    if (!run.completed()) {
      return fmt::format("over {:g} s: {}: {}", reference.whole, run.status, run.reason);
    }
    return run.metrics.deepest().depth <= deepest
               ? std::string()
               : fmt::format("{:.2e} m deep over {:g} s", run.metrics.deepest().depth,
                             reference.whole);
  };
}

Recommendation recommend(const Assessment& assessment, const Requirements& wanted, double frame,
                         const WholeRun& whole) {
  Recommendation result;
  const Reference& reference = assessment.reference;
  if (!reference.unseen.empty()) {
    result.refused = fmt::format(
        "methods can be compared up to {:.4g} s of {:g} s only, and up to there there is no impact "
        "of {}: what is right there may be wrong later; allowed: a --duration that ends before, or "
        "a scene that is less sensitive",
        reference.until, reference.whole, fmt::join(reference.unseen, ", none of "));
  }
  for (const Assessed& method : assessment.methods) {
    result.shortcomings.push_back(shortcoming(method, assessment.reference, wanted, frame));
  }
  result.ranked.resize(assessment.methods.size());
  std::iota(result.ranked.begin(), result.ranked.end(), std::size_t{0});
  std::sort(result.ranked.begin(), result.ranked.end(), [&](std::size_t a, std::size_t b) {
    const Assessed& x = assessment.methods[a];
    const Assessed& y = assessment.methods[b];
    return std::pair(x.run.work(), x.candidate.name) < std::pair(y.run.work(), y.candidate.name);
  });
  for (const std::size_t i : result.ranked) {
    if (!result.refused.empty() || !result.shortcomings[i].empty()) {
      continue;
    }
    result.shortcomings[i] = whole(assessment.methods[i]);
    if (result.shortcomings[i].empty()) {
      result.pick = i;
      break;
    }
  }
  return result;
}

}  // namespace kairos::experiments
