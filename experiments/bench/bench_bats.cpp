#include "core/mesh_body.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/processor_time.hpp"
#include "experiments/rally/rally_bats.hpp"
#include "experiments/rally/rally_run.hpp"

#include <fmt/format.h>

#include <utility>

namespace kairos::experiments {

void bench_bats(int rallies) {
  const Shape mesh = bat_mesh();
  fmt::print(
      "{} rallies, event-driven, certified; the bat is a blade with a handle of {} triangles\n",
      rallies, std::get<Mesh>(mesh).body->mesh.triangles().size());
  fmt::print("{:<18}{:>8}{:>8}{:>10}{:>10}{:>10}{:>10}{:>12}\n", "the bat is", "hits", "early",
             "most, mm", "inside", "passed", "stopped", "ms a rally");
  for (const RallyBat& bat : rally_bats) {
    BatWatch watch(mesh);
    std::int64_t stopped = 0;
    double spent = 0.0;  // s, of the processor
    for (int r = 0; r < rallies; ++r) {
      const RallyRecording rally = make_rally({.seed = 1999 + static_cast<std::uint64_t>(r)});
      Scene scene = rally_scene(rally, {.name = "event-driven"});
      if (bat.mesh) {
        take_bat(scene, rally, mesh, bat.bounds);
      }
      const Model model(std::move(scene));
      const double start = processor_seconds();
      stopped += simulate(model, {}, watch).status == RunStatus::completed ? 0 : 1;
      spent += processor_seconds() - start;
    }
    fmt::print("{:<18}{:>8}{:>8}{:>10.2f}{:>10}{:>10}{:>10}{:>12.2f}\n", bat.name, watch.hits,
               watch.early, 1e3 * watch.farthest, watch.inside, watch.passed, stopped,
               1e3 * spent / rallies);
  }
}

}  // namespace kairos::experiments
