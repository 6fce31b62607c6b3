#include "core/schemes/event/impact_history.hpp"

#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

TEST_CASE("impacts: a body that hardly moves from one to the next creeps after 200", "[impacts]") {
  ImpactHistory history;
  Instant t;
  // 1e-6 m/s for 1e-3 s: 1e-9 m from impact to impact. The first has none before it.
  for (int k = 0; k < 201; ++k, t = t + 1e-3) {
    REQUIRE_FALSE(history.creeps(1e-6, 1e-8, t));
  }
  CHECK(history.creeps(1e-6, 1e-8, t));
  SECTION("one flight that goes farther, and the count begins anew") {
    t = t + 1.0;
    CHECK_FALSE(history.creeps(1e-6, 1e-8, t));
    CHECK_FALSE(history.creeps(1e-6, 1e-8, t + 1e-3));
  }
}

TEST_CASE("impacts: a gap that closes makes them ever faster, a steady one does not", "[impacts]") {
  // The k-th impact at T (1 - q^k): all of them within T, however many.
  const auto accelerates = [](double ratio, int impacts) {
    ImpactHistory history;
    Instant t;
    for (int k = 0; k < impacts; ++k) {
      t = t + 1e-3 * std::pow(ratio, k);
      if (history.accelerates(1e-3, t)) {
        return true;
      }
      (void)history.creeps(1.0, 0.0, t);
    }
    return false;
  };
  CHECK(accelerates(0.9995, 1 << 16));
  CHECK_FALSE(accelerates(0.9995, 4095));  // too few to tell
  CHECK_FALSE(accelerates(1.0, 1 << 16));
  CHECK_FALSE(accelerates(1.0001, 1 << 14));
}

TEST_CASE("impacts: looks that get nowhere stall after 200", "[impacts]") {
  ImpactHistory history;
  for (int k = 0; k < 200; ++k) {
    REQUIRE_FALSE(history.stalls(1e-13));
  }
  CHECK(history.stalls(1e-13));
  CHECK_FALSE(history.stalls(1e-3));
}
