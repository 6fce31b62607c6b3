// What `--out` leaves: all files whole, or nothing at all; and the same bytes for the same run.

#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/simulation/scenes.hpp"

#include <algorithm>
#include <string>
#include <vector>

using namespace kairos::tests;

namespace {

const std::vector<std::string> run_files{"energy.csv", "events.csv", "summary.json",
                                         "trajectory.csv"};

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("run --out leaves the four files and nothing else", "[output]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const Outcome outcome = kairos_program({"run", scene, "--out", folder.path("a/b")});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(folder.entries("a/b") == run_files);

  // 2.5 s at 1/60 s are 150 frames; the first is drawn at 0 and the last at the end. Two bodies.
  const std::string trajectory = read_all(folder.path("a/b/trajectory.csv"));
  CHECK(
      trajectory.starts_with("t,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n"
                             "0,floor,0,0,0,1,0,0,0,0,0,0,0,0,0\n"
                             "0,ball,0,5,0,1,0,0,0,0,0,0,0,0,0\n"));
  CHECK(lines(trajectory) == 1 + 2 * 151);
  CHECK(lines(read_all(folder.path("a/b/energy.csv"))) == 1 + 151);
  CHECK(lines(read_all(folder.path("a/b/events.csv"))) == 1 + 1);
  const std::string summary = read_all(folder.path("a/b/summary.json"));
  for (const char* part :
       {"\"gravity\": \"acceleration\"", "\"ball\": \"shape\"", "\"status\": \"completed\"",
        "\"scheme\": \"event-driven\"", "\"impacts\": 1", "\"max_depth\": 0"}) {
    CAPTURE(part);
    CHECK(summary.find(part) != std::string::npos);
  }
}

TEST_CASE("the same run twice leaves the same bytes", "[output]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  for (const char* flag : {"--roundoff", "--thesis"}) {
    for (const char* out : {"one", "two"}) {
      REQUIRE(kairos_program({"run", scene, flag, "--out", folder.path(out)}).exit_code == 0);
    }
    for (const std::string& name : run_files) {
      CAPTURE(flag, name);
      CHECK(read_all(folder.path("one/" + name)) == read_all(folder.path("two/" + name)));
    }
  }
}

TEST_CASE("an earlier result is replaced, or left as it was", "[output][fault]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const std::string out = folder.path("out");
  REQUIRE(kairos_program({"run", scene, "--out", out, "--duration", "1.5"}).exit_code == 0);
  const std::string before = read_all(out + "/trajectory.csv");

  SECTION("by a run that succeeds") {
    REQUIRE(kairos_program({"run", scene, "--out", out}).exit_code == 0);
    CHECK(read_all(out + "/trajectory.csv").size() > before.size());
  }
  SECTION("where the disk fills") {
    const Outcome full = kairos_program({"run", scene, "--out", out}, {.largest_file = 10000});
    CAPTURE(full.err);
    CHECK(full.exit_code == 1);
    CHECK(full.err.find("trajectory.csv: cannot be written") != std::string::npos);
    CHECK(read_all(out + "/trajectory.csv") == before);
  }
  CHECK(folder.entries("out") == run_files);
}

TEST_CASE("a disk that fills leaves nothing behind", "[output][fault]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const std::vector<std::string> before = folder.entries();
  for (const std::size_t limit : {1, 100, 5000, 12000}) {
    CAPTURE(limit);
    const Outcome outcome =
        kairos_program({"run", scene, "--out", folder.path("new/out")}, {.largest_file = limit});
    CHECK(outcome.exit_code != 0);
    CHECK(outcome.exit_code != 2);
    CHECK(folder.entries() == before);
  }
}

TEST_CASE("a folder that cannot be written is named, and nothing runs", "[output][fault]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  for (const std::string& out : {scene, scene + "/out", std::string("/proc/out"),
                                 std::string("/proc/self/fd"), std::string("/dev/full")}) {
    const Outcome outcome = kairos_program({"run", scene, "--out", out});
    CAPTURE(out, outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find(out) != std::string::npos);
  }
}

TEST_CASE("input that is wrong makes no folder", "[output]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const std::vector<std::string> before = folder.entries();
  CHECK(
      kairos_program({"run", scene, "--detector", "sat", "--out", folder.path("out")}).exit_code ==
      2);
  CHECK(folder.entries() == before);
}

TEST_CASE("a run that is killed leaves no file", "[output][fault]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  // Two seconds of processor time are not enough for 1e9 s at 60 frames a second.
  const Outcome killed =
      kairos_program({"run", scene, "--thesis", "--duration", "1e9", "--out", folder.path("out")},
                     {.processor_seconds = 2});
  CHECK(killed.exit_code < 0);
  for (const std::string& name : folder.entries("out")) {
    CAPTURE(name);
    CHECK(name.starts_with("."));  // where the file system cannot do without a name
  }
}
