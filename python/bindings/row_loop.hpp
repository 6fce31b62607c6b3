#pragma once

#include "core/error.hpp"

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "python/bindings/errors.hpp"
#include "python/bindings/worker_threads.hpp"
#include <limits>
#include <mutex>
#include <string>

namespace kairos::python {

/// The first bad row of a batch, whatever the order in which threads come across bad ones.
class FirstFailure {
 public:
  void tell(std::size_t row, const std::string& what) {
    const std::lock_guard lock(mutex_);
    if (row < row_) {
      row_ = row;
      what_ = what;
    }
  }
  void raise() const {
    if (row_ != none) {
      throw InputError("", 0, fmt::format("row {}", row_), what_);
    }
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::mutex mutex_;
  std::size_t row_ = none;
  std::string what_;
};

/// Calls `work(row)` for all rows, on `threads` threads (0: one per core), with the interpreter's
/// lock released. Throws `InputError` that names the first row whose work threw.
template <typename Work>
void for_all_rows(std::size_t count, std::size_t threads, const Work& work) {
  FirstFailure failure;
  Interrupts interrupts;
  {
    const pybind11::gil_scoped_release unlocked;
    in_pieces(
        count, threads,
        [&](std::size_t first, std::size_t last) {
          for (std::size_t i = first; i < last; ++i) {
            try {
              work(i);
            } catch (const std::exception& bad) {
              failure.tell(i, bad.what());
            }
          }
        },
        [&] { interrupts.look(); });
  }
  failure.raise();
}

}  // namespace kairos::python
