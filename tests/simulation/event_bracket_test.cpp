// What an event tells of its time: the bracket of an impact holds the true time, contact begins
// when the hops have died down, and events of one instant tell one story.

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

using namespace kairos;
using tests::of_kind;

namespace {

const std::string floor_body =
    "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n";

Simulation run(const std::string& text) { return simulate(parse_scene(text, "test.toml"), {}); }

}  // namespace

TEST_CASE("the bracket of an impact holds its time", "[event-driven]") {
  constexpr std::uint64_t seed = 20261123;
  for (std::uint64_t k = 0; k < 200; ++k) {
    Random random(seed, k);
    const double G = random.uniform(1.0, 20.0);
    const double radius = std::pow(10.0, random.uniform(-3.0, 1.0));
    const double height = radius * (1.0 + std::pow(10.0, random.uniform(-2.0, 3.0)));
    const double up = random.uniform(-3.0, 3.0);
    const bool box = random.below(2) == 0;
    // The earlier root of height - radius + up t - G t^2 / 2, in a form in which nothing cancels.
    const long double fall = static_cast<long double>(height) - radius;
    const long double root = std::sqrt(static_cast<long double>(up) * up + 2.0L * G * fall);
    const long double truth = up > 0.0 ? (up + root) / G : 2.0L * fall / (root - up);
    const Simulation sim = run(fmt::format(
        "duration = {}\nframe = 10\nG = {}\n{}[[body]]\nname = \"b\"\nentity = \"body\"\n{}\n"
        "mass = 1\nposition = [0, {}, 0]\nvelocity = [{}, {}, 0]\n",
        static_cast<double>(1.5L * truth), G, floor_body,
        box ? fmt::format("half_extents = [0.1, {}, 0.2]", radius)
            : fmt::format("radius = {}", radius),
        height, random.uniform(-1.0, 1.0), up));
    const std::vector<Event> impacts = of_kind(sim.trajectory, EventKind::impact);
    CAPTURE(k, G, radius, height, up, box, sim.result.reason);
    REQUIRE(!impacts.empty());
    const Instant t = impacts.front().time;
    const long double late =
        (truth - static_cast<long double>(t.seconds)) - static_cast<long double>(t.correction);
    const double bracket = impacts.front().bracket;
    CHECK(late >= 0.0L);
    CHECK(late <= static_cast<long double>(bracket));
    CHECK(bracket <= 1e-6 * static_cast<double>(truth));  // a bracket, not a window
  }
}

TEST_CASE("what ends at an impact is told with the velocity that the impact left",
          "[event-driven]") {
  // A ball slides down a smooth ramp onto a floor, which takes the speed along its normal.
  const Simulation sim =
      run("duration = 1\nfriction = 0\n" + floor_body +
          "[[body]]\nname = \"ramp\"\nentity = \"wall\"\nshape = \"half-space\"\n"
          "normal = [0.49999999999999994, 0.8660254037844387, 0]\n"
          "[[body]]\nname = \"b\"\nentity = \"body\"\nshape = \"sphere\"\nradius = 0.05\nmass = 1\n"
          "position = [-0.8410254037844387, 0.5433012701892219, 0]\nrestitution = 0\n");
  const std::vector<Event> impacts = of_kind(sim.trajectory, EventKind::impact);
  const std::vector<Event> ends = of_kind(sim.trajectory, EventKind::contact_ends);
  REQUIRE(impacts.size() == 1);
  REQUIRE(ends.size() == 1);
  REQUIRE(ends[0].time == impacts[0].time);
  const BodyState& left = impacts[0].a == ends[0].a ? impacts[0].after_a : impacts[0].after_b;
  CHECK(ends[0].before_a.twist.linear == left.twist.linear);
  CHECK(ends[0].after_a.twist.linear == left.twist.linear);
}

TEST_CASE("what hops and slides is told to slide when its contact has begun", "[event-driven]") {
  const Simulation sim =
      run("duration = 3\nG = 9.8\nfriction = 0.1\n" + floor_body +
          "[[body]]\nname = \"b\"\nentity = \"body\"\nhalf_extents = [0.5, 0.05, 0.5]\nmass = 1\n"
          "position = [0, 0.15, 0]\nvelocity = [5, 0, 0]\nrestitution = 0.5\n");
  REQUIRE(sim.result.status == RunStatus::completed);
  const std::vector<Event> begins = of_kind(sim.trajectory, EventKind::contact_begins);
  const std::vector<Event> slips = of_kind(sim.trajectory, EventKind::slip_begins);
  REQUIRE(begins.size() == 1);
  REQUIRE(slips.size() == 1);
  CHECK(begins[0].time <= slips[0].time);
  CHECK(begins[0].grade == Grade::exact);
  // sqrt(2 h / g) (1 + 2 e / (1 - e)); hops of 1e-11 m and shorter are summed up.
  const double zeno = std::sqrt(2.0 * 0.1 / 9.8) * 3.0;
  CHECK(begins[0].time.seconds == Approx(zeno).epsilon(1e-11));
  CHECK(begins[0].bracket == 0.0);
  std::size_t begun = 0;
  for (const Event& event : sim.trajectory.events()) {
    begun += event.kind == EventKind::contact_begins ? 1 : 0;
    CHECK((event.kind != EventKind::slip_begins || begun > 0));
    CHECK((event.kind != EventKind::stick_begins || begun > 0));
  }
}

TEST_CASE("what is handed on between bodies in touch is told to be set-valued", "[event-driven]") {
  const auto body = [](const std::string& name, const std::string& shape, double height) {
    return fmt::format(
        "[[body]]\nname = \"{}\"\nentity = \"body\"\n{}\nmass = 1\nposition = [0, {}, 0]\n"
        "restitution = 0.5\n",
        name, shape, height);
  };
  const std::string brick = "half_extents = [0.2, 0.1, 0.2]";
  const Simulation sim =
      run("duration = 0.5\nfriction = 0.2\n" + floor_body + body("low", brick, 0.1) +
          body("top", brick, 0.3) + body("ball", "radius = 0.1", 0.6));
  const std::vector<Event> impacts = of_kind(sim.trajectory, EventKind::impact);
  REQUIRE(impacts.size() > 2);
  CHECK(impacts[0].flag == EventFlag::none);  // of the ball, alone
  CHECK(impacts[1].time == impacts[0].time);
  CHECK(impacts[1].flag == EventFlag::set_valued);
  const Simulation alone = run("duration = 2\n" + floor_body + body("ball", "radius = 0.1", 0.6));
  for (const Event& event : alone.trajectory.events()) {
    CHECK(event.flag == EventFlag::none);
  }
}
