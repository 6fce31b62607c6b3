#include "core/schemes/event/event_agenda.hpp"

#include "core/archive.hpp"
#include "core/large_pages.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace kairos {
inline namespace core {

Agenda::Agenda(const Model& model)
    : by_name_(model.size()),
      rank_(model.size()),
      version_(model.size(), 0),
      records_(scattered<Record>(model.size())),
      calendar_(model.size()) {
  std::iota(by_name_.begin(), by_name_.end(), BodyIndex{0});
  std::sort(by_name_.begin(), by_name_.end(),
            [&](BodyIndex a, BodyIndex b) { return model.body(a).name < model.body(b).name; });
  for (std::uint32_t r = 0; r < by_name_.size(); ++r) {
    rank_[by_name_[r]] = r;
  }
}

void Agenda::push(Instant t, DueKind kind, BodyIndex a, BodyIndex b, double bracket, bool decided,
                  const Image& image) {
  if (heap_.size() >= crowded_) {
    sweep_out();
  }
  heap_.push_back({t, bracket, rank_[a], rank_[b], version_[a], version_[b], image, kind, decided});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

void Agenda::meet(BodyIndex i, BodyIndex b, Instant t, double bracket) {
  Record& record = records_[i];
  const bool known = record.version == version_[i] && record.meeting <= t;
  if (known && (record.meeting < t || ranks(i, record.partner) < ranks(i, rank_[b]))) {
    return;
  }
  record.meeting = t;
  record.bracket = bracket;
  record.partner = rank_[b];
  record.version = version_[i];
  record.partner_version = version_[b];
}

Instant Agenda::meeting(BodyIndex i) const {
  const Record& record = records_[i];
  const bool known =
      record.version == version_[i] && record.partner_version == version_[by_name_[record.partner]];
  return known ? record.meeting : Instant::never();
}

void Agenda::file(BodyIndex i) {
  Record& record = records_[i];
  record.filed = true;
  if (record.version != version_[i]) {
    record.meeting = Instant::never();
  }
  calendar_.put(static_cast<std::uint32_t>(i), std::min(record.crossing, record.meeting), *this);
}

EventCalendar::Entry Agenda::due(std::uint32_t body) const {
  const Record& record = records_[body];
  const bool crosses = record.crossing <= record.meeting;
  const auto [a, b] = crosses ? std::pair{rank_[body], rank_[body]} : ranks(body, record.partner);
  const DueKind kind = crosses ? DueKind::crossing : DueKind::impact;
  return {.time = std::min(record.crossing, record.meeting),
          .key = static_cast<std::uint64_t>(kind) << 32U | a,
          .key2 = b,
          .body = body};
}

DueEvent Agenda::pop_record(const EventCalendar::Entry& first) {
  const BodyIndex i = first.body;
  Record& record = records_[i];
  DueEvent event{.time = first.time, .a = i, .b = i, .own = true, .owner = i};
  calendar_.drop(first.body);
  record.filed = false;
  if (record.crossing <= record.meeting) {
    event.kind = DueKind::crossing;
    record.crossing = Instant::never();
    return event;
  }
  const auto [a, b] = ranks(i, record.partner);
  event.kind = DueKind::impact;
  event.a = by_name_[a];
  event.b = by_name_[b];
  event.bracket = record.bracket;
  event.stale = meeting(i) == Instant::never();
  record.meeting = Instant::never();
  return event;
}

DueEvent Agenda::pop() {
  if (const EventCalendar::Entry* const first = calendar_.first(*this); first != nullptr) {
    const auto key = [first] {
      return std::tuple(first->time.seconds, first->time.correction, first->key, first->key2);
    };
    if (heap_.empty() || key() < heap_.front().full_key()) {
      return pop_record(*first);
    }
  }
  std::pop_heap(heap_.begin(), heap_.end(), later);
  const Entry entry = heap_.back();
  heap_.pop_back();
  const BodyIndex a = by_name_[entry.a];
  const BodyIndex b = by_name_[entry.b];
  return {.time = entry.time,
          .kind = entry.kind,
          .a = a,
          .b = b,
          .bracket = entry.bracket,
          .decided = entry.decided,
          .stale = stale(entry),
          .image = entry.image};
}

/// Removes stale entries. Impacts may follow each other much faster than predictions far ahead come
/// up, and stale ones would pile up without end. Kinds that are taken even when stale are kept.
void Agenda::sweep_out() {
  std::erase_if(heap_, [this](const Entry& entry) {
    return stale(entry) && entry.kind != DueKind::epoch_end &&
           entry.kind != DueKind::contact_begins;
  });
  std::make_heap(heap_.begin(), heap_.end(), later);
  crowded_ = std::max(least_crowded, 2 * heap_.size());
}

/// Whether something can be due then: not before the start, nor so late that differences of times
/// have no number.
static bool possible(Instant t) {
  return !(t < Instant::never()) || (t.seconds >= 0.0 && t.seconds < 1e100);
}

void Agenda::Entry::persist(Archive& archive) {
  archive(time, kind, a, b, version_a, version_b, bracket, decided, image);
}

void Agenda::Record::persist(Archive& archive) {
  archive(meeting, crossing, bracket, partner, version, partner_version);
}

void Agenda::persist(Archive& archive) {
  archive(version_, heap_, crowded_, records_);
  for (BodyIndex i = 0; i < records_.size(); ++i) {
    archive.require(records_[i].partner < by_name_.size() && possible(records_[i].meeting) &&
                    possible(records_[i].crossing));
    if (archive.reading()) {
      file(i);
    }
  }
  for (const Entry& entry : heap_) {
    archive.require(entry.a < by_name_.size() && entry.b < by_name_.size());
  }
}

}  // namespace core
}  // namespace kairos
