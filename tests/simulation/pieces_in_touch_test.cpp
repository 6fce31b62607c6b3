// Meshes and compounds that turn while they touch, by their pieces.
#include "core/model.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/whole_run.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace kairos;
using namespace kairos::simulation;
using namespace kairos::tests;

namespace {

constexpr double g = 9.8;

Simulation run(const std::string& text, double truncated = 1e-8) {
  const Scene scene = parse_scene(text, "test.toml");
  Simulation sim = simulate(scene, {});
  check_whole(sim, scene, truncated);
  return sim;
}

std::string world(double duration, const std::string& friction) {
  return fmt::format("duration = {}\nframe = \"1/60\"\nG = {}\nfriction = {}\n", duration, g,
                     friction);
}

/// A strip of `rows` x 4 heights about the origin, 0.1 m apart along x, `step` along z.
std::string field(int rows, double step, const std::string& row, const std::string& tilt) {
  std::string heights;
  for (int i = 0; i < rows; ++i) {
    heights += row + ", ";
  }
  return fmt::format(
      "[[body]]\nname = \"ground\"\nentity = \"wall\"\nshape = \"height-field\"\nheights = [{}]\n"
      "spacing = [0.1, {}]\n{}\n",
      heights, step, tilt);
}

}  // namespace

// Two equal balls on a rod, a compound, roll down a slope as what rolls does: a = g sin / (1 + I /
// (m r^2)), I about the rod.
TEST_CASE("pieces: a dumbbell rolls as fast as its moment says", "[pieces]") {
  constexpr double slope = 0.2;
  constexpr double r = 0.1;
  const std::string text =
      world(1.0, "0.6") +
      fmt::format(
          "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n"
          "normal = [{}, {}, 0]\n"
          "[[body]]\nname = \"dumbbell\"\nentity = \"body\"\nshape = \"compound\"\n"
          "mass = 1\nrestitution = 0\nposition = [{}, {}, 0]\n"
          "[[body.part]]\nshape = \"sphere\"\nradius = {}\nposition = [0, 0, -0.2]\n"
          "[[body.part]]\nshape = \"sphere\"\nradius = {}\nposition = [0, 0, 0.2]\n"
          "[[body.part]]\nshape = \"cylinder\"\nradius = 0.03\nlength = 0.4\n"
          "axis_angle = [1, 0, 0, 1.5707963267948966]\n",
          std::sin(slope), std::cos(slope), r * std::sin(slope), r * std::cos(slope), r, r);
  const Simulation sim = run(text);
  const Model model(parse_scene(text, "test.toml"));
  // It is on the floor, and along the rod nothing of it is special but that axis.
  const BodyInertia& inertia = model.inertia(1);
  const Vector3 rod = inertia.axes.conjugate() * Vector3::UnitZ();
  const double about = rod.cwiseAbs2().dot(inertia.principal);
  const double a = g * std::sin(slope) / (1.0 + about / (inertia.mass * r * r));
  for (const double t : {0.3, 0.6, 1.0}) {
    const BodyState state = sim.trajectory.at(1, Instant{} + t);
    const Vector3 down(std::cos(slope), -std::sin(slope), 0.0);
    const Vector3 way = state.pose.position - sim.trajectory.at(1, Instant{}).pose.position;
    INFO(t);
    CHECK(std::abs(way.dot(down) - 0.5 * a * t * t) <= 1e-9);
    CHECK(std::abs(way.z()) <= 1e-9);
  }
}

// Where triangles end within a plane nothing happens: a ball rolls over a mesh as over a plane.
TEST_CASE("pieces: a ball rolls over the triangles of a flat mesh", "[pieces]") {
  constexpr double slope = 0.25;
  constexpr double r = 0.07;
  const std::string text =
      world(0.9, "0.5") +
      field(15, 0.13, "[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]",
            fmt::format("axis_angle = [0, 0, 1, {}]", -slope)) +
      fmt::format(
          "[[body]]\nname = \"ball\"\nentity = \"body\"\nshape = \"sphere\"\nradius = {}\n"
          "mass = 1\nrestitution = 0\nposition = [{}, {}, 0.021]\n",
          r, r * std::sin(slope) - 0.4 * std::cos(slope),
          r * std::cos(slope) + 0.4 * std::sin(slope));
  const Simulation sim = run(text);
  const double a = 5.0 / 7.0 * g * std::sin(slope);
  for (const double t : {0.2, 0.5, 0.9}) {
    const Vector3 way = sim.trajectory.at(1, Instant{} + t).pose.position -
                        sim.trajectory.at(1, Instant{}).pose.position;
    INFO(t);
    CHECK(std::abs(way.dot(Vector3(std::cos(slope), -std::sin(slope), 0.0)) - 0.5 * a * t * t) <=
          1e-9);
    CHECK(std::abs(way.z()) <= 1e-9);
  }
}

