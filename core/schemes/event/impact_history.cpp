#include "core/schemes/event/impact_history.hpp"

#include "core/archive.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {
void ImpactHistory::add(const Impact& impact, Instant t) {
  const bool first = last_ == Instant::never();
  const double way = first ? 0.0 : (t - last_) * impact.approach;
  if (first || way > impact.near) {
    chain_ = 0;
    partners_.clear();
  }
  if (chain_ > 0 && partners_.empty() && impact.partner != last_partner_) {
    partners_.push_back(last_partner_);
  }
  if (!partners_.empty() &&
      std::find(partners_.begin(), partners_.end(), impact.partner) == partners_.end()) {
    partners_.push_back(impact.partner);
  }
  ++chain_;
  creeping_ = first || way > impact.tolerance ? 0 : creeping_ + 1;
  const bool again = !first && impact.partner == last_partner_;
  resting_ = impact.rest ? (again ? resting_ + 1 : 1) : 0;
  last_ = t;
  last_partner_ = impact.partner;
}

std::vector<BodyIndex> ImpactHistory::partners() const {
  return partners_.empty() && chain_ > 0 ? std::vector<BodyIndex>{last_partner_} : partners_;
}

bool ImpactHistory::stalls(Instant t, double resolution) {
  const bool first = stalled_ == Instant::never();
  stalling_ = !first && t - stalled_ <= resolution ? stalling_ + 1 : 0;
  stalled_ = t;
  return stalling_ > most_stalling;
}

void ImpactHistory::persist(Archive& archive) {
  archive(last_, chain_, partners_, last_partner_, creeping_, resting_, stalling_, stalled_);
}

}  // namespace core
}  // namespace kairos
