#include "experiments/thesis/test_excerpts.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace kairos::experiments::thesis {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> test_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.path().extension() == ".cpp") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::string test_excerpt(std::string_view name) {
  const fs::path root = fs::path(KAIROS_SOURCE_EXPERIMENTS).parent_path();
  const std::string opening = "TEST_CASE(\"" + std::string(name) + "\"";
  for (const fs::path& path : test_files(root / "tests")) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    const std::string file = text.str();
    const std::size_t begin = file.find(opening);
    if (begin == std::string::npos) {
      continue;
    }
    // A test ends with the first brace at the beginning of a line.
    const std::size_t end = file.find("\n}\n", begin);
    return "// " + path.lexically_relative(root).string() + "\n\n" +
           file.substr(begin, end == std::string::npos ? end : end + 3 - begin);
  }
  return "";
}

}  // namespace kairos::experiments::thesis
