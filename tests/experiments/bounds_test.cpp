// Inputs that once ended the program, or never ended: every one is answered with an exit code and a
// reason, within bounded memory and time.

#include "core/archive.hpp"
#include "core/random.hpp"
#include "experiments/checkpoint/checkpoint_file.hpp"
#include "experiments/sweeps/sweep_plan.hpp"
#include "tests/allocations.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;
using tests::kairos_program;
using tests::Outcome;
using tests::TemporaryFolder;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t mebibyte = std::size_t{1} << 20;

const std::string ball =
    "[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\nposition = [0, 5, "
    "0]\n";
const std::string spec_head =
    "scene = \"bounce\"\nmetrics = [\"impacts\"]\n[options]\nduration = 0.1\n";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

void check_refused(const std::vector<std::string>& arguments, const std::string& says,
                   tests::Surroundings surroundings = {}) {
  surroundings.processor_seconds = 20;
  const Outcome outcome = kairos_program(arguments, surroundings);
  CAPTURE(arguments, outcome.err.substr(0, 500));
  CHECK(outcome.exit_code == 2);
  CHECK(contains(outcome.err, says));
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string out;
  for (std::size_t k = 0; k < times; ++k) {
    out += text;
  }
  return out;
}

}  // namespace

TEST_CASE("bounds: an integrator that fails at once stops the run, whatever the scheme",
          "[bounds]") {
  for (const char* scheme : {"bisected", "substepped", "geometric", "original", "event-driven"}) {
    for (const char* integrator : {"dopri5", "rk4"}) {
      const Outcome outcome = kairos_program(
          {"run", "table-tennis", "--duration", "0.2", "--scheme", scheme, "--integrator",
           integrator, "--detector", "certified", "--absolute-tolerance", "0"});
      CAPTURE(scheme, integrator, outcome.err);
      CHECK((outcome.exit_code >= 0 && outcome.exit_code <= 2));
      CHECK((outcome.exit_code == 0 || !outcome.err.empty()));
    }
  }
}

TEST_CASE("bounds: empty arrays where a table is due", "[bounds]") {
  const TemporaryFolder folder;
  for (const std::string& text :
       {spec_head + "[[method]]\nname = \"m\"\nset = []\n", "set = []\n" + spec_head,
        "method = []\n" + spec_head, "axis = []\n" + spec_head, "derive = []\n" + spec_head,
        "constants = []\n" + spec_head, "sweep = []\n" + spec_head}) {
    check_refused({"sweep", folder.file("spec.toml", text)}, "is an empty array");
  }
}

TEST_CASE("bounds: keys of 60,000 parts, and brackets in brackets", "[bounds]") {
  const TemporaryFolder folder;
  const std::string parts = "a" + repeated(".a", 60000);
  const std::string tables = repeated("{a=", 300) + "1" + repeated("}", 300);
  const std::string mixed = repeated("{" + ("a" + repeated(".a", 20)) + " = ", 60);
  for (const std::string& text :
       {parts + " = 1\n", "[" + parts + "]\n", "[[" + parts + "]]\n", "x = {" + parts + " = 1}\n",
        "\"a\"" + repeated(" . \"a\"", 60000) + " = 1\n", "x = " + tables + "\n",
        "x = " + repeated("[", 100000) + "\n", "x = " + mixed + "\n"}) {
    check_refused({"run", folder.file("deep.toml", text)}, "deep.toml:1: is nested too deeply");
    check_refused({"sweep", folder.file("deep.toml", text)}, "deep.toml:1: is nested too deeply");
  }
  check_refused({"run", "bounce", "--set", "body.ball.radius={" + parts + "=1}"},
                "nested too deeply");
  check_refused({"run", "bounce", "--set", parts + "=1"}, "the scene has no");
  // What is only long is not deep: numbers, texts and comments with any number of dots.
  const std::string flat = folder.file(
      "flat.toml", "summary = \"" + repeated("a.", 1000) + "\" # " + repeated("[.", 1000) +
                       "\nname = '''\n" + repeated("x.y[{\n", 100) + "'''\n" + ball);
  CHECK(kairos_program({"run", flat, "--duration", "0.1"}).exit_code == 0);
}

