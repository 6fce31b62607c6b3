#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/physworld/search.hpp"
#include "experiments/run_error.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace kairos::experiments {
namespace {

struct PhysworldCommand {
  std::uint64_t seed = 1;
  std::int64_t tries = 200000;
  std::string out;

  void run() const {
    // Models are looked for beside the shipped scenes.
    const auto beside = std::filesystem::path(scene_folder()) / "physworld.def";
    const SearchResult found = search_physworld(seed, tries, beside.string());
    if (found.def.empty()) {
      throw RunError(fmt::format("no world in {} tries with seed {}", tries, seed));
    }
    if (out.empty()) {
      fmt::print("{}", found.def);
    } else {
      write_file(out, found.def);
    }
    fmt::print(stderr, "found at try {} with seed {}\n", found.tries, seed);
  }
};

}  // namespace

void add_physworld_command(Command& app) {
  const auto command = std::make_shared<PhysworldCommand>();
  Command physworld = app.add_subcommand(
      "physworld", "Look for the values of physworld.def that the thesis does not give (ch. 8.1)");
  physworld.add_option("--seed", command->seed, "the same seed, the same world")
      .check(seed_number())
      .capture_default_str();
  physworld.add_option("--tries", command->tries, "at most this many worlds")
      .check(whole_number(1, 100000000))
      .capture_default_str();
  physworld.add_option("--out", command->out, "the .def file (default: stdout)")
      .type_name("FILE")
      .check(some_path());
  physworld.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
