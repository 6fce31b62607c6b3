#pragma once

#include "core/contact_detector.hpp"
#include "core/event.hpp"
#include "core/model.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace kairos::experiments {

/// When a body was hit, and whether it should have been.
class ImpactWatch {
 public:
  ImpactWatch(const Model& model, BodyIndex body);
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
  [[nodiscard]] Contact contact_of(const Event& event) const;

  const Model& model_;
  std::shared_ptr<const ContactDetector> detector_;
  BodyIndex body_;
  std::optional<double> first_, last_, rest_;
  std::int64_t approaching_ = 0;
  std::int64_t separating_ = 0;
};

}  // namespace kairos::experiments
