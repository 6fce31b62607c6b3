// `kairos toi`: the file format, its answers, and what it says of rows that make no sense.

#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace kairos::tests;

namespace {

const std::string header =
    "id,a_hx,a_hy,a_hz,a_px,a_py,a_pz,a_qw,a_qx,a_qy,a_qz,a_vx,a_vy,a_vz,a_ax,a_ay,a_az,"
    "a_wx,a_wy,a_wz,"
    "b_hx,b_hy,b_hz,b_px,b_py,b_pz,b_qw,b_qx,b_qy,b_qz,b_vx,b_vy,b_vz,b_ax,b_ay,b_az,"
    "b_wx,b_wy,b_wz,duration,a_shape,b_shape";

/// A box of half-size 0.5 that moves at 1 m/s towards one that starts 2 m in front of it: the gap
/// of 1 m closes at t = 1 s. Fields can be replaced.
std::string row(const std::string& id,
                const std::vector<std::pair<std::string, std::string>>& changes = {}) {
  std::vector<std::string> fields{id,                                       //
                                  "0.5", "0.5", "0.5", "0", "0", "0",       // a: h, p
                                  "1",   "0",   "0",   "0", "1", "0", "0",  // q, v
                                  "0",   "0",   "0",   "0", "0", "0",       // a, w
                                  "0.5", "0.5", "0.5", "2", "0", "0",       // b
                                  "1",   "0",   "0",   "0", "0", "0", "0",  //
                                  "0",   "0",   "0",   "0", "0", "0",       //
                                  "3",   "box", "box"};
  std::vector<std::string> names;
  std::istringstream columns(header);
  for (std::string name; std::getline(columns, name, ',');) {
    names.push_back(name);
  }
  for (const auto& [name, value] : changes) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) {
        fields[i] = value;
      }
    }
  }
  return fmt::format("{}\n", fmt::join(fields, ","));
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) {
    fields.push_back(field);
  }
  return fields;
}

std::vector<std::vector<std::string>> answers(const Outcome& outcome) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(outcome.out);
  for (std::string line; std::getline(in, line);) {
    rows.push_back(split(line));
  }
  return rows;
}

Outcome toi(const std::string& text, std::vector<std::string> options = {}) {
  options.insert(options.begin(), {"toi", "-"});
  return kairos_program(options, {.input = text});
}

}  // namespace

TEST_CASE("toi answers a row with a bracket, a gap and a normal from a to b", "[toi]") {
  const Outcome outcome = toi(header + "\n" + row("first"));
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const auto rows = answers(outcome);
  REQUIRE(rows.size() == 2);
  CHECK(fmt::format("{}", fmt::join(rows[0], ",")) ==
        "id,status,t_lo,t_hi,gap,nx,ny,nz,evaluations");
  CHECK(rows[1][0] == "first");
  CHECK(rows[1][1] == "impact");
  // At 1 m/s the default tolerance, 1e-9 of the smaller extent and a little roundoff, is as long
  // in seconds; t_lo is never late.
  const double t_lo = std::stod(rows[1][2]);
  const double t_hi = std::stod(rows[1][3]);
  CHECK(t_lo <= 1.0);
  CHECK(t_lo >= 1.0 - 2e-9);
  CHECK(t_hi >= 1.0);
  CHECK(std::stod(rows[1][4]) <= 2e-9);
  CHECK(std::stod(rows[1][5]) == Approx(1.0).epsilon(1e-12));  // a few roundings of a unit vector
}

TEST_CASE("toi knows spheres, half-spaces and all four statuses", "[toi]") {
  const std::string text =
      header + "\n" +
      row("sphere", {{"a_shape", "sphere"}, {"a_hy", ""}, {"a_hz", ""}, {"b_shape", "sphere"}}) +
      row("floor", {{"b_shape", "half-space"},
                    {"b_hx", ""},
                    {"b_hy", ""},
                    {"b_hz", ""},
                    {"b_px", "0"},
                    {"a_py", "1.5"},
                    {"a_vx", "0"},
                    {"a_vy", "-2"}}) +
      row("apart", {{"duration", "0.5"}}) + row("inside", {{"b_px", "0.25"}});
  const Outcome outcome = toi(text);
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const auto rows = answers(outcome);
  REQUIRE(rows.size() == 5);
  CHECK(rows[1][1] == "impact");
  CHECK(std::stod(rows[1][2]) == Approx(1.0).epsilon(2e-9));
  CHECK(rows[2][1] == "impact");  // 1 m above the floor at 2 m/s
  CHECK(std::stod(rows[2][2]) == Approx(0.5).epsilon(2e-9));
  CHECK(std::stod(rows[2][6]) == Approx(-1.0).epsilon(1e-12));
  CHECK(rows[3][1] == "separated");
  CHECK(rows[4][1] == "overlapping");
}

