#pragma once

#include "ccd/relative_boxes.hpp"
#include "core/contact_detector.hpp"

#include <span>
#include <vector>

/// What exists more than once in the program, by the registers of processors, compiled for one of
/// them.
struct InstructionSet {
  const char* name;
  bool here;  ///< whether this processor has it

  void (*filter_balls)(const kairos::FlightsBeside& balls, double tolerance,
                       std::span<double> clear);
  kairos::ccd::AxisSeparation (*greatest)(const kairos::ccd::RelativeBoxes& boxes);
  int (*verdicts)(const kairos::ccd::RelativeBoxes& boxes);  ///< of four questions, as digits
  void (*batch)(const std::vector<kairos::ccd::RelativeBoxes>& boxes,
                std::span<kairos::ccd::Verdict> verdicts,
                std::span<kairos::ccd::AxisSeparation> separations, std::span<double> errors);
};

[[nodiscard]] InstructionSet baseline_set();
[[nodiscard]] InstructionSet avx2_set();
[[nodiscard]] InstructionSet avx512_set();
