// The command line as a person meets it: help everywhere, exit codes, and messages that name what
// is wrong and what is allowed.

#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/simulation/scenes.hpp"

#include <fmt/format.h>
#include <stdlib.h>  // setenv: POSIX

#include <string>
#include <vector>

using namespace kairos::tests;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::vector<std::string> commands{"run", "explain", "list", "toi"};

}  // namespace

TEST_CASE("option --help works everywhere and goes to stdout", "[cli]") {
  const Outcome top = kairos_program({"--help"});
  CHECK(top.exit_code == 0);
  CHECK(top.err.empty());
  for (const std::string& command : commands) {
    CAPTURE(command);
    CHECK(contains(top.out, command));
    const Outcome help = kairos_program({command, "--help"});
    CHECK(help.exit_code == 0);
    CHECK(contains(help.out, "Usage:"));
    CHECK(help.err.empty());
  }
}

TEST_CASE("option --version names the version", "[cli]") {
  const Outcome outcome = kairos_program({"--version"});
  CHECK(outcome.exit_code == 0);
  CHECK(contains(outcome.out, "kairos 0."));
}

TEST_CASE("list names what there is to choose from", "[cli]") {
  const Outcome all = kairos_program({"list"});
  REQUIRE(all.exit_code == 0);
  for (const char* name : {"original",     "geometric",    "substepped", "bisected",
                           "event-driven", "moreau-jean",  "pgs",        "xpbd",
                           "penalty",      "thesis-euler", "auto",       "closed-form",
                           "rk4",          "sat",          "bisection",  "conservative-advancement",
                           "certified",    "newton",       "all-pairs",  "conveyor",
                           "bounce"}) {
    CAPTURE(name);
    CHECK(contains(all.out, name));
  }
  const Outcome one = kairos_program({"list", "detectors"});
  CHECK(contains(one.out, "certified"));
  CHECK_FALSE(contains(one.out, "thesis-euler"));
}

TEST_CASE("list takes what has two words in any spelling", "[cli]") {
  for (const auto& [first, second] : {std::pair{"impact", "laws"}, std::pair{"broad", "phases"}}) {
    const std::string both = first + std::string("-") + second;
    const Outcome hyphen = kairos_program({"list", both});
    REQUIRE(hyphen.exit_code == 0);
    CHECK(hyphen.out.starts_with(both + "\n"));
    CHECK(kairos_program({"list", first, second}).out == hyphen.out);
    CHECK(kairos_program({"list", first + std::string(" ") + second}).out == hyphen.out);
  }
}

TEST_CASE("list --csv says the same to programs", "[cli]") {
  const Outcome integrators = kairos_program({"list", "integrators", "--csv"});
  REQUIRE(integrators.exit_code == 0);
  CHECK(
      integrators.out.starts_with("name,order,position_order,velocity_order,chooses_order,"
                                  "symplectic,step,library,source,summary\n"));
  CHECK(contains(integrators.out, "\nvelocity-verlet,2,2,2,no,yes,fixed,kairos,"));
  const Outcome all = kairos_program({"list", "--csv"});
  CHECK(all.out.starts_with("kind,name,summary\nschemes,original,"));
  CHECK(contains(all.out, "\nintegrators,rk4,\n"));
  CHECK(contains(all.out, "\nbroad-phases,all-pairs,\n"));
}

TEST_CASE("run prints a summary and exits with 0", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const Outcome outcome = kairos_program({"run", scene});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  CHECK(contains(outcome.out, "event-driven + auto (closed-form) + certified + newton"));
  CHECK(contains(outcome.out, "integrator steps      2, 2 right-hand sides\n"));  // fall, rebound
  CHECK(contains(outcome.out, "t = 2.5 s"));
}

TEST_CASE("option --thesis is the thesis' own method, and single choices win over it", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const Outcome thesis = kairos_program({"run", scene, "--thesis"});
  CHECK(contains(thesis.out, "original + thesis-euler + sat + thesis"));
  const Outcome mixed = kairos_program({"run", scene, "--thesis", "--impact", "newton"});
  CHECK(contains(mixed.out, "original + thesis-euler + sat + newton"));
}

TEST_CASE("option --set replaces a value of the scene", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const Outcome none = kairos_program({"run", scene, "--set", "body.ball.position=[0, 500, 0]"});
  CAPTURE(none.out, none.err);
  CHECK(none.exit_code == 0);
  CHECK(contains(none.out, "impacts               0"));
}

TEST_CASE("option --frame takes a fraction, a unit, or a CSV of frame times", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const std::string times = folder.file("frames.csv", "duration\n0.5\n0.25\n");
  for (const std::string frame : {"1/60", "16ms", "0.01", times.c_str()}) {
    CAPTURE(frame);
    CHECK(kairos_program({"run", scene, "--frame", frame}).exit_code == 0);
  }
}

