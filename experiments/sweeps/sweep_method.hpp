#pragma once

#include "experiments/simulation.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace kairos::experiments {

/// Method options that a sweep can set, by name: scheme, integrator, detector, impact, frame
/// (s), frame_jitter, spike_probability, spike_factor, duration (s), step (s), threshold (m),
/// equal_substeps, max_substeps, toi_tolerance (m), relative_tolerance, absolute_tolerance,
/// roundoff.
[[nodiscard]] bool is_method_option(std::string_view name);
[[nodiscard]] std::string method_option_names();
/// True for the options that are names (scheme, integrator, detector, impact).
[[nodiscard]] bool is_text_option(std::string_view name);

/// Collects the options of one run; frame times are put together from several.
class MethodOptions {
 public:
  /// `name` must be a method option that takes a name.
  void set_text(std::string_view name, const std::string& value);
  /// `name` must be a method option that takes a number; throws `std::invalid_argument` with the
  /// allowed range.
  void set_number(std::string_view name, double value);
  /// `seed` draws jitter and spikes.
  [[nodiscard]] RunChoice choice(std::uint64_t seed) const;

 private:
  RunChoice choice_;
  std::optional<double> frame_;
  double jitter_ = 0.0;
  double spike_probability_ = 0.0;
  double spike_factor_ = 10.0;
};

}  // namespace kairos::experiments
