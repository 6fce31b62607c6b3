// A field that is entered and left changes the force between two steps: no stepper may go on with
// what it remembers of the force before.

#include "core/reading/scene_reader.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <string>

using namespace kairos;

TEST_CASE("pad: under every scheme every stepper of order 2 and more flies its parabolas",
          "[pad][slow]") {
  const Scene scene = read_scene(find_scene("pad"), {{"duration", "1.4"}});
  for (const auto& scheme : schemes()) {
    if (!scheme->info().integrator.empty()) {
      continue;  // takes no stepper
    }
    for (const IntegratorEntry& integrator : integrator_entries()) {
      if (integrator.info.position_order == 1) {
        continue;  // the Euler methods gain or lose energy on a parabola
      }
      RunChoice choice;
      choice.method = {std::string(scheme->info().name), std::string(integrator.info.name),
                       "certified", "newton"};
      CAPTURE(choice.method.scheme, integrator.info.name);
      const Simulation sim = simulate(scene, choice);
      CAPTURE(sim.result.reason);
      REQUIRE(sim.result.status == RunStatus::completed);
      std::size_t fields = 0;
      for (const Event& event : sim.trajectory.events()) {
        fields += event.kind == EventKind::field_entered || event.kind == EventKind::field_left;
      }
      CHECK(fields == 2);
      // Exact on a parabola but for roundoff, of some hundred steps at 28.42 J; methods whose step
      // is controlled by a lower order, or that choose theirs, keep to their tolerance of 1e-10 a
      // step. What a stale force does to a single frame is 0.3 J.
      const bool keeps_to_tolerance =
          integrator.info.variable_order || integrator.info.name == "arkode-2";
      CHECK(std::abs(sim.result.ledger.line(EnergyLine::truncation)) <=
            (keeps_to_tolerance ? 2e-7 : 1e-12));
    }
  }
}
