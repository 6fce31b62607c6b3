#include "core/schemes/event/impact_history.hpp"

#include "tests/catch.hpp"

using namespace kairos;

namespace {

ImpactHistory::Impact with(BodyIndex partner, double approach, bool rest = false) {
  return {.partner = partner, .approach = approach, .near = 1e-3, .tolerance = 1e-8, .rest = rest};
}

}  // namespace

TEST_CASE("impacts: two that hardly move against each other creep after 200", "[impacts]") {
  ImpactHistory history;
  Instant t;
  // 1e-6 m/s for 1e-3 s: 1e-9 m from impact to impact. The first has none before it.
  for (int k = 0; k < 201; ++k, t = t + 1e-3) {
    history.add(with(1, 1e-6), t);
    REQUIRE_FALSE(history.creeps());
  }
  history.add(with(1, 1e-6), t);
  CHECK(history.creeps());
  SECTION("one flight that goes farther, and the count begins anew") {
    t = t + 1.0;
    history.add(with(1, 1e-6), t);
    CHECK_FALSE(history.creeps());
    history.add(with(1, 1e-6), t + 1e-3);
    CHECK_FALSE(history.creeps());
  }
}

TEST_CASE("impacts: those that creep add up, whatever short ways come between them", "[impacts]") {
  ImpactHistory history;
  Instant t;
  const auto add = [&](double pause) {
    t = t + pause;
    history.add(with(1, 1e-6), t);
  };
  add(0.0);
  for (int round = 0; round < 50; ++round) {
    for (int k = 0; k < 100; ++k) {
      add(1e-3);
    }
    CHECK_FALSE(history.creeps_on());
    add(0.1);  // 1e-7 m: more than none, and near
  }
  CHECK_FALSE(history.creeps());
  add(1e-3);
  CHECK(history.creeps_on());
  SECTION("until one goes so far that it hangs together with none of them") {
    add(1e4);
    CHECK_FALSE(history.creeps_on());
  }
}

TEST_CASE("impacts: those on short ways hang together, with their partners", "[impacts]") {
  ImpactHistory history;
  Instant t;
  for (const BodyIndex partner : {4U, 7U, 4U, 7U}) {
    history.add(with(partner, 1.0), t);
    t = t + 1e-4;  // 1e-4 m
  }
  CHECK(history.chain() == 4);
  CHECK(history.partners() == std::vector<BodyIndex>{4, 7});
  history.add(with(2, 1.0), t + 1e-2);
  CHECK(history.chain() == 1);
  CHECK(history.partners() == std::vector<BodyIndex>{2});
}

TEST_CASE("impacts: a body rests that meets one and the same too slowly, again and again",
          "[impacts]") {
  ImpactHistory history;
  for (int k = 0; k < 3; ++k) {
    history.add(with(1, 1e-7, true), Instant{} + k);
    REQUIRE_FALSE(history.rests());
  }
  SECTION("four times") {
    history.add(with(1, 1e-7, true), Instant{} + 3.0);
    CHECK(history.rests());
  }
  SECTION("not where another comes in between") {
    history.add(with(2, 1e-7, true), Instant{} + 3.0);
    history.add(with(1, 1e-7, true), Instant{} + 4.0);
    CHECK_FALSE(history.rests());
  }
  SECTION("not where one of them was fast") {
    history.add(with(1, 1.0, false), Instant{} + 3.0);
    history.add(with(1, 1e-7, true), Instant{} + 4.0);
    CHECK_FALSE(history.rests());
  }
}

TEST_CASE("impacts: looks that get nowhere stall after 200, whatever impacts come in between",
          "[impacts]") {
  ImpactHistory history;
  Instant t;
  for (int k = 0; k < 201; ++k, t = t + 1e-13) {
    REQUIRE_FALSE(history.stalls(t, 1e-12));
    history.add(with(1, 1.0), t);
  }
  CHECK(history.stalls(t, 1e-12));
  CHECK_FALSE(history.stalls(t + 1e-3, 1e-12));
}
