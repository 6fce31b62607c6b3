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
  /// For people: what moves the body, and how.
  [[nodiscard]] virtual std::string description() const = 0;
  /// Whether its velocity never jumps, so that a joint can follow it.
  [[nodiscard]] virtual bool smooth() const { return true; }
  /// Whether it tells when a fist is closed (7.5).
  [[nodiscard]] virtual bool has_gestures() const { return false; }
  /// Whether the fist is closed from t on; changes only where a `motion` ends.
  [[nodiscard]] virtual bool closed(Instant /*t*/) const { return false; }
};

}  // namespace core
}  // namespace kairos