TEST_CASE("bounds: more threads than memory has room for", "[bounds][toi][address-space]") {
  const TemporaryFolder folder;
  const std::string queries = folder.file(
      "queries.csv",
      "id,a_hx,a_hy,a_hz,a_px,a_py,a_pz,a_qw,a_qx,a_qy,a_qz,a_vx,a_vy,a_vz,a_ax,a_ay,a_az,a_wx,"
      "a_wy,a_wz,b_hx,b_hy,b_hz,b_px,b_py,b_pz,b_qw,b_qx,b_qy,b_qz,b_vx,b_vy,b_vz,b_ax,b_ay,b_az,"
      "b_wx,b_wy,b_wz,duration\n"
      "q,1,1,1,0,0,0,1,0,0,0,1,0,0,0,0,0,0,0,0,1,1,1,5,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0,10\n");
  const Outcome outcome =
      kairos_program({"toi", queries, "--threads", "1024"}, {.memory = 400 * mebibyte});
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(contains(outcome.out, "q,impact,"));
  const std::string spec = folder.file("spec.toml", "repeats = 2000\n" + spec_head);
  const Outcome sweep =
      kairos_program({"sweep", spec, "--threads", "1024"}, {.memory = 400 * mebibyte});
  CAPTURE(sweep.err);
  CHECK(sweep.exit_code == 0);
}

TEST_CASE("bounds: more bodies than memory has room for are refused, with the number that fits",
          "[bounds][address-space]") {
  const tests::Surroundings little{.memory = 400 * mebibyte};
  const auto gas = [&](const std::string& balls) {
    return kairos_program({"run", "gas", "--set", "many.ball.count=" + balls, "--set",
                           "many.ball.radius=0.005", "--duration", "1e-4", "--frame", "1e-4"},
                          little);
  };
  const Outcome refused = gas("10000000");
  CAPTURE(refused.err);
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.err, "many.ball.count: 10000000 bodies take some 20480000000 bytes"));
  const std::string room = "there is room for ";
  const std::size_t at = refused.err.find(room);
  REQUIRE(at != std::string::npos);
  const double fits = std::stod(refused.err.substr(at + room.size()));
  CHECK(fits > 20'000);
  const Outcome run = gas(std::to_string(static_cast<int>(fits)));
  CAPTURE(fits, run.err);
  CHECK(run.exit_code == 0);  // and so it does
}

TEST_CASE("bounds: a device without an end is no input", "[bounds][address-space]") {
  const TemporaryFolder folder;
  const std::string endless = folder.path("endless.csv");
  fs::create_symlink("/dev/zero", endless);
  const std::string tracked = folder.file(
      "tracked.toml",
      ball +
          "[[body]]\nname = \"bat\"\nentity = \"bat\"\nhalf_extents = [0.1, 0.1, 0.1]\nmass = "
          "1.0\n[body.drive]\ntrack = \"endless.csv\"\n");
  const std::string framed = folder.file("framed.toml", "frame = {csv = \"endless.csv\"}\n" + ball);
  const tests::Surroundings little{.memory = 1500 * mebibyte};
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", tracked},
        {"run", framed},
        {"run", "/dev/zero"},
        {"run", "bounce", "--frame", endless},
        {"sweep", "/dev/zero"},
        {"toi", "/dev/zero"},
        {"render", endless, "--out", folder.path("frames")}}) {
    const Outcome outcome = kairos_program(arguments, little);
    CAPTURE(arguments, outcome.exit_code, outcome.err.substr(0, 300));
    CHECK(outcome.exit_code == 2);
  }
  check_refused({"run", "bounce", "--resume", "/dev/zero"}, "no regular file", little);
  check_refused({"run", "bounce", "--resume", folder.path("")}, "no regular file", little);
}

