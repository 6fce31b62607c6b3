#include "experiments/output/file_part.hpp"

#include "core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <vector>

namespace kairos::experiments {

OpenFile::OpenFile(const std::string& path) : path_(path) {
  if (path.find('\0') != std::string::npos) {
    throw InputError(path, 0, "", "is no path: it holds a zero byte");
  }
  // Not blocking: a pipe without a writer would wait for ever.
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    throw InputError(path, 0, "",
                     fmt::format("cannot be read: {}", std::generic_category().message(errno)));
  }
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw InputError(path, 0, "", "cannot be read: it is no regular file");
  }
  size_ = static_cast<std::size_t>(status.st_size);
}

OpenFile::~OpenFile() { ::close(descriptor_); }

void OpenFile::read(std::size_t begin, std::size_t count,
                    const std::function<void(std::string_view)>& take) const {
  std::vector<char> block(std::min(count, std::size_t{1} << 16));
  while (count > 0) {
    const ::ssize_t got = ::pread(descriptor_, block.data(), std::min(count, block.size()),
                                  static_cast<::off_t>(begin));
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      throw InputError(
          path_, 0, "",
          got == 0 ? "is cut off: its end is missing"
                   : fmt::format("cannot be read: {}", std::generic_category().message(errno)));
    }
    const auto size = static_cast<std::size_t>(got);
    take({block.data(), size});
    begin += size;
    count -= size;
  }
}

std::string OpenFile::text(std::size_t begin, std::size_t count) const {
  std::string text;
  text.reserve(std::min(count, size_));
  read(begin, count, [&text](std::string_view block) { text += block; });
  return text;
}

}  // namespace kairos::experiments
