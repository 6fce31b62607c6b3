// Bodies that are meshes, in runs of events: as the shapes that they are meshes of.

#include "core/error.hpp"
#include "core/mesh_shapes.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/solid_size.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/temporary_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

using namespace kairos;

namespace {

std::string off_text(const MeshData& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  for (const Vector3& v : mesh.vertices) {
    text += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
  }
  for (const Triangle& t : mesh.triangles) {
    text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  }
  return text;
}

/// What the reader complains about, or nothing.
template <typename Read>
std::string complaint(const Read& read, const std::string& keys) {
  try {
    (void)read(keys);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& message, std::string_view words) {
  return message.find(words) != std::string::npos;
}

const Vector3 half(0.1, 0.2, 0.3);

/// A free box that falls on a floor: `floor` and `stone` are the keys of their shapes.
std::string scene(const std::string& floor, const std::string& stone) {
  return fmt::format(R"(duration = 2.0
frame = 0.05
[[body]]
name = "floor"
entity = "wall"
position = [0, -1, 0]
{}
[[body]]
name = "stone"
entity = "body"
mass = 2.0
restitution = 0.8
position = [0, 1, 0]
velocity = [0.3, 0.5, -0.2]
angular_velocity = [2, 1, -3]
{}
)",
                     floor, stone);
}

Simulation run(const tests::TemporaryFolder& folder, const std::string& text) {
  RunChoice choice;
  choice.step = 0.05;
  return simulate(read_scene(folder.file("scene.toml", text)), choice);
}

std::vector<double> impacts(const Simulation& simulation) {
  std::vector<double> times;
  for (const Event& event : simulation.trajectory.events()) {
    if (event.kind == EventKind::impact) {
      times.push_back(event.time - Instant{});
    }
  }
  return times;
}

}  // namespace

TEST_CASE("a mesh of a box gives the box's events", "[meshes]") {
  const tests::TemporaryFolder folder;
  folder.file("box.off", off_text(box_mesh(half)));
  folder.file("slab.off", off_text(box_mesh({4.0, 1.0, 4.0})));
  const std::string box = "half_extents = [0.1, 0.2, 0.3]";
  const std::string mesh = "shape = \"mesh\"\nfile = \"box.off\"";
  const std::string plane = "shape = \"half-space\"\n";
  const std::string slab = "half_extents = [4, 1, 4]";
  const std::string slab_mesh = "shape = \"mesh\"\nfile = \"slab.off\"";
  const auto same = [&](const std::string& floor, const std::string& other) {
    const std::vector<double> boxes = impacts(run(folder, scene(floor, box)));
    const std::vector<double> meshes = impacts(run(folder, scene(other, mesh)));
    REQUIRE(boxes.size() >= 4);
    REQUIRE(meshes.size() >= 4);
    for (std::size_t i = 0; i < 4; ++i) {
      // Impacts of a tumbling box are chaotic: roundoff grows some tenfold in each of these.
      INFO(floor << other << i);
      CHECK(std::abs(boxes[i] - meshes[i]) < 1e-10);
    }
  };
  same(plane, plane);
  same(slab, slab);
  same(slab, slab_mesh);
}

TEST_CASE("a solid mesh weighs what its solid weighs", "[meshes]") {
  const tests::TemporaryFolder folder;
  MeshData moved = box_mesh(half);
  for (Vector3& v : moved.vertices) {
    v += Vector3(1.0, -2.0, 0.5);
  }
  folder.file("box.off", off_text(moved));
  const Scene read = read_scene(folder.file(
      "scene.toml", scene("shape = \"half-space\"", "shape = \"mesh\"\nfile = \"box.off\"")));
  const Body& stone = read.bodies[1];
  const Vector3 expected = solid_inertia(Box{half}, 2.0);
  Vector3 moments = stone.inertia;
  std::sort(moments.begin(), moments.end());
  Vector3 sorted = expected;
  std::sort(sorted.begin(), sorted.end());
  CHECK((moments - sorted).norm() < 1e-14);
  // About its centroid, which is where `position` says.
  CHECK((bounding_box(stone.shape).half_extents - half).norm() < 1e-15);
}

TEST_CASE("a ball in a ring of triangles stays in its hole", "[meshes]") {
  // The hull of the ring has no hole: only the triangles let the ball through.
  const tests::TemporaryFolder folder;
  folder.file("ring.off", off_text(torus_mesh(1.0, 0.25, 24, 12)));
  const auto scene_of = [&](const std::string& bounds) {
    return fmt::format(R"(duration = 1.0
frame = 0.05
G = 0
[[body]]
name = "ring"
entity = "wall"
shape = "mesh"
file = "ring.off"
{}
[[body]]
name = "ball"
entity = "ball"
radius = 0.2
mass = 1
position = [0, 0, 2]
velocity = [0, 0, -4]
)",
                       bounds);
  };
  CHECK(impacts(run(folder, scene_of(""))).empty());
  CHECK(impacts(run(folder, scene_of("bounds = \"hull\""))).size() == 1);
  CHECK(impacts(run(folder, scene_of("bounds = \"obb\""))).size() == 1);
}

