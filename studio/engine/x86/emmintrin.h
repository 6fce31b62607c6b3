// The compiler's SSE2, with what makes a vector of doubles changed. Where LLVM 14 makes
// `v128.load64_splat` of a load, it forgets that the load comes before a later store to the same place
// (its LowerBUILD_VECTOR does not hand on the chain of the load), so that `v = matrix * v` reads what it
// wrote. A value that went through a register is no load.
#pragma once
#include_next <emmintrin.h>

static inline double kairos_in_register(double value) {
  __asm__("" : "+r"(value));
  return value;
}
static inline __m128d kairos_set_pd(double second, double first) {
  return __extension__(__m128d){kairos_in_register(first), kairos_in_register(second)};
}
static inline __m128d kairos_set1_pd(double value) { return kairos_set_pd(value, value); }
static inline __m128d kairos_load_pd(const double* from) {
  return kairos_set_pd(from[1], from[0]);
}
#define _mm_set_pd kairos_set_pd
#define _mm_set1_pd kairos_set1_pd
#define _mm_load_pd kairos_load_pd
#define _mm_loadu_pd kairos_load_pd
