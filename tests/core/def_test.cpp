// The thesis' own formats: .off models and .def scenes, and every way of getting them wrong.

#include "core/error.hpp"
#include "core/model.hpp"
#include "core/reading/def_reader.hpp"
#include "core/reading/off_file.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "tests/catch.hpp"
#include "tests/temporary_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

using namespace kairos;

namespace {

const std::string cube =
    "OFF\n# a cube, off its origin\n8 6 12\n"
    "0 0 0\n2 0 0\n2 4 0\n0 4 0\n0 0 6\n2 0 6\n2 4 6\n0 4 6\n"
    "4 0 1 2 3\n4 4 5 6 7\n4 0 1 5 4 255 0 0\n4 2 3 7 6\n4 0 3 7 4\n4 1 2 6 5\n";
const std::string octahedron =
    "OFF\n6 8 12\n1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n"
    "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n";

/// A folder with models and a scene.
class Folder {
 public:
  Folder() {
    std::filesystem::create_directories(path("object_files"));
    write("object_files/cube.off", cube);
    write("object_files/ball.off", octahedron);
    write("object_files/flat.off", "OFF 3 1 3\n0 0 0\n1 0 0\n0 0 1\n3 0 1 2\n");
    write("object_files/broken.off", cube.substr(0, cube.size() / 2));
  }
  void write(const std::string& name, const std::string& text) const { folder_.file(name, text); }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path(name); }

 private:
  tests::TemporaryFolder folder_;
};

/// The five lines that survive, with a model of ours.
const std::string pad_lines =
    "Object1-Name:object_files/cube\nObject1-Pos:12.0 -25.0 20.0\nObject1-Normal:0.0, 1.0, 0.0\n"
    "Object1-Type:O_agpad\nObject1-COLLType:SQUARE\n";
const std::string ball_lines =
    "Object2-Name:object_files/ball\nObject2-Type:O_ball\nObject2-Pos:0 0 0\nObject2-Mass:2\n";

struct Bad {
  std::string text;
  int line;
  std::string part;
};

}  // namespace

TEST_CASE("off: a model, and the box of 3.3 around it", "[off]") {
  const OffModel model = parse_off(cube, "cube.off");
  CHECK(model.vertices.size() == 8);
  CHECK(model.faces.size() == 6);
  CHECK(model.faces[2] == std::vector<std::size_t>{0, 1, 5, 4});
  const FittedBox box = fit_box(model);
  CHECK(box.centre == Vector3(1, 2, 3));
  CHECK(box.half_extents == Vector3(1, 2, 3));
  // Normals and colours at the vertices are read over; the counts may follow the first word.
  CHECK(parse_off("NOFF 1 0 0\n1 2 3 0 1 0\n", "n.off").vertices[0] == Vector3(1, 2, 3));
  CHECK(parse_off("COFF\n1 0 0\n1 2 3 1 1 1 1\r\n", "c.off").vertices[0] == Vector3(1, 2, 3));
}

