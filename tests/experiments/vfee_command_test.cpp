// `kairos vfee`: both file formats, their answers, and what it says of rows that make no sense.
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

using namespace kairos::tests;

namespace {

const std::string header =
    "id,kind,s0x,s0y,s0z,s1x,s1y,s1z,s2x,s2y,s2z,s3x,s3y,s3z,"
    "e0x,e0y,e0z,e1x,e1y,e1z,e2x,e2y,e2z,e3x,e3y,e3z,separation\n";

/// A point falls from z = 1 to the given height, through or towards a triangle at rest.
std::string falling(const std::string& id, const std::string& to, const std::string& separation) {
  const std::string triangle = "0,0,0,1,0,0,0,1,0";
  return fmt::format("{},vf,0.25,0.25,1,{},0.25,0.25,{},{},{}\n", id, triangle, to, triangle,
                     separation);
}

/// Two edges, crossed, from heights of 1/4 and 0 to -1/4 and 0, as the data set writes them.
std::string crossing(const std::string& truth) {
  const std::string z[2] = {"1,4", "-1,4"};
  std::string rows;
  for (const std::string& height : z) {
    rows += fmt::format("-1,1,0,1,{0},{1}\n1,1,0,1,{0},{1}\n0,1,-1,2,0,1,{1}\n0,1,1,2,0,1,{1}\n",
                        height, truth);
  }
  return rows;
}

Outcome vfee(const std::string& text, std::vector<std::string> options = {}) {
  options.insert(options.begin(), {"vfee", "-"});
  return kairos_program(options, {.input = text});
}

bool says(const Outcome& outcome, const std::string& text) {
  return outcome.err.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("vfee answers rows with hit, the first time and the stage", "[vfee]") {
  const Outcome outcome = vfee(header + falling("through", "-1", "") +
                               "\"beside, never\",ee,0,0,0,1,0,0,0,0,1,0,1,1,"
                               "0,0,0,1,0,0,0,0,1,0,1,1,\n" +
                               falling("above", "0.125", "") + falling("near", "0.125", "0.25"));
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.out ==
        "id,hit,t_lo,t_hi,stage\n"
        "through,1,0.5,0.5,filter\n"
        "\"beside, never\",0,,,boxes\n"
        "above,0,,,boxes\n"
        "near,1,0.8571428571428571,0.8571428571428572,integers\n");
}

TEST_CASE("vfee reads the data set's rational rows, and counts by their truth", "[vfee]") {
  const Outcome outcome = vfee(crossing("1") + crossing("0"), {"--kind", "ee"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.out.starts_with("line,hit,t_lo,t_hi,stage,truth\n1,1,0.5,0.5,"));
  CHECK(outcome.out.find("\n9,1,0.5,0.5,") != std::string::npos);
  CHECK(says(outcome, "stdin: 2 queries, 0 false negatives, 1 false positives"));
  CHECK(vfee(crossing("1")).exit_code == 2);
  CHECK(says(vfee(crossing("1")), "--kind: is needed"));
}

TEST_CASE("vfee answers the same on any number of threads, across blocks", "[vfee]") {
  std::string rows;
  for (int i = 0; i < 6000; ++i) {  // several blocks of 256 KiB, cut within queries
    rows += crossing(i % 3 == 0 ? "1" : "0");
  }
  const Outcome one = vfee(rows, {"--kind", "ee", "--threads", "1"});
  const Outcome four = vfee(rows, {"--kind", "ee", "--threads", "4"});
  REQUIRE(one.exit_code == 0);
  CHECK(one.out == four.out);
  CHECK(says(one, "6000 queries, 0 false negatives, 4000 false positives"));
}

TEST_CASE("vfee names bad rows by their line, and goes on if asked to", "[vfee]") {
  struct Case {
    std::string rows, options, message;
  };
  const std::vector<Case> cases{
      {header + falling("a", "nan", ""), "", "stdin:2: e0z: 'nan' is not allowed"},
      {header + falling("a", "1e400", ""), "", "stdin:2: e0z: '1e400' is not allowed"},
      {header + falling("a", "-1", "-1"), "", "stdin:2: separation: -1 is negative"},
      {header + "a,vv" + falling("", "-1", "").substr(3), "", "stdin:2: kind: 'vv' is unknown"},
      {header + "a,vf,1\n", "", "stdin:2: has 3 fields; the header names 27 columns"},
      {"id,kind\n", "", "stdin:1: s0x: is missing from the header"},
      {"", "", "stdin: is empty"},
      {crossing("1").substr(0, 29), "ee", "stdin:1: begins a query of 8 rows that has only 2"},
      {crossing("2"), "ee", "stdin:1: truth: '2' is not allowed"},
      {"1,3" + crossing("1").substr(4), "ee", "stdin:1: x numerator: 1/3 is no double"},
      {"1,0" + crossing("1").substr(4), "ee", "stdin:1: x denominator: '0' is not allowed"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.rows);
    std::vector<std::string> options;
    if (!c.options.empty()) {
      options = {"--kind", c.options};
    }
    const Outcome outcome = vfee(c.rows, options);
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(says(outcome, c.message));
  }
  const Outcome outcome =
      vfee(header + falling("a", "nan", "") + falling("b", "-1", ""), {"--keep-going"});
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.out == "id,hit,t_lo,t_hi,stage\na,,,,invalid\nb,1,0.5,0.5,filter\n");
  CHECK(says(outcome, "stdin: 1 query is invalid"));
}
