// `kairos bench accuracy`: the table of answers against the reference, and the file of its queries.
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace kairos::tests;

namespace {

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("1e5 random queries: none missed, none late, none undecided", "[slow][accuracy]") {
  const TemporaryFolder folder;
  const Outcome outcome = kairos_program(
      {"bench", "accuracy", "--queries", "100000", "--seed", "3", "--out", folder.path("out")});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.out.find("undecided: ") == std::string::npos);
  std::istringstream rows(text_of(folder.path("out/accuracy.csv")));
  int certified = 0;
  for (std::string row; std::getline(rows, row);) {
    if (!row.starts_with("certified,")) {
      continue;
    }
    ++certified;
    std::vector<std::string> fields;
    std::istringstream in(row);
    for (std::string field; std::getline(in, field, ',');) {
      fields.push_back(field);
    }
    CAPTURE(row);
    REQUIRE(fields.size() == 16);
    for (const std::size_t zero : {6, 8, 9, 10}) {  // undecided, missed, late, wrong
      CHECK(fields[zero] == "0");
    }
    CHECK(fields[7] == fields[2]);  // every answer was judged
  }
  CHECK(certified == 10);  // nine classes and all
}

TEST_CASE("its queries are a file that kairos toi answers, whatever the number of threads",
          "[accuracy]") {
  const TemporaryFolder folder;
  std::string first;
  for (const std::string threads : {"1", "3"}) {
    const std::string out = folder.path("out" + threads);
    REQUIRE(kairos_program(
                {"bench", "accuracy", "--queries", "900", "--threads", threads, "--out", out})
                .exit_code == 0);
    const Outcome answers = kairos_program({"toi", out + "/queries.csv", "--threads", threads});
    REQUIRE(answers.exit_code == 0);
    CHECK(std::count(answers.out.begin(), answers.out.end(), '\n') == 801);  // no polynomials
    const std::string all = text_of(out + "/accuracy.csv") + answers.out;
    CHECK((first.empty() || all == first));
    first = all;
  }
}
