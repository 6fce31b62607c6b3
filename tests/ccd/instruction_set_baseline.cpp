#define KAIROS_NAMED(name) name##_baseline
#define KAIROS_WIDE
#define KAIROS_WIDEST
#include "tests/ccd/instruction_set_sources.hpp"

InstructionSet baseline_set() {
  return {"baseline",
          true,
          kairos::ccd::filter_balls,
          kairos::ccd::greatest,
          kairos::ccd::verdicts,
          kairos::ccd::batch};
}
