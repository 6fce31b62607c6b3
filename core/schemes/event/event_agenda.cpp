#include "core/schemes/event/event_agenda.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <numeric>

namespace kairos {
inline namespace core {

Agenda::Agenda(const Model& model)
    : by_name_(model.size()), rank_(model.size()), version_(model.size(), 0) {
  std::iota(by_name_.begin(), by_name_.end(), BodyIndex{0});
  std::sort(by_name_.begin(), by_name_.end(),
            [&](BodyIndex a, BodyIndex b) { return model.body(a).name < model.body(b).name; });
  for (std::uint32_t r = 0; r < by_name_.size(); ++r) {
    rank_[by_name_[r]] = r;
  }
}

void Agenda::push(Instant t, Due due, BodyIndex a, BodyIndex b, double patience, bool decided) {
  if (heap_.size() >= crowded_) {
    sweep_out();
  }
  heap_.push_back({t, due, rank_[a], rank_[b], version_[a], version_[b], patience, decided});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

DueEvent Agenda::pop() {
  std::pop_heap(heap_.begin(), heap_.end(), later);
  const Entry entry = heap_.back();
  heap_.pop_back();
  const BodyIndex a = by_name_[entry.a];
  const BodyIndex b = by_name_[entry.b];
  return {entry.time, entry.due, a, b, entry.patience, entry.decided, stale(entry)};
}

/// Where impacts follow each other much faster than what was predicted far ahead comes up, stale
/// entries would pile up without end. What is taken even when it is stale stays.
void Agenda::sweep_out() {
  std::erase_if(heap_, [this](const Entry& entry) {
    return stale(entry) && entry.due != Due::epoch_end && entry.due != Due::contact_begins;
  });
  std::make_heap(heap_.begin(), heap_.end(), later);
  crowded_ = std::max(least_crowded, 2 * heap_.size());
}

void Agenda::Entry::persist(Archive& archive) {
  archive(time, due, a, b, version_a, version_b, patience, decided);
}

void Agenda::persist(Archive& archive) {
  archive(version_, heap_, crowded_);
  for (const Entry& entry : heap_) {
    archive.require(entry.a < by_name_.size() && entry.b < by_name_.size());
  }
}

}  // namespace core
}  // namespace kairos
