// Impacts without a preferred direction: what collides along a line stays on it, to the last bit,
// whichever axis of the world that line is. Blocks before a wall count the digits of pi.

#include "core/impact_check.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace kairos;

namespace {

std::string text(const Vector3& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
}

/// Where a scene that was thought of along +y is put: turned and moved.
struct Place {
  Quaternion turn = Quaternion::Identity();
  Vector3 up = Vector3::UnitY();  ///< what +y becomes
  int axis = 1;                   ///< of the bodies, along `up`
  Vector3 origin = Vector3::Zero();

  [[nodiscard]] std::string at(double height) const { return text(origin + height * up); }
};

/// Along +-x, +-y, +-z exactly, away from the origin; bodies are not turned.
std::vector<Place> axes() {
  std::vector<Place> places;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Place& place = places.emplace_back();
      place.up = sign * Vector3::Unit(axis);
      place.axis = axis;
      place.origin = {0.3, -0.7, 1.1};
    }
  }
  return places;
}

/// Along directions that no double holds exactly; bodies are turned with them.
std::vector<Place> tilted() {
  std::vector<Place> places;
  for (const Vector3& rotation : {Vector3(0.3, 0, 0), Vector3(1, 2, -0.5), Vector3(-2, 0.1, 0.7)}) {
    const Quaternion q = rotate(rotation, Quaternion::Identity()).normalized();
    places.push_back({.turn = q, .up = q * Vector3::UnitY(), .origin = {0.3, -0.7, 1.1}});
  }
  return places;
}

std::string wall(const std::string& name, const Place& place, double height, double sign) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = {}\n"
      "position = {}\n",
      name, text(sign * place.up), place.at(height));
}

std::string mover(const std::string& name, const std::string& shape, double mass,
                  const Place& place, double height, double speed) {
  const Quaternion& q = place.turn;
  const bool box = shape.find("half_extents") != std::string::npos;
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"{}\"\n{}\nmass = {}\nposition = {}\nvelocity = {}\n"
      "orientation = [{:.17g}, {:.17g}, {:.17g}, {:.17g}]\n",
      name, box ? "body" : "ball", shape, mass, place.at(height), text(speed * place.up), q.w(),
      q.x(), q.y(), q.z());
}

/// Holds every impact to the law, and counts.
class Impacts : public Recorder {
 public:
  void frame(const Frame& frame) override { tests::check_explained(frame.ledger); }
  void event(const Event& event) override {
    if (event.kind == EventKind::impact) {
      ++count;
      if (const std::string broken = broken_restitution(event, 1.0); !broken.empty()) {
        FAIL(broken);
      }
    }
  }
  std::int64_t count = 0;
};

/// A block of 100^digits kg comes towards one of 1 kg before a wall. The number of impacts is pi's
/// first digits (G. Galperin).
std::int64_t count_of_blocks(const Place& place, const std::string& shape, int digits) {
  const double mass = std::pow(100.0, digits);
  const Model model(parse_scene("duration = 20\nframe = 2\nG = 0\n" +
                                    wall("wall", place, 0.0, 1.0) +
                                    mover("small", shape, 1.0, place, 1.5, 0.0) +
                                    mover("large", shape, mass, place, 3.0, -1.0),
                                ""));
  Impacts impacts;
  const RunResult result = simulate(model, {}, impacts);
  INFO(result.reason);
  CHECK(result.status == RunStatus::completed);
  for (const BodyIndex i : {1U, 2U}) {
    CHECK(result.state[i].twist.angular == Vector3::Zero());
  }
  return impacts.count;
}

const std::string ball = "radius = 0.5";
const std::string box = "half_extents = [0.6, 0.5, 0.4]";
const std::string cube = "half_extents = [0.5, 0.5, 0.5]";

/// A box that flies flat between two walls, 3.5 m of way, at 2 m/s; its last state and impacts.
void check_flat(const Place& place, std::int64_t bounces) {
  Vector3 half(0.1, 0.125, 0.2);
  half[place.axis] = 0.25;
  const Model model(parse_scene(
      fmt::format("duration = {}\nframe = {}\nG = 0\n", 1.75 * static_cast<double>(bounces),
                  0.175 * static_cast<double>(bounces)) +
          wall("low", place, 0.0, 1.0) + wall("high", place, 4.0, -1.0) +
          mover("box", "half_extents = " + text(half), 1.0, place, 2.0, 2.0),
      ""));
  Impacts impacts;
  const RunResult result = simulate(model, {}, impacts);
  INFO(result.reason);
  REQUIRE(result.status == RunStatus::completed);
  CHECK(impacts.count == bounces);
  const BodyState& end = result.state[2];
  CHECK(end.twist.angular == Vector3::Zero());
  const Quaternion& start = model.body(2).initial.pose.orientation;
  CHECK(end.pose.orientation.coeffs() == start.coeffs());
  // Elastic. A normal whose square is 1 to 4 eps, as it was given, changes 2 m/s by 16 eps, each
  // time alike; along an axis nothing is rounded.
  const double drift = place.turn.w() == 1.0 ? 0.0 : 16.0 * 0x1p-52 * static_cast<double>(bounces);
  CHECK(std::abs(end.twist.linear.norm() - 2.0) <= drift);
}

}  // namespace

TEST_CASE("blocks before a wall count 31 and 314 along every axis, balls and boxes", "[blocks]") {
  for (const Place& place : axes()) {
    for (const std::string& shape : {ball, cube}) {
      CAPTURE(place.up, shape);
      CHECK(count_of_blocks(place, shape, 1) == 31);
      CHECK(count_of_blocks(place, shape, 2) == 314);
    }
  }
}

TEST_CASE("boxes before a tilted wall count 31 and 314: a symmetric patch turns nothing",
          "[blocks]") {
  for (const Place& place : tilted()) {
    CAPTURE(place.up);
    // Other half-extents along the line would move the walls of the count, not the count.
    CHECK(count_of_blocks(place, box, 1) == 31);
    CHECK(count_of_blocks(place, box, 2) == 314);
  }
}

TEST_CASE("blocks before a wall count 3141, balls 31415, along every axis", "[blocks][slow]") {
  for (const Place& place : axes()) {
    CAPTURE(place.up);
    CHECK(count_of_blocks(place, ball, 3) == 3141);
    CHECK(count_of_blocks(place, cube, 3) == 3141);
    CHECK(count_of_blocks(place, ball, 4) == 31415);
  }
}

TEST_CASE("balls before a wall count 314159 along x, y and z", "[blocks][slow]") {
  for (const std::size_t along : {0U, 2U, 4U}) {
    const Place place = axes()[along];
    CAPTURE(place.up);
    CHECK(count_of_blocks(place, ball, 5) == 314159);
  }
}

TEST_CASE("a box that flies flat between two walls stays flat", "[blocks]") {
  for (const Place& place : axes()) {
    CAPTURE(place.up);
    check_flat(place, 2000);
  }
  for (const Place& place : tilted()) {
    CAPTURE(place.up);
    check_flat(place, 2000);
  }
}

TEST_CASE("a box that flies flat between two walls stays flat for 1e6 bounces", "[blocks][slow]") {
  for (const Place& place : {axes()[0], axes()[5], tilted()[1]}) {
    CAPTURE(place.up);
    check_flat(place, 1'000'000);
  }
}
