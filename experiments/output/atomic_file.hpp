#pragma once

#include "experiments/output/file_part.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace kairos::experiments {

/// A file that appears whole or not at all: written without a name (where the file system can;
/// under a hidden one elsewhere) in its folder, flushed to the disk, then renamed. Every write is
/// checked. A process that is killed leaves nothing; one that is killed in the very act of renaming
/// may leave a whole copy under a hidden name, which the next writer of the same path removes.
class AtomicFile {
 public:
  /// Opens the temporary file. Throws `InputError` where that is impossible, or where `path` is a
  /// device, a pipe or a folder; a symbolic link is followed.
  explicit AtomicFile(const std::string& path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Removes what was not published.
  ~AtomicFile();

  /// Appends. Throws `RunError` where the disk does not take it.
  void write(std::string_view text);
  /// Bytes written so far. Throws `RunError`.
  [[nodiscard]] std::size_t size();
  /// What was written so far, in blocks, in constant memory. Throws `RunError`.
  void read(const std::function<void(std::string_view)>& take);
  /// Makes this what was written so far. Throws `RunError`, or `InputError` where it cannot be
  /// read.
  void restore(const FilePart& part);
  /// Writes what is buffered and waits until the disk has it. Throws `RunError`.
  void finish();
  /// Gives the file its name, replacing one that has it. Call after `finish`. Throws `RunError`.
  void publish();

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void flush();
  void publish_anonymous();

  std::string path_;
  std::string temporary_;  ///< empty: has no name (yet)
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes a whole file at once.
void write_file(const std::string& path, std::string_view text);

}  // namespace kairos::experiments
