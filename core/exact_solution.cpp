#include "core/exact_solution.hpp"

#include "core/error.hpp"

namespace kairos {
inline namespace core {
namespace exact {

// A new solution is one file, one declaration here and one line in the list below.
ExactSolutionType elastic_drop();
ExactSolutionType inelastic_drop();
ExactSolutionType equal_masses();
ExactSolutionType reflection();
ExactSolutionType drag_drop();
ExactSolutionType oscillator();

}  // namespace exact

std::span<const ExactSolutionType> exact_solution_catalogue() {
  static const ExactSolutionType catalogue[] = {
      exact::elastic_drop(), exact::inelastic_drop(), exact::equal_masses(),
      exact::reflection(),   exact::drag_drop(),      exact::oscillator(),
  };
  return catalogue;
}

const ExactSolutionType* find_exact_solution(std::string_view name) {
  for (const ExactSolutionType& type : exact_solution_catalogue()) {
    if (type.name == name) {
      return &type;
    }
  }
  return nullptr;
}

std::unique_ptr<const ExactMotion> solve_exactly(const Scene& scene) {
  if (!scene.exact) {
    return nullptr;
  }
  const ExactSolutionType* type = find_exact_solution(scene.exact->solution);
  if (type == nullptr) {
    throw InputError(scene.path, 0, "exact.solution",
                     "\"" + scene.exact->solution + "\" does not exist");
  }
  bool rough = false;
  for (const Body& body : scene.bodies) {
    rough = rough || body.friction > 0.0;
  }
  if (rough) {
    throw InputError(scene.path, 0, "exact.solution",
                     "\"" + scene.exact->solution + "\" holds without friction only");
  }
  return type->solve(scene);
}

}  // namespace core
}  // namespace kairos
