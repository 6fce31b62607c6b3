// Shards of a sweep: merged they are the bytes of one machine, whatever was killed in between; what
// is missing, there twice or foreign is named.

#include "experiments/sweeps/sweep_shards.hpp"

#include "core/error.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/temporary_folder.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;

namespace {

/// Three methods, one the reference; listed and drawn axes; a prediction; series; what is refused.
const std::string spec_text = R"(
scene = "bounce"
metrics = ["impacts", "max_penetration"]
repeats = 7
reference = "event-driven"
series = true
samples = 5
[options]
duration = 1
frame = "= 1/30"
[set]
"body.ball.position" = [0, "= height", 0]
[[axis]]
name = "height"
list = [2, 3, -5]
[[axis]]
name = "jolt"
random = { from = 0, to = 1 }
[[method]]
scheme = "original"
detector = "sat"
[[method]]
scheme = "event-driven"
[[method]]
scheme = "substepped"
detector = "sat"
[derive]
twice = "2*max_penetration + jolt"
)";

/// A spec, its shards and its tables, each in a folder.
struct Workshop {
  tests::TemporaryFolder folder;
  std::string spec = folder.file("spec.toml", spec_text);

  [[nodiscard]] tests::Outcome kairos(std::vector<std::string> arguments,
                                      double kill_after = 0.0) const {
    arguments.insert(arguments.begin(), "sweep");
    return tests::kairos_program(arguments, {.kill_after = kill_after});
  }
  [[nodiscard]] tests::Outcome shard(int k, int n, const std::string& out,
                                     double kill_after = 0.0) const {
    return kairos({spec, "--shard", fmt::format("{}/{}", k, n), "--out", folder.path(out)},
                  kill_after);
  }
  [[nodiscard]] std::string merge(const std::vector<std::string>& shards,
                                  const std::string& out) const {
    std::vector<std::string> arguments{"--merge"};
    for (const std::string& name : shards) {
      arguments.push_back(folder.path(name));
    }
    arguments.insert(arguments.end(), {"--out", folder.path(out)});
    const tests::Outcome outcome = kairos(arguments);
    return outcome.exit_code == 0 ? "merged" : outcome.err;
  }
  /// Names of files whose bytes differ; times do, and are left out.
  [[nodiscard]] std::string differences(const std::string& a, const std::string& b) const {
    std::string names;
    REQUIRE(folder.entries(a) == folder.entries(b));
    for (const std::string& name : folder.entries(a)) {
      const bool timed = name.find("timings") != std::string::npos;
      if (!timed && tests::read_all(folder.path(a) + "/" + name) !=
                        tests::read_all(folder.path(b) + "/" + name)) {
        names += name + " ";
      }
    }
    return names;
  }
};

}  // namespace

TEST_CASE("a shard is told as I/N", "[sweep][shards]") {
  CHECK(parse_shard("3/8").index == 3);
  CHECK(parse_shard("8/8").count == 8);
  for (const char* wrong :
       {"", "3", "/", "3/", "0/8", "9/8", "3/8/1", "-1/8", "a/b", "1/1000001"}) {
    CHECK_THROWS_AS(parse_shard(wrong), InputError);
  }
}

TEST_CASE("shards hold every run of every method once, in equal shares", "[sweep][shards]") {
  for (const std::size_t runs : {1U, 2U, 7U, 100U, 1009U}) {
    for (const std::size_t count : {1U, 2U, 3U, 8U, 300U}) {
      std::size_t held = 0;
      for (std::size_t place = 0; place < runs; ++place) {
        for (std::size_t k = 1; k <= count; ++k) {
          held += Shard{k, count}.holds(place, runs) ? 1U : 0U;
        }
      }
      CHECK(held == runs);
      for (std::size_t k = 1; k <= count; ++k) {
        const Shard shard{k, count};
        const std::size_t size = shard.begin(k, runs) - shard.begin(k - 1, runs);
        CHECK(size <= runs / count + 1);
        CHECK(size + 1 >= runs / count);
      }
    }
  }
}

TEST_CASE("merged shards are the bytes of one machine", "[sweep][shards]") {
  const Workshop work;
  REQUIRE(work.kairos({work.spec, "--out", work.folder.path("one")}).exit_code == 0);
  for (const int count : {1, 3, 8}) {
    std::vector<std::string> names;
    for (int k = count; k >= 1; --k) {  // in any order
      names.push_back(fmt::format("shard{}-{}", count, k));
      REQUIRE(work.shard(k, count, names.back()).exit_code == 0);
    }
    const std::string out = fmt::format("merged{}", count);
    REQUIRE(work.merge(names, out) == "merged");
    CHECK(work.differences("one", out).empty());
  }
}

