#include "core/schemes/event/motion_table.hpp"

#include "core/reading/scene_reader.hpp"
#include "tests/catch.hpp"

#include <cstring>
#include <limits>
#include <string>
#include <vector>

// What is kept of a motion tells all of it: a ball on a parabola has its flight alone, and the
// motion that is made of it differs in no bit from the one that was kept.

using namespace kairos;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// So many balls that flights are kept instead of motions, one of them tilted.
Model many_balls() {
  std::string text = "G = 0.0\n";
  for (int i = 0; i < 200; ++i) {
    text += "[[body]]\nname = \"" + std::to_string(i) + "\"\nentity = \"ball\"\nmass = 1.0\n" +
            "radius = 0.1\nposition = [" + std::to_string(i) + ", 0, 0]\n";
  }
  Scene scene = parse_scene(text, "many");
  scene.bodies[1].initial.pose.orientation = Quaternion(0.6, 0.0, 0.8, 0.0);
  return Model(std::move(scene));
}

template <int Dim>
void check_same(const Polynomial<Dim>& x, const Polynomial<Dim>& y) {
  REQUIRE(x.degree() == y.degree());
  for (int k = 0; k <= x.degree(); ++k) {
    CHECK(std::memcmp(x[k].data(), y[k].data(), sizeof(double) * Dim) == 0);
  }
}

void check_same(const Motion& x, const Motion& y) {
  CHECK(x.start == y.start);
  CHECK(x.duration == y.duration);
  CHECK(x.error_radius == y.error_radius);
  CHECK(x.rotation == y.rotation);
  check_same(x.position, y.position);
  check_same(x.velocity, y.velocity);
  check_same(x.quaternion, y.quaternion);
  check_same(x.angular_velocity, y.angular_velocity);
  CHECK(std::memcmp(x.rotation_rate.data(), y.rotation_rate.data(), 3 * sizeof(double)) == 0);
}

void check_same(const BodyState& x, const BodyState& y) {
  CHECK(x.pose.position == y.pose.position);
  CHECK(x.pose.orientation.coeffs() == y.pose.orientation.coeffs());
  CHECK(x.twist.linear == y.twist.linear);
  CHECK(x.twist.angular == y.twist.angular);
}

Motion parabola(const Pose& pose, const Vector3& v, const Vector3& a) {
  return Motion::ballistic(Instant{3.0, 1e-17}, infinity, pose, {v, Vector3::Zero()}, a);
}

}  // namespace

TEST_CASE("a motion that is kept as a flight comes back bit for bit", "[many]") {
  const Model model = many_balls();
  MotionTable table(model);
  const Pose upright{Vector3(0.1, -0.0, 1.0 / 3.0), Quaternion(1.0, 0.0, 0.0, 0.0)};
  const Pose tilted{upright.position, model.body(1).initial.pose.orientation};
  const Vector3 v(0.7, -0.3, 1e-300);
  const Vector3 g(0.0, -9.81, -0.0);

  std::vector<Motion> flights{parabola(upright, v, g), parabola(upright, v, Vector3::Zero()),
                              parabola(upright, Vector3::Zero(), Vector3::Zero()),
                              parabola(upright, Vector3::Zero(), g)};
  std::vector<Motion> others = flights;
  others[0].duration = 2.0;
  others[1].error_radius = 1e-9;
  others[2].velocity = Polynomial<3>(v);  // moves on a path of its own
  others[3].position.resize(3);
  others[3].position[3] = Vector3(1.0, 2.0, 3.0);
  others.push_back(Motion::ballistic(Instant{}, infinity, upright, {v, Vector3(1.0, 2.0, 3.0)}, g));
  others.push_back(parabola({upright.position, Quaternion(0.0, 1.0, 0.0, 0.0)}, v, g));

  const auto keep = [&](BodyIndex i, const Motion& motion, bool as_flight) {
    table.keep(i, motion);
    CHECK(table.is_flight(i) == as_flight);
    check_same(table.of(i), motion);
    check_same(table.moving(i).motion(), motion);
    CHECK(table.start(i) == motion.start);
    CHECK(table.duration(i) == motion.duration);
    CHECK(table.end(i) == motion.end());
    for (const double s : {0.0, 0.3, 1.9}) {
      check_same(table.at(i, motion.start + s), {motion.pose(s), motion.twist(s)});
    }
  };
  for (const Motion& flight : flights) {
    for (const Motion& other : others) {  // places of what is no flight are given back and taken
      keep(0, flight, true);
      keep(2, other, false);
      keep(0, other, false);
      keep(2, flight, true);
    }
  }
  keep(1, parabola(tilted, v, g), true);
  keep(0, parabola(tilted, v, g), false);
}
