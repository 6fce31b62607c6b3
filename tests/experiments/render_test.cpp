// A run as pictures: what is read back, what a picture shows, what is refused.

#include "experiments/render/render.hpp"

#include "core/error.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/simulation/scenes.hpp"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

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
  PictureOptions options{.camera = camera_for(std::vector<Shot>{{&footage, 0, 0}}, 4.0 / 3.0),
                         .label = "a label"};
  const std::string scene = pov_scene(footage, 0, options);
  CHECK(count(scene, "cylinder {") == 36);  // plate, pad, and the box that the ball collides as
  CHECK(count(scene, "intersection {") == 1);
  CHECK(scene.find("\"0.250 s  a label\"") != std::string::npos);
  options.boxes = false;
  CHECK(count(pov_scene(footage, 0, options), "cylinder {") == 24);
}

TEST_CASE("camera: by itself it sees all that moves, high, wide, and of both runs", "[render]") {
  const auto run = [](const Vector3& from, const Vector3& to) {
    Footage footage;
    footage.actors = {{"floor", "wall", HalfSpace{}, HalfSpace{}},
                      {"hall", "wall", Box{{500, 1, 500}}, Box{{500, 1, 500}}},
                      {"ball", "ball", Sphere{0.5}, Sphere{0.5}, true, false, true}};
    footage.pictures = {{0.0, {Pose{}, Pose{{0, -1, 0}}, Pose{from}}},
                        {1.0, {Pose{}, Pose{{0, -1, 0}}, Pose{to}}}};
    return footage;
  };
  const Footage high = run({0, 1, 0}, {0, 31, 0});
  const Footage wide = run({-20, 1, 0}, {20, 1, 3});
  for (const double aspect : {4.0 / 3.0, 0.5, 3.0}) {
    const std::vector<Shot> shots{{&high, 0, 1}, {&wide, 0, 1}};
    const Camera camera = camera_for(shots, aspect);
    const Vector3 ahead = (camera.target - camera.position).normalized();
    const Vector3 right = ahead.cross(Vector3::UnitY()).normalized();
    const Vector3 up = right.cross(ahead);
    const double half = std::tan(camera.angle * std::numbers::pi / 360.0);
    for (const Shot& shot : shots) {
      for (const auto& picture : shot.footage->pictures) {
        const Vector3 to = picture.poses[2].position - camera.position;
        const double depth = to.dot(ahead) - 0.5;
        CAPTURE(aspect, to.transpose());
        REQUIRE(depth > 0.0);
        CHECK(std::abs(to.dot(right)) + 0.5 <= half * depth);
        CHECK(std::abs(to.dot(up)) + 0.5 <= half / aspect * depth);
      }
    }
    // Not from so far that what stands still, a hundred times larger, is seen as a whole.
    CHECK((camera.target - camera.position).norm() < 300.0);
  }
}

TEST_CASE("picture: no wall stands before the eye, and none hides what is behind it", "[render]") {
  Footage footage;
  footage.actors = {{"floor", "wall", HalfSpace{}, HalfSpace{}},
                    {"ball", "ball", Sphere{0.5}, Sphere{0.5}, true, false, true}};
  footage.pictures = {{0.0, {Pose{}, Pose{{0, 1, 0}}}}};
  PictureOptions options;
  options.camera = {{0, 3, 9}, {0, 1, 0}};
  CHECK(count(pov_scene(footage, 0, options), "transmit 0 ") == 3);  // two colours and the ball
  footage.pictures[0].poses[1].position.y() = -2.0;  // through the floor, as the thesis saw it
  CHECK(count(pov_scene(footage, 0, options), "transmit 0.5 ") == 2);
  options.camera.position.y() = -1.0;
  CHECK(count(pov_scene(footage, 0, options), "checker") == 0);
}

TEST_CASE("picture: no text gets out of its string", "[render][paths]") {
  const Footage footage = still();
  const std::string evil = "x\" } #fopen F \"/etc/evil\" write \\\n\x01\xff";
  const PictureOptions options{.camera = camera_for(std::vector<Shot>{{&footage, 0, 0}}, 1.0),
                               .label = evil};
  const std::string scene = pov_scene(footage, 0, options);
  const std::size_t begin = scene.find("text { internal 1 \"") + 18;
  std::size_t end = begin + 1;
  while (scene[end] != '"') {
    end += scene[end] == '\\' ? 2 : 1;
  }
  CHECK(scene.substr(end, 10) == "\", 1, 0 pi");
  CHECK(scene.substr(begin, end - begin).find('\n') == std::string::npos);
  CHECK(scene.substr(begin, end - begin).find("#fopen") != std::string::npos);  // as a text
}

TEST_CASE("kairos render: folders of any name, and no picture of an earlier film is left",
          "[render][paths]") {
  if (!why_no_povray().empty()) {
    return;
  }
  const TemporaryFolder folder;
  const std::string run = folder.path("a\" } #error \"%d");
  REQUIRE(kairos_program({"run", "bounce", "--duration", "1", "--out", run}).exit_code == 0);
  const std::string frames = folder.path("fr\"%05d");
  const auto render = [&](const std::string& every) {
    return kairos_program(
        {"render", run, "--beside", run, "--out", frames, "--every", every, "--size", "16x16"});
  };
  const auto first = render("0.25");
  CAPTURE(first.err);
  REQUIRE(first.exit_code == 0);
  const auto pictures = [&] {
    std::size_t found = 0;
    for (const auto& entry : std::filesystem::directory_iterator(frames)) {
      found += entry.path().extension() == ".png" ? 1 : 0;
    }
    return found;
  };
  CHECK(pictures() == 5);
  REQUIRE(render("0.5").exit_code == 0);
  CHECK(pictures() == 3);
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
