// vrphysicsapp in the thesis' own format: both schemes tell ch. 8.1, and the search finds such
// worlds.

#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "experiments/physworld/story.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <string>

using namespace kairos;
using namespace kairos::experiments;
using kairos::tests::kairos_program;
using kairos::tests::read_all;

namespace {

Story told_by(const MethodChoice& method) {
  const Model model(read_scene(find_scene("physworld")));
  StoryRecorder recorder;
  (void)simulate(model, {.method = method}, recorder);
  return recorder.story();
}

}  // namespace

TEST_CASE("physworld: the pad's five lines are the thesis' own", "[physworld]") {
  const std::string text = read_all(find_scene("physworld"));
  const std::string five =
      "Object1-Name:object_files/agpad\nObject1-Pos:12.0 -25.0 20.0\nObject1-Normal:0.0, 1.0, 0.0\n"
      "Object1-Type:O_agpad\nObject1-COLLType:SQUARE\n";
  CHECK(text.find(five) != std::string::npos);
}

TEST_CASE("physworld: original and event-driven tell ch. 8.1 in the order of its captions",
          "[physworld]") {
  for (const auto& method :
       {MethodChoice::thesis(), MethodChoice{"event-driven", "auto", "certified", "thesis"}}) {
    const Story story = told_by(method);
    INFO(method.scheme << ": missing: " << story.missing);
    CHECK(story.complete);
    REQUIRE(story.moments.size() == 16);
    for (std::size_t i = 1; i < story.moments.size(); ++i) {
      CHECK(story.moments[i - 1].frame <= story.moments[i].frame);
    }
    for (std::size_t i = 1; i < story.frames.size(); ++i) {
      CHECK(story.frames[i - 1] < story.frames[i]);
    }
  }
}

TEST_CASE("physworld: a light green ball is swallowed by the conveyor, and the story ends",
          "[physworld]") {
  const Model model(read_scene(find_scene("physworld"), {{"body.conveyor.belt_mass", "200"}}));
  StoryRecorder recorder;
  (void)simulate(model, {.method = MethodChoice::thesis()}, recorder);
  CHECK_FALSE(recorder.story().complete);
}

TEST_CASE("kairos physworld: finds the shipped world again", "[physworld][slow]") {
  const auto found = kairos_program({"physworld", "--seed", "1"});
  CHECK(found.exit_code == 0);
  CHECK(found.out == read_all(find_scene("physworld")));
}

TEST_CASE("kairos physworld: says so where it finds nothing", "[physworld]") {
  const auto none = kairos_program({"physworld", "--tries", "1"});
  CHECK(none.exit_code == 1);
  CHECK(none.err.find("no world in 1 tries") != std::string::npos);
}
