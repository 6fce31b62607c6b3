#include "simulation/scene_builder.hpp"

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"

#include <string>

namespace kairos {
namespace {

SceneBuilder drop() {
  SceneBuilder builder("drop");
  builder.set("duration", 2.5)
      .set("frame", "1/60")
      .set("G", 9.8)
      .body("floor", {{"entity", "wall"}, {"shape", "half-space"}})
      .body(
          "ball",
          {{"entity", "ball"}, {"radius", 0.1}, {"mass", 1}, {"position", Vector3(0.0, 5.0, 0.0)}});
  return builder;
}

std::string message(const SceneBuilder& builder) {
  try {
    (void)builder.scene();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a scene built in C++ runs: a ball that falls 4.9 m lands after a second") {
  const Simulation run = simulate(drop().scene());
  REQUIRE_FALSE(run.trajectory.events().empty());
  // sqrt(2 * 4.9 / 9.8), resolved to a few ulp by the closed form.
  CHECK(run.trajectory.events().front().time.seconds == Approx(1.0).margin(1e-15));
}

TEST_CASE("a built scene and its text are the same scene, to the last bit") {
  SceneBuilder builder = drop();
  builder.body("a top",
               {{"entity", "wall"},
                {"half_extents", Vector3(0.1, 0.2, 1.0 / 3.0)},
                {"position", Vector3(2.0, 3.0, 0.0)},
                {"drive", KeyValue({{"frequency", 2.0}, {"amplitude", Vector3::UnitX()}})}});
  const Scene built = builder.scene();
  const Scene read = parse_scene(builder.toml(), "drop.toml");
  REQUIRE(read.bodies.size() == built.bodies.size());
  CHECK(read.duration == built.duration);
  for (std::size_t i = 0; i < built.bodies.size(); ++i) {
    CHECK(read.bodies[i].name == built.bodies[i].name);
    CHECK(read.bodies[i].mass == built.bodies[i].mass);
    CHECK(read.bodies[i].initial.pose.position == built.bodies[i].initial.pose.position);
    CHECK(bounding_radius(read.bodies[i].shape) == bounding_radius(built.bodies[i].shape));
    CHECK((read.bodies[i].drive != nullptr) == (built.bodies[i].drive != nullptr));
  }
}

TEST_CASE("a scene built wrong is refused with the reader's message and the key") {
  SceneBuilder builder = drop();
  builder.body("egg", {{"entity", "ball"}, {"radius", -0.1}, {"mass", 1.0}});
  CHECK(message(builder).find("body.egg.radius") != std::string::npos);
  SceneBuilder typo = drop();
  typo.body("egg", {{"entity", "ball"}, {"raduis", 0.1}, {"mass", 1.0}});
  CHECK(message(typo).find("radius") != std::string::npos);
  SceneBuilder twice = drop();
  twice.body("ball", {{"entity", "ball"}, {"radius", 0.1}, {"mass", 1.0}});
  CHECK(message(twice).find("ball") != std::string::npos);
  CHECK_FALSE(message(SceneBuilder("empty")).empty());
}

}  // namespace kairos
