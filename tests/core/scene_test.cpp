#include "core/scene.hpp"

#include "core/compound_body.hpp"
#include "core/entity.hpp"
#include "core/error.hpp"
#include "core/exact_solution.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_shapes.hpp"
#include "core/model.hpp"
#include "core/nearest_name.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/document.hpp"
#include "core/reading/scene_keys.hpp"
#include "core/reading/scene_reader.hpp"
#include "tests/catch.hpp"
#include "tests/locations.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

using namespace kairos;

namespace {

const std::string scenes = tests::source_path("scenes/");

/// The lines of scenes/README.md that are rows of a table.
bool documented(const std::string& readme, std::string_view first, std::string_view second = {}) {
  std::string row = "| `" + std::string(first) + "` |";
  if (!second.empty()) {
    row += " `" + std::string(second) + "` |";
  }
  return readme.find("\n" + row) != std::string::npos;
}

}  // namespace

TEST_CASE("scene: all that is written arrives", "[scene]") {
  const Scene scene = parse_scene(R"(
summary = "two things"
duration = "1500ms"
frame = "1/60"
gravity = "force"
G = 5
bounds = "obb"
[[body]]
name = "ramp"
entity = "wall"
half_extents = [1, 2, 3]
position = [1, 2, 3]
axis_angle = [0, 0, 2, 1.5707963267948966]
normal = [-2, 0, 0]
restitution = 0.5
[[body]]
name = "left ball"
entity = "ball"
radius = 0.25
mass = 2
velocity = [1, 2.5, -3]
collision_type = "round"
scale = 2
G = 7
bounds = "shape"
)",
                                  "dir/two.toml");
  CHECK(scene.name == "two");
  CHECK(scene.duration == 1.5);
  CHECK(mean_frame_duration(scene.frames) == 1.0 / 60.0);
  CHECK(scene.gravity == GravityMode::force);
  REQUIRE(scene.bodies.size() == 2);
  const Body& ramp = scene.bodies[0];
  CHECK(ramp.line == 8);
  CHECK(ramp.mass == -1.0);
  CHECK(ramp.bounds == Bounds::obb);
  CHECK(ramp.restitution == 0.5);
  // The normal is told in the world and kept in the body: it comes back to roundoff.
  CHECK((ramp.normal(ramp.initial.pose) - Vector3(-1, 0, 0)).norm() < 1e-15);
  CHECK((ramp.initial.pose.orientation * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-15);
  const Body& ball = scene.bodies[1];
  CHECK(ball.G == 7.0);
  CHECK(ball.scale == 2.0);
  CHECK(ball.collision_type == CollisionType::round);
  CHECK(ball.bounds == Bounds::shape);
  CHECK(ball.initial.twist.linear == Vector3(1, 2.5, -3));
  // 2/5 m r^2, to roundoff.
  CHECK(ball.inertia.x() == Approx(0.4 * 2.0 * 0.0625).epsilon(1e-15));
}

TEST_CASE("scene: a quaternion of seven printed digits is normalised exactly", "[scene]") {
  const Scene scene = parse_scene(
      "[[body]]\nname = \"b\"\nentity = \"wall\"\nradius = 1\n"
      "orientation = [0.7071068, 0.7071068, 0, 0]",
      "");
  CHECK(std::abs(scene.bodies[0].initial.pose.orientation.norm() - 1.0) < 4e-16);
}

TEST_CASE("scene: the normal of a half-space is the one given, to the last bit", "[scene]") {
  const double r = 1.0 / std::sqrt(3.0);
  for (const auto& [normal, exact] : std::vector<std::pair<std::string, Vector3>>{
           {"[1, 0, 0]", {1, 0, 0}},
           {"[-1, 0, 0]", {-1, 0, 0}},
           {"[0, -1, 0]", {0, -1, 0}},
           {"[0, 2, 0]", {0, 1, 0}},
           {"[0, 0, 1]", {0, 0, 1}},
           {"[0, 0, -1e-3]", {0, 0, -1}},
           {"[0.6, 0.8, 0]", {0.6, 0.8, 0}},
           {"[0.48, -0.6, 0.64]", {0.48, -0.6, 0.64}},
           {fmt::format("[{0}, {0}, {0}]", r), {r, r, r}}}) {
    const Scene scene = parse_scene(
        "[[body]]\nname = \"b\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = " + normal,
        "");
    const Body& body = scene.bodies[0];
    const Vector3 up = half_space_normal(std::get<HalfSpace>(body.shape), body.initial.pose);
    INFO(normal);
    CHECK(up == exact);
    CHECK(body.normal(body.initial.pose) == exact);
    CHECK(std::abs(up.norm() - 1.0) < 1e-15);
  }
}

