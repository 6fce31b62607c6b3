#include <kairos/experiments/simulation.hpp>

#include <iostream>

int main() {
  using namespace kairos;
  const Scene scene = read_scene(SCENES "/bounce.toml");
  const auto [result, trajectory] = experiments::simulate(scene, {.duration = 4.0});
  for (const Event& event : trajectory.events()) {
    std::cout << event.time.seconds << " s: " << to_string(event.kind) << '\n';
  }
}
