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
    crept_ = 0;
    if (rare_ != nullptr) {
      rare_->partners.clear();
    }
  }
  if (chain_ > 0 && impact.partner != last_partner_ && rare().partners.empty()) {
    rare_->partners.push_back(last_partner_);
  }
  if (rare_ != nullptr && !rare_->partners.empty()) {
    std::vector<BodyIndex>& partners = rare_->partners;
    if (std::find(partners.begin(), partners.end(), impact.partner) == partners.end()) {
      partners.push_back(impact.partner);
    }
  }
  ++chain_;
  const bool creeps = !first && way <= impact.tolerance;
  creeping_ = creeps ? creeping_ + 1 : 0;
  crept_ += creeps ? 1 : 0;
  const bool again = !first && impact.partner == last_partner_;
  resting_ = impact.rest ? (again ? resting_ + 1 : 1) : 0;
  last_ = t;
  last_partner_ = static_cast<std::uint32_t>(impact.partner);
}

std::vector<BodyIndex> ImpactHistory::partners() const {
  if (rare_ != nullptr && !rare_->partners.empty()) {
    return rare_->partners;
  }
  return chain_ > 0 ? std::vector<BodyIndex>{last_partner_} : std::vector<BodyIndex>{};
}

bool ImpactHistory::stalls(Instant t, double resolution) {
  Rare& of = rare();
  const bool first = of.stalled == Instant::never();
  of.stalling = !first && t - of.stalled <= resolution ? of.stalling + 1 : 0;
  of.stalled = t;
  return of.stalling > most_stalling;
}

void ImpactHistory::go_on() {
  if (rare_ != nullptr) {
    rare_->stalling = 0;
  }
}

ImpactHistory::Rare& ImpactHistory::rare() {
  if (rare_ == nullptr) {
    rare_ = std::make_unique<Rare>();
  }
  return *rare_;
}

void ImpactHistory::persist(Archive& archive) {
  bool more = rare_ != nullptr;
  archive(last_, chain_, last_partner_, creeping_, crept_, resting_, more);
  if (more) {
    Rare& of = rare();
    archive(of.partners, of.stalled, of.stalling);
  }
}

}  // namespace core
}  // namespace kairos
