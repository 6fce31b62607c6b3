#include "core/schemes/event/work_budget.hpp"

#include "tests/catch.hpp"

using namespace kairos;

namespace {

DueEvent event_at(Instant t, BodyIndex a = 0, BodyIndex b = 1) {
  return {.time = t, .kind = DueKind::impact, .a = a, .b = b};
}

}  // namespace

TEST_CASE("budget: 10,000 events at one instant, or 1000 a body", "[budget]") {
  WorkBudget few(0, 3, 0.1);
  for (int k = 0; k < 10'000; ++k) {
    // 1e-22 s from event to event: at t = 1 s no double would notice.
    REQUIRE(few.spend(event_at((Instant{} + 1.0) + 1e-22 * k)) == WorkBudget::Spent::nothing);
  }
  CHECK(few.spend(event_at(Instant{} + 1.0 + 1e-18)) == WorkBudget::Spent::instant);
  CHECK(few.spend(event_at(Instant{} + 1.0 + 1e-12)) == WorkBudget::Spent::nothing);
  CHECK(WorkBudget(0, 50, 0.1).most_at_once() == 50'000);
}

TEST_CASE("budget: so many events in a frame as were asked for, however they are spread",
          "[budget]") {
  WorkBudget budget(100, 3, 0.1);
  for (int frame = 0; frame < 3; ++frame) {
    budget.begin_frame();
    for (int k = 0; k < 100; ++k) {
      REQUIRE(budget.spend(event_at(Instant{} + frame + 1e-3 * k)) == WorkBudget::Spent::nothing);
    }
  }
  CHECK(budget.spend(event_at(Instant{} + 3.0)) == WorkBudget::Spent::frame);
  CHECK(WorkBudget(0, 3, 0.1).most_in_frame() == 1'000'000);
  CHECK(WorkBudget(0, 5000, 0.1).most_in_frame() == 5'000'000);
}

TEST_CASE("budget: it knows who keeps the run busy", "[budget]") {
  WorkBudget budget(0, 3, 0.1);
  for (int k = 0; k < 1000; ++k) {
    const BodyIndex b = k % 4 == 0 ? 2 : 1;
    (void)budget.spend(event_at(Instant{} + 1e-3 * k, 0, b));
  }
  const auto shares = budget.busiest();
  REQUIRE(shares.size() == 2);
  CHECK(shares[0].b == 1);
  CHECK(shares[0].share == 0.75);
  CHECK(shares[1].b == 2);
}
