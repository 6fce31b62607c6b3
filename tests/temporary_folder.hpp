#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::tests {

/// A folder of its own for one test; gone afterwards. Tests run side by side: none may
/// know the name of another's.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }
  /// Writes a file and returns its path.
  std::string file(std::string_view name, std::string_view text) const;
  /// Names of all that is in it, hidden files included, sorted.
  [[nodiscard]] std::vector<std::string> entries(std::string_view below = "") const;

 private:
  std::filesystem::path folder_;
};

[[nodiscard]] std::string read_all(const std::string& path);

}  // namespace kairos::tests