TEST_CASE("explain says what the model leaves out", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const Outcome outcome = kairos_program({"explain", scene});
  CHECK(outcome.exit_code == 0);
  CHECK(contains(outcome.out, "because"));
}

TEST_CASE("wrong command lines exit with 2 and say what is wrong", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  const std::string empty = folder.file("empty.csv", "");
  const std::string bad_times = folder.file("bad.csv", "duration\n0.1\n-1\n");
  const std::string stump = folder.file("stump.toml", drop_scene.substr(0, 150));
  const std::string inside =
      folder.file("inside.toml", std::string(drop_scene) +
                                     "[[body]]\nname = \"other\"\n"
                                     "entity = \"ball\"\nradius = 0.1\nmass = 1.0\n"
                                     "position = [0.05, 5.0, 0.0]\n");
  struct Case {
    std::vector<std::string> arguments;
    std::string says;
  };
  const std::vector<Case> cases{
      {{}, "subcommand"},
      {{"fly"}, "fly"},
      {{"--fly"}, "--fly"},
      {{"run"}, "scene"},
      {{"run", "nowhere.toml"}, "nowhere.toml"},
      {{"run", "bounse"}, "bounce"},
      {{"run", folder.path("")}, folder.path("")},
      {{"run", stump}, "stump.toml:"},
      {{"run", inside}, "inside body.ball (line 11)"},
      {{"run", scene, "--scheme", "orginal"}, "original"},
      {{"run", scene, "--integrator", "rk5"}, "rk4"},
      {{"run", scene, "--detector", "certain"}, "certified"},
      {{"run", scene, "--impact", "newtonian"}, "newton"},
      {{"run", scene, "--scheme", "event-driven", "--detector", "sat"}, "sat"},
      {{"run", scene, "--frame", "0"}, "--frame"},
      {{"run", scene, "--frame", "-1/60"}, "--frame"},
      {{"run", scene, "--frame", "1/0"}, "--frame"},
      {{"run", scene, "--frame", "nan"}, "--frame"},
      {{"run", scene, "--frame", "16parsecs"}, "--frame"},
      {{"run", scene, "--frame", folder.path("none.csv")}, "none.csv"},
      {{"run", scene, "--frame", empty}, "empty.csv"},
      {{"run", scene, "--frame", bad_times}, "bad.csv:3"},
      {{"run", scene, "--frame", "1e-15", "--duration", "1000"}, "frames"},
      {{"run", scene, "--duration", "-1"}, "--duration"},
      {{"run", scene, "--duration", "inf"}, "--duration"},
      {{"run", scene, "--duration", ""}, "--duration"},
      {{"run", scene, "--step", "0"}, "--step"},
      {{"run", scene, "--threshold", "-0.1"}, "threshold"},
      {{"run", scene, "--threshold", "wide"}, "--threshold"},
      {{"run", scene, "--tolerance", "-1e-9"}, "tolerance"},
      {{"run", scene, "--tolerance", "nan"}, "--tolerance"},
      {{"run", scene, "--max-substeps", "0"},
       "--max-substeps: is 0; allowed: a whole number from 1 to"},
      {{"run", scene, "--max-substeps", "1.5"}, "--max-substeps"},
      {{"run", scene, "--relative-tolerance", "-1"},
       "--relative-tolerance: is -1; allowed: a number > 0 and <= 1"},
      {{"run", scene, "--absolute-tolerance", "x"}, "--absolute-tolerance"},
      {{"run", scene, "--set", "radius"}, "--set"},
      {{"run", scene, "--set", "=1"}, "--set"},
      {{"run", scene, "--set", "body.ball.radius=-1"}, "radius"},
      {{"run", scene, "--set", "body.bal.radius=1"}, "ball"},
      {{"run", scene, "--set", "body.ball.mass=nan"}, "mass"},
      {{"run", scene, "--out", ""}, "--out"},
      {{"run", scene, scene}, "drop.toml"},
      {{"explain"}, "scene"},
      {{"explain", "nowhere"}, "nowhere"},
      {{"list", "planets"}, "planets"},
      {{"toi"}, "queries"},
      {{"toi", "nowhere.csv"}, "nowhere.csv"},
      {{"toi", empty, "--detector", "sat"}, "sat"},
      {{"toi", empty, "--tolerance", "-1"}, "--tolerance"},
      {{"toi", empty, "--threads", "-3"}, "--threads"},
  };
  for (const Case& wrong : cases) {
    const Outcome outcome = kairos_program(wrong.arguments);
    INFO("kairos " << fmt::format("{}", fmt::join(wrong.arguments, " ")));
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, wrong.says));
  }
}

