#pragma once

#include <filesystem>
#include <string>
#include <string_view>
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

/// A folder of its own for one test; gone afterwards.
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
