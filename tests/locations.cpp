#include "tests/locations.hpp"

namespace kairos::tests {

std::string source_path(const std::string& file) { return KAIROS_SOURCE_DIR "/" + file; }

}  // namespace kairos::tests
