// `kairos deform`: what meets from file to file, and what it says of files that make no sense.
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/temporary_folder.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

using namespace kairos::tests;

namespace {

/// A triangle at a height, and a large one at z = 0.
class Files {
 public:
  std::string triangle(const std::string& name, double z) {
    return write(name, fmt::format("v 0 0 {0}\nv 1 0 {0}\nv 0 1 {0}\nf 1 2 3\n", z));
  }
  std::string floor() { return write("floor.obj", "v -5 -4 0\nv 7 -4 0\nv -5 9 0\nf 1 2 3\n"); }
  std::string write(const std::string& name, const std::string& text) {
    return folder_.file(name, text);
  }

 private:
  TemporaryFolder folder_;
};

Outcome deform(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "deform");
  return kairos_program(arguments, {});
}

bool says(const Outcome& outcome, const std::string& text) {
  return outcome.err.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("deform tells what meets in each step, and when", "[deform]") {
  Files files;
  const std::vector<std::string> frames{files.triangle("0.obj", 2.0), files.triangle("1.obj", 1.0),
                                        files.triangle("2.obj", -3.0)};
  const Outcome outcome = deform({frames[0], frames[1], frames[2], "--with", files.floor()});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.out ==
        "step,kind,a,b,t_lo,t_hi,stage\n"
        "2,vertex-face,0,0,0.25,0.25,filter\n"
        "2,vertex-face,1,0,0.25,0.25,filter\n"
        "2,vertex-face,2,0,0.25,0.25,filter\n");
  const Outcome first = deform(
      {frames[0], frames[1], frames[2], "--with", files.floor(), "--first", "--separation", "1"});
  REQUIRE(first.exit_code == 0);
  CHECK(first.out.substr(0, first.out.find(",filter")).find("1,vertex-face,0,0,1,1") !=
        std::string::npos);
  CHECK(deform({frames[0], frames[1]}).out == "step,kind,a,b,t_lo,t_hi,stage\n");
}

TEST_CASE("deform names the file that does not fit", "[deform]") {
  Files files;
  const std::string a = files.triangle("a.obj", 1.0);
  const std::string b = files.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n");
  for (const auto& [arguments, text] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{a, b}, "b.obj"},
           {{a, "none.obj"}, "none.obj"},
           {{a, a, a, "--with", b, b}, "--with"},
           {{a, "--separation", "-1"}, "--separation"},
           {{a, "--separation", "nan"}, "--separation"},
           {{a, "--scale", "0"}, "--scale"}}) {
    const Outcome outcome = deform(arguments);
    CAPTURE(text, outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(says(outcome, text));
  }
}
