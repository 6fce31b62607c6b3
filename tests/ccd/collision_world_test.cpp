// Many objects at one instant: who touches is who touches when each pair is asked about, whatever
// is remembered; filters; whose response is called.
#include "ccd/collision_world.hpp"

#include "ccd/pair_overlap.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_shapes.hpp"
#include "tests/catch.hpp"
#include "tests/ccd/convex_query.hpp"

using namespace kairos;
using ccd::CollisionWorld;
using ccd::Touch;

namespace {

Pose at(double x) { return {{x, 0.0, 0.0}, Quaternion::Identity()}; }

/// Balls, boxes, hulls, a mesh and a floor, in a box of 6 m.
std::vector<Shape> shapes(Random& random, std::size_t count) {
  std::vector<Shape> all;
  for (std::size_t i = 0; i + 2 < count; ++i) {
    all.push_back(convex::random_shape(random, static_cast<int>(i % 6)));
  }
  all.emplace_back(Mesh{solid_body(torus_mesh(1.0, 0.3, 12, 8)).body});
  all.emplace_back(HalfSpace{});
  return all;
}

}  // namespace

TEST_CASE("a world tells the pairs that touch, and remembers what keeps others apart",
          "[ccd][world]") {
  Random random(3);
  constexpr std::size_t count = 60;
  const std::vector<Shape> all = shapes(random, count);
  CollisionWorld world(count);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back({convex::any_vector(random, 3.0), random.orientation()});
    world.put(i, all[i], poses[i], {i % 3 == 0 ? 2U : 1U, i % 5 == 0 ? 1U : 3U});
  }
  std::int64_t near = 0, reminded = 0, told = 0;
  for (int frame = 0; frame < 30; ++frame) {
    std::vector<std::pair<BodyIndex, BodyIndex>> wanted;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) {
        const auto group = [](std::size_t i) { return i % 3 == 0 ? 2U : 1U; };
        const auto mask = [](std::size_t i) { return i % 5 == 0 ? 1U : 3U; };
        if ((mask(a) & group(b)) != 0 && (mask(b) & group(a)) != 0 &&
            ccd::shapes_overlap(all[a], poses[a], all[b], poses[b])) {
          wanted.emplace_back(a, b);
        }
      }
    }
    std::vector<std::pair<BodyIndex, BodyIndex>> found;
    for (const Touch& touch : world.touching()) {
      found.emplace_back(touch.a, touch.b);
      CHECK(touch.overlap.overlapping);
    }
    CHECK(found == wanted);
    near += world.cost().near;
    reminded += world.cost().reminded;
    told += static_cast<std::int64_t>(found.size());
    CHECK(world.cost().near == world.cost().reminded + world.cost().asked);
    for (std::size_t i = 0; i < count; ++i) {
      poses[i].position += convex::any_vector(random, 0.02);
      poses[i].orientation =
          rotate(convex::any_vector(random, 0.02), poses[i].orientation).normalized();
      world.move(i, poses[i]);
    }
  }
  CAPTURE(near, reminded, told);
  CHECK(told > 1000);                 // otherwise the world shows nothing
  CHECK(2 * reminded > near - told);  // most that stay apart are told so by what is remembered
}

TEST_CASE("of a pair, of one of the two, of all: the nearest response is called", "[ccd][world]") {
  CollisionWorld world(4);
  std::string called;
  const auto says = [&called](const char* what) {
    return [&called, what](const Touch& t) {
      called += what + std::to_string(t.a) + std::to_string(t.b) + " ";
    };
  };
  for (BodyIndex i = 0; i < 4; ++i) {
    world.put(i, Sphere{1.0}, at(1.5 * static_cast<double>(i)));
  }
  CHECK(world.touching().size() == 3);  // 01, 12, 23: nobody has said anything
  world.respond(says("all"));
  world.respond(2, says("one"));
  world.respond(3, 2, says("pair"));
  (void)world.touching();
  CHECK(called == "all01 one12 pair23 ");
  called.clear();
  world.respond(3, 2, {});
  world.remove(1);
  (void)world.touching();
  CHECK(called == "one23 ");
  CHECK_FALSE(world.has(1));
}

TEST_CASE("a response may move and remove objects, from the next time on", "[ccd][world]") {
  CollisionWorld world(3);
  for (BodyIndex i = 0; i < 3; ++i) {
    world.put(i, Box{{1.0, 1.0, 1.0}}, at(0.5 * static_cast<double>(i)));
  }
  world.respond([&world](const Touch& touch) {
    if (touch.a == 0) {
      world.move(touch.b, at(100.0 * static_cast<double>(touch.b)));
    } else {
      world.remove(touch.b);
    }
  });
  CHECK(world.touching().size() == 3);
  CHECK(world.touching().empty());
}

TEST_CASE("a world refuses what is no object and no pose", "[ccd][world]") {
  CollisionWorld world(2);
  CHECK_THROWS_AS(world.put(2, Sphere{1.0}, at(0.0)), std::out_of_range);
  CHECK_THROWS_AS(world.move(0, at(0.0)), std::out_of_range);
  CHECK_THROWS_AS(world.respond(0, [](const Touch&) {}), std::out_of_range);
  CHECK_THROWS_AS(world.put(0, Sphere{1.0}, at(std::nan(""))), std::invalid_argument);
  CHECK_THROWS_AS(world.put(0, Sphere{1.0}, {Vector3::Zero(), Quaternion(0.5, 0, 0, 0)}),
                  std::invalid_argument);
  world.put(0, Sphere{1.0}, at(0.0));
  CHECK(world.touching().empty());
  world.remove(1);
}
