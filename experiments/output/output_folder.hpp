#pragma once

#include "experiments/output/atomic_file.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// How a set of files lies in a folder, and what it may replace.
struct OutputSet {
  /// The file without which the set is not whole: the old one goes first, the new one comes last.
  std::string seal = {};
  /// How the seal of an earlier set of the same kind begins. A folder that holds files of the new
  /// names without such a seal is somebody else's, and is refused.
  std::string begins = {};
  bool replace = false;  ///< `--force`: whatever there is
};

/// The folder of `--out`, as long as this lives taken by one process (`flock`).
///
/// Its files appear together when the work is done, or not at all. Several files cannot be renamed
/// at once: where the program is killed between two of them, the seal is missing, and `incomplete`
/// says so to whoever reads.
class OutputFolder {
 public:
  /// Creates the folder where it is missing. Throws `InputError` where it cannot be written, or
  /// where another process has it.
  explicit OutputFolder(const std::filesystem::path& path, OutputSet set = {});
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  /// Without `publish`: removes the files, and the folders that this one made.
  ~OutputFolder();

  /// A new file, of a plain name; valid as long as the folder. Throws `InputError` where the name
  /// is taken by what is not of an earlier set.
  AtomicFile& file(std::string_view name);
  /// Throws as `file` does, before any work is done for it.
  void claim(std::string_view name) const;
  /// All files reach the disk, then all get their names, in the order in which they were made, the
  /// seal last. Throws `RunError`.
  void publish();

 private:
  void take();
  [[nodiscard]] bool is_ours() const;

  std::filesystem::path path_;
  OutputSet set_;
  std::vector<std::filesystem::path> made_;  ///< deepest first
  std::vector<std::unique_ptr<AtomicFile>> files_;
  int descriptor_ = -1;  ///< of the folder, locked
  bool ours_ = false;    ///< what is in it may be replaced
  bool sealed_ = false;  ///< the seal is there, and the last of the files
};

/// Whether a set of files was being published there when the program was killed.
[[nodiscard]] bool incomplete(const std::filesystem::path& folder);

}  // namespace kairos::experiments
