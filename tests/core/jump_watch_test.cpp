#include "core/schemes/event/jump_watch.hpp"

#include "tests/catch.hpp"

using namespace kairos;

namespace {

/// Two bodies at rest, of which the first is brought at 1 s.
struct World {
  State now{2};
  JumpWatch watch{2};

  World() {
    watch.begin();
    watch.brought(0, Instant{1.0}, now[0]);
  }
  [[nodiscard]] bool complete() const { return watch.left_out(now).empty(); }
};

}  // namespace

TEST_CASE("jump watch: a body that is brought may be left as it is", "[event-driven]") {
  World world;
  CHECK(world.watch.is_brought(0, Instant{1.0}));
  CHECK_FALSE(world.watch.is_brought(0, Instant{2.0}));
  CHECK(world.complete());
}

TEST_CASE("jump watch: what is changed is launched, what is launched is predicted",
          "[event-driven]") {
  World world;
  world.now[0].twist.linear.x() = 1.0;
  CHECK_FALSE(world.complete());
  world.watch.launched(0);
  CHECK_FALSE(world.complete());
  world.watch.predicted(0);
  CHECK(world.complete());
  world.watch.launched(1);  // another body of the island, which is forgotten
  CHECK_FALSE(world.complete());
  world.watch.begin();
  CHECK(world.complete());
}

TEST_CASE("jump watch: a launch before the change is none; what a hand carries meets nothing",
          "[event-driven]") {
  World world;
  world.watch.launched(0, false);
  CHECK(world.complete());
  world.watch.brought(0, Instant{1.0}, world.now[0]);
  world.now[0].pose.position.z() = 1.0;
  CHECK_FALSE(world.complete());
}
