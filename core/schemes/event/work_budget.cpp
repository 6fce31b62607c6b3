#include "core/schemes/event/work_budget.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

constexpr std::int64_t least_in_frame = 1'000'000;
constexpr std::int64_t least_at_once = 10'000;
constexpr std::int64_t of_a_body = 1000;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

WorkBudget::WorkBudget(std::int64_t most_in_frame, std::size_t bodies, double frame)
    : most_in_frame_(most_in_frame), frame_(frame) {
  const std::int64_t all = of_a_body * static_cast<std::int64_t>(bodies);
  if (most_in_frame_ == 0) {
    most_in_frame_ = std::max(least_in_frame, all);
  }
  most_at_once_ = std::max(least_at_once, all);
}

WorkBudget::Spent WorkBudget::spend(const DueEvent& event) {
  last_ = event.kind == DueKind::crossing ? 1 : 0;
  Count& count = counts_[last_];
  count.latest[count.taken++ % remembered] = {event.a, event.b};
  if (event.time - count.since > epsilon * std::max(event.time.seconds, frame_)) {
    count.since = event.time;
    count.at_once = 0;
  }
  ++count.at_once;
  ++count.in_frame;
  if (count.at_once > most_at_once_) {
    return Spent::instant;
  }
  return count.in_frame > most_in_frame_ ? Spent::frame : Spent::nothing;
}

std::vector<WorkBudget::Share> WorkBudget::busiest() const {
  const Count& last = counts_[last_];
  const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(last.taken, remembered));
  std::map<std::pair<BodyIndex, BodyIndex>, int> counts;
  for (std::size_t k = 0; k < n; ++k) {
    ++counts[std::minmax(last.latest[k].a, last.latest[k].b)];
  }
  std::vector<Share> shares;
  for (const auto& [pair, count] : counts) {
    const double share = static_cast<double>(count) / static_cast<double>(n);
    if (share >= 0.1) {
      shares.push_back({pair.first, pair.second, share});
    }
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& x, const Share& y) { return x.share > y.share; });
  return shares;
}

void WorkBudget::Pair::persist(Archive& archive) { archive(a, b); }

void WorkBudget::Count::persist(Archive& archive) { archive(at_once, since, latest, taken); }

void WorkBudget::persist(Archive& archive) { archive(counts_); }

}  // namespace core
}  // namespace kairos