TEST_CASE("a mesh that is no solid is refused where it has to be one", "[meshes]") {
  const tests::TemporaryFolder folder;
  MeshData open = box_mesh(half);
  open.triangles.pop_back();
  folder.file("open.off", off_text(open));
  const auto read = [&](const std::string& keys) {
    return read_scene(folder.file("scene.toml", scene("shape = \"half-space\"", keys)));
  };
  const std::string mesh = "shape = \"mesh\"\nfile = \"open.off\"\n";
  CHECK(says(complaint(read, mesh), "is no solid: it is not closed"));
  CHECK(says(complaint(read, mesh + "solid = false\n"), "inertia"));
  CHECK(complaint(read, mesh + "inertia = [0.1, 0.1, 0.1]\n").empty());
  CHECK(says(complaint(read, "shape = \"mesh\"\n"), "file"));
  CHECK(says(complaint(read, mesh + "rounding = 0.1\n"), "a mesh has no rounding"));
}

TEST_CASE("a box in two halves, a compound, gives the box's events", "[meshes]") {
  const tests::TemporaryFolder folder;
  const std::string box = "half_extents = [0.1, 0.2, 0.3]";
  const std::string halves = R"(shape = "compound"
[[body.part]]
half_extents = [0.1, 0.2, 0.15]
position = [0, 0, 0.15]
[[body.part]]
half_extents = [0.1, 0.2, 0.15]
position = [0, 0, -0.15]
)";
  for (const std::string floor : {"shape = \"half-space\"", "half_extents = [4, 1, 4]"}) {
    const Simulation whole = run(folder, scene(floor, box));
    const Simulation parts = run(folder, scene(floor, halves));
    const std::vector<double> boxes = impacts(whole);
    const std::vector<double> compounds = impacts(parts);
    REQUIRE(boxes.size() >= 4);
    REQUIRE(compounds.size() >= 4);
    for (std::size_t i = 0; i < 4; ++i) {
      INFO(floor << i);
      CHECK(std::abs(boxes[i] - compounds[i]) < 1e-10);  // chaotic, as above
    }
  }
}

TEST_CASE("a compound has its centre of mass at its position, and the moments of its parts",
          "[meshes]") {
  // A dumbbell, told about one of its ends: m d^2/4 across, and what the balls have of their own.
  const tests::TemporaryFolder folder;
  const Scene read = read_scene(folder.file("scene.toml", scene("shape = \"half-space\"", R"(
shape = "compound"
[[body.part]]
radius = 0.1
[[body.part]]
radius = 0.1
position = [1, 0, 0]
)")));
  const Body& stone = read.bodies[1];
  const double own = 0.4 * 2.0 * 0.01;
  CHECK(stone.inertia.minCoeff() == Approx(own).epsilon(1e-14));
  CHECK(stone.inertia.maxCoeff() == Approx(own + 2.0 * 0.25).epsilon(1e-14));
  CHECK(bounding_box(stone.shape).half_extents.x() == Approx(0.6).epsilon(1e-14));
}

/// A slab that is 0.3 m thick above its middle, half of it rounding.
const std::string rounded_slab = R"(
shape = "compound"
[[body.part]]
shape = "hull"
points = [[3, 0.15, 3], [-3, 0.15, 3], [3, 0.15, -3], [-3, 0.15, -3], [3, -0.15, 3], [-3, -0.15, 3], [3, -0.15, -3], [-3, -0.15, -3]]
rounding = 0.15
position = [0, -0.3, 0]
)";

TEST_CASE("a part that is a rounded hull is one in walls, and refused in what moves freely",
          "[meshes]") {
  const tests::TemporaryFolder folder;
  const std::string box = "half_extents = [0.1, 0.2, 0.3]";
  const std::vector<double> plane = impacts(run(folder, scene("shape = \"half-space\"", box)));
  const std::vector<double> slab = impacts(run(folder, scene(rounded_slab, box)));
  REQUIRE(plane.size() >= 4);
  REQUIRE(slab.size() >= 4);  // without its rounding it is 0.15 m lower
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(std::abs(plane[i] - slab[i]) < 1e-10);  // chaotic, as above
  }
  const auto read = [&](const std::string& stone) {
    return read_scene(folder.file("scene.toml", scene("shape = \"half-space\"", stone)));
  };
  CHECK(says(complaint(read, rounded_slab), "the centre of mass of a rounded hull is not known"));
}

