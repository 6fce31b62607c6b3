#include "simulation/gas_averages.hpp"

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <string>

// What averages of many bodies are held to: gases so small that every number is known.

using namespace kairos;

namespace {

/// Of what is added up over a few impacts and frames.
constexpr double roundoff = 1e-12;

void listen(const std::string& text, GasAverages& averages) {
  const Model model(parse_scene("G = 0\nframe = 0.1\n" + text, "tiny.toml"));
  REQUIRE(simulate(model, {}, averages).status == RunStatus::completed);
}

std::string ball(const char* name, const char* position, const char* velocity) {
  return std::string("[[body]]\nname = \"") + name +
         "\"\nentity = \"ball\"\nradius = 0.1\nmass = 2\nposition = " + position +
         "\nvelocity = " + velocity + "\n";
}

}  // namespace

// Two balls go to and fro between each other and their images: 0.3 m apart at first and 0.6 m after
// that, at 2 m/s, so they meet at 0.15 s, 0.45 s, ... The centre of mass moves, and does not count.
TEST_CASE("averages of two balls in a periodic box are those by hand", "[gas]") {
  GasAverages averages(
      {.skipped_frames = 6, .frames_a_block = 6, .greatest_distance = 0.66, .distances = 6});
  listen("duration = 1.85\n[periodic]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n" +
             ball("a", "[0.25, 0.5, 0.5]", "[1, 0.3, 0]") +
             ball("b", "[0.75, 0.5, 0.5]", "[-1, 0.3, 0]"),
         averages);
  CHECK(averages.bodies() == 2);
  REQUIRE(averages.blocks().size() == 2);  // from 0.6 s and from 1.2 s on
  for (const GasBlock& block : averages.blocks()) {
    CHECK(std::abs(block.duration - 0.6) < roundoff);
    CHECK(block.impacts == 2);
    CHECK(block.wall_impacts == 0);
    CHECK(std::abs(block.virial - 2 * 4.0 * 0.2) < 1e-8);  // 4 N s at 0.2 m; gaps are up to 1e-10
    CHECK(std::abs(block.kinetic - 2.0) < roundoff);
    CHECK(block.spin.norm() == 0.0);
    REQUIRE(block.way.size() == 6);
    for (std::size_t k = 0; k < 6;
         ++k) {  // each is 0.1 m from where it was, but half way and after
      CHECK(std::abs(block.way[k] - ((k + 1) % 3 == 0 ? 0.0 : 0.01)) < 1e-9);
    }
  }
  REQUIRE(averages.times().size() == 6);
  CHECK(std::abs(averages.times()[2] - 0.3) < roundoff);
  // 0.5 m apart at the end of each block: in the fifth interval of 0.11 m.
  CHECK(averages.pairs() == std::vector<std::int64_t>{0, 0, 0, 0, 2, 0});
}

TEST_CASE("averages know walls, and turning about principal axes", "[gas]") {
  GasAverages walls({.frames_a_block = 9});
  listen("duration = 1.05\n" + ball("a", "[0, 0.3, 0]", "[0, -1, 0]") +
             "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n"
             "[[body]]\nname = \"ceiling\"\nentity = \"wall\"\nshape = \"half-space\"\n"
             "position = [0, 0.6, 0]\nnormal = [0, -1, 0]\n",
         walls);
  REQUIRE(walls.blocks().size() == 1);
  CHECK(walls.blocks()[0].wall_impacts == 2);  // at 0.2 and 0.6 s
  CHECK(walls.blocks()[0].impacts == 0);
  CHECK(std::abs(walls.blocks()[0].wall_impulse - 8.0) < roundoff);

  GasAverages turning({.frames_a_block = 5});
  listen(
      "duration = 0.55\n[[body]]\nname = \"box\"\nentity = \"body\"\nmass = 3\n"
      "half_extents = [0.1, 0.2, 0.3]\nangular_velocity = [0, 0, 2]\n",
      turning);
  REQUIRE(turning.blocks().size() == 1);
  const double moment = 3.0 / 3.0 * (0.01 + 0.04);
  CHECK((turning.blocks()[0].spin - Vector3(0.0, 0.0, 0.5 * moment * 4.0)).norm() < roundoff);
}

TEST_CASE("the error of a mean is that of the scatter of blocks", "[gas]") {
  const BlockMean mean = block_mean({1.0, 2.0, 3.0});
  CHECK(mean.mean == Approx(2.0));
  CHECK(mean.error == Approx(std::sqrt(1.0 / 3.0)));
  CHECK(block_mean({4.0}).error == 0.0);
}