TEST_CASE("toi: column order, extra columns, line ends, blank lines and quoted ids", "[toi]") {
  std::string plain = header + ",note\n" + row("\"a, b\"");
  plain.insert(plain.size() - 1, ",ignored");
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : plain) {
    windows += c == '\n' ? "\r\n\r\n" : std::string(1, c);
  }
  windows.resize(windows.size() - 4);  // the last line has no line break
  const Outcome unix_lines = toi(plain);
  CAPTURE(unix_lines.err);
  REQUIRE(unix_lines.exit_code == 0);
  CHECK(unix_lines.out.find("\n\"a, b\",impact,") != std::string::npos);
  CHECK(toi(windows).out == unix_lines.out);
  CHECK(toi(header + "\n").out == "id,status,t_lo,t_hi,gap,nx,ny,nz,evaluations\n");
}

TEST_CASE("toi gives the same bytes whatever the number of threads", "[toi]") {
  std::string text = header + "\n";
  for (int i = 0; i < 20000; ++i) {
    text += row(std::to_string(i), {{"b_py", fmt::format("{}", 1e-4 * (i % 9000))},
                                    {"a_wz", fmt::format("{}", 0.01 * (i % 700))}});
  }
  const Outcome one = toi(text, {"--threads", "1"});
  REQUIRE(one.exit_code == 0);
  CHECK(answers(one).size() == 20001);
  CHECK(answers(one)[20000][0] == "19999");
  CHECK(toi(text, {"--threads", "2"}).out == one.out);
  CHECK(toi(text, {"--threads", "7"}).out == one.out);
}

TEST_CASE("toi names a bad row with its line and column, and what is allowed", "[toi]") {
  const std::vector<std::pair<std::string, std::string>> bad{
      {"a_hx", "0"},       {"a_hy", "-0.5"},    {"b_hz", "nan"},      {"a_px", "inf"},
      {"a_px", "-inf"},    {"b_vx", "1e999"},   {"b_vx", "1e200"},    {"a_ax", ""},
      {"a_ax", "1.0.0"},   {"a_ax", "0x10"},    {"b_wz", "fast"},     {"b_wz", "1 2"},
      {"a_qw", "0"},       {"a_qw", "1.00001"}, {"b_qx", "1"},        {"duration", "-1"},
      {"duration", "nan"}, {"duration", "inf"}, {"a_shape", "torus"}, {"b_hx", "1e-400"},
  };
  for (const auto& [column, value] : bad) {
    const Outcome outcome =
        toi(header + "\n" + row("good") + row("bad", {{column, value}}) + row("after"));
    CAPTURE(column, value, outcome.err);
    CHECK(outcome.exit_code == 2);
    // A quaternion is named by its first component.
    const std::string named = column.substr(2, 1) == "q" ? column.substr(0, 3) + "w" : column;
    CHECK(outcome.err.find("stdin:3: " + named + ": ") == 0);
    CHECK(outcome.err.find("allowed") + outcome.err.find("not a number") +
              outcome.err.find("range of a double") !=
          3 * std::string::npos);
    // What was answered before stays; nothing after it is answered.
    CHECK(outcome.out.find("\ngood,impact") != std::string::npos);
    CHECK(outcome.out.find("after") == std::string::npos);
  }
}

TEST_CASE("toi names rows and headers of a wrong shape", "[toi]") {
  const std::string good = row("good");
  CHECK(toi("").exit_code == 2);
  CHECK(toi("").err.find("is empty") != std::string::npos);
  CHECK(toi("id,duration\n").err.find("stdin:1: a_hx: is missing") == 0);
  CHECK(toi(header + ",id\n").err.find("stdin:1: id: is the name of two columns") == 0);
  CHECK(toi(header + "\n" + good + "1,2,3\n").err.find("stdin:3: has 3 fields") == 0);
  CHECK(toi(header + "\n" + good + "\"open\n").err.find("stdin:3: has a quote") == 0);
  CHECK(toi(header + "\n" + row("two", {{"a_shape", "half-space"}, {"b_shape", "half-space"}}))
            .err.find("stdin:2: b_shape: ") == 0);
  CHECK(toi(header + "\n" + row("far", {{"a_vx", "1e140"}, {"duration", "1e140"}}))
            .err.find("stdin:2: a_vx: ") == 0);
  CHECK(toi(header + "\n" + std::string(std::size_t{1} << 25, ' ')).err.find("16 MiB") !=
        std::string::npos);
}

