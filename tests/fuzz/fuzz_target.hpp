#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

/// The one function of a fuzz target, as libFuzzer calls it. Returns 0; a broken promise aborts.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace kairos::fuzz {

/// What must hold of every input: says what was broken and aborts, so that the input is kept.
inline void require(bool holds, const std::string& broken) {
  if (!holds) {
    std::fprintf(stderr, "broken: %s\n", broken.c_str());
    std::abort();
  }
}

}  // namespace kairos::fuzz
