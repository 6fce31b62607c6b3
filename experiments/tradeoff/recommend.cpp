#include "experiments/tradeoff/recommend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

Recommendation recommend(const Assessment& assessment, const Requirements& wanted, double frame) {
  Recommendation result;
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
    if (result.shortcomings[i].empty()) {
      result.pick = i;
      break;
    }
  }
  return result;
}

}  // namespace kairos::experiments
