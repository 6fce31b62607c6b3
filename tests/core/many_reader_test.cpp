// `[[many]]`: bodies in number, written once.
#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "tests/catch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace kairos;

namespace {

/// A scene of one `[[many]]` with these lines.
Scene many(const std::string& lines) {
  return parse_scene("[[many]]\nname = \"b\"\nentity = \"body\"\nmass = 2.0\n" + lines, "s.toml");
}

const std::string region = "region = {min = [0, 0, 0], max = [4, 4, 4]}\n";

std::string complaint(const std::string& lines) {
  try {
    (void)many(lines);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("many: what is written once arrives as often as it says", "[scene][many]") {
  const Scene scene =
      many("count = 100\nradius = 0.2\nrestitution = 0.5\nvelocity = [1, 0, 0]\n" + region);
  REQUIRE(scene.bodies.size() == 100);
  CHECK(scene.bodies[0].name == "b-001");
  CHECK(scene.bodies[99].name == "b-100");
  for (const Body& body : scene.bodies) {
    CHECK(std::get<Sphere>(body.shape).radius == 0.2);
    CHECK(body.mass == 2.0);
    CHECK(body.restitution == 0.5);
    CHECK(body.initial.twist.linear == Vector3(1, 0, 0));
  }
}

TEST_CASE("many: they come after the bodies, and beside other manies", "[scene][many]") {
  const Scene scene = parse_scene(
      "[[many]]\nname = \"a\"\nentity = \"ball\"\nradius = 0.1\nmass = 1\ncount = 3\n"
      "region = {min = [0, 0, 0], max = [1, 1, 1]}\n"
      "[[many]]\nname = \"c\"\nentity = \"wall\"\nhalf_extents = [0.1, 0.1, 0.1]\ncount = 2\n"
      "region = {min = [2, 0, 0], max = [3, 1, 1]}\n"
      "[[body]]\nname = \"one\"\nentity = \"ball\"\nradius = 1\nmass = 1\nposition = [9, 9, 9]\n",
      "");
  REQUIRE(scene.bodies.size() == 6);
  CHECK(scene.bodies[0].name == "one");
  CHECK(scene.bodies[1].name == "a-1");
  CHECK(scene.bodies[4].name == "c-1");
}

TEST_CASE("many: sizes keep the density, velocities have their deviation, seeds repeat",
          "[scene][many]") {
  const std::string lines =
      "count = 2000\nhalf_extents = [0.02, 0.03, 0.04]\nsizes = [0.5, 1.0]\nplacement = "
      "\"random\"\norientations = \"random\"\nvelocity_deviation = 3.0\n"
      "angular_velocity_deviation = 0.5\nseed = 5\n" +
      region;
  const Scene scene = many(lines);
  const Scene again = many(lines);
  double square = 0.0;
  double spin = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const double size = std::get<Box>(body.shape).half_extents.x() / 0.02;
    CHECK(size >= 0.5);
    CHECK(size <= 1.0);
    CHECK(body.mass == Approx(2.0 * size * size * size));
    CHECK(body.inertia.x() == Approx(solid_inertia(body.shape, body.mass).x()));
    CHECK(body.initial.pose.position == again.bodies[i].initial.pose.position);
    CHECK(body.initial.twist.linear == again.bodies[i].initial.twist.linear);
    square += body.initial.twist.linear.squaredNorm();
    spin += body.initial.twist.angular.squaredNorm();
  }
  // 6000 components of variance 9: the mean square is off by less than five standard deviations,
  // sqrt(2 / 6000) each.
  const double five = 5.0 * std::sqrt(2.0 / 6000.0);
  CHECK(std::abs(square / 6000.0 / 9.0 - 1.0) < five);
  CHECK(std::abs(spin / 6000.0 / 0.25 - 1.0) < five);
  // One choice leaves the others' draws alone.
  const Scene slower = many(
      "count = 2000\nhalf_extents = [0.02, 0.03, 0.04]\nsizes = [0.5, 1.0]\n"
      "placement = \"random\"\nseed = 5\n" +
      region);
  CHECK(slower.bodies[1234].initial.pose.position == scene.bodies[1234].initial.pose.position);
}

TEST_CASE("many: what cannot be is refused with file, line, key and what is allowed",
          "[scene][many]") {
  const auto has = [](const std::string& text, const std::string& part) {
    INFO(text);
    CHECK(text.find(part) != std::string::npos);
  };
  has(complaint("radius = 0.2\n" + region), "s.toml:1: many.b.count: is missing");
  has(complaint("count = 0\nradius = 0.2\n" + region), "s.toml:5: many.b.count: ");
  has(complaint("count = 99999999\nradius = 0.2\n" + region), "1 to 10000000");
  has(complaint("count = 5\nradius = 0.2\n"), "many.b.region: is missing");
  has(complaint("count = 5\nradius = 0.2\nregion = {min = [0, 0, 0], max = [1, 0, 1]}\n"),
      "s.toml:7: many.b.region.max: is not above min");
  has(complaint("count = 5000\nradius = 0.2\n" + region), "allowed: at most");
  has(complaint("count = 900\nradius = 0.2\nplacement = \"random\"\n" + region), "jams at 0.38");
  has(complaint("count = 5\nradius = 3.0\nplacement = \"random\"\n" + region),
      "no room for more than 0 of 5");
  has(complaint("count = 5\nradius = 0.2\nposition = [1, 1, 1]\n" + region),
      "many.b.position: is of one body");
  has(complaint("count = 5\nradius = 0.2\nsizes = [2, 1]\n" + region), "many.b.sizes: ");
  has(complaint("count = 5\nradius = 0.2\nsises = [1, 2]\n" + region), "sizes");
  has(complaint("count = 5\nradius = nan\n" + region), "many.b.radius: ");
  has(complaint("count = 5\nradius = 0.2\nvelocity_deviation = inf\n" + region),
      "many.b.velocity_deviation: ");
  CHECK_THROWS_AS(parse_scene("duration = 1\n", ""), InputError);
}

TEST_CASE("many: a million are placed, a value of theirs is replaced from outside",
          "[scene][many]") {
  const Scene scene = parse_scene(
      "[[many]]\nname = \"b\"\nentity = \"ball\"\nmass = 1\nradius = 0.004\ncount = 10\n"
      "region = {min = [0, 0, 0], max = [1, 1, 1]}\n",
      "", {{"many.b.count", "1000000"}});
  CHECK(scene.bodies.size() == 1'000'000);
}
