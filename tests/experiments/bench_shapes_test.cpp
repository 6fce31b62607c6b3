// `kairos bench shapes`: every goal has its verdict, and what needs no clock is met.

#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <sstream>
#include <string>

TEST_CASE("the table of shapes names each goal as met or not, and no answer is wrong",
          "[bench][slow]") {
  const auto run =
      kairos::tests::kairos_program({"bench", "shapes", "--pairs", "96", "--rounds", "1"});
  REQUIRE(run.exit_code == 0);
  const auto goals = run.out.find("Measured against what is asked for");
  REQUIRE(goals != std::string::npos);
  std::istringstream lines(run.out.substr(goals));
  std::string line;
  int told = 0;
  int exact = 0;
  std::getline(lines, line);  // the title
  std::getline(lines, line);  // the columns
  while (std::getline(lines, line)) {
    CAPTURE(line);
    const bool verdict = line.ends_with("  met") || line.find("not met") != std::string::npos;
    CHECK((verdict || line.find("no peer") != std::string::npos));
    ++told;
    if (line.find("whole numbers") != std::string::npos ||
        line.find("bytes") != std::string::npos) {
      CHECK(line.ends_with("  met"));  // filters against whole numbers; memory: nothing is timed
      ++exact;
    }
  }
  CHECK(told == 21);
  CHECK(exact == 3);
}
