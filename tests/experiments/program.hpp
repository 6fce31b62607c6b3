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
  std::string error = {};            ///< file that takes stderr; empty: caught in `Outcome::err`
  std::size_t memory = 0;            ///< bytes of address space; 0: no limit
  std::size_t largest_file = 0;      ///< bytes; 0: no limit. Stands for a disk that fills
  double kill_after = 0.0;           ///< s; then SIGKILL; 0: never
  unsigned processor_seconds = 100;  ///< then it is killed: a run that hangs fails its test
};

/// Runs a command line that begins with `kairos` by a shell, as a person who has copied it would;
/// its exit code.
[[nodiscard]] int in_a_shell(const std::string& command);

/// Runs the built program as a person would.
[[nodiscard]] Outcome kairos_program(const std::vector<std::string>& arguments,
                                     const Surroundings& surroundings = {});

}  // namespace kairos::tests
