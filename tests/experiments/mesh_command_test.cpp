// `kairos collide` and `kairos distance`: answers, options, and what they say of input that makes
// no sense.
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/temporary_folder.hpp"

#include <fstream>
#include <string>
#include <vector>

using namespace kairos::tests;

namespace {

const std::string header =
    "id,a_px,a_py,a_pz,a_qw,a_qx,a_qy,a_qz,b_px,b_py,b_pz,b_qw,b_qx,b_qy,b_qz\n";

/// A cube with edge 2 around the origin, six squares.
std::string cube_file(const TemporaryFolder& folder) {
  const std::string path = folder.path("cube.off");
  std::ofstream(path)
      << "OFF\n8 6 0\n-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n"
         "-1 1 1\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
  return path;
}
std::string row(const std::string& id, const std::string& x) {
  return id + ",0,0,0,1,0,0,0," + x + ",0.25,0.125,1,0,0,0\n";
}
Outcome ask(std::vector<std::string> words, const std::string& rows) {
  words.insert(words.begin() + 1, "-");
  return kairos_program(words, {.input = header + rows});
}

}  // namespace

TEST_CASE("collide: touching is exact, all pairs on request, solids hold what is inside",
          "[mesh]") {
  const TemporaryFolder folder;
  const std::string cube = cube_file(folder);
  const Outcome one = ask({"collide", "--a", cube, "--b", cube},
                          row("touch", "2") + row("miss", "2.0000000000000004"));
  CAPTURE(one.err);
  REQUIRE(one.exit_code == 0);
  CHECK(one.out.starts_with("id,verdict,a_triangle,b_triangle\ntouch,touching,"));
  CHECK(one.out.ends_with("\nmiss,apart,,\n"));
  const Outcome all = ask({"collide", "--a", cube, "--b", cube, "--all"}, row("t", "2"));
  CHECK(all.out.find("t,touching,6,10\n") != std::string::npos);  // x = 1 and x = -1
  const std::string small = row("s", "0.125");
  const std::vector<std::string> inside{"collide", "--a", cube, "--b", cube, "--solid"};
  CHECK(ask(inside, small).out.find("s,touching,") != std::string::npos);
}

TEST_CASE("distance: bounds, tolerance, all pairs within it", "[mesh]") {
  const TemporaryFolder folder;
  const std::string cube = cube_file(folder);
  const Outcome far = ask({"distance", "--a", cube, "--b", cube}, row("f", "5") + row("t", "1"));
  CAPTURE(far.err);
  REQUIRE(far.exit_code == 0);
  CHECK(far.out.find("\nf,apart,2.99999999999") != std::string::npos);
  CHECK(far.out.find("\nt,touching,0,0,") != std::string::npos);
  const auto within = [&](const char* metres) {
    return ask({"distance", "--a", cube, "--b", cube, "--tolerance", metres}, row("f", "5")).out;
  };
  CHECK(within("3.001").find("\nf,yes,") != std::string::npos);
  CHECK(within("2.999").find("\nf,no,") != std::string::npos);
  CHECK(within("3").find("\nf,undecided,") != std::string::npos);
  const Outcome all =
      ask({"distance", "--a", cube, "--b", cube, "--tolerance", "3.1", "--all"}, row("f", "5"));
  CHECK(all.out.find("f,yes,6,10,") != std::string::npos);
  const Outcome scaled =
      ask({"distance", "--a", cube, "--b", cube, "--scale", "0.5"}, row("f", "5"));
  CHECK(scaled.out.find("\nf,apart,3.99999999999") != std::string::npos);
}

TEST_CASE("collide: rows and meshes that make no sense are named", "[mesh]") {
  const TemporaryFolder folder;
  const std::string cube = cube_file(folder);
  const auto says = [](const Outcome& outcome, const std::string& text) {
    INFO(outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.err.find(text) != std::string::npos);
  };
  const std::vector<std::string> both{"collide", "--a", cube, "--b", cube};
  says(ask({"collide"}, row("r", "1")), "a_mesh: is missing from the header");
  says(ask(both, row("r", "nan")), "stdin:2: b_px: 'nan' is not allowed");
  says(ask(both, "r,0,0,0,2,0,0,0,0,0,0,1,0,0,0\n"), "a_qw: the quaternion has length 2");
  says(ask(both, "r,0\n"), "stdin:2: has 2 fields");
  says(ask({"collide", "--a", cube, "--b", "none.stl"}, row("r", "1")), "none.stl");
  const std::string open = folder.path("open.obj");
  std::ofstream(open) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  says(ask({"collide", "--a", cube, "--b", open, "--solid"}, row("r", "1")), "is no solid");
  const Outcome on =
      ask({"collide", "--a", cube, "--b", cube, "--keep-going"}, row("r", "x") + row("s", "9"));
  says(on, "1 row is invalid");
  CHECK(on.out.ends_with("\nr,invalid,,\ns,apart,,\n"));
}