TEST_CASE("what is not expected is named in the order in which it was written", "[cli]") {
  const Outcome outcome =
      kairos_program({"run", "bounce", "--zeta", "1", "--schem", "original", "--alpha"});
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.err.starts_with("--zeta: "));
  CHECK(outcome.err.find("--schem") < outcome.err.find("--alpha"));
  const Outcome typed = kairos_program({"run", "bounce", "--schem", "original"});
  CHECK(contains(typed.err, "did you mean \"--scheme\""));
  CHECK(kairos_program({"run", "bounce", "--help"}).exit_code == 0);
}

TEST_CASE("messages lead to what was meant", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", "gravity = -9.81\n" + std::string(drop_scene));
  struct Case {
    std::vector<std::string> arguments;
    std::vector<std::string> says;
  };
  const std::vector<Case> cases{
      {{"run", scene}, {"drop.toml:1: gravity", "acceleration, force", "G = 9.81"}},
      {{"sweep", "bounce"}, {"is a scene", "kairos run bounce", "file of a spec"}},
      {{"sweep", "penetration"}, {"is an experiment", "kairos experiment penetration"}},
      {{"experiment", "foo"}, {"fig13", "penetration", "table-tennis"}},
      {{"experiment", "penetratoin"}, {"did you mean \"penetration\""}}};
  for (const Case& wrong : cases) {
    const Outcome outcome = kairos_program(wrong.arguments);
    CAPTURE(wrong.arguments, outcome.err);
    CHECK(outcome.exit_code == 2);
    for (const std::string& part : wrong.says) {
      CAPTURE(part);
      CHECK(contains(outcome.err, part));
    }
  }
}

TEST_CASE("what is allowed and hardly meant draws a warning", "[cli]") {
  const Outcome seconds = kairos_program({"run", "bounce", "--duration", "2", "--frame", "16"});
  CHECK(seconds.exit_code == 0);
  CHECK(contains(seconds.err, "warning: a frame is 16 s"));
  CHECK(contains(seconds.err, "16ms"));
  CHECK(kairos_program({"run", "bounce", "--duration", "2", "--frame", "16ms"}).err.empty());
  const Outcome second = kairos_program({"recommend", "bullet", "--error", "1", "--budget", "1"});
  CHECK(contains(second.err, "warning: --budget is 1 s"));
  CHECK(kairos_program({"recommend", "bullet", "--error", "1", "--budget", "1ms"}).err.empty());
}

TEST_CASE("list fits the terminal, and is as wide as it is in a pipe", "[cli]") {
  const Outcome pipe = kairos_program({"list"});
  ::setenv("COLUMNS", "80", 1);
  const Outcome narrow = kairos_program({"list"});
  const Outcome csv = kairos_program({"list", "--csv"});
  ::unsetenv("COLUMNS");
  std::size_t begin = 0;
  for (std::size_t end = narrow.out.find('\n'); end != std::string::npos;
       begin = end + 1, end = narrow.out.find('\n', begin)) {
    const std::string line = narrow.out.substr(begin, end - begin);
    CAPTURE(line);
    CHECK(line.size() <= 80);
  }
  const auto words = [](std::string text) {
    std::string out;
    for (const char c : text) {
      out += c == ' ' || c == '\n' ? "" : std::string(1, c);
    }
    return out;
  };
  CHECK(words(narrow.out) == words(pipe.out));  // nothing is lost
  CHECK(csv.out == kairos_program({"list", "--csv"}).out);
}

TEST_CASE("explain tells what of the speed an impact keeps", "[cli]") {
  CHECK(contains(kairos_program({"explain", "bounce"}).out, "impacts lose nothing"));
  const Outcome half = kairos_program({"explain", "bounce", "--set", "body.ball.restitution=0.5",
                                       "--set", "body.floor.restitution=0.8"});
  CAPTURE(half.out);
  CHECK(contains(half.out, "0.5 x 0.8 = 0.4, as for ball and floor"));
  CHECK(contains(half.out, "product"));
  CHECK_FALSE(contains(half.out, "ball and ball"));  // there is one ball, and it never meets itself
  CHECK(contains(kairos_program({"explain", "stack"}).out, "as for box-01 and box-02"));
}

TEST_CASE("a message names file, line and key", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene =
      folder.file("drop.toml", std::string(drop_scene) + "restitution = 2.0\n");
  const Outcome outcome = kairos_program({"run", scene});
  CHECK(outcome.exit_code == 2);
  CHECK(contains(outcome.err, scene + ":17: body.ball.restitution: "));
}

TEST_CASE("stdout that takes nothing is a failed run", "[cli][fault]") {
  const TemporaryFolder folder;
  const std::string scene = folder.file("drop.toml", drop_scene);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", scene}, {"list"}, {"explain", scene}, {"--help"}}) {
    CAPTURE(arguments.front());
    const Outcome outcome = kairos_program(arguments, {.output = "/dev/full"});
    CHECK(outcome.exit_code == 1);
    CHECK(contains(outcome.err, "No space left"));
  }
}
