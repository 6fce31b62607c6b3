#pragma once

#include "tests/temporary_folder.hpp"

#include <string>
#include <vector>

namespace kairos::tests {

/// What a run of the program `kairos` left.
struct Outcome {
  int exit_code = -1;  ///< minus the signal that killed it
  std::string out;
  std::string err;
};

struct Surroundings {
  std::string input = {};            ///< on stdin
  std::string output = {};           ///< file that takes stdout; empty: caught in `Outcome::out`
  std::size_t largest_file = 0;      ///< bytes; 0: no limit. Stands for a disk that fills
  double kill_after = 0.0;           ///< s; then SIGKILL; 0: never
  unsigned processor_seconds = 100;  ///< then it is killed: a run that hangs fails its test
};

/// Runs the built program as a person would.
[[nodiscard]] Outcome kairos_program(const std::vector<std::string>& arguments,
                                     const Surroundings& surroundings = {});

}  // namespace kairos::tests
