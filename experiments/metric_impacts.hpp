#pragma once

#include "core/event.hpp"

#include <cstdint>
#include <optional>

namespace kairos::experiments {

/// When a body was hit, and whether it should have been.
class ImpactWatch {
 public:
  explicit ImpactWatch(BodyIndex body) : body_(body) {}
  void event(const Event& event);

  [[nodiscard]] std::optional<double> first() const { return first_; }
  [[nodiscard]] std::optional<double> last() const { return last_; }
  /// Start of the contact that has not ended.
  [[nodiscard]] std::optional<double> rest() const { return rest_; }
  /// Impacts in which the bodies approached along the contact normal.
  [[nodiscard]] std::int64_t approaching() const { return approaching_; }
  /// Impacts in which they were moving apart already: the reflection turns the body back inwards.
  [[nodiscard]] std::int64_t separating() const { return separating_; }

 private:
  BodyIndex body_;
  std::optional<double> first_, last_, rest_;
  std::int64_t approaching_ = 0;
  std::int64_t separating_ = 0;
};

}  // namespace kairos::experiments