TEST_CASE("a height field that is flat is a floor", "[meshes]") {
  const tests::TemporaryFolder folder;
  const std::string field =
      "shape = \"height-field\"\nspacing = [3, 3]\nheights = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]";
  const std::string box = "half_extents = [0.1, 0.2, 0.3]";
  const std::vector<double> plane = impacts(run(folder, scene("shape = \"half-space\"", box)));
  const std::vector<double> grid = impacts(run(folder, scene(field, box)));
  REQUIRE(plane.size() >= 4);
  REQUIRE(grid.size() >= 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(std::abs(plane[i] - grid[i]) < 1e-10);  // chaotic, as above
  }
}

// The plateau ends at x = -0.5: the box lands across its rim, tips, and touches along two edges
// that are hardly off its face. Each look saw the face's plane close; a run took a million of them.
TEST_CASE("a box that tips over the rim of a height field is followed in few looks", "[meshes]") {
  const tests::TemporaryFolder folder;
  const auto sim = run(folder, R"(duration = 0.5
frame = 0.02
[[body]]
name = "field"
entity = "wall"
friction = 0.1
shape = "height-field"
spacing = [0.5, 0.5]
heights = [[-0.06, -0.03, 0.14, -0.09], [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], [0.09, 0.25, 0.04, 0.07], [-0.02, -0.02, -0.09, 0.17]]
[[body]]
name = "box"
entity = "body"
mass = 1
restitution = 0
friction = 0.1
position = [-0.534411, 0.703296, -0.294526]
velocity = [-0.76474, -0.680161, 0.114446]
half_extents = [0.1, 0.1, 0.1]
)");
  INFO(sim.result.reason);
  CHECK(sim.result.end.seconds > 0.288);             // it has landed
  CHECK(sim.result.cost.toi_evaluations <= 50'000);  // of which it takes 10,533
}

TEST_CASE("parts and heights that are none are refused", "[meshes]") {
  const tests::TemporaryFolder folder;
  const auto read = [&](const std::string& keys) {
    return read_scene(folder.file("scene.toml", scene(keys, "radius = 0.1")));
  };
  CHECK(says(complaint(read, "shape = \"compound\""), "[[body.part]]"));
  CHECK(says(complaint(read, "shape = \"compound\"\n[[body.part]]\nshape = \"half-space\""),
             "is a half-space; allowed: a sphere"));
  CHECK(says(complaint(read, "shape = \"compound\"\n[[body.part]]\nradius = 1\nmass = 2"), "mass"));
  CHECK(says(complaint(read, "shape = \"height-field\"\nspacing = [1, 1]\nheights = [[0, 0], [0]]"),
             "has 1 numbers; allowed: 2 to 1000, as many in each row"));
}

TEST_CASE("a table slides down on its four legs", "[meshes]") {
  // An incline of 30 degrees that is a box: its face is met by feet, and not under the middle.
  constexpr double g = 9.8;
  constexpr double mu = 0.2;
  constexpr double half_height = 0.4;
  const double c = std::cos(M_PI / 6.0);
  const Vector3 up(c, 0.5, 0.0), out(-0.5, c, 0.0);
  const auto at = [](const Vector3& p) { return fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z()); };
  const std::string tilted =
      fmt::format("orientation = [{}, 0, 0, {}]", std::cos(M_PI / 12.0), std::sin(M_PI / 12.0));
  std::string text = fmt::format(
      "duration = 1.0\nframe = 0.05\nG = {}\nfriction = {}\n[[body]]\nname = \"slope\"\n"
      "entity = \"wall\"\nhalf_extents = [9, 1, 2]\nposition = {}\n{}\n[[body]]\nname = "
      "\"table\"\nentity = \"body\"\nmass = 1\nrestitution = 0\nshape = \"compound\"\n"
      "position = {}\n{}\n",
      g, mu, at(-out), tilted, at(4.0 * up + half_height * out), tilted);
  for (const double x : {-0.45, 0.45}) {
    for (const double z : {-0.25, 0.25}) {
      text +=
          fmt::format("[[body.part]]\nhalf_extents = [0.05, {}, 0.05]\nposition = [{}, 0, {}]\n",
                      half_height, x, z);
    }
  }
  const Simulation sim = run(tests::TemporaryFolder(), text);
  CAPTURE(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  const double slid = 0.5 * g * (0.5 - mu * c);
  const Vector3 end = sim.result.state[1].pose.position;
  CHECK((end - ((4.0 - slid) * up + half_height * out)).norm() <= 1e-9);
}
