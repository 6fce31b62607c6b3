#include "core/schemes/event/impact_history.hpp"

#include "core/archive.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {
namespace {

constexpr int most_creeping = 200;
constexpr std::int64_t many_impacts = 4096;
constexpr int most_accelerating = 3;
constexpr double least_progress = 1e-12;

}  // namespace

bool ImpactHistory::creeps(double speed, double reach, Instant t) {
  const bool moved = !((t - last_impact_) * std::max(speed, last_speed_) <= reach);
  creeping_ = moved || last_impact_ == Instant::never() ? 0 : creeping_ + 1;
  last_impact_ = t;
  last_speed_ = speed;
  return creeping_ > most_creeping;
}

bool ImpactHistory::accelerates(double reach, Instant t) {
  const std::int64_t n = ++impacts_;
  const bool power_of_two = (n & (n - 1)) == 0;
  if (n < many_impacts || !power_of_two) {
    return false;
  }
  const double duration = t - octave_start_;
  accelerating_ = duration < octave_duration_ ? accelerating_ + 1 : 0;
  octave_start_ = t;
  octave_duration_ = duration;
  const double hop = (t - last_impact_) * last_speed_;
  return accelerating_ >= most_accelerating && hop <= reach;
}

bool ImpactHistory::stalls(double progress) {
  creeping_ = progress < least_progress ? creeping_ + 1 : 0;
  return creeping_ > most_creeping;
}

void ImpactHistory::persist(Archive& archive) {
  archive(creeping_, last_impact_, last_speed_, impacts_, octave_start_, octave_duration_,
          accelerating_);
}

}  // namespace core
}  // namespace kairos
