// What a file of input says may not reach beyond --out, and --out takes nothing from anybody else:
// names, folders that are taken, sets of files that are whole or known not to be.

#include "core/error.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/output/plain_file_name.hpp"
#include "experiments/render/footage.hpp"
#include "experiments/run_error.hpp"
#include "experiments/sweeps/sweep_spec.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;
using tests::kairos_program;
using tests::Outcome;
using tests::TemporaryFolder;

namespace {

namespace fs = std::filesystem;

const std::string head = "scene = \"bounce\"\nmetrics = [\"impacts\"]\n[options]\nduration = 0.1\n";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The last number of the column of a table.
std::string last_field(const std::string& path, std::size_t column) {
  const std::string text = tests::read_all(path);
  std::string line = text.substr(text.rfind('\n', text.size() - 2) + 1);
  for (std::size_t k = 0; k < column; ++k) {
    line.erase(0, line.find(',') + 1);
  }
  return line.substr(0, line.find(','));
}

}  // namespace

TEST_CASE("paths: the name of a sweep is a name, and nothing is written or deleted beyond --out",
          "[paths]") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path("victim"));
  (void)folder.file("victim/precious.rows", "mine");
  (void)folder.file("victim/precious", "mine");
  const std::string out = folder.path("work/out");
  for (const std::string name :
       {"./../../victim/evil", "../precious", "a/b", "..", ".", "", ".hidden", "a\\u0000b",
        "../../victim/precious\\u0000", "x\\ny", "/etc/evil"}) {
    const std::string spec =
        folder.file("spec.toml", head + "[[sweep]]\nname = \"" + name + "\"\n");
    const std::vector<std::string> before = folder.entries();
    const Outcome outcome = kairos_program({"sweep", spec, "--out", out});
    CAPTURE(name, outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(contains(outcome.err, "spec.toml:6: sweep[1].name"));
    CHECK(folder.entries() == before);
    CHECK(tests::read_all(folder.path("victim/precious")) == "mine");
  }
  // The same of the whole, which names a folder of `kairos experiment`.
  const std::string spec = folder.file("spec.toml", "name = \"../../evil\"\n" + head);
  const Outcome outcome = kairos_program({"experiment", spec, "--out", out});
  CHECK(outcome.exit_code == 2);
  CHECK(contains(outcome.err, "spec.toml:1: name"));
}

TEST_CASE("paths: two sweeps of one name are refused, not the first one lost", "[paths]") {
  for (const std::string second : {"a", "A"}) {
    const std::string text =
        head + "[[sweep]]\nname = \"a\"\n[[sweep]]\nname = \"" + second + "\"\n";
    CHECK_THROWS_AS(parse_experiment(text, "spec.toml", Size::quick), InputError);
  }
  // A name that was given, and the one that another sweep has without one.
  CHECK_THROWS_AS(parse_experiment(head + "[[sweep]]\n[[sweep]]\nname = \"sweep1\"\n", "spec.toml",
                                   Size::quick),
                  InputError);
}

TEST_CASE("paths: a figure script is one of ours", "[paths]") {
  for (const std::string script : {"../../evil", "/etc/evil", "a.b", "x\\u0000"}) {
    CHECK_THROWS_AS(
        parse_experiment("figure = \"" + script + "\"\n" + head, "spec.toml", Size::quick),
        InputError);
  }
}

TEST_CASE("paths: a scene of any name writes its tables where it is told to", "[paths]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("s.toml", R"(name = "../../evil"
summary = "a ball flies"
duration = 0.1
[[body]]
name = "ball"
entity = "ball"
radius = 0.1
mass = 1.0
)");
  const std::string out = folder.path("a/b/out");
  const Outcome outcome = kairos_program({"tradeoff", scene, "--rounds", "1", "--out", out});
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 0);
  for (const std::string& name : folder.entries()) {
    CAPTURE(name);
    CHECK((name == "s.toml" || name == "a" || name.starts_with("a/b")));
  }
  CHECK(fs::exists(out + "/------evil_methods.csv"));
  CHECK(plain_file_name("") == "unnamed");
  CHECK(plain_file_name(std::string_view("a/b\0c.d", 7)) == "a-b-c-d");

  OutputFolder taken(folder.path("c"));
  for (const std::string_view name :
       {std::string_view("../x"), std::string_view("a/b"), std::string_view("a\0b", 3),
        std::string_view(".."), std::string_view()}) {
    CHECK_THROWS_AS(taken.file(name), InputError);
  }
}

