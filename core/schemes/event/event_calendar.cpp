#include "core/schemes/event/event_calendar.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

namespace kairos {
inline namespace core {
namespace {

constexpr double entries_a_day = 8.0;
/// Days that hold so much more or less than that are made anew.
constexpr double too_many = 4.0;
constexpr double too_few = 1.0 / 8.0;
/// Passed over are at most so many times as many as there are bodies.
constexpr std::size_t most_entries = 6;

}  // namespace

bool EventCalendar::later(const Entry& x, const Entry& y) {
  return std::tuple(x.time.seconds, x.time.correction, x.key, x.key2) >
         std::tuple(y.time.seconds, y.time.correction, y.key, y.key2);
}

void EventCalendar::put(Entry entry) {
  entry.stamp = latest_[entry.body].stamp + 1;
  latest_[entry.body] = entry;
  if (entry.time < Instant::never()) {
    file(entry);
  }
}

void EventCalendar::file(const Entry& entry) {
  const double day = (entry.time.seconds - origin_) * per_day_;
  const auto ahead = day - static_cast<double>(day_);
  if (per_day_ == 0.0 || !(ahead < static_cast<double>(days_.size()))) {
    far_.push_back({entry.body, entry.stamp});
  } else if (const auto number = static_cast<std::int64_t>(day); number <= day_) {
    today_.push_back(entry);
    std::push_heap(today_.begin(), today_.end(), later);
  } else {
    days_[static_cast<std::size_t>(number) & (days_.size() - 1)].push_back(
        {entry.body, entry.stamp});
    ++filed_;
  }
}

const EventCalendar::Entry* EventCalendar::first() {
  if (today_.empty() && filed_ == 0 && far_.empty()) {
    return nullptr;
  }
  if (per_day_ == 0.0 || filed_ + far_.size() > most_entries * latest_.size() + 1024) {
    renew();
  }
  while (true) {
    while (!today_.empty()) {
      if (current(today_.front())) {
        return today_.data();
      }
      std::pop_heap(today_.begin(), today_.end(), later);
      today_.pop_back();
    }
    if (filed_ == 0) {
      if (far_.empty()) {
        return nullptr;
      }
      renew();
      continue;
    }
    begin_next_day();
  }
}

void EventCalendar::begin_next_day() {
  ++day_;
  Day& day = days_[static_cast<std::size_t>(day_) & (days_.size() - 1)];
  filed_ -= day.size();
  for (const Slip& slip : day) {
    if (current(slip)) {
      today_.push_back(latest_[slip.body]);
    }
  }
  day.clear();
  taken_ += today_.size();
  std::make_heap(today_.begin(), today_.end(), later);
  if (day_ >= check_) {
    const double mean =
        static_cast<double>(taken_) / (0.5 * static_cast<double>(days_.size()) * entries_a_day);
    if (mean > too_many || mean < too_few) {
      renew();
    } else {
      file_far();
    }
  }
}

/// What has come within the ring's reach by half a turn of it.
void EventCalendar::file_far() {
  taken_ = 0;
  check_ = day_ + static_cast<std::int64_t>(days_.size() / 2);
  Day again;
  again.swap(far_);
  for (const Slip& slip : again) {
    if (current(slip)) {
      file(latest_[slip.body]);
    }
  }
}

/// New days, of a length by which the next quarter of all entries fills them.
void EventCalendar::renew() {
  std::vector<Entry> all;
  const auto take = [&](const auto& from) {
    for (const auto& entry : from) {
      if (current(entry)) {
        all.push_back(latest_[entry.body]);
      }
    }
  };
  take(today_);
  take(far_);
  for (const Day& day : days_) {
    take(day);
  }
  if (days_.empty()) {
    days_.resize(std::bit_ceil(std::clamp<std::size_t>(latest_.size() / 2, 64, 1U << 20U)));
  }
  for (Day& day : days_) {
    day.clear();
  }
  today_.clear();
  far_.clear();
  filed_ = taken_ = 0;
  day_ = 0;
  check_ = static_cast<std::int64_t>(days_.size() / 2);
  if (all.empty()) {
    per_day_ = 0.0;
    return;
  }
  const auto quarter = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 4);
  std::nth_element(all.begin(), quarter, all.end(),
                   [](const Entry& x, const Entry& y) { return x.time.seconds < y.time.seconds; });
  const auto by_time = [](const Entry& x, const Entry& y) {
    return x.time.seconds < y.time.seconds;
  };
  origin_ = std::min_element(all.begin(), quarter + 1, by_time)->time.seconds;
  const double last = std::max_element(all.begin(), all.end(), by_time)->time.seconds;
  const double span =
      std::max({quarter->time.seconds - origin_, 1e-9 * (last - origin_),
                1e3 * std::numeric_limits<double>::epsilon() * std::abs(last), 1e-30});
  per_day_ = static_cast<double>(all.size() / 4 + 1) / (entries_a_day * span);
  for (const Entry& entry : all) {
    file(entry);
  }
}

}  // namespace core
}  // namespace kairos