// In a groove of a mesh a ball touches two of its faces at once: it slides down without friction,
// and rolls about the line through both points with it, a = g sin / (1 + 2/5 (r / d)^2), d from
// that line to its middle.
TEST_CASE("pieces: a ball in the groove of a mesh", "[pieces]") {
  constexpr double slope = 0.2;
  constexpr double half = 0.78539816339744831;  // of the groove, rad
  constexpr double r = 0.04;
  for (const bool rolls : {false, true}) {
    // Along z the groove; sides of 45 degrees over 0.1 m.
    const std::string text =
        world(0.5, rolls ? "0.6" : "0") +
        "[[body]]\nname = \"ground\"\nentity = \"wall\"\nshape = \"height-field\"\n"
        "heights = [[0.1, 0.1, 0.1, 0.1, 0.1, 0.1], [0, 0, 0, 0, 0, 0], "
        "[0.1, 0.1, 0.1, 0.1, 0.1, 0.1]]\nspacing = [0.1, 0.2]\n" +
        fmt::format("axis_angle = [1, 0, 0, {}]\n", slope) +
        fmt::format(
            "[[body]]\nname = \"ball\"\nentity = \"body\"\nshape = \"sphere\"\n"
            "radius = {}\nmass = 1\nrestitution = 0\nposition = [0, {}, {}]\n",
            r, r / std::sin(half) * std::cos(slope) + 0.3 * std::sin(slope),
            r / std::sin(half) * std::sin(slope) - 0.3 * std::cos(slope));
    const Simulation sim = run(text);
    const double d = r * std::sin(half);
    const double a = g * std::sin(slope) / (rolls ? 1.0 + 0.4 * (r / d) * (r / d) : 1.0);
    for (const double t : {0.2, 0.5}) {
      const Vector3 way = sim.trajectory.at(1, Instant{} + t).pose.position -
                          sim.trajectory.at(1, Instant{}).pose.position;
      CAPTURE(rolls, t);
      CHECK(std::abs(way.dot(Vector3(0.0, -std::sin(slope), std::cos(slope))) - 0.5 * a * t * t) <=
            1e-9);
    }
  }
}

// A box made of two halves tips and falls as the whole box does.
TEST_CASE("pieces: two halves move as the whole", "[pieces]") {
  const auto scene = [](const std::string& shape) {
    return world(0.5, "0.8") +
           "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n"
           "[[body]]\nname = \"box\"\nentity = \"body\"\n" +
           "mass = 2\nrestitution = 0\naxis_angle = [0, 0, 1, -0.5]\n" +
           fmt::format("position = [0, {}, 0]\n", 0.2 * std::cos(0.5) + 0.1 * std::sin(0.5)) +
           shape;
  };
  const Simulation whole = run(scene("half_extents = [0.1, 0.2, 0.15]\n"), 1e-6);
  const Simulation halves =
      run(scene("shape = \"compound\"\n"
                "[[body.part]]\nhalf_extents = [0.1, 0.1, 0.15]\nposition = [0, -0.1, 0]\n"
                "[[body.part]]\nhalf_extents = [0.1, 0.1, 0.15]\nposition = [0, 0.1, 0]\n"),
          1e-6);
  for (const double t : {0.1, 0.2, 0.3, 0.5}) {
    const BodyState a = whole.trajectory.at(1, Instant{} + t);
    const BodyState b = halves.trajectory.at(1, Instant{} + t);
    INFO(t);
    CHECK((a.pose.position - b.pose.position).norm() <= 1e-8);
  }
}

// Over edges that rise, and into hollows between faces.
TEST_CASE("pieces: over hills and into hollows", "[pieces]") {
  const std::string hills = world(1.2, "0.4") + R"(
[[body]]
name = "ground"
entity = "wall"
shape = "height-field"
heights = [[0.08, 0.05, 0.0, -0.02, 0.0, 0.04, 0.06], [0.06, 0.02, -0.03, -0.06, -0.02, 0.03, 0.05],
  [0.0, -0.03, -0.07, -0.08, -0.06, -0.01, 0.02], [-0.02, -0.05, -0.08, -0.1, -0.07, -0.02, 0.01],
  [0.01, -0.02, -0.06, -0.07, -0.05, 0.0, 0.03], [0.05, 0.03, -0.02, -0.04, 0.0, 0.04, 0.07],
  [0.09, 0.06, 0.02, 0.0, 0.03, 0.07, 0.1]]
spacing = [0.2, 0.2]
)";
  const std::string at =
      "entity = \"body\"\nmass = 1\nrestitution = 0.3\nvelocity = [0.4, 0, -0.3]\n"
      "axis_angle = [0.3, 0.2, 1, 0.6]\nposition = [0.21, 0.3, 0.17]\n";
  for (const std::string shape :
       {"shape = \"sphere\"\nradius = 0.06\n", "half_extents = [0.06, 0.09, 0.05]\n",
        "shape = \"compound\"\n[[body.part]]\nhalf_extents = [0.15, 0.03, 0.03]\n"
        "[[body.part]]\nhalf_extents = [0.03, 0.1, 0.03]\nposition = [-0.12, 0.12, 0]\n"}) {
    INFO(shape);
    (void)run(fmt::format("{}[[body]]\nname = \"thing\"\n{}{}", hills, at, shape), 1e-6);
  }
}
