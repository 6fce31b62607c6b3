// The compiler's SSE2, with two functions changed. Where LLVM 14 makes `v128.load64_splat` of a load, it
// forgets that the load comes before a later store to the same place (its LowerBUILD_VECTOR does not hand
// on the chain of the load), so that `v = matrix * v` reads what it wrote. A value that went through a
// register is no load.
#pragma once
#include_next <emmintrin.h>

static inline double kairos_in_register(double value) {
  __asm__("" : "+r"(value));
  return value;
}
static inline __m128d kairos_set1_pd(double value) {
  return _mm_set1_pd(kairos_in_register(value));
}
static inline __m128d kairos_set_pd(double second, double first) {
  return _mm_set_pd(second, kairos_in_register(first));
}
#define _mm_set1_pd kairos_set1_pd
#define _mm_set_pd kairos_set_pd
