// A hull's axes are those in which its points are written, wherever its principal axes lie.

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

using namespace kairos;

namespace {

std::string list(const Vector3& x) { return fmt::format("[{}, {}, {}]", x.x(), x.y(), x.z()); }

std::string list(const Quaternion& q) {
  return fmt::format("[{}, {}, {}, {}]", q.w(), q.x(), q.y(), q.z());
}

constexpr double floor_height = -0.1;

/// A body in the air that falls onto a floor; `shape`: its keys.
std::string scene(const std::string& shape, const Quaternion& q) {
  return fmt::format(R"(duration = 1.5
frame = 0.05
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
position = [0, {}, 0]
[[body]]
name = "stone"
entity = "body"
mass = 2.0
restitution = 0.8
position = [0, 1, 0]
velocity = [0.3, 0.5, -0.2]
angular_velocity = [2, 1, -3]
orientation = {}
{}
)",
                     floor_height, list(q), shape);
}

std::vector<Vector3> corners_of_box(const Vector3& h) {
  std::vector<Vector3> points;
  for (int k = 0; k < 8; ++k) {
    points.emplace_back((k & 1) != 0 ? h.x() : -h.x(), (k & 2) != 0 ? h.y() : -h.y(),
                        (k & 4) != 0 ? h.z() : -h.z());
  }
  return points;
}

std::string hull_of(const std::vector<Vector3>& points, const Quaternion& axes) {
  std::string text = "shape = \"hull\"\npoints = [";
  for (const Vector3& x : points) {
    text += list(axes.conjugate() * x) + ", ";
  }
  return text + "]\n";
}

Simulation run(const std::string& text, const std::string& integrator = "auto",
               double step = 0.05) {
  RunChoice choice;
  choice.step = step;
  choice.method.integrator = integrator;
  return simulate(parse_scene(text, "hull.toml"), choice);
}

Quaternion drawn(Random& random) {
  return Quaternion(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                    random.uniform(-1, 1))
      .normalized();
}

const Vector3 half(0.1, 0.2, 0.3);

}  // namespace

TEST_CASE("A hull is where its written points are", "[hull]") {
  Random random(11);
  for (int n = 0; n < 5; ++n) {
    const Quaternion axes = drawn(random), q = drawn(random);
    const Simulation sim = run(scene(hull_of(corners_of_box(half), axes), q));
    REQUIRE(sim.result.end.seconds > 0.2);
    // Printed digits are those of the doubles; reading normalises.
    CHECK((sim.trajectory.frame_state(0)[1].pose.orientation.coeffs() - q.coeffs()).norm() < 1e-15);
    int impacts = 0;
    for (const Event& event : sim.trajectory.events()) {
      if (event.kind != EventKind::impact) {
        continue;
      }
      ++impacts;
      const Pose pose = sim.trajectory.at(1, event.time).pose;
      double lowest = 10.0;
      for (const Vector3& x : corners_of_box(half)) {
        lowest = std::min(lowest, (pose.position + pose.orientation * (axes.conjugate() * x)).y());
      }
      CHECK(lowest - floor_height >= 0.0);
      CHECK(lowest - floor_height <= 1e-9);  // the tolerance of an impact
    }
    CHECK(impacts >= 1);
  }
}

TEST_CASE("The axes in which a solid is written change nothing of its motion", "[hull]") {
  Random random(12);
  const Quaternion axes = drawn(random), q = drawn(random);
  const std::string box = fmt::format("half_extents = {}\n", list(half));
  const std::string hull = hull_of(corners_of_box(half), axes);
  // As many digits as the integrator keeps of one motion told in two ways, over one impact; the
  // splitting, of second order, takes the principal axes in their order.
  for (const auto& [integrator, digits] :
       {std::pair("auto", 1e-8), std::pair("dopri5", 1e-6), std::pair("rk4", 1e-8),
        std::pair("free-top-splitting", 1e-4)}) {
    CAPTURE(integrator);
    const Simulation first = run(scene(box, q), integrator, 0.005);
    const Simulation second = run(scene(hull, (q * axes).normalized()), integrator, 0.005);
    const std::size_t frames = 8;
    REQUIRE(first.trajectory.frame_times().size() > frames);
    REQUIRE(second.trajectory.frame_times().size() > frames);
    for (std::size_t n = 0; n <= frames; ++n) {
      const BodyState& a = first.trajectory.frame_state(n)[1];
      const BodyState& b = second.trajectory.frame_state(n)[1];
      CHECK((a.pose.position - b.pose.position).norm() < digits);
      CHECK((a.twist.linear - b.twist.linear).norm() < digits);
      CHECK((a.twist.angular - b.twist.angular).norm() < digits);
      CHECK((a.pose.orientation * axes).angularDistance(b.pose.orientation) < digits);
    }
  }
}

TEST_CASE("Moments that are given are along the axes that are told", "[hull]") {
  Random random(13);
  const Quaternion axes = drawn(random), q = drawn(random);
  std::string text =
      scene(hull_of(corners_of_box(half), axes) + "inertia = [0.02, 0.03, 0.04]\n", q);
  const std::string spin = "angular_velocity = [2, 1, -3]";
  text.replace(text.find(spin), spin.size(), "angular_velocity = " + list(q * Vector3(0, 5, 0)));
  // About a principal axis it turns at a constant rate, until it meets the floor.
  const Simulation sim = run(text);
  for (std::size_t n = 0; n < 6; ++n) {
    const BodyState& state = sim.trajectory.frame_state(n)[1];
    CHECK((state.twist.angular - q * Vector3(0, 5, 0)).norm() < 1e-13);
  }
}

TEST_CASE("A driven hull is driven in the axes of its points", "[hull]") {
  std::string text = R"(duration = 1
[[body]]
name = "bat"
entity = "bat"
mass = 1.0
shape = "hull"
points = [[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]]
drive = { frequency = 1.0, amplitude = [0.1, 0.0, 0.0] }
)";
  const Scene read = parse_scene(text, "bat.toml");
  CHECK(read.bodies[0].initial.pose.orientation.vec().isZero(0.0));
}
