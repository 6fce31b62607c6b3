#include "core/schemes/event/event_calendar.hpp"

#include "core/prefetch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

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

void EventCalendar::put(std::uint32_t body, Instant time, const Source& source) {
  const Slip slip{body, ++latest_[body], 0};
  if (time < Instant::never()) {
    if (filed_ + far_.size() > most_entries * latest_.size() + 1024) {
      renew(source);
    }
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
  const auto ahead = day - static_cast<double>(week_ << to_week_);
  if (per_day_ == 0.0 || !(ahead < static_cast<double>(days_ahead()))) {
    far_.push_back(slip);
    return;
  }
  const auto number = static_cast<std::int64_t>(day);
  if (number <= day_) {
    late_.push_back(entry_of(source, slip));
    std::push_heap(late_.begin(), late_.end(), later);
    return;
  }
  const std::int64_t week = number >> to_week_;
  const auto of_week =
      static_cast<std::uint32_t>(number) & static_cast<std::uint32_t>(days_.size() - 1);
  note(
      week == week_ ? days_[of_week] : weeks_[static_cast<std::size_t>(week) & (weeks_.size() - 1)],
      {slip.body, slip.stamp, of_week});
}

void EventCalendar::note(std::uint32_t& in, const Slip& slip) {
  if (in == none || pages_[in].count == pages_[in].slips.size()) {
    std::uint32_t page = free_;
    if (page == none) {
      page = static_cast<std::uint32_t>(pages_.size());
      pages_.emplace_back();
    } else {
      free_ = pages_[page].next;
    }
    pages_[page].count = 0;
    pages_[page].next = in;
    in = page;
  }
  Page& page = pages_[in];
  page.slips[page.count++] = slip;
  ++filed_;
}

/// Shows all slips of a day or a week; it is empty then.
template <typename See>
void EventCalendar::tear_off(std::uint32_t& from, const See& see) {
  while (from != none) {
    const Page page = pages_[from];  // what is shown may be noted elsewhere
    pages_[from].next = free_;
    free_ = std::exchange(from, page.next);
    filed_ -= page.count;
    if (from != none) {
      prefetch(pages_[from]);
    }
    for (std::uint32_t k = 0; k < page.count; ++k) {
      see(page.slips[k]);
    }
  }
}

/// The earliest of today's, where some were put after it began.
const EventCalendar::Entry* EventCalendar::first_of_late() {
  while (!late_.empty() && !current(late_.front())) {
    std::pop_heap(late_.begin(), late_.end(), later);
    late_.pop_back();
  }
  if (late_.empty()) {
    return today_.empty() ? nullptr : &today_.back();
  }
  const bool is_late = today_.empty() || later(today_.back(), late_.front());
  return is_late ? late_.data() : &today_.back();
}

/// Today is over, or has not begun.
const EventCalendar::Entry* EventCalendar::first_after_today(const Source& source) {
  while (filed_ != 0 || !far_.empty()) {
    if (filed_ == 0 || per_day_ == 0.0) {
      renew(source);
    } else {
      begin_next_day(source);
    }
    if (const Entry* const earliest = first_of_today(); earliest != nullptr) {
      return earliest;
    }
  }
  return nullptr;
}

void EventCalendar::begin_next_day(const Source& source) {
  ++day_;
  ++days_begun_;
  if (const std::int64_t week = day_ >> to_week_; week != week_) {
    begin_week(week);
  }
  tear_off(days_[static_cast<std::size_t>(day_) & (days_.size() - 1)], [&](const Slip& slip) {
    if (current(slip)) {
      today_.push_back(entry_of(source, slip));
    }
  });
  look_ahead(source);
  taken_ += today_.size();
  std::sort(today_.begin(), today_.end(), later);
  if (day_ >= check_) {
    const double mean =
        static_cast<double>(taken_) / (0.5 * static_cast<double>(days_ahead()) * entries_a_day);
    if (mean > too_many || mean < too_few) {
      renew(source);
    } else {
      file_far(source);
    }
  }
}

/// Who is due tomorrow is looked up while today's are taken.
void EventCalendar::look_ahead(const Source& source) const {
  const auto tomorrow = static_cast<std::size_t>(day_ + 1) & (days_.size() - 1);
  if (tomorrow == 0 || days_[tomorrow] == none) {
    return;  // another week is not in days yet
  }
  const Page& page = pages_[days_[tomorrow]];
  for (std::uint32_t k = 0; k < page.count; ++k) {
    prefetch(latest_[page.slips[k].body]);
    source.look_up(page.slips[k].body);
  }
}

void EventCalendar::begin_week(std::int64_t week) {
  week_ = week;
  tear_off(weeks_[static_cast<std::size_t>(week) & (weeks_.size() - 1)], [&](const Slip& slip) {
    if (current(slip)) {
      note(days_[slip.day], slip);
    }
  });
}

/// What has come within the ring's reach by half a turn of it.
void EventCalendar::file_far(const Source& source) {
  taken_ = 0;
  check_ = day_ + static_cast<std::int64_t>(days_ahead() / 2);
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
      all.push_back(entry_of(source, {slip.body, slip.stamp, 0}));
    }
  };
  std::for_each(today_.begin(), today_.end(), take);
  std::for_each(late_.begin(), late_.end(), take);
  std::for_each(far_.begin(), far_.end(), take);
  for (std::vector<std::uint32_t>* const ring : {&days_, &weeks_}) {
    for (std::uint32_t& pages : *ring) {
      tear_off(pages, take);
    }
  }
  if (days_.empty()) {
    const auto to_all = static_cast<int>(
        std::bit_width(std::clamp<std::size_t>(latest_.size() / 2, 64, 1U << 20U) - 1));
    to_week_ = (to_all + 1) / 2;
    days_.resize(std::size_t{1} << to_week_, none);
    weeks_.resize(std::size_t{1} << (to_all - to_week_), none);
  }
  today_.clear();
  late_.clear();
  far_.clear();
  filed_ = taken_ = 0;
  day_ = week_ = 0;
  check_ = static_cast<std::int64_t>(days_ahead() / 2);
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
    file({entry.body, entry.stamp, 0}, entry.time, source);
  }
}

}  // namespace core
}  // namespace kairos
