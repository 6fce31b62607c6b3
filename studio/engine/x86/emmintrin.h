// The compiler's SSE2, with one function changed. When LLVM 14 makes `v128.load64_splat` of a load and a
// broadcast, it forgets that the load comes before a later store to the same place (its
// LowerBUILD_VECTOR does not hand on the chain of the load), so that `v = matrix * v` reads what it wrote.
// A value that went through a register is no load.
#pragma once
#include_next <emmintrin.h>

static inline __m128d kairos_set1_pd(double value) {
  __asm__("" : "+r"(value));
  return _mm_set1_pd(value);
}
#define _mm_set1_pd kairos_set1_pd
