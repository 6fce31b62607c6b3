#pragma once

#include <stdexcept>

namespace kairos::experiments {

/// The input was right and the work failed all the same: a run stopped before its end, a disk
/// filled. The command line exits with 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kairos::experiments