TEST_CASE("shards that are killed go on where they were", "[sweep][shards]") {
  const Workshop work;
  Random random(20261122);
  INFO("seed 20261122");
  REQUIRE(work.kairos({work.spec, "--out", work.folder.path("one")}).exit_code == 0);
  int killed = 0;
  for (int k = 1; k <= 4; ++k) {
    const std::string out = fmt::format("shards/{}", k);
    for (int tries = 0; tries < 5; ++tries) {
      killed += work.shard(k, 4, out, random.uniform(0.005, 0.05)).exit_code < 0 ? 1 : 0;
    }
    REQUIRE(work.shard(k, 4, out).exit_code == 0);
    const std::string rows = tests::read_all(work.folder.path(out) + "/spec.rows");
    REQUIRE(work.shard(k, 4, out).exit_code == 0);  // again: nothing is done twice
    CHECK(tests::read_all(work.folder.path(out) + "/spec.rows") == rows);
  }
  CHECK(killed >= 3);
  REQUIRE(work.merge({"shards"}, "merged") == "merged");
  CHECK(work.differences("one", "merged").empty());
}

TEST_CASE("what does not make a whole sweep is named", "[sweep][shards]") {
  const Workshop work;
  REQUIRE(work.shard(1, 3, "a").exit_code == 0);
  REQUIRE(work.shard(3, 3, "c").exit_code == 0);
  CHECK(work.merge({"a", "c"}, "out").find("of 3 shards these are missing: 2") !=
        std::string::npos);
  REQUIRE(work.shard(1, 3, "again").exit_code == 0);
  CHECK(work.merge({"a", "again"}, "out").find("is there twice") != std::string::npos);
  REQUIRE(work.shard(2, 4, "other").exit_code == 0);
  CHECK(work.merge({"a", "other", "c"}, "out").find("a sweep is divided once") !=
        std::string::npos);
  CHECK(work.merge({"nowhere"}, "out").find("holds no shard") != std::string::npos);

  REQUIRE(work.shard(2, 3, "b").exit_code == 0);
  // What a death leaves: rows alone.
  std::filesystem::remove(work.folder.path("b") + "/shard.csv");
  std::filesystem::remove(work.folder.path("b") + "/spec.toml");
  CHECK(work.merge({"a", "b", "c"}, "out").find("is not finished") != std::string::npos);
  REQUIRE(work.shard(2, 3, "b").exit_code == 0);
  REQUIRE(work.merge({"a", "b", "c"}, "out") == "merged");

  const std::string full = work.folder.path("full");
  REQUIRE(work.kairos({work.spec, "--full", "--shard", "2/3", "--out", full}).exit_code == 0);
  CHECK(work.merge({"a", "full", "c"}, "other-size").find("is of another size than") !=
        std::string::npos);
  (void)work.folder.file("spec.toml", spec_text + "# another\n");
  REQUIRE(work.shard(2, 3, "edited").exit_code == 0);
  CHECK(work.merge({"a", "edited", "c"}, "other-spec").find("is of another spec than") !=
        std::string::npos);
}

TEST_CASE("a shard needs a folder, and merging needs shards alone", "[sweep][shards]") {
  const Workshop work;
  CHECK(work.kairos({work.spec, "--shard", "1/2"}).exit_code == 2);
  CHECK(work.kairos({work.spec, "--shard", "3/2", "--out", work.folder.path("x")}).exit_code == 2);
  CHECK(work.kairos({work.spec, "--merge", work.folder.path("x"), "--out", "y"}).exit_code == 2);
  CHECK(work.kairos({}).exit_code == 2);
}

TEST_CASE("sweep: how far all shards are is told, while some are not there or were killed") {
  const Workshop workshop;
  const auto progress = [&] {
    return workshop.kairos({workshop.spec, "--progress", workshop.folder.path("")}).out;
  };
  CHECK(progress() == "spec: 0 shards finished, 0 begun; 0 of 63 runs, 0.0 %\n");
  REQUIRE(workshop.shard(1, 3, "shards/1").exit_code == 0);
  REQUIRE(workshop.shard(3, 3, "shards/3").exit_code == 0);
  CHECK(progress() == "spec: 2 shards finished, 0 begun; 42 of 63 runs, 66.7 %\n");
  // Killed: rows without the file that comes last.
  std::filesystem::remove(workshop.folder.path("shards/3/shard.csv"));
  CHECK(progress() == "spec: 1 shards finished, 1 begun; 42 of 63 runs, 66.7 %\n");
  CHECK(workshop.kairos({workshop.spec, "--progress", workshop.folder.path("none")}).exit_code ==
        2);
}
