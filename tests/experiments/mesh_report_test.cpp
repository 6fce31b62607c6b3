#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/temporary_folder.hpp"

using namespace kairos::tests;

namespace {

bool says(const Outcome& outcome, const std::string& words) {
  return outcome.out.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("kairos mesh tells mass, and defects by file, line and face", "[cli][meshes]") {
  const TemporaryFolder folder;
  const std::string corners = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string solid =
      folder.file("solid.off", corners + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  const Outcome good = kairos_program({"mesh", solid});
  CHECK(good.exit_code == 0);
  CHECK(says(good, "4 triangles, 4 vertices"));
  CHECK(says(good, "solid: volume 0.166666666667 m^3, centre (0.25, 0.25, 0.25)"));
  CHECK(says(good, "0 defects, 0 pairs of triangles that cross"));

  // The last face is turned, and a triangle goes through all of it.
  const std::string bad =
      folder.file("bad.off",
                  "OFF\n7 5 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 0.2 0.2\n2 0.2 0.2\n2 0.3 0.2\n"
                  "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 3 2\n3 4 5 6\n");
  const Outcome told = kairos_program({"mesh", bad});
  CHECK(told.exit_code == 0);
  CHECK(says(told, "surface: no solid"));
  CHECK(says(told, "9 defects, 2 pairs of triangles that cross"));
  CHECK(says(told, "bad.off:13: face 4: contrary at the edge from (1, 0, 0)"));
  CHECK(says(told, "bad.off:14: face 5: open at the edge"));
  CHECK(says(told, "face 3: crosses"));
  CHECK(kairos_program({"mesh", folder.path("none.off")}).exit_code == 2);
}
