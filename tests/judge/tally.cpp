#include "tests/judge/tally.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kairos::judge {

void Tally::add(const TimeOfImpact& answer, const Verdict& verdict, double seconds) {
  ++statuses_[static_cast<std::size_t>(answer.status)];
  for (std::size_t i = 0; i < fault_count; ++i) {
    faults_[i] += verdict.found[i] ? 1 : 0;
  }
  broken_ += verdict.breaks_a_promise() ? 1 : 0;
  evaluations_.push_back(answer.evaluations);
  slowest_ = std::max(slowest_, seconds);
}

void Tally::add(const Tally& other) {
  for (std::size_t i = 0; i < statuses_.size(); ++i) {
    statuses_[i] += other.statuses_[i];
  }
  for (std::size_t i = 0; i < fault_count; ++i) {
    faults_[i] += other.faults_[i];
  }
  broken_ += other.broken_;
  refused_ += other.refused_;
  evaluations_.insert(evaluations_.end(), other.evaluations_.begin(), other.evaluations_.end());
  slowest_ = std::max(slowest_, other.slowest_);
}

void Tally::refuse(bool wrongly) {
  ++refused_;
  broken_ += wrongly ? 1 : 0;
}

std::string Tally::header() {
  std::string text = fmt::format("{:18}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8} |", "class", "queries",
                                 "refused", "apart", "impact", "overlap", "undec.");
  for (std::size_t i = 0; i < fault_count; ++i) {
    text += fmt::format("{:>9}", to_string(static_cast<Fault>(i)));
  }
  return text + " | evaluations: p50, p99, p99.9, max; slowest ms";
}

std::string Tally::row(const std::string& name) const {
  std::string text = fmt::format("{:18}{:>8}{:>8}", name, evaluations_.size() + refused_, refused_);
  for (const std::size_t count : statuses_) {
    text += fmt::format("{:>8}", count);
  }
  text += " |";
  for (const std::size_t count : faults_) {
    text += count == 0 ? fmt::format("{:>9}", '.') : fmt::format("{:>9}", count);
  }
  return text + " | " + evaluations() + fmt::format("; {:.1f}", 1e3 * slowest_);
}

std::string Tally::evaluations() const {
  if (evaluations_.empty()) {
    return "";
  }
  std::vector<int> sorted = evaluations_;
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double share) {
    return sorted[std::min(sorted.size() - 1,
                           static_cast<std::size_t>(share * static_cast<double>(sorted.size())))];
  };
  return fmt::format("{}, {}, {}, {}", quantile(0.5), quantile(0.99), quantile(0.999),
                     sorted.back());
}

}  // namespace kairos::judge
