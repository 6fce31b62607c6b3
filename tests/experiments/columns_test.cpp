// What experiments/output/README.md says of the files of a run is what a run writes.

#include "core/event.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/locations.hpp"

#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace kairos::tests;

namespace {

/// What is between backticks, in order.
std::vector<std::string> in_backticks(const std::string& text) {
  std::vector<std::string> found;
  for (std::size_t open = text.find('`'); open != std::string::npos; open = text.find('`', open)) {
    const std::size_t close = text.find('`', open + 1);
    found.push_back(text.substr(open + 1, close - open - 1));
    open = close + 1;
  }
  return found;
}

/// The part of the README under this heading.
std::string section(const std::string& heading) {
  const std::string text = read_all(source_path("experiments/output/README.md"));
  const std::size_t start = text.find("\n## " + heading + "\n");
  REQUIRE(start != std::string::npos);
  return text.substr(start, text.find("\n## ", start + 1) - start);
}

/// Names in the first cells of the table of a section whose header starts with `first`.
std::vector<std::string> first_cells(const std::string& heading, const std::string& first) {
  std::istringstream lines(section(heading));
  std::vector<std::string> names;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    inside = line.starts_with("| " + first + " |") || (inside && line.starts_with("|"));
    if (inside) {
      const auto cell = in_backticks(line.substr(0, line.find(" | ")));
      names.insert(names.end(), cell.begin(), cell.end());
    }
  }
  return names;
}

std::string join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ",") + name;
  }
  return text;
}

std::string header_of(const std::string& path) {
  const std::string text = read_all(path);
  return text.substr(0, text.find('\n'));
}

/// The keys of the objects in an object, one line each, as `summary.json` is laid out.
std::set<std::string> keys_of(const std::string& json, const std::string& object) {
  std::istringstream lines(json);
  std::set<std::string> keys;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  \"")) {
      inside = line.starts_with("  \"" + object + "\": {");
    } else if (inside && line.starts_with("    \"")) {
      keys.insert(line.substr(5, line.find('"', 5) - 5));
    }
  }
  return keys;
}

}  // namespace

TEST_CASE("the columns and keys of a run's files are the documented ones", "[output]") {
  const TemporaryFolder folder;
  // The thesis' stepping penetrates: all keys are there.
  const Outcome outcome =
      kairos_program({"run", "bounce", "--thesis", "--duration", "3", "--out", folder.path("run")});
  REQUIRE(outcome.exit_code == 0);
  for (const std::string file : {"trajectory.csv", "events.csv", "energy.csv"}) {
    CAPTURE(file);
    CHECK(header_of(folder.path("run/" + file)) == join(first_cells(file, "column")));
  }

  const std::string json = read_all(folder.path("run/summary.json"));
  std::istringstream lines(section("summary.json"));
  std::set<std::string> objects;
  for (std::string line; std::getline(lines, line);) {
    const auto names = in_backticks(line);
    if (!line.starts_with("| `")) {
      continue;
    }
    objects.insert(names.front());
    const std::set<std::string> documented(names.begin() + 1, names.end());
    for (const std::string& key : keys_of(json, names.front())) {
      CAPTURE(names.front(), key);
      CHECK((names.front() == "bodies" || documented.contains(key)));  // bodies have any name
    }
    if (names.front() == "metrics" || names.front() == "energy" || names.front() == "cost") {
      CHECK(keys_of(json, names.front()) == documented);
    }
  }
  CHECK(objects == std::set<std::string>{"scene", "bodies", "method", "versions", "metrics",
                                         "energy", "cost", "status"});
}

TEST_CASE("every kind of event is documented", "[output]") {
  using kairos::EventKind;
  std::vector<std::string> kinds;
  for (int kind = 0; kind <= static_cast<int>(EventKind::roll_begins); ++kind) {
    kinds.emplace_back(to_string(static_cast<EventKind>(kind)));
  }
  CHECK(first_cells("events.csv", "kind") == kinds);
}
