#include "experiments/output/fingerprint.hpp"

#include <fmt/format.h>

namespace kairos::experiments {

std::string Fingerprint::text() const { return fmt::format("{:016x}", hash_); }

}  // namespace kairos::experiments
