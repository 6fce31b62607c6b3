#include "experiments/output/text_or_nothing.hpp"

#include "core/reading/document.hpp"

#include <filesystem>
#include <system_error>

namespace kairos::experiments {

std::string text_or_nothing(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none) ? read_text_file(path) : std::string();
}

}  // namespace kairos::experiments
