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
  if (x.time.seconds != y.time.seconds) {
    return x.time.seconds > y.time.seconds;
  }
  return std::tuple(x.time.correction, x.key, x.key2) >
         std::tuple(y.time.correction, y.key, y.key2);
}

void EventCalendar::put(std::uint32_t body, Instant time, const Source& source) {
  const Slip slip{body, ++latest_[body]};
  if (time < Instant::never()) {
    file(slip, time, source);
  }
}

EventCalendar::Entry EventCalendar::entry_of(const Source& source, const Slip& slip) const {
  Entry entry = source.due(slip.body);
  entry.stamp = slip.stamp;
  return entry;
}

void EventCalendar::file(const Slip& slip, Instant time, const Source& source) {
  const double day = (time.seconds - origin_) * per_day_;
  const auto ahead = day - static_cast<double>(day_);
  if (per_day_ == 0.0 || !(ahead < static_cast<double>(days_.size()))) {
    far_.push_back(slip);
  } else if (const auto number = static_cast<std::int64_t>(day); number <= day_) {
    today_.push_back(entry_of(source, slip));
    std::push_heap(today_.begin(), today_.end(), later);
  } else {
    note(days_[static_cast<std::size_t>(number) & (days_.size() - 1)], slip);
    ++filed_;
  }
}

void EventCalendar::note(std::uint32_t& day, const Slip& slip) {
  if (day == none || pages_[day].count == pages_[day].slips.size()) {
    std::uint32_t page = free_;
    if (page == none) {
      page = static_cast<std::uint32_t>(pages_.size());
      pages_.emplace_back();
    } else {
      free_ = pages_[page].next;
    }
    pages_[page].count = 0;
    pages_[page].next = day;
    day = page;
  }
  Page& page = pages_[day];
  page.slips[page.count++] = slip;
}

/// Shows all slips of a day; it is empty then.
template <typename See>
void EventCalendar::tear_off(std::uint32_t& day, const See& see) {
  while (day != none) {
    Page& page = pages_[day];
    for (std::uint32_t k = 0; k < page.count; ++k) {
      see(page.slips[k]);
    }
    filed_ -= page.count;
    const std::uint32_t next = page.next;
    page.next = free_;
    free_ = day;
    day = next;
  }
}

const EventCalendar::Entry* EventCalendar::first(const Source& source) {
  if (today_.empty() && filed_ == 0 && far_.empty()) {
    return nullptr;
  }
  if (per_day_ == 0.0 || filed_ + far_.size() > most_entries * latest_.size() + 1024) {
    renew(source);
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
      renew(source);
      continue;
    }
    begin_next_day(source);
  }
}

void EventCalendar::begin_next_day(const Source& source) {
  ++day_;
  ++days_begun_;
  tear_off(days_[static_cast<std::size_t>(day_) & (days_.size() - 1)], [&](const Slip& slip) {
    if (current(slip)) {
      today_.push_back(entry_of(source, slip));
    }
  });
  taken_ += today_.size();
  std::make_heap(today_.begin(), today_.end(), later);
  if (day_ >= check_) {
    const double mean =
        static_cast<double>(taken_) / (0.5 * static_cast<double>(days_.size()) * entries_a_day);
    if (mean > too_many || mean < too_few) {
      renew(source);
    } else {
      file_far(source);
    }
  }
}

/// What has come within the ring's reach by half a turn of it.
void EventCalendar::file_far(const Source& source) {
  taken_ = 0;
  check_ = day_ + static_cast<std::int64_t>(days_.size() / 2);
  std::vector<Slip> again;
  again.swap(far_);
  for (const Slip& slip : again) {
    if (current(slip)) {
      file(slip, source.due(slip.body).time, source);
    }
  }
}

/// New days, of a length by which the next quarter of all entries fills them.
void EventCalendar::renew(const Source& source) {
  std::vector<Entry> all;
  const auto take = [&](const auto& slip) {
    if (current(slip)) {
      all.push_back(entry_of(source, {slip.body, slip.stamp}));
    }
  };
  std::for_each(today_.begin(), today_.end(), take);
  std::for_each(far_.begin(), far_.end(), take);
  for (std::uint32_t& day : days_) {
    tear_off(day, take);
  }
  if (days_.empty()) {
    days_.resize(std::bit_ceil(std::clamp<std::size_t>(latest_.size() / 2, 64, 1U << 20U)), none);
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
    file({entry.body, entry.stamp}, entry.time, source);
  }
}

}  // namespace core
}  // namespace kairos
