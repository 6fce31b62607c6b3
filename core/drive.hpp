#pragma once

#include "core/motion.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// Who moves a driven body: a tracker recording, a sinusoid. Immutable, shared between threads.
class Drive {
 public:
  virtual ~Drive() = default;
  /// The motion from t on, lasting at most `at_most` s, shorter where a knot comes first (a sample
  /// of a recording, where velocity may jump; the end of a polynomial fit). Never of length 0.
  [[nodiscard]] virtual Motion motion(Instant t, double at_most) const = 0;
  [[nodiscard]] virtual std::string description() const = 0;
};

}  // namespace core
}  // namespace kairos
