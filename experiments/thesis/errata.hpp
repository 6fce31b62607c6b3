#pragma once

#include "experiments/sweeps/sweep_spec.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments::thesis {

/// How a measured number is held against a predicted one.
enum class Agreement {
  equal,     ///< |measured - predicted| <= tolerance
  at_most,   ///< measured <= predicted
  at_least,  ///< measured >= predicted
};

/// One number that a prediction comes down to.
struct Check {
  std::string quantity;
  std::string unit;  ///< empty: a count or a ratio
  double predicted = 0.0;
  double measured = 0.0;
  Agreement agreement = Agreement::equal;
  double tolerance = 0.0;
  std::string_view tolerance_kind;  ///< what the tolerance stands for

  [[nodiscard]] bool confirmed() const;
};

/// A statement about the thesis that a run decides.
struct Erratum {
  std::string_view id;       ///< "1", "2.1.2": number of the prediction or section of the claim
  std::string_view section;  ///< of the thesis
  std::string_view thesis;   ///< what it says
  std::string_view reading;  ///< what its algorithm should do, then
  std::string_view test;     ///< the test that holds it, by its full name
  std::vector<Check> (*measure)(Size size);
};

[[nodiscard]] std::span<const Erratum> errata();

}  // namespace kairos::experiments::thesis