TEST_CASE("scene: overrides reach values by name, number, index, and defaults", "[scene]") {
  const Scene scene = read_scene(scenes + "bounce.toml", {{"body.ball.radius", "0.25"},
                                                          {"body[1].mass", "3"},
                                                          {"body.ball.position[1]", "7"},
                                                          {"body.ball.restitution", "0.5"},
                                                          {"frame", "1/30"},
                                                          {"gravity", "force"},
                                                          {"duration", "\"20s\""}});
  const Body& ball = scene.bodies[1];
  CHECK(std::get<Sphere>(ball.shape).radius == 0.25);
  CHECK(ball.mass == 3.0);
  CHECK(ball.initial.pose.position.y() == 7.0);
  CHECK(ball.restitution == 0.5);
  CHECK(mean_frame_duration(scene.frames) == 1.0 / 30.0);
  CHECK(scene.gravity == GravityMode::force);
  CHECK(scene.duration == 20.0);
}

TEST_CASE("scene: a file with a byte order mark and DOS line ends is read", "[scene]") {
  const Scene scene = parse_scene(
      "\xEF\xBB\xBFname = \"dos\"\r\n[[body]]\r\nname = \"b\"\r\nentity = \"wall\"\r\nradius = "
      "1\r\n",
      "");
  CHECK(scene.name == "dos");
}

TEST_CASE("scene: every scene of the library is read, modelled and documented", "[scene]") {
  const std::string readme = read_text_file(scenes + "README.md");
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
    if (entry.path().extension() != ".toml") {
      continue;
    }
    ++count;
    INFO(entry.path());
    const Scene scene = read_scene(entry.path().string());
    CHECK(scene.name == entry.path().stem().string());
    CHECK_FALSE(scene.summary.empty());
    CHECK(documented(readme, scene.name));
    const Model model(scene);
    CHECK(model.initial_state().size() == scene.bodies.size());
    if (scene.exact) {
      CHECK(solve_exactly(scene) != nullptr);
    }
  }
  CHECK(count >= 8);
}

TEST_CASE("scene: the README documents every key that the reader takes", "[scene]") {
  const std::string readme = read_text_file(scenes + "README.md");
  // Keys of one kind of force or joint stand in rows of their own.
  const auto kind_of = [](std::string_view table) {
    for (const std::string_view of : {"force.", "joint."}) {
      if (table.substr(0, of.size()) == of) {
        return table.substr(of.size());
      }
    }
    return std::string_view();
  };
  for (const SceneKey& key : scene_keys()) {
    INFO(key.table << "." << key.key);
    const std::string_view kind = kind_of(key.table);
    CHECK((kind.empty() ? documented(readme, key.key) : documented(readme, kind, key.key)));
  }
  for (const EntityType& type : entity_catalogue()) {
    INFO(type.kind);
    CHECK(documented(readme, type.kind));
    for (const EntityKey& key : type.keys) {
      INFO(key.key);
      CHECK(documented(readme, type.kind, key.key));
    }
  }
  for (const ExactSolutionType& type : exact_solution_catalogue()) {
    INFO(type.name);
    CHECK(documented(readme, type.name));
  }
}

TEST_CASE("names: the nearest is suggested only where it is near", "[scene]") {
  const std::vector<std::string_view> names = {"radius", "mass", "half_extents"};
  CHECK(nearest_name("radios", names) == "radius");
  CHECK(nearest_name("Mass", names) == "mass");
  CHECK(nearest_name("halfextents", names) == "half_extents");
  CHECK(nearest_name("temperature", names).empty());
  CHECK(nearest_name(std::string(100000, 'x'), names).empty());
}

TEST_CASE("numbers: only whole finite decimal numbers are numbers", "[scene]") {
  CHECK(parse_number("-1.5e3") == -1500.0);
  for (const char* text : {"", " 1", "1 ", "1x", "nan", "inf", "-inf", "1e400", "0x10", "1,5"}) {
    INFO(text);
    CHECK_FALSE(parse_number(text).has_value());
  }
}

TEST_CASE(
    "a mesh collides as the box that the thesis fits, between its least and greatest coordinates") {
  MeshData data = box_mesh({0.5, 1.0, 2.0});
  Body body;
  body.bounds = Bounds::obb;
  body.shape = Mesh{mesh_in_place(data, CollisionMesh::Kind::solid)};
  const Shape central = body.collision_shape();
  REQUIRE(std::holds_alternative<Box>(central));
  CHECK(std::get<Box>(central).half_extents.isApprox(Vector3(0.5, 1.0, 2.0), 1e-15));
  for (Vector3& vertex : data.vertices) {
    vertex += Vector3(0.0, -3.0, 0.25);
  }
  body.shape = Mesh{mesh_in_place(data, CollisionMesh::Kind::solid)};
  const Shape aside = body.collision_shape();
  REQUIRE(std::holds_alternative<Compound>(aside));  // a box about the origin would be 4 m high
  const auto& parts = std::get<Compound>(aside).body->parts;
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].pose.position.isApprox(Vector3(0.0, -3.0, 0.25), 1e-15));
  CHECK(std::get<Box>(parts[0].shape).half_extents.isApprox(Vector3(0.5, 1.0, 2.0), 1e-15));
}
