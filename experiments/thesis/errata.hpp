#pragma once

#include "experiments/sweeps/sweep_spec.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments::thesis {

/// How a measured number is held against a predicted one.
enum class Agreement {
  equal,      ///< |measured - predicted| <= tolerance
  at_most,    ///< measured <= predicted
  more_than,  ///< measured > predicted
};

/// What a number is worth as evidence: could a run have said otherwise?
enum class Evidence {
  run,          ///< predicted before, in closed form; a run or the library's answer could refute it
  arithmetic,   ///< counted or computed on both sides: no run could refute it
  observation,  ///< no number was predicted; a run shows that the effect is there
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
  Evidence evidence = Evidence::run;

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

/// Two places of the thesis that say different things.
struct Contradiction {
  std::string_view section;
  std::string_view says;
  std::string_view other_section;
  std::string_view other_says;
  std::string_view run;      ///< which is run here
  std::string_view measure;  ///< what the difference comes to; quotes values as `{name}`
};
[[nodiscard]] std::span<const Contradiction> contradictions();

/// A claim of the thesis that no run here decides.
struct Undecided {
  std::string_view section;
  std::string_view claim;
  std::string_view why;    ///< it is not decided
  std::string_view known;  ///< what runs do say about it; quotes values as `{name}`
};
[[nodiscard]] std::span<const Undecided> undecided();

/// What we predicted at first, and a run refuted.
struct Corrected {
  std::string_view id;  ///< of the statement that it became part of
  std::string_view at_first;
  std::string_view measured;
};
[[nodiscard]] std::span<const Corrected> corrected();

}  // namespace kairos::experiments::thesis
