#pragma once

#include "core/force.hpp"

#include <span>

namespace kairos {
inline namespace core {

/// Port: the gaps of the pairs of an island as functions of its state, for steppers that find
/// roots themselves (CVODE).
class GapFunction {
 public:
  virtual ~GapFunction() = default;
  /// How many pairs there are.
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Signed gap per pair (m; negative: overlapping) at time t for these states of the island.
  virtual void evaluate(Instant t, std::span<const BodyState> states,
                        std::span<double> gaps) const = 0;
};

}  // namespace core
}  // namespace kairos
