#include "core/schemes/event/event_calendar.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cstdint>
#include <map>
#include <tuple>

using namespace kairos;

namespace {

using Key = std::tuple<double, double, std::uint64_t, std::uint64_t>;

/// The calendar beside a map that is in order by itself.
class Beside : private EventCalendar::Source {
 public:
  explicit Beside(std::size_t bodies) : calendar_(bodies) {}

  void put(std::uint32_t body, Instant t, std::uint64_t key) {
    forget(body);
    put_[body] = {.time = t, .key = key, .key2 = body, .body = body, .stamp = 0};
    calendar_.put(body, t, *this);
    if (t < Instant::never()) {
      of_[body] = {t.seconds, t.correction, key, body};
      bodies_[of_[body]] = body;
    }
  }
  /// The body that is due first, if both say the same; none left: `nobody`.
  std::uint32_t take() {
    const EventCalendar::Entry* const first = calendar_.first(*this);
    if (bodies_.empty() || first == nullptr) {
      CHECK((bodies_.empty() && first == nullptr));
      return nobody;
    }
    const std::uint32_t body = first->body;
    CHECK(body == bodies_.begin()->second);
    now = first->time.seconds;
    calendar_.drop(body);
    forget(body);
    return body;
  }

  static constexpr std::uint32_t nobody = ~std::uint32_t{0};
  double now = 0.0;

 private:
  [[nodiscard]] EventCalendar::Entry due(std::uint32_t body) const override {
    return put_.at(body);
  }
  void forget(std::uint32_t body) {
    if (of_.contains(body)) {
      bodies_.erase(of_[body]);
      of_.erase(body);
    }
  }

  EventCalendar calendar_;
  std::map<std::uint32_t, EventCalendar::Entry> put_;
  std::map<Key, std::uint32_t> bodies_;
  std::map<std::uint32_t, Key> of_;
};

}  // namespace

// Rates that change by orders of magnitude, bodies put off, bodies due at one instant, some far
// ahead and some never: days must be made anew, and the order must stay.
TEST_CASE("a calendar gives what is due in the order of time and key", "[agenda]") {
  constexpr std::uint64_t seed = 3;
  INFO("seed " << seed);
  Random random(seed);
  constexpr std::uint32_t bodies = 300;
  Beside both(bodies);
  CHECK(both.take() == Beside::nobody);
  for (std::uint32_t i = 0; i < bodies; ++i) {
    both.put(i, i % 7 == 0 ? Instant{1.0} : Instant{random.uniform(0.0, 2.0)}, i % 3);
  }
  double pace = 1.0;
  for (int k = 0; k < 40000; ++k) {
    const std::uint32_t body = both.take();
    if (body == Beside::nobody) {
      break;
    }
    pace = k % 10000 == 9999 ? pace * (k == 19999 ? 1e-6 : 1e3) : pace;
    const double draw = random.uniform();
    const Instant next = draw < 0.02   ? Instant::never()
                         : draw < 0.05 ? Instant{both.now + 1e9 * pace}
                         : draw < 0.10 ? Instant{both.now}  // at once
                                       : Instant{both.now} + pace * random.uniform();
    both.put(body, next, static_cast<std::uint64_t>(k % 2));
    const auto other = static_cast<std::uint32_t>(random.uniform() * bodies);
    both.put(other, Instant{both.now} + pace * random.uniform(), 1);
  }
  std::uint32_t left = 0;
  while (left <= bodies && both.take() != Beside::nobody) {
    ++left;
  }
  CHECK(left <= bodies);
}