TEST_CASE("output: one folder is taken by one run", "[output][lock]") {
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  {
    const OutputFolder taken(out);
    const Outcome second = kairos_program({"run", "bounce", "--out", out});
    CAPTURE(second.err);
    CHECK(second.exit_code == 2);
    CHECK(contains(second.err, "another run"));
  }
  // The lock goes with its owner, and two at once never mix: whoever is second is refused, or comes
  // after the first one's end.
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Outcome> ends(2);
    {
      std::jthread first([&] {
        ends[0] = kairos_program({"run", "bounce", "--duration", "3", "--out", out});
      });
      ends[1] = kairos_program(
          {"run", "bounce", "--duration", "2", "--set", "body.ball.restitution=0.5", "--out", out});
    }
    CAPTURE(trial, ends[0].err, ends[1].err);
    CHECK((ends[0].exit_code == 0 || ends[1].exit_code == 0));
    const std::string end = last_field(out + "/trajectory.csv", 0);
    CHECK(last_field(out + "/energy.csv", 1) == end);
    CHECK(contains(tests::read_all(out + "/summary.json"), "\"end\": " + end));
  }
}

TEST_CASE("output: a set that broke off half-way is known not to be whole", "[output][fault]") {
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  REQUIRE(kairos_program({"run", "bounce", "--out", out}).exit_code == 0);
  REQUIRE_NOTHROW(read_footage(out));
  {
    OutputFolder set(out, {.seal = "summary.json", .begins = "{"});
    set.file("trajectory.csv").write("t,body\n");
    set.file("summary.json").write("{ new }");
    set.file("events.csv").write("new");
    // What takes its place cannot be renamed over: as if the program died there.
    fs::remove(out + "/events.csv");
    fs::create_directories(out + "/events.csv/in the way");
    CHECK_THROWS_AS(set.publish(), RunError);
  }
  CHECK(incomplete(out));
  CHECK_FALSE(fs::exists(out + "/summary.json"));  // neither the old seal nor the new one
  CHECK_THROWS_AS(read_footage(out), InputError);
  fs::remove_all(out + "/events.csv");
  // It is known as ours: the same command makes it whole.
  const Outcome again = kairos_program({"run", "bounce", "--out", out});
  CAPTURE(again.err);
  CHECK(again.exit_code == 0);
  CHECK_FALSE(incomplete(out));
  CHECK_NOTHROW(read_footage(out));
  CHECK(folder.entries("out").size() == 4);
}

TEST_CASE("output: files that are of no earlier run are replaced on demand only", "[output]") {
  const TemporaryFolder folder;
  const std::string out = folder.path("mine");
  fs::create_directories(out);
  (void)folder.file("mine/notes.txt", "notes");
  // A folder that holds something else is no obstacle.
  REQUIRE(kairos_program({"run", "bounce", "--out", out}).exit_code == 0);
  CHECK(kairos_program({"run", "bounce", "--out", out}).exit_code == 0);
  CHECK(tests::read_all(out + "/notes.txt") == "notes");

  for (const char* name : {"trajectory.csv", "summary.json"}) {
    const std::string other = folder.path(std::string("other-") + name);
    fs::create_directories(other);
    (void)folder.file(std::string("other-") + name + "/" + name, "somebody's own");
    const Outcome refused = kairos_program({"run", "bounce", "--out", other});
    CAPTURE(name, refused.err);
    CHECK(refused.exit_code == 2);
    CHECK(contains(refused.err, "--force"));
    CHECK(tests::read_all(other + "/" + name) == "somebody's own");
    CHECK(kairos_program({"run", "bounce", "--out", other, "--force"}).exit_code == 0);
    CHECK(tests::read_all(other + "/" + name) != "somebody's own");
  }
  // A sweep leaves a copy of its spec: not over another one.
  const std::string own = folder.file("mine/spec.toml", head);
  const std::string spec = folder.file("other.toml", head);
  const Outcome refused = kairos_program({"sweep", spec, "--out", out});
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "spec.toml"));
  CHECK(tests::read_all(own) == head);
}