TEST_CASE("toi --keep-going answers bad rows as invalid, in their place", "[toi]") {
  const Outcome outcome = toi(
      header + "\n" + row("a") + row("b", {{"a_hx", "-1"}}) + "c,2\n" + row("d"), {"--keep-going"});
  CAPTURE(outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.out.find("\nb,invalid,,,,,,,\nc,invalid,,,,,,,\nd,impact,") != std::string::npos);
  CHECK(outcome.err.find("stdin:3: a_hx: ") == 0);
  CHECK(outcome.err.find("\nstdin:4: has 2 fields") != std::string::npos);
}

TEST_CASE("toi: a folder, a full disk", "[toi][fault]") {
  CHECK(kairos_program({"toi", "/proc"}).exit_code == 2);
  const Outcome full = kairos_program({"toi", "-"}, {header + "\n" + row("a"), "/dev/full"});
  CHECK(full.exit_code == 1);
  CHECK(full.err.find("No space left") != std::string::npos);
}

TEST_CASE("toi answers for meshes and compounds as for the boxes that they are", "[toi][parts]") {
  // A cube of half-size 0.5, as a box, as the triangles of a file told in half metres, as a solid,
  // and as two halves; the gap of 1 m closes at t = 1 s.
  const TemporaryFolder folder;
  const std::string cube =
      folder.file("cube.off",
                  "OFF\n8 6 0\n-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n"
                  "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const std::string more = header + ",a_file,a_parts,b_file,b_parts\n";
  const auto ask = [&](const std::string& shape, const std::string& file,
                       const std::string& parts) {
    std::string line = row(shape, {{"a_shape", shape}});
    line.pop_back();
    return line + "," + file + ",\"" + parts + "\",,\n";
  };
  const std::string halves =
      "box 0.25 0.5 0.5 -0.25 0 0 1 0 0 0; box 0.25 0.5 0.5 0.25 0 0 0 1 0 0";
  const Outcome outcome = toi(more + ask("box", "", "") + ask("mesh", cube, "") +
                              ask("solid", cube, "") + ask("compound", "", halves));
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const auto rows = answers(outcome);
  REQUIRE(rows.size() == 5);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    CAPTURE(rows[i][0]);
    CHECK(rows[i][1] == "impact");
    // Within a nanometre: the default tolerance is 1e-9 of the size.
    CHECK(std::abs(std::stod(rows[i][2]) - 1.0) < 1e-9);
    CHECK(std::stod(rows[i][2]) <= 1.0);
    CHECK(std::stod(rows[i][5]) == 1.0);
  }
}

TEST_CASE("what is no mesh and no compound is refused by its column", "[toi][parts]") {
  const std::string more = header + ",a_file,a_parts\n";
  const auto refusal = [&](const std::string& shape, const std::string& file,
                           const std::string& parts) {
    std::string line = row("bad", {{"a_shape", shape}});
    line.pop_back();
    const Outcome outcome = toi(more + line + "," + file + "," + parts + "\n");
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(refusal("mesh", "", ""), Contains("needs the column a_file"));
  CHECK_THAT(refusal("mesh", "nowhere.off", ""), Contains("a_file") && Contains("nowhere.off"));
  CHECK_THAT(refusal("compound", "", ""), Contains("needs the column a_parts"));
  CHECK_THAT(refusal("compound", "", "box 1 1 1"), Contains("a part of 3 numbers"));
  CHECK_THAT(refusal("compound", "", "hull 1 1 1 0 0 0 1 0 0 0"), Contains("a part 'hull'"));
  CHECK_THAT(refusal("compound", "", "box 1 0 1 0 0 0 1 0 0 0"), Contains("a_parts"));
  CHECK_THAT(refusal("compound", "", "box 1 1 1 0 0 0 2 0 0 0"), Contains("a_parts"));
}