TEST_CASE("off: what is wrong is named by file and line", "[off][input]") {
  const std::vector<Bad> cases = {
      {"", 1, "truncated"},
      {"# nothing but a comment\n", 2, "truncated"},
      {"PLY\n", 1, "OFF, NOFF, COFF"},
      {"OFF\n", 2, "truncated"},
      {"OFF\n3\n", 2, "number of faces"},
      {"OFF\n-3 1 3\n", 2, "number of vertices"},
      {"OFF\n3.5 1 3\n", 2, "number of vertices"},
      {"OFF\n1e12 1 3\n", 2, "number of vertices"},
      {"OFF\n3 1 3 7\n", 2, "three numbers"},
      {"OFF\n0 0 0\n", 2, "no vertices"},
      {"OFF\n2 0 0\n0 0 0\n", 4, "vertex 2 of 2"},
      {"OFF\n1 0 0\n0 0\n", 3, "2 numbers"},
      {"OFF\n1 0 0\n0 0 0 0\n", 3, "4 numbers"},
      {"OFF\n1 0 0\n0 nan 0\n", 3, "nan"},
      {"OFF\n1 0 0\n0 1e13 0\n", 3, "1e13"},
      {"OFF\n1 0 0\n0 x 0\n", 3, "\"x\""},
      {"OFF\n1 1 0\n0 0 0\n", 4, "face 1 of 1"},
      {"OFF\n1 1 0\n0 0 0\n3 0 0 1\n", 4, "\"1\" is no vertex"},
      {"OFF\n1 1 0\n0 0 0\n3 0 0 -1\n", 4, "\"-1\" is no vertex"},
      {"OFF\n1 1 0\n0 0 0\n3 0 0 0.5\n", 4, "\"0.5\" is no vertex"},
      {"OFF\n1 1 0\n0 0 0\n3 0 0\n", 4, "names 2 vertices"},
      {"OFF\n1 1 0\n0 0 0\n2 0 0\n", 4, "2 corners"},
      {"OFF\n1 1 0\n0 0 0\n3 0 0 0 red\n", 4, "\"red\""},
      {"OFF\n1 0 0\n0 0 0\n3 0 0 0\n", 4, "something follows"},
  };
  for (const Bad& bad : cases) {
    INFO(bad.text);
    try {
      (void)parse_off(bad.text, "model.off");
      FAIL("was not refused");
    } catch (const InputError& error) {
      INFO(error.what());
      CHECK(error.file() == "model.off");
      CHECK(error.line() == bad.line);
      CHECK(error.reason().find(bad.part) != std::string::npos);
    }
  }
}

TEST_CASE("off: every prefix of a model is refused, never more", "[off][input]") {
  // The last line may lose what is no index of its own.
  for (std::size_t n = 0; n + 3 < octahedron.size(); ++n) {
    CHECK_THROWS_AS(parse_off(octahedron.substr(0, n), "prefix.off"), InputError);
  }
}

TEST_CASE("def: a scene as the thesis wrote it", "[def]") {
  const Folder folder;
  folder.write("world.def",
               "# two objects\n" + pad_lines + ball_lines +
                   "Object2-Vel:1, 2, 3\nObject2-Scale:0.5\nObject2-Label:red\nObject2-G:19.6\n"
                   "World-Duration:3\nWorld-Frame:1/50\n");
  const Scene scene = read_scene(folder.path("world.def"));
  CHECK(scene.name == "world");
  CHECK(scene.duration == 3.0);
  CHECK(mean_frame_duration(scene.frames) == 0.02);
  CHECK(scene.gravity == GravityMode::force);
  REQUIRE(scene.bodies.size() == 2);
  const Body& pad = scene.bodies[0];
  CHECK(pad.name == "cube");
  CHECK(pad.entity->kind() == "anti-gravity-pad");
  CHECK(std::get<Box>(pad.shape).half_extents == Vector3(1, 2, 3));
  // The model's box is not centred on its origin (3.3).
  CHECK(pad.initial.pose.position == Vector3(13, -23, 23));
  CHECK(pad.collision_type == CollisionType::square);
  const Body& ball = scene.bodies[1];
  CHECK(ball.name == "red");
  CHECK(std::get<Sphere>(ball.shape).radius == 0.5);
  CHECK(std::holds_alternative<Box>(ball.collision_shape()));
  CHECK(ball.initial.twist.linear == Vector3(1, 2, 3));
  CHECK(ball.mass == 2.0);
  CHECK(ball.G == 19.6);
  CHECK(ball.scale == 0.5);
  CHECK(ball.line == 7);
  // A scale along each axis, as the thesis' Scale3D.
  folder.write("long.def", pad_lines + "Object1-Scale:1 2 3\n");
  CHECK(std::get<Box>(read_scene(folder.path("long.def")).bodies[0].shape).half_extents ==
        Vector3(1, 4, 9));
  // Values can be replaced as in any scene.
  CHECK(read_scene(folder.path("world.def"), {{"body.red.mass", "5"}}).bodies[1].mass == 5.0);
  CHECK(Model(scene).size() == 2);
}