TEST_CASE("bounds: no half of a file is used where memory ends", "[bounds][address-space]") {
  const TemporaryFolder folder;
  // 100 MB of comment, then what would be missing: the second ball.
  std::string text = ball;
  text += "#" + std::string(100 * mebibyte, 'x') + "\n";
  std::string second = ball;
  second.replace(second.find("ball"), 4, "other");
  second.replace(second.find("0, 5"), 4, "3, 5");
  const std::string scene = folder.file("long.toml", text + second);
  int ended = 0;
  for (const std::size_t memory :
       std::vector<std::size_t>{120, 160, 200, 240, 280, 320, 400, 600}) {
    const std::string out = folder.path("out-" + std::to_string(memory));
    const Outcome outcome = kairos_program({"run", scene, "--duration", "0.1", "--out", out},
                                           {.memory = memory * mebibyte});
    CAPTURE(memory, outcome.exit_code, outcome.err);
    if (outcome.exit_code == 0) {  // then it is the whole scene
      CHECK(contains(tests::read_all(out + "/summary.json"), "\"other\""));
      continue;
    }
    ++ended;
    CHECK(outcome.exit_code == 1);
    CHECK(contains(outcome.err, "memory"));
  }
  CHECK(ended > 0);
}

TEST_CASE("bounds: numbers that are none, and names that are empty", "[bounds][cli]") {
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"record", "--out", out, "--rate", "nan"},
        {"record", "--out", out, "--noise", "nan"},
        {"record", "--out", out, "--angle-noise", "nan"},
        {"record", "--out", out, "--slowest", "nan"},
        {"record", "--out", out, "--fastest", "nan"},
        {"record", "--out", out, "--seed", "-1"},
        {"run", "bounce", "--save", out, "--save-interval", "nan"},
        {"run", "bounce", "--save", out, "--save-interval", "inf"},
        {"run", "bounce", "--save", ""},
        {"run", "bounce", "--resume", ""},
        {"random-scenes", "--count", "1", "--first", "-1"},
        {"random-scenes", "--count", "1", "--seed", "-1"},
        {"random-scenes", "--count", "nan"},
        {"render", out, "--out", out, "--film-rate", "nan"},
        {"render", out, "--out", out, "--beside", ""},
        {"physworld", "--tries", "-1"},
        {"physworld", "--out", ""},
        {"bench", "accuracy", "--out", ""},
        {"sweep", "x.toml", "--out", ""},
        {"sweep", "x.toml", "--threads", "1.5"}}) {
    const Outcome outcome = kairos_program(arguments);
    CAPTURE(arguments, outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(contains(outcome.err, arguments[arguments.size() - 2]));
    CHECK_FALSE(fs::exists(out));
  }
}

TEST_CASE("bounds: models of a .def whose names are too long or lead in a circle", "[bounds]") {
  const TemporaryFolder folder;
  fs::create_symlink(folder.path("loop.off"), folder.path("loop.off"));
  for (const std::string& name : {std::string(5000, 'x'), std::string("loop"),
                                  repeated("a/", 3000) + "b", std::string("\1\2")}) {
    const std::string scene = folder.file(
        "world.def", "Object1-Name:" + name + "\nObject1-Pos:0 0 0\nObject1-Type:O_ball\n");
    check_refused({"run", scene}, "world.def:1: Object1-Name");
  }
}

