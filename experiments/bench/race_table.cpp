#include "experiments/bench/race_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kairos::experiments {
namespace {

/// What a racer's answers are worth, by the proven ones.
struct Judgement {
  std::size_t missed = 0;     ///< no impact, where there is one
  std::size_t late = 0;       ///< by more than is asked for
  std::size_t invented = 0;   ///< an impact, where there is none
  double median_error = 0.0;  ///< of the times of those that both found, s
};

Judgement judge(std::span<const double> answers, std::span<const double> truth, double accuracy) {
  Judgement judgement;
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == never || answers[i] == never) {
      judgement.missed += truth[i] < answers[i] ? 1 : 0;
      judgement.invented += answers[i] < truth[i] ? 1 : 0;
      continue;
    }
    judgement.late += answers[i] > truth[i] + accuracy ? 1 : 0;
    errors.push_back(std::abs(answers[i] - truth[i]));
  }
  if (!errors.empty()) {
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    judgement.median_error = *middle;
  }
  return judgement;
}

}  // namespace

std::vector<RaceResult> tell(const std::string& title, const std::vector<Racer>& racers,
                             std::size_t count, int rounds, const Telling& telling) {
  const std::vector<RaceResult> results = race_in_chunks(racers, count, rounds, telling.chunk);
  const auto measure = std::find_if(results.begin(), results.end(),
                                    [&](const RaceResult& r) { return r.name == telling.measure; });
  fmt::print("{}\n  {:<44}{:>12}{:>10}{:>8}{:>10}{:>14}{:>10}\n", title, "", "ns a query", "missed",
             telling.late, "invented", "median error", "ratio");
  for (const RaceResult& result : results) {
    const Judgement verdict = judge(result.answers, results.front().answers, telling.accuracy);
    fmt::print("  {:<44}{:>12.1f}{:>10}{:>8}{:>10}{:>14.1e}{:>10}\n", result.name,
               result.nanoseconds, verdict.missed, verdict.late, verdict.invented,
               verdict.median_error,
               measure == results.end()
                   ? std::string()
                   : fmt::format("{:.3f}", result.nanoseconds / measure->nanoseconds));
  }
  return results;
}

double ratio(std::span<const RaceResult> results, const std::string& name,
             const std::string& than) {
  double time[2] = {};
  for (const RaceResult& result : results) {
    time[0] = result.name == name ? result.nanoseconds : time[0];
    time[1] = result.name == than ? result.nanoseconds : time[1];
  }
  return time[0] / time[1];
}

namespace {

std::string verdict(const Bar& bar) {
  if (!std::isfinite(bar.value)) {
    return "";
  }
  if (bar.value <= bar.at_most) {
    return "met";
  }
  return bar.at_most > 0.0 ? fmt::format("not met: {:.3g} times as much", bar.value / bar.at_most)
                           : "not met";
}

}  // namespace

void print_bars(std::span<const Bar> bars) {
  fmt::print("Measured against what is asked for\n  {:<60}{:>12}{:>12}\n", "", "measured",
             "at most");
  for (const Bar& bar : bars) {
    const bool known = std::isfinite(bar.value);
    fmt::print("  {:<60}{:>12}{:>12.3g}  {}\n", bar.what,
               known ? fmt::format("{:.3g}", bar.value) : "no peer", bar.at_most, verdict(bar));
  }
}

}  // namespace kairos::experiments
