// A run as pictures: what is read back, what a picture shows, what is refused.

#include "experiments/render/render.hpp"

#include "core/error.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/simulation/scenes.hpp"

#include <filesystem>
#include <string>

using namespace kairos;
using namespace kairos::experiments;
using kairos::tests::drop_scene;
using kairos::tests::kairos_program;
using kairos::tests::read_all;
using kairos::tests::TemporaryFolder;

namespace {

/// A ball in a plate, a box in its field, one picture.
Footage still() {
  Footage footage;
  footage.title = "still";
  footage.actors = {{"plate", "wall", Box{{1, 0.1, 1}}, Box{{1, 0.1, 1}}, false, false},
                    {"pad", "anti-gravity-pad", Box{{1, 1, 1}}, Box{{1, 1, 1}}, false, true},
                    {"red ball", "ball", Sphere{0.5}, Box{{0.5, 0.5, 0.5}}, true, false}};
  footage.pictures = {{0.25, {Pose{}, Pose{{5, 0, 0}}, Pose{{0, 0.4, 0}}}}};
  return footage;
}

void write(const TemporaryFolder& folder, const std::string& below, const std::string& name,
           const std::string& text) {
  std::filesystem::create_directories(folder.path(below));
  (void)folder.file(below + "/" + name, text);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

}  // namespace

TEST_CASE("footage: what a run left is read back, bodies and frames", "[render]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  REQUIRE(kairos_program({"run", scene, "--set", "bounds=obb", "--out", folder.path("run")})
              .exit_code == 0);
  for (const char* path : {"run", "run/trajectory.csv"}) {
    const Footage footage = read_footage(folder.path(path));
    REQUIRE(footage.actors.size() == 2);
    CHECK(footage.actors[0].name == "floor");
    CHECK(std::holds_alternative<HalfSpace>(footage.actors[0].shape));
    CHECK(std::get<Sphere>(footage.actors[1].shape).radius == 0.1);
    CHECK(std::get<Box>(footage.actors[1].collides_as).half_extents == Vector3(0.1, 0.1, 0.1));
    CHECK(footage.actors[1].is_free);
    REQUIRE(footage.pictures.size() == 151);
    CHECK(footage.pictures[0].poses[1].position == Vector3(0, 5, 0));
    CHECK(footage.at(-1.0) == 0);
    CHECK(footage.at(0.5) == 30);
    CHECK(footage.at(99.0) == 150);
  }
}

TEST_CASE("footage: what is missing or broken is named", "[render][input]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  REQUIRE(kairos_program({"run", scene, "--out", folder.path("run")}).exit_code == 0);
  const std::string trajectory = read_all(folder.path("run/trajectory.csv"));
  const std::string summary = read_all(folder.path("run/summary.json"));
  const auto refused = [&](const std::string& path, const std::string& part) {
    try {
      (void)read_footage(path);
    } catch (const InputError& error) {
      INFO(error.what());
      CHECK(std::string(error.what()).find(part) != std::string::npos);
      return;
    }
    FAIL("was not refused");
  };
  refused(folder.path("nowhere"), "is not there");
  write(folder, "alone", "trajectory.csv", trajectory);
  refused(folder.path("alone"), "summary.json");
  write(folder, "other", "trajectory.csv", "a,b\n1,2\n");
  write(folder, "other", "summary.json", summary);
  refused(folder.path("other"), "trajectory.csv:1: body");
  write(folder, "none", "trajectory.csv", trajectory);
  write(folder, "none", "summary.json", "{}\n");
  refused(folder.path("none"), "bodies");
  std::string wrong = trajectory;
  wrong.replace(wrong.find("ball"), 4, "bull");
  write(folder, "wrong", "trajectory.csv", wrong);
  write(folder, "wrong", "summary.json", summary);
  refused(folder.path("wrong"), "\"bull\" is not in summary.json");
}

TEST_CASE("picture: wire for boxes, a glow for what is in common, the time in the corner",
          "[render]") {
  const Footage footage = still();
  const auto common = overlapping(footage, 0);
  REQUIRE(common.size() == 1);  // a field is no solid
  CHECK(common[0].depth == Approx(0.2));
  PictureOptions options{.camera = camera_for(footage, 0, 0), .label = "a label"};
  const std::string scene = pov_scene(footage, 0, options);
  CHECK(count(scene, "cylinder {") == 36);  // plate, pad, and the box that the ball collides as
  CHECK(count(scene, "intersection {") == 1);
  CHECK(scene.find("\"0.250 s  a label\"") != std::string::npos);
  options.boxes = false;
  CHECK(count(pov_scene(footage, 0, options), "cylinder {") == 24);
}

TEST_CASE("camera: seven numbers, and nothing that looks nowhere", "[render][input]") {
  const Camera camera = parse_camera("0, 1, 5, 0, 1, 0, 35");
  CHECK(camera.position == Vector3(0, 1, 5));
  CHECK(camera.target == Vector3(0, 1, 0));
  CHECK(camera.angle == 35.0);
  CHECK(parse_camera("0,1,5,0,1,0").angle == 40.0);
  for (const char* bad : {"", "1,2,3", "0,0,0,0,0,x", "0,0,0,0,0,0", "0,5,0,0,0,0", "0,0,1,0,0,0,0",
                          "0,0,1,0,0,0,180", "0,0,1,0,0,0,40,1", "0,0,1,0,0,", "0,0,nan,0,0,0"}) {
    INFO(bad);
    CHECK_THROWS_AS(parse_camera(bad), InputError);
  }
}

TEST_CASE("picture times: each frame, or steps from the first to the last", "[render][input]") {
  Footage footage = still();
  for (int k = 1; k <= 60; ++k) {
    footage.pictures.push_back({0.25 + k / 60.0, footage.pictures.front().poses});
  }
  CHECK(picture_times(footage, {}).size() == 61);
  CHECK(picture_times(footage, {.from = 0.5, .to = 0.75}).size() == 16);
  CHECK(picture_times(footage, {.every = 0.1}).size() == 11);
  CHECK(picture_times(footage, {.from = 0.3, .to = 0.3}).size() == 1);
  CHECK_THROWS_AS(picture_times(footage, {.from = 2.0}), InputError);
  CHECK_THROWS_AS(picture_times(footage, {.from = 0.5, .to = 0.4}), InputError);
  CHECK_THROWS_AS(picture_times(footage, {.every = 1e-9}), InputError);
}

TEST_CASE("kairos render: pictures by POV-Ray, or one clear sentence", "[render]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  REQUIRE(kairos_program({"run", scene, "--out", folder.path("run")}).exit_code == 0);
  const std::vector<std::string> command{"render",   folder.path("run"),
                                         "--out",    folder.path("frames"),
                                         "--from",   "0.5",
                                         "--to",     "1",
                                         "--every",  "0.5",
                                         "--size",   "64x48",
                                         "--beside", folder.path("run")};
  const auto made = kairos_program(command);
  CAPTURE(made.err);
  if (!why_no_povray().empty()) {
    CHECK(made.exit_code == 1);
    CHECK(made.err.find("povray is not found") != std::string::npos);
    return;
  }
  CHECK(made.exit_code == 0);
  CHECK(folder.entries("frames").size() >= 2);
  CHECK(read_all(folder.path("frames/frame-00001.png")).substr(1, 3) == "PNG");
  const auto wrong =
      kairos_program({"render", folder.path("run"), "--out", folder.path("no"), "--size", "big"});
  CHECK(wrong.exit_code == 2);
  CHECK_THROWS(folder.entries("no"));
}
