// The balance of energy at every frame of the shipped scenes, not only at the end of a run.

#include "core/reading/scene_reader.hpp"
#include "experiments/metrics/metrics.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <string>

using namespace kairos;
using namespace kairos::experiments;

namespace {

class FrameBalance : public Recorder {
 public:
  void frame(const Frame& frame) override { tests::check_explained(frame.ledger); }
};

void check_frames(const std::string& scene, const MethodChoice& method) {
  CAPTURE(scene, method.scheme, method.integrator);
  const Model model(read_scene(find_scene(scene)));
  RunChoice choice;
  choice.method = method;
  choice.duration = std::min(1.0, model.scene().duration);
  if (why_refused(model, choice).empty()) {
    FrameBalance balance;
    (void)simulate(model, choice, balance);
  }
}

}  // namespace

TEST_CASE("ledger: every frame of every shipped scene is explained", "[ledger][slow]") {
  for (const std::string& scene : shipped_scenes()) {
    check_frames(scene, {});
    check_frames(scene, MethodChoice::thesis());
  }
}

TEST_CASE(
    "ledger: every frame of every shipped scene is explained where schemes step over contacts",
    "[ledger]") {
  for (const std::string& scene : shipped_scenes()) {
    for (const char* scheme : {"moreau-jean", "pgs", "xpbd", "penalty"}) {
      CAPTURE(scene, scheme);
      check_frames(scene, {scheme, "auto", "certified", "newton"});
    }
  }
}

TEST_CASE("ledger: turning bodies whose step is a frame are explained", "[ledger]") {
  for (const char* scene : {"flipping-box", "spinning-box"}) {
    for (const char* integrator : {"thesis-euler", "explicit-euler", "symplectic-euler",
                                   "velocity-verlet", "rk4", "rkmk4", "free-top-splitting"}) {
      for (const char* scheme : {"original", "event-driven"}) {
        MethodChoice method{scheme, integrator, "certified", "newton"};
        check_frames(scene, method);
      }
    }
  }
}
