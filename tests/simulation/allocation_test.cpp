#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "simulation/simulate.hpp"
#include "tests/allocations.hpp"
#include "tests/catch.hpp"
#include "tests/locations.hpp"

#include <string>

// Hot loops do not allocate: a run that lasts four times as long asks the heap no more often.

using namespace kairos;

namespace {

std::size_t allocations_of(const Model& model, RunChoice choice, double duration) {
  choice.duration = duration;
  Recorder silent;
  const std::size_t before = test::allocations();
  const RunResult result = simulate(model, choice, silent);
  REQUIRE(result.status == RunStatus::completed);
  return test::allocations() - before;
}

void check_no_allocation(const std::string& scheme, const std::string& integrator,
                         const std::string& scene = "bounce") {
  const Model model(read_scene(tests::source_path("scenes/" + scene + ".toml")));
  RunChoice choice;
  choice.method = {scheme, integrator, "certified", "newton"};
  CAPTURE(scheme, integrator, scene);
  allocations_of(model, choice, 1.0);  // the registry is filled on first use
  CHECK(allocations_of(model, choice, 40.0) == allocations_of(model, choice, 10.0));
}

}  // namespace

TEST_CASE("the loops of the schemes do not allocate", "[allocation]") {
  check_no_allocation("original", "thesis-euler");
  check_no_allocation("original", "rk4");
  check_no_allocation("substepped", "thesis-euler");
  check_no_allocation("bisected", "velocity-verlet");
  check_no_allocation("event-driven", "closed-form");
  check_no_allocation("event-driven", "rk4");
}

TEST_CASE("joints do not allocate in the loops", "[allocation]") {
  for (const std::string scene : {"double-pendulum", "slider-crank"}) {
    check_no_allocation("event-driven", "rk4", scene);
    check_no_allocation("event-driven", "dopri5", scene);
  }
  check_no_allocation("original", "rk4", "double-pendulum");
}
