// Sweeps: a spec is read or refused with file, line and key; rows are the same for any number of
// threads; nothing that fails is dropped.

#include "experiments/sweeps/sweep.hpp"

#include "core/error.hpp"
#include "core/random.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/sweeps/sweep_journal.hpp"
#include "experiments/sweeps/sweep_plan.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <fcntl.h>
#include <pty.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;

namespace {

const std::string head = "scene = \"bullet\"\nmetrics = [\"tunnelled\", \"impacts\"]\n";

SweepSpec spec(const std::string& text) {
  return parse_experiment(text, "spec.toml", Size::quick).sweeps.front();
}

std::string complaint(const std::string& text) {
  try {
    for (const SweepSpec& sweep : parse_experiment(text, "spec.toml", Size::quick).sweeps) {
      (void)run_sweep(sweep, 1);
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return "(none)";
}

}  // namespace

TEST_CASE("a program's scenes have a duration each, of the size asked for, or none is given",
          "[sweep]") {
  const std::string text = "program = \"tradeoff\"\nscenes = [\"stack\", \"spring\"]\n";
  const std::string both = text + "durations = { quick = [1, \"1/2\"], full = [10, 2] }\n";
  CHECK(parse_experiment(text, "spec.toml", Size::quick).durations.empty());
  CHECK(parse_experiment(both, "spec.toml", Size::quick).durations == std::vector{1.0, 0.5});
  CHECK(parse_experiment(both, "spec.toml", Size::full).durations == std::vector{10.0, 2.0});
  for (const auto& [given, reason] :
       {std::pair{"[1]", "durations: 1 are not allowed; allowed: one for each of 2 scenes"},
        {"[1, 0]", "durations[2]: 0 is not allowed; allowed: > 0"},
        {"[1, nan]", "durations[2]"},
        {"1", "durations"}}) {
    CAPTURE(given);
    const std::string said = complaint(text + "durations = " + given + "\n");
    CHECK(said.starts_with("spec.toml:3: "));
    CHECK(said.find(reason) != std::string::npos);
  }
}

TEST_CASE("joint_drift: what a joint is off by, of the size of its mechanism", "[sweep]") {
  // Frames end where steps do, at whose ends joints hold to roundoff; in between, by dense output.
  const SweepSpec held = spec(
      "scene = \"double-pendulum\"\nmetrics = [\"joint_drift\"]\n[options]\nduration = 1\n"
      "frame = \"1/64\"\nfixed_step = 1\nintegrator = \"rk4\"\n");
  const experiments::Table runs = run_sweep(held, 1).runs;
  const double drift = std::get<double>(runs.rows.front().at(runs.column("joint_drift")));
  CHECK(drift > 0.0);
  CHECK(drift <= 1e-12);
  // Nothing is jointed: there is nothing to be off.
  const SweepSpec loose = spec("scene = \"bullet\"\nmetrics = [\"joint_drift\"]\n");
  const experiments::Table unjointed = run_sweep(loose, 1).runs;
  CHECK(std::get<double>(unjointed.rows.front().at(unjointed.column("joint_drift"))) == 0.0);
}

TEST_CASE("axes: lists, linear and logarithmic ranges include their ends", "[sweep]") {
  const SweepSpec sweep = spec(head + R"(
[constants]
h = "1/50"
[[axis]]
name = "a"
list = [1, "= 2*h", "text"]
[[axis]]
name = "b"
linear = { from = 0, to = 1, count = 5 }
[[axis]]
key = "body.bullet.radius"
log = { from = 0.001, to = 0.01, count = 3 }
)");
  REQUIRE(sweep.axes.size() == 3);
  CHECK(sweep.axes[0].values[1].number == 0.04);
  CHECK(sweep.axes[0].values[2].text == "text");
  CHECK_FALSE(sweep.axes[0].values[2].number);
  CHECK(sweep.axes[1].values[2].number == 0.5);
  CHECK(sweep.axes[2].name == "radius");
  CHECK(sweep.axes[2].values[0].number == 0.001);
  CHECK(sweep.axes[2].values[1].number.value() == Approx(0.001 * std::sqrt(10.0)));
  CHECK(sweep.axes[2].values[2].number == 0.01);
}

TEST_CASE("plan: draws are stratified, repeatable, and the same for all methods", "[sweep]") {
  const std::string text = head + R"(
repeats = 50
[[method]]
name = "one"
[[method]]
name = "two"
[[axis]]
name = "n"
list = [1, 2]
[[axis]]
name = "phase"
stratified = { from = 2, to = 4 }
[[axis]]
name = "free"
random = { from = -1, to = 1 }
)";
  const auto plan = SweepPlan(spec(text));
  REQUIRE(plan.size() == 200);
  for (std::size_t i = 0; i < 200; ++i) {
    const double phase = plan[i].values.at("phase");
    const auto k = static_cast<double>(i % 50);
    CHECK(phase >= 2.0 + 2.0 * k / 50.0);
    CHECK(phase < 2.0 + 2.0 * (k + 1.0) / 50.0);
    CHECK(std::abs(plan[i].values.at("free")) <= 1.0);
    CHECK(plan[i].values.at("free") == plan[(i + 100) % 200].values.at("free"));
  }
  CHECK(plan[0].values.at("free") != plan[50].values.at("free"));
  const auto other = SweepPlan(spec("seed = 2\n" + text));
  CHECK(plan[0].values.at("free") != other[0].values.at("free"));
}

TEST_CASE("plan: expressions reach scene values and method options", "[sweep]") {
  const auto plan = SweepPlan(spec(head + R"(
[constants]
frame = "1/50"
[options]
frame = "= frame/2"
duration = 0.5
[set]
"body.bullet.velocity" = ["= 10*speed", 0, 0]
[[method]]
scheme = "substepped"
detector = "sat"
impact = "thesis"
integrator = "thesis-euler"
threshold = "= speed/100"
equal_substeps = true
[[axis]]
name = "speed"
list = [2, 3]
)"));
  REQUIRE(plan.size() == 2);
  CHECK(plan[1].overrides[0].key == "body.bullet.velocity");
  CHECK(plan[1].overrides[0].value == "[30, 0, 0]");
  CHECK(plan[1].choice.threshold == 0.03);
  CHECK(plan[1].choice.equal_substeps);
  CHECK(std::get<FixedFrames>(*plan[1].choice.frames).duration == 0.01);
}

TEST_CASE("one and two threads leave the same bytes", "[sweep]") {
  const SweepSpec sweep = spec(head + R"(
repeats = 8
series = true
[[method]]
scheme = "original"
integrator = "thesis-euler"
detector = "sat"
impact = "thesis"
[[method]]
scheme = "event-driven"
[[axis]]
name = "phase"
stratified = { from = 0, to = 1 }
[set]
"body.bullet.position" = ["= -1 - phase/3", 0, 0]
)");
  const SweepResult one = run_sweep(sweep, 1);
  const SweepResult two = run_sweep(sweep, 2);
  CHECK(one.runs.csv() == two.runs.csv());
  CHECK(one.summary.csv() == two.summary.csv());
  CHECK(one.series.csv() == two.series.csv());
  CHECK(one.apexes.csv() == two.apexes.csv());
  CHECK(one.runs.rows.size() == 16);
  CHECK(one.failed == 0);
}

TEST_CASE("what is refused or stopped is a row with its reason", "[sweep]") {
  const SweepResult result = run_sweep(spec(head + R"(
[[axis]]
key = "body.bullet.radius"
list = [0.02, -1]
[[method]]
name = "good"
[[method]]
name = "no location"
scheme = "event-driven"
detector = "sat"
[[method]]
name = "too many substeps"
scheme = "substepped"
integrator = "thesis-euler"
detector = "sat"
impact = "thesis"
max_substeps = 1
)"),
                                       2);
  const std::size_t status = result.runs.column("status");
  const std::size_t reason = result.runs.column("reason");
  REQUIRE(result.runs.rows.size() == 6);
  const std::vector<std::string> expected = {"completed", "refused", "refused",
                                             "refused",   "stopped", "refused"};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO(i << ": " << to_text(result.runs.rows[i][reason]));
    CHECK(to_text(result.runs.rows[i][status]) == expected[i]);
    CHECK((to_text(result.runs.rows[i][reason]).empty()) == (expected[i] == "completed"));
  }
  CHECK(result.failed == 5);
}

TEST_CASE("a reference method adds differences", "[sweep]") {
  const SweepResult result = run_sweep(spec(R"(
scene = "bounce"
metrics = ["energy_gain"]
reference = "event-driven"
[options]
duration = 1
[[method]]
scheme = "original"
integrator = "thesis-euler"
detector = "sat"
impact = "thesis"
[[method]]
scheme = "event-driven"
)"),
                                       1);
  const std::size_t error = result.runs.column("energy_gain_error");
  CHECK(std::get<double>(result.runs.rows[0][error]) > 0.5);
  CHECK(std::get<double>(result.runs.rows[1][error]) == 0.0);
}

TEST_CASE("bad specs are named by file, line and key", "[sweep][input]") {
  struct Bad {
    std::string text;
    std::string part;
  };
  const std::string axis = head + "[[axis]]\nname = \"a\"\n";
  const std::vector<Bad> cases = {
      {"", "scene: is missing"},
      {"scene = \"bullet\"\n", "metrics: is missing"},
      {"scene = 3\n", "spec.toml:1: scene: is a whole number; allowed: a string"},
      {"scene = \"bullet\"\nmetrics = \"x\"\n",
       "spec.toml:2: metrics: is a string; allowed: an array"},
      {"scene = \"bullet\"\nmetrics = [\"speed\"]\n", "no metric 'speed'"},
      {"scene = \"nowhere\"\nmetrics = [\"impacts\"]\n", "'nowhere'"},
      {"scene = \"bullet\"\nmetrics = [\"impacts\", \"impacts\"]\n", "used twice"},
      {head + "sede = 1\n", "spec.toml:3: sede: unknown key; allowed: scene"},
      {head + "seed = -1\n", "spec.toml:3: seed: is -1; allowed: a whole number from 0"},
      {head + "seed = 1.5\n", "seed: is a number; allowed: a whole number"},
      {head + "repeats = 0\n", "repeats: is 0; allowed: a whole number from 1"},
      {head + "series = 1\n", "series: is a whole number; allowed: true, false"},
      {head + "subject = \"nobody\"\n", "no body 'nobody'"},
      {head + "reference = \"x\"\n", "there is no method 'x'"},
      {head + "x = [\n", "not TOML"},
      {head + "[constants]\na = inf\n",
       "spec.toml:4: constants.a: is inf; allowed: a finite number"},
      {head + "[constants]\na = \"1/0\"\n", "allowed: a finite number"},
      {head + "[constants]\na = \"1+\"\n", "at character"},
      {head + "[options]\nspeed = 1\n", "options.speed: unknown key; allowed: scheme"},
      {head + "[options]\nframe = 0\n", "frame: \"0\" is no duration"},
      {head + "[options]\nframe = \"=x\"\n", "there is no 'x'"},
      {head + "[options]\nframe_jitter = 0.5\n", "frame_jitter: needs a frame"},
      {head + "[options]\nscheme = 3\n", "scheme"},
      {head + "[options]\nframe = [1]\n", "one value, not a list"},
      {head + "[[method]]\nscheme = \"orignal\"\n", "original"},
      {head + "[[method]]\nintegrator = \"rk5\"\n", "rk4"},
      {head + "[[method]]\nfoo = 1\n", "method[1].foo: unknown key"},
      {head + "[[method]]\nname = \"a\"\n[[method]]\nname = \"a\"\n", "used twice"},
      {head + "[set]\n\"body.nobody.mass\" = 1\n", "nobody"},
      {head + "[set]\n\"body.bullet.mass\" = { a = 1 }\n", "allowed: a number, text"},
      {head + "[derive]\np = \"nothing\"\n", "there is no 'nothing'"},
      {head + "[derive]\np = 3\n", "derive.p: is a whole number; allowed: a string"},
      {head + "[derive]\nimpacts = \"1\"\n", "used twice"},
      {head + "[[axis]]\nlist = [1]\n", "needs a name or a key"},
      {axis, "exactly one of list"},
      {axis + "list = []\n", "at least one value"},
      {axis + "list = [1]\nrandom = { from = 0, to = 1 }\n", "exactly one of list"},
      {axis + "linear = [1]\n", "must be {from"},
      {axis + "linear = { from = 0, to = 1 }\n", "count: is missing"},
      {axis + "linear = { from = 0, to = 1, count = 0 }\n", "count"},
      {axis + "linear = { from = 0, to = 1, count = 2, by = 1 }\n", "linear.by: unknown key"},
      {axis + "log = { from = 0, to = 1, count = 2 }\n", "needs from > 0"},
      {axis + "random = { from = 1, to = 1 }\n", "less than"},
      {axis + "stratified = { to = 1 }\n", "from: is missing"},
      {axis + "list = [1]\nkey = \"method.speed\"\n", "unknown; allowed"},
      {axis + "list = [1]\n[[axis]]\nname = \"a\"\nlist = [1]\n", "used twice"},
      {axis + "linear = { from = 0, to = 1, count = 100000 }\n[[axis]]\nname = \"b\"\n"
              "linear = { from = 0, to = 1, count = 100000 }\n",
       "at most 10000000"},
  };
  for (const Bad& bad : cases) {
    const std::string said = complaint(bad.text);
    INFO(bad.text << "\n-> " << said);
    CHECK(said.find(bad.part) != std::string::npos);
    CHECK(said.find("spec.toml") == 0);
  }
}

TEST_CASE("the command sweep: a table on stdout, exit 2 for what is wrong", "[sweep][cli]") {
  const tests::TemporaryFolder folder;
  const std::string good = folder.file("good.toml", head);
  const tests::Outcome table = tests::kairos_program({"sweep", good});
  CHECK(table.exit_code == 0);
  CHECK(table.out.find("run,method,repeat,status,reason,tunnelled,impacts") == 0);
  CHECK(table.err.empty());
  const tests::Outcome wrong =
      tests::kairos_program({"sweep", folder.file("wrong.toml", head + "sede = 1\n")});
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.err.find("wrong.toml:3: sede: unknown key") != std::string::npos);
  CHECK(tests::kairos_program({"sweep", folder.path("none.toml")}).exit_code == 2);
  CHECK(tests::kairos_program({"experiment", "nothing"}).exit_code == 2);
}

