// The shipped experiments: their specs can be read and planned, and what one leaves is the same
// twice.

#include "experiments/data_folders.hpp"
#include "experiments/named_method.hpp"
#include "experiments/output/table.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/programs/run_experiment.hpp"
#include "experiments/rally/rally_run.hpp"
#include "experiments/sweeps/sweep_plan.hpp"
#include "experiments/tradeoff/candidates.hpp"
#include "simulation/scene_library.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

using namespace kairos::experiments;
using kairos::tests::TemporaryFolder;

TEST_CASE("every shipped experiment can be read and planned at both sizes", "[experiment]") {
  CHECK(shipped_experiments().size() >= 6);
  for (const std::string& name : shipped_experiments()) {
    for (const Size size : {Size::quick, Size::full}) {
      INFO(name << " " << to_string(size));
      const ExperimentSpec experiment = read_experiment(find_experiment(name), size);
      CHECK(experiment.name == name);
      CHECK_FALSE(experiment.title.empty());
      CHECK_FALSE(experiment.asks.empty());
      CHECK_FALSE(experiment.how.empty());
      for (const SweepSpec& sweep : experiment.sweeps) {
        CHECK(SweepPlan(sweep).size() > 0);
      }
    }
  }
}

namespace {

/// A name tells whether substeps are equal, and says so in the same two words everywhere.
void check_name(const std::string& name, bool equal_substeps) {
  CAPTURE(name, equal_substeps);
  CHECK(name.starts_with("equal substeps") == equal_substeps);
  CHECK(name.find('_') == std::string::npos);
}

}  // namespace

TEST_CASE("a method has one name, in sweeps, comparisons, trade-offs and rallies", "[experiment]") {
  for (const std::string& name : shipped_experiments()) {
    for (const SweepSpec& sweep : read_experiment(find_experiment(name), Size::quick).sweeps) {
      const SweepPlan plan(sweep);
      for (std::size_t i = 0; i < plan.size(); ++i) {
        const PlannedRun run = plan[i];
        if (run.point == 0 && run.repeat == 0) {
          check_name(sweep.methods[run.method].name, run.choice.equal_substeps);
        }
      }
    }
  }
  for (const NamedMethod& method : compared_methods()) {
    check_name(std::string(method.name), method.choice.equal_substeps);
  }
  for (const RallyMethod& method : rally_methods()) {
    check_name(method.name, method.choice.equal_substeps);
  }
  const kairos::Model model(kairos::read_scene(kairos::find_scene("bounce")));
  for (const Candidate& candidate : sensible_candidates(model)) {
    check_name(candidate.name, candidate.choice.equal_substeps);
  }
}

TEST_CASE("an experiment leaves the same bytes with one and two threads, timings apart",
          "[experiment][slow]") {
  const TemporaryFolder folder;
  const ExperimentSpec spec = read_experiment(find_experiment("spinning-box"), Size::quick);
  const std::vector<std::string> folders = {folder.path("one"), folder.path("two")};
  (void)run_experiment(spec, {Size::quick, 1, "kairos experiment spinning-box"}, folders[0]);
  (void)run_experiment(spec, {Size::quick, 2, "kairos experiment spinning-box"}, folders[1]);
  const auto names = folder.entries("one");
  CHECK(names == folder.entries("two"));
  CHECK(names.size() >= 6);
  for (const std::string& name : names) {
    INFO(name);
    if (name != "timings.csv") {
      CHECK(kairos::tests::read_all(folders[0] + "/" + name) ==
            kairos::tests::read_all(folders[1] + "/" + name));
    }
  }
}

TEST_CASE("tables are read as they are written", "[table]") {
  const TemporaryFolder folder;
  Table table{{"name", "x", "n", "none"}, {}};
  table.rows.push_back({std::string("a,\"b\"\nc"), 0.1, std::int64_t{3}, Cell()});
  table.rows.push_back({std::string("plain"), number_cell(std::numeric_limits<double>::quiet_NaN()),
                        std::int64_t{-1}, Cell()});
  const Table back = read_csv(folder.file("table.csv", table.csv()));
  CHECK(back.columns == table.columns);
  REQUIRE(back.rows.size() == 2);
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t c = 0; c < 4; ++c) {
      CHECK(to_text(back.rows[r][c]) == to_text(table.rows[r][c]));
    }
  }
  CHECK(to_text(back.rows[1][1]).empty());
}

TEST_CASE("parallel_for calls each index once and hands on what was thrown", "[parallel]") {
  for (const std::size_t threads : {1U, 2U, 7U}) {
    std::vector<int> calls(1000, 0);
    parallel_for(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    CHECK(calls == std::vector<int>(1000, 1));
    CHECK_THROWS_AS(parallel_for(100, threads,
                                 [](std::size_t i) {
                                   if (i == 50) {
                                     throw std::runtime_error("fifty");
                                   }
                                 }),
                    std::runtime_error);
  }
}

TEST_CASE("to start a thread does not fill the memory that is kept free for stacks", "[parallel]") {
  // The greatest size of a process that starts so many threads, KiB.
  const auto size_with = [](std::size_t threads) {
    const pid_t child = ::fork();
    if (child == 0) {
      start_threads(threads, [] {}).clear();
      ::_exit(0);
    }
    int status = 0;
    ::rusage usage{};
    REQUIRE(::wait4(child, &status, 0, &usage) == child);
    REQUIRE(status == 0);
    return usage.ru_maxrss;
  };
  // 48 MiB are kept; a stack, its guard and what a sanitizer knows of both take less than this.
  CHECK(size_with(1) < size_with(0) + 24 * 1024);
}
