#include <kairos/simulation.hpp>

#include <iostream>

int main(int, char** arguments) {
  using namespace kairos;
  const Scene scene = read_scene(arguments[1]);
  const MethodChoice method{"event-driven", "dopri5", "certified", "newton"};
  const auto [result, trajectory] = simulate(scene, {.method = method});
  for (const Event& event : trajectory.events()) {
    std::cout << event.time.seconds << " s: " << to_string(event.kind) << '\n';
  }
}
