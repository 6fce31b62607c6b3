#pragma once

#include "core/scene.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// The known answer of a scene, evaluated by code from the scene's own numbers, so that it stays
/// true when a value is overridden. Immutable.
class ExactMotion {
 public:
  virtual ~ExactMotion() = default;
  /// Time of the k-th impact of the scene, k from 1, s; nullopt where there are fewer.
  [[nodiscard]] virtual std::optional<double> impact_time(std::int64_t k) const = 0;
  /// Position and velocity of a body at time t; nullopt for bodies that it says nothing of.
  [[nodiscard]] virtual std::optional<BodyState> state(BodyIndex body, Instant t) const = 0;
  /// When everything has come to rest, s; nullopt: never.
  [[nodiscard]] virtual std::optional<double> rest_time() const { return std::nullopt; }
};

/// What the catalogue knows of an exact solution.
struct ExactSolutionType {
  std::string_view name;
  std::string_view summary;
  std::string_view formula;
  std::string_view source;
  /// Throws `InputError` where the scene is not one that it solves.
  std::unique_ptr<const ExactMotion> (*solve)(const Scene& scene);
};

/// All exact solutions, in the order in which they are documented.
[[nodiscard]] std::span<const ExactSolutionType> exact_solution_catalogue();
/// nullptr if there is none of that name.
[[nodiscard]] const ExactSolutionType* find_exact_solution(std::string_view name);
/// The exact solution that the scene names; nullptr if it names none. Throws `InputError` where
/// the scene (after an override, say) is not one that it solves.
[[nodiscard]] std::unique_ptr<const ExactMotion> solve_exactly(const Scene& scene);

}  // namespace core
}  // namespace kairos
