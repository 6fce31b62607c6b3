// Every output where the disk is full, the folder cannot be written, or the program is killed:
// whole or not there, and said so.

#include "core/random.hpp"
#include "core/reading/document.hpp"
#include "experiments/output/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

using namespace kairos;
using tests::kairos_program;
using tests::Outcome;
using tests::TemporaryFolder;

namespace {

struct Command {
  std::string name;
  std::vector<std::string> arguments;  ///< `OUT` stands for where the output goes
};

std::vector<Command> commands(const TemporaryFolder& folder) {
  const std::string spec = folder.file("spec.toml",
                                       "scene = \"bullet\"\nmetrics = [\"impacts\"]\n"
                                       "repeats = 200\n");
  return {{"run --out", {"run", "bounce", "--out", "OUT"}},
          {"run --save", {"run", "bounce", "--save", "OUT"}},
          {"sweep --out", {"sweep", spec, "--out", "OUT"}},
          {"tradeoff --out", {"tradeoff", "bullet", "--rounds", "1", "--out", "OUT"}}};
}

Outcome run_into(const Command& command, const std::string& out,
                 const tests::Surroundings& surroundings = {}) {
  std::vector<std::string> arguments = command.arguments;
  std::replace(arguments.begin(), arguments.end(), std::string("OUT"), out);
  return kairos_program(arguments, surroundings);
}

/// What is left of an output, but the finished rows of a sweep, which are kept on purpose.
std::vector<std::string> remains(const TemporaryFolder& folder, const std::string& out) {
  std::vector<std::string> names;
  for (const std::string& name : folder.entries()) {
    if (name.starts_with(out + "/") && !name.ends_with(".rows")) {
      names.push_back(name);
    }
  }
  return names;
}

}  // namespace

TEST_CASE("a disk that fills: exit 1, a reason, and no part of an output", "[fault]") {
  const TemporaryFolder folder;
  for (const Command& command : commands(folder)) {
    const Outcome outcome = run_into(command, folder.path("full"), {.largest_file = 700});
    CAPTURE(command.name, outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.err.find("cannot be written") != std::string::npos);
    CHECK(remains(folder, "full").empty());
    std::filesystem::remove_all(folder.path("full"));
  }
}

TEST_CASE("an output that cannot be made: exit 2 and its name, before any work", "[fault]") {
  const TemporaryFolder folder;
  (void)folder.file("taken", "a file, not a folder");
  for (const Command& command : commands(folder)) {
    const Outcome outcome = run_into(command, folder.path("taken") + "/below");
    CAPTURE(command.name, outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.err.find("taken") != std::string::npos);
  }
}

TEST_CASE("standard output on a full disk: exit 1", "[fault]") {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"run", "bullet"},
                                                    {"list"},
                                                    {"explain", "bounce"},
                                                    {"tradeoff", "bullet"},
                                                    {"recommend", "bullet", "--error", "1"}}) {
    const Outcome outcome = kairos_program(arguments, {.output = "/dev/full"});
    CAPTURE(arguments[0]);
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.err.find("No space left") != std::string::npos);
  }
}

TEST_CASE("a run that is killed leaves a checkpoint that is whole", "[fault][checkpoint]") {
  const TemporaryFolder folder;
  const std::vector<std::string> head{"run", "bounce", "--thesis", "--duration", "400"};
  const auto run = [&](std::vector<std::string> more, double kill_after) {
    more.insert(more.begin(), head.begin(), head.end());
    return kairos_program(more, {.kill_after = kill_after});
  };
  const Outcome whole = run({}, 0.0);
  REQUIRE(whole.exit_code == 0);
  Random random(20261121, 7);
  INFO("seed 20261121, stream 7");
  const std::string file = folder.path("checkpoint");
  for (int kill = 0; kill < 5; ++kill) {
    const std::vector<std::string> save{"--save", file, "--save-interval", "0"};
    std::vector<std::string> again = save;
    if (std::filesystem::exists(file)) {
      again.insert(again.end(), {"--resume", file});
    }
    (void)run(again, random.uniform(0.05, 0.3));
    const std::vector<std::string> left = folder.entries();
    for (const std::string& name : left) {  // hidden: killed in the very act of renaming
      CHECK((name == "checkpoint" || name == ".checkpoint.complete"));
    }
  }
  REQUIRE(std::filesystem::exists(file));
  const Outcome resumed = run({"--resume", file}, 0.0);
  CHECK(resumed.exit_code == 0);
  CHECK(resumed.out == whole.out);
}

TEST_CASE("what a kill in the act of renaming leaves is cleared by the next writer", "[fault]") {
  const TemporaryFolder folder;
  (void)folder.file(".checkpoint.complete", "of a run that was killed");
  const std::string file = folder.path("checkpoint");
  CHECK(kairos_program({"run", "bounce", "--save", file}).exit_code == 0);
  CHECK(folder.entries() == std::vector<std::string>{"checkpoint"});
}

TEST_CASE("many writers of one path: each ends well, and the file is one of theirs", "[fault]") {
  const TemporaryFolder folder;
  const std::string file = folder.path("file");
  constexpr int writers = 8;
  std::vector<std::thread> threads;
  std::atomic<int> failures = 0;
  for (int writer = 0; writer < writers; ++writer) {
    threads.emplace_back([&failures, &file, writer] {
      try {
        for (int k = 0; k < 50; ++k) {
          experiments::write_file(file, std::string(1000, static_cast<char>('a' + writer)));
        }
      } catch (const std::exception&) {
        ++failures;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  CHECK(failures == 0);
  CHECK(folder.entries() == std::vector<std::string>{"file"});
  const std::string text = read_text_file(file);
  REQUIRE(text.size() == 1000);
  CHECK(text == std::string(1000, text[0]));
}
