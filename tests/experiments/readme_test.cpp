// What the README promises exists: its commands, their options, its ten lines of C++.

#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/locations.hpp"

#include <sstream>
#include <string>
#include <vector>

using namespace kairos::tests;

namespace {

const std::string root = source_path("");

/// The words of every line of a README's code blocks that starts with `kairos`.
std::vector<std::vector<std::string>> commands_of(const std::string& text) {
  std::vector<std::vector<std::string>> commands;
  std::istringstream lines(text);
  bool code = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      code = !code;
      continue;
    }
    if (!code || !line.starts_with("kairos ")) {
      continue;
    }
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<std::string>& command = commands.emplace_back();
    for (std::string word; words >> word;) {
      command.push_back(word);
    }
  }
  return commands;
}

}  // namespace

TEST_CASE("the commands and options of the README exist", "[readme]") {
  const auto commands = commands_of(read_all(root + "README.md"));
  REQUIRE(commands.size() >= 4);
  for (const std::vector<std::string>& command : commands) {
    REQUIRE(command.size() >= 2);
    const Outcome help = kairos_program({command[1], "--help"});
    CAPTURE(command[1], help.err);
    CHECK(help.exit_code == 0);
    for (const std::string& word : command) {
      if (word.starts_with("--")) {
        CAPTURE(word);
        CHECK(help.out.find(word.substr(0, word.find('='))) != std::string::npos);
      }
    }
  }
}

TEST_CASE("the README's programs are the consumers that are built and run", "[readme]") {
  const std::string readme = read_all(root + "README.md");
  for (const std::string name : {"run_scene", "ten_lines"}) {
    const std::string program = read_all(root + "tests/consumer/" + name + ".cpp");
    CAPTURE(name);
    REQUIRE_FALSE(program.empty());
    CHECK(readme.find("```cpp\n" + program + "```") != std::string::npos);
  }
}
