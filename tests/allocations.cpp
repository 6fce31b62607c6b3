#include "tests/allocations.hpp"

#include "tests/sanitizers.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> count{0};

}  // namespace

#ifndef KAIROS_SANITIZED_MEMORY  // which the sanitizer pairs; nothing is counted here

// The whole program's: a test that counts before and after a loop proves that it does not allocate.
void* operator new(std::size_t size) {
  ++count;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

#endif

namespace kairos::test {

std::size_t allocations() { return count.load(); }

}  // namespace kairos::test
