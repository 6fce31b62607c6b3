// What a body is to meet is looked for again where its next meeting comes to nothing.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/locations.hpp"

#include <algorithm>

using namespace kairos;

namespace {

class Deepest : public Recorder {
 public:
  void event(const Event& event) override { gap = std::min(gap, event.contact.gap); }
  double gap = 0.0;  ///< m
};

}  // namespace

TEST_CASE("event-driven: after a touch without an impact the next meeting is found again, too",
          "[event-driven][slow]") {
  const Model model(read_scene(tests::source_path("tests/simulation/crowd_that_hops.toml")));
  Deepest deepest;
  RunChoice choice;
  choice.method = {"event-driven", "auto", "certified", "newton"};
  choice.duration = 1.1402;
  const RunResult result = simulate(model, choice, deepest);
  CAPTURE(result.reason);
  CHECK(result.status == RunStatus::completed);
  CHECK(deepest.gap > -1e-12);  // -5.6e-9 where it was not
}
