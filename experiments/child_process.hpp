#pragma once

#include <string>
#include <vector>

namespace kairos::experiments {

enum class ChildOutput { shown, hidden };

/// Where a program runs; empty: as we do.
struct ChildPlace {
  std::string folder = {};  ///< its working directory
  std::string home = {};    ///< its HOME, where it looks for what configures it
};

/// Runs a program (found on PATH) with its arguments, no shell in between, and waits for it.
/// Returns its exit code; -1 where it cannot be started or was ended by a signal.
int run_child(const std::vector<std::string>& command, ChildOutput output,
              const ChildPlace& place = {});

}  // namespace kairos::experiments