TEST_CASE("def: what is wrong is named by file and line", "[def][input]") {
  const Folder folder;
  const std::vector<Bad> cases = {
      {"", 0, "no object"},
      {"Object1", 1, "says nothing"},
      {"Object1-Pos 1 2 3", 1, "says nothing"},
      {"Object1Pos:1 2 3", 1, "says nothing"},
      {"Object-Pos:1 2 3", 1, "is no object"},
      {"Object0-Pos:1 2 3", 1, "is no object"},
      {"Object1x-Pos:1 2 3", 1, "is no object"},
      {"Thing1-Pos:1 2 3", 1, "is no object"},
      {"Object1-Position:1 2 3", 1, "unknown key"},
      {"World-Gravity:1", 1, "unknown key"},
      {"Object1-Pos:", 1, "no value"},
      {pad_lines + "Object1-Pos:1 2 3", 6, "already, in line 2"},
      {"Object1-Name:object_files/cube", 1, "missing"},
      {"Object1-Name:object_files/cube\nObject1-Type:O_wall", 1, "missing"},
      {"Object1-Type:O_wall\nObject1-Pos:0 0 0", 1, "missing"},
      {"Object1-Type:O_wal\nObject1-Pos:0 0 0", 1, "did you mean \"O_wall\""},
      {pad_lines + "Object3-Type:O_wall", 6, "no Object2"},
      {"Object1-Name:object_files/none\nObject1-Type:O_wall\nObject1-Pos:0 0 0", 1, "there is no"},
      {"Object1-Name:object_files/flat\nObject1-Type:O_wall\nObject1-Pos:0 0 0", 1, "is flat"},
      {"Object1-Name:object_files/cube\nObject1-Type:O_wall\nObject1-Pos:0 0", 3, "has 2 numbers"},
      {"Object1-Name:object_files/cube\nObject1-Type:O_wall\nObject1-Pos:0 0 0 0", 3,
       "has 4 numbers"},
      {"Object1-Name:object_files/cube\nObject1-Type:O_wall\nObject1-Pos:0 up 0", 3, "\"up\""},
      {"Object1-Name:object_files/cube\nObject1-Type:O_wall\nObject1-Pos:0 nan 0", 3, "\"nan\""},
      {"Object1-Name:object_files/cube\nObject1-Type:O_wall\nObject1-Pos:0 1e13 0", 3, "1e+12"},
      {pad_lines + "Object1-Scale:0", 6, "is 0"},
      {pad_lines + "Object1-Scale:1 2", 6, "has 2 numbers"},
      {pad_lines + "Object1-Scale:1 -2 1", 6, "is -2"},
      {pad_lines + "Object1-Orient:1 1 0 0", 6, "norm"},
      {pad_lines + "Object2-Name:object_files/cube\nObject2-Type:O_wall\nObject2-Pos:0 0 0\n"
                   "Object2-Normal:0 0 0",
       9, "length 0"},
      {pad_lines + ball_lines + "Object2-COLLType:OVAL", 10, "SQUARE, ROUND"},
      {pad_lines + ball_lines + "Object2-Vel:1 2", 10, "has 2 numbers"},
      {pad_lines + ball_lines + "Object2-Label:a,b", 10, "is no name"},
      {pad_lines + "Object1-Mass:1", 6, "infinite mass"},
      {pad_lines + "Object1-Vel:1 0 0", 6, "not moved by forces"},
      {pad_lines + "Object2-Name:object_files/ball\nObject2-Type:O_ball\nObject2-Pos:0 0 0", 6,
       "missing"},
      {pad_lines + ball_lines + "World-Duration:-1", 10, ""},
      {pad_lines + ball_lines + "World-Frame:soon", 10, ""},
  };
  for (const Bad& bad : cases) {
    INFO(bad.text);
    folder.write("bad.def", bad.text);
    try {
      (void)read_scene(folder.path("bad.def"));
      FAIL("was not refused");
    } catch (const InputError& error) {
      INFO(error.what());
      CHECK(error.file() == folder.path("bad.def"));
      CHECK(error.line() == bad.line);
      CHECK(error.reason().find(bad.part) != std::string::npos);
    }
  }
  // A model that is broken is named itself.
  folder.write("bad.def",
               "Object1-Name:object_files/broken\nObject1-Type:O_wall\nObject1-Pos:0 0 0");
  try {
    (void)read_scene(folder.path("bad.def"));
    FAIL("was not refused");
  } catch (const InputError& error) {
    CHECK(error.file() == folder.path("object_files/broken.off"));
    CHECK(error.line() > 1);
  }
}
