#include "core/trajectory.hpp"

#include "core/reading/scene_reader.hpp"
#include "tests/catch.hpp"
#include "tests/locations.hpp"

using namespace kairos;

TEST_CASE("trajectory: samples the motion that is valid at a time", "[trajectory]") {
  const Model model(read_scene(tests::source_path("scenes/bounce.toml")));
  Trajectory trajectory;
  trajectory.begin(model);
  const Vector3 g(0, -10, 0);
  // Falls for ever, but at 1 s a second motion takes over.
  trajectory.motion(1, Motion::ballistic(Instant{}, 1e9, {}, {}, g));
  trajectory.motion(
      1, Motion::ballistic(Instant{1.0}, 2.0, {Vector3(0, -5, 0)}, {Vector3(0, 10, 0)}, g));
  CHECK(trajectory.at(1, Instant{0.5}).pose.position.y() == -1.25);
  CHECK(trajectory.at(1, Instant{1.0}).twist.linear.y() == 10.0);
  CHECK(trajectory.at(1, Instant{2.0}).pose.position.y() == 0.0);
  // Outside of the run: its ends.
  CHECK(trajectory.at(1, Instant{-1.0}).pose.position.y() == 0.0);
  CHECK(trajectory.at(1, Instant{9.0}).twist.linear.y() == -10.0);
}

TEST_CASE("trajectory: keeps frames and starts again", "[trajectory]") {
  const Model model(read_scene(tests::source_path("scenes/bounce.toml")));
  const State state = model.initial_state();
  const EnergyLedger ledger;
  Trajectory trajectory;
  trajectory.begin(model);
  trajectory.frame({0, Instant{0.5}, state, ledger});
  REQUIRE(trajectory.frame_times().size() == 1);
  CHECK(trajectory.frame_times()[0].seconds == 0.5);
  CHECK(trajectory.frame_state(0)[1].pose.position.y() == 5.0);
  trajectory.begin(model);
  CHECK(trajectory.frame_times().empty());
}

TEST_CASE("names of events and stages are words without spaces", "[trajectory]") {
  for (const EventKind kind :
       {EventKind::impact, EventKind::contact_begins, EventKind::contact_ends,
        EventKind::field_entered, EventKind::field_left, EventKind::grasped, EventKind::released}) {
    CHECK(to_string(kind).find(' ') == std::string_view::npos);
    CHECK_FALSE(to_string(kind).empty());
  }
  CHECK(to_string(Stage::restrict_movement) == "restrict-movement");
}
