#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace kairos::experiments {

/// A file that is open for reading, by its bytes; the name may meanwhile go to another file.
class OpenFile {
 public:
  /// Throws `InputError` where it cannot be opened or is no regular file: what has no end has no
  /// size, and is not read.
  explicit OpenFile(const std::string& path);
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile();

  /// Bytes, when it was opened.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// These bytes, in blocks, in constant memory. Throws `InputError` where they are not there.
  void read(std::size_t begin, std::size_t count,
            const std::function<void(std::string_view)>& take) const;
  /// These bytes. Throws `InputError`.
  [[nodiscard]] std::string text(std::size_t begin, std::size_t count) const;

 private:
  std::string path_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

/// A part of a file.
struct FilePart {
  std::shared_ptr<const OpenFile> file;
  std::size_t begin = 0;
  std::size_t count = 0;
};

}  // namespace kairos::experiments
