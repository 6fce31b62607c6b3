#define KAIROS_NAMED(name) name##_avx2
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define KAIROS_WIDE [[gnu::target("avx2")]]
#define KAIROS_HERE (__builtin_cpu_supports("avx2") != 0)
#else
#define KAIROS_WIDE
#define KAIROS_HERE false
#endif
#define KAIROS_WIDEST KAIROS_WIDE
#include "tests/ccd/instruction_set_sources.hpp"

InstructionSet avx2_set() {
  return {"avx2",
          KAIROS_HERE,
          kairos::ccd::filter_balls,
          kairos::ccd::greatest,
          kairos::ccd::verdicts,
          kairos::ccd::batch};
}
