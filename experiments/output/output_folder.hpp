#pragma once

#include "experiments/output/atomic_file.hpp"

#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// The folder of `--out`: its files appear together when the work is done, or not at all.
class OutputFolder {
 public:
  /// Creates the folder where it is missing. Throws `InputError` where it cannot be written.
  explicit OutputFolder(const std::filesystem::path& path);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  /// Without `publish`: removes the files, and the folders that this one made.
  ~OutputFolder();

  /// A new file; valid as long as the folder.
  AtomicFile& file(std::string_view name);
  /// All files reach the disk, then all get their names, in the order in which they were made.
  void publish();

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  ///< deepest first
  std::vector<std::unique_ptr<AtomicFile>> files_;
};

}  // namespace kairos::experiments