TEST_CASE("bounds: a grid of ten million runs takes no memory to plan", "[bounds][sweep]") {
  const ExperimentSpec spec = parse_experiment(
      spec_head +
          "[[axis]]\nname = \"x\"\nlinear = {from = 0, to = 1, count = 100000}\n[[axis]]\n"
          "name = \"y\"\nlinear = {from = 0, to = 1, count = 100}\n",
      "grid.toml", Size::quick);
  const std::size_t before = test::allocations();
  const SweepPlan plan(spec.sweeps.front());
  REQUIRE(plan.size() == 10'000'000);
  const PlannedRun last = plan[plan.size() - 1];
  CHECK(last.values.at("x") == 1.0);
  CHECK(last.values.at("y") == 1.0);
  CHECK(plan[12345].values.at("y") == Approx(45.0 / 99.0));
  // A copy of the spec has a text or two for each value of its axes, and no run has anything.
  CHECK(test::allocations() - before < 500'000);
}

TEST_CASE("bounds: run --save holds what was written on the disk, not in memory",
          "[bounds][address-space]") {
  const TemporaryFolder folder;
  const std::string saved = folder.path("saved");
  const Outcome outcome =
      kairos_program({"run", "bounce", "--duration", "6000", "--out", folder.path("out"), "--save",
                      saved, "--save-interval", "1e6"},
                     {.memory = 160 * mebibyte});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(fs::file_size(saved) > 80 * mebibyte);  // all output is in it
  const Outcome on = kairos_program(
      {"run", "bounce", "--duration", "6001", "--out", folder.path("more"), "--resume", saved},
      {.memory = 160 * mebibyte});
  CAPTURE(on.err);
  CHECK(on.exit_code == 0);
}

TEST_CASE("bounds: forged checkpoints with a right checksum end with a code and a reason",
          "[bounds][checkpoint][address-space]") {
  const TemporaryFolder folder;
  Random random(20261122, 28);
  INFO("seed 20261122, stream 28");
  for (const std::vector<std::string>& method :
       {std::vector<std::string>{"run", "table-tennis"},
        {"run", "pad", "--thesis"},
        {"run", "bounce-inelastic", "--scheme", "bisected", "--integrator", "dopri5"},
        {"run", "spinning-box", "--integrator", "rk4"}}) {
    const std::string saved = folder.path("saved");
    std::vector<std::string> save = method;
    save.insert(save.end(), {"--duration", "0.4", "--save", saved});
    REQUIRE(kairos_program(save).exit_code <= 1);  // 1: it stopped, with a checkpoint
    REQUIRE(fs::exists(saved));
    const std::string whole = tests::read_all(saved);
    const CheckpointFile file = read_checkpoint(saved);
    const std::size_t begin = whole.find(file.world);
    for (int trial = 0; trial < 60; ++trial) {
      std::string forged = whole.substr(0, whole.size() - 16);
      const auto changes = 1 + random.below(4);
      for (std::uint64_t k = 0; k < changes; ++k) {
        const std::size_t at = begin + random.below(file.world.size());
        forged[at] = static_cast<char>(random.below(3) == 0 ? 0xff : random.below(256));
      }
      forged += fingerprint(forged);
      std::vector<std::string> resume = method;
      resume.insert(resume.end(), {"--duration", "0.6", "--resume", folder.file("forged", forged)});
      const Outcome outcome =
          kairos_program(resume, {.memory = 1000 * mebibyte, .processor_seconds = 20});
      CAPTURE(method[1], trial, outcome.err);
      CHECK((outcome.exit_code >= 0 && outcome.exit_code <= 2));
    }
  }
}

TEST_CASE("a run shows a person on a terminal that it works, before its first frame", "[cli]") {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  REQUIRE(terminal >= 0);
  REQUIRE((::grantpt(terminal) == 0 && ::unlockpt(terminal) == 0));
  const int held = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY);
  const Outcome outcome =
      kairos_program({"run", "bounce", "--frame", "10"}, {.error = ::ptsname(terminal)});
  std::string shown(4096, '\0');
  const ::ssize_t count = ::read(terminal, shown.data(), shown.size());
  ::close(held);
  ::close(terminal);
  REQUIRE(count > 0);
  CHECK(outcome.exit_code == 0);
  CHECK(contains(shown, "0 of 10 s"));
}