TEST_CASE("quantiles interpolate", "[sweep]") {
  CHECK(quantile({3.0}, 0.25) == 3.0);
  CHECK(quantile({1.0, 2.0, 3.0, 4.0}, 0.5) == 2.5);
  CHECK(quantile({1.0, 2.0, 3.0, 4.0, 5.0}, 0.25) == 2.0);
}

TEST_CASE("a sweep that is killed goes on where it stopped, to the same table", "[sweep][slow]") {
  const tests::TemporaryFolder folder;
  const std::string spec = folder.file("spec.toml",
                                       "scene = \"bounce\"\nmetrics = [\"impacts\", "
                                       "\"max_penetration\"]\nrepeats = 60\n"
                                       "[options]\nduration = 600\nframe_jitter = 0.1\n"
                                       "frame = \"= 1/60\"\n"
                                       "[[method]]\nscheme = \"original\"\n");
  const auto sweep = [&](const char* out, double kill_after) {
    return tests::kairos_program({"sweep", spec, "--out", folder.path(out)},
                                 {.kill_after = kill_after})
        .exit_code;
  };
  REQUIRE(sweep("whole", 0.0) == 0);
  const auto rows_of = [&](const char* out) {
    for (const std::string& name : folder.entries(out)) {
      if (name.find("_runs.csv") != std::string::npos) {
        return tests::read_all(folder.path(out) + "/" + name);
      }
    }
    return std::string();
  };
  const std::string whole = rows_of("whole");
  REQUIRE(whole.size() > 1000);

  Random random(20261121);
  INFO("seed 20261121");
  std::size_t kept = 0;
  int grown = 0;
  for (int kills = 0; kills < 10; ++kills) {
    (void)sweep("killed", random.uniform(0.03, 0.4));
    if (!rows_of("killed").empty()) {  // killed while it drew figures: the tables are whole
      CHECK(rows_of("killed") == whole);
      std::filesystem::remove_all(folder.path("killed"));
      kept = 0;
      continue;
    }
    std::error_code none_yet;
    const auto size = std::filesystem::file_size(folder.path("killed") + "/.spec.rows", none_yet);
    if (!none_yet) {
      CHECK(size + 200 >= kept);  // no finished row is lost; a torn one may be
      grown += size > kept ? 1 : 0;
      kept = size;
    }
  }
  CHECK(grown >= 3);
  CHECK(sweep("killed", 0.0) == 0);
  CHECK(rows_of("killed") == whole);
  CHECK(folder.entries("killed") == folder.entries("whole"));
}

TEST_CASE("rows of another sweep, or torn ones, are not taken for this one's", "[sweep]") {
  const tests::TemporaryFolder folder;
  const std::string path = folder.path("rows");
  const std::string key = "kairos sweep 1 0123456789abcdef";
  RunRecord record;
  record.status = "completed";
  record.metrics = {1.5, std::nullopt};
  constexpr std::size_t runs = 8;
  {
    SweepJournal journal(path, key, runs);
    journal.add(3, record);
    journal.add(1, record);
  }
  CHECK(SweepJournal(path, key, runs).size() == 2);
  const std::string bytes = tests::read_all(path);
  for (std::size_t cut = 1; cut < 60; ++cut) {  // within the last record
    const std::string torn = folder.file("torn", bytes.substr(0, bytes.size() - cut));
    SweepJournal journal(torn, key, runs);
    REQUIRE(journal.size() == 1);
    REQUIRE(journal.has(3));
    std::size_t index = 0;
    CHECK(read_row(RecordFile(torn).at(journal.places()[3]), index).metrics == record.metrics);
    CHECK(index == 3);
    journal.add(7, record);
    CHECK(SweepJournal(torn, key, runs).size() == 2);
  }
  CHECK(SweepJournal(path, "kairos sweep 1 fedcba9876543210", runs).size() == 0);
  CHECK(SweepJournal(folder.file("foreign", "not a journal"), key, runs).size() == 0);
}

TEST_CASE("a sweep tells on a terminal how far a run has come that takes long", "[sweep]") {
  int terminal = -1;
  int program_side = -1;
  std::array<char, 256> name{};
  REQUIRE(::openpty(&terminal, &program_side, name.data(), nullptr, nullptr) == 0);
  const tests::TemporaryFolder folder;
  const std::string spec = folder.file("long.toml",
                                       "scene = \"bounce\"\nmetrics = [\"impacts\"]\n"
                                       "[options]\nduration = 1e9\n"
                                       "[[method]]\nscheme = \"original\"\n");
  // 6e10 frames: it does not end before it is ended.
  const tests::Outcome outcome =
      tests::kairos_program({"sweep", spec}, {.error = name.data(), .processor_seconds = 1});
  CHECK(outcome.exit_code < 0);
  ::close(program_side);
  std::string shown;
  std::array<char, 4096> block{};
  for (ssize_t size = 1; size > 0;) {
    size = ::read(terminal, block.data(), block.size());
    shown.append(block.data(), static_cast<std::size_t>(size > 0 ? size : 0));
  }
  ::close(terminal);
  CHECK(shown.find("0/1, one at ") != std::string::npos);
}
