#include "experiments/output/atomic_file.hpp"

#include "core/error.hpp"
#include "experiments/run_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace kairos::experiments {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 16;

std::string reason() { return std::generic_category().message(errno); }

[[noreturn]] void fail(const std::string& path) {
  throw RunError(fmt::format("{}: cannot be written: {}", path, reason()));
}

/// Where the name of the file begins, behind its folder.
std::size_t name_begin(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? 0 : slash + 1;
}

std::string folder(const std::string& path) {
  const std::size_t name = name_begin(path);
  return name == 0 ? "." : path.substr(0, name);
}

/// Beside the final name, and hidden.
std::string hidden_name(const std::string& path, std::string_view suffix) {
  const std::size_t name = name_begin(path);
  return fmt::format("{}.{}{}", path.substr(0, name), path.substr(name), suffix);
}

/// Waits until no living process holds the file of this name, and removes it if it is still there.
void remove_abandoned(const std::string& name) {
  const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    if (errno != ENOENT) {
      fail(name);
    }
    return;
  }
  struct ::stat held = {};
  struct ::stat named = {};
  const bool locked = ::flock(descriptor, LOCK_EX) == 0;
  const bool free = locked || errno == EINTR;
  const bool same = locked && ::fstat(descriptor, &held) == 0 &&
                    ::stat(name.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
                    held.st_ino == named.st_ino;
  const bool cleared = free && (!same || ::unlink(name.c_str()) == 0);
  const int why = errno;
  ::close(descriptor);
  if (!cleared) {
    errno = why;
    fail(name);
  }
}

/// Where the file will be: the end of symbolic links, so that they stay. A device, a pipe or a
/// folder is refused: renaming over one would destroy it.
std::string target(const std::string& path) {
  if (path.find('\0') != std::string::npos) {
    throw InputError(path, 0, "", "is no path: it holds a zero byte");
  }
  std::error_code none;
  const std::filesystem::file_status status = std::filesystem::status(path, none);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw InputError(path, 0, "",
                     "is not a regular file; allowed: a new file, or a file to replace");
  }
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(path, none))) {
    const std::filesystem::path end = std::filesystem::weakly_canonical(path, none);
    return none ? path : end.string();
  }
  return path;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(target(path)) {
  // A file without a name vanishes with its process, whatever kills it.
  descriptor_ = ::open(folder(path_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {  // not every file system has them
    temporary_ = hidden_name(path_, fmt::format(".{}.partial", ::getpid()));
    descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  }
  if (descriptor_ < 0) {
    const std::string why = reason();
    temporary_.clear();
    throw InputError(path_, 0, "", fmt::format("cannot be created: {}", why));
  }
  buffer_.reserve(buffer_size);
}

AtomicFile::~AtomicFile() {
  ::close(descriptor_);
  if (!temporary_.empty()) {
    ::unlink(temporary_.c_str());
  }
}

void AtomicFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= buffer_size) {
    flush();
  }
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ::ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno != EINTR) {
      fail(path_);
    }
    rest.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

std::size_t AtomicFile::size() {
  flush();
  const ::off_t size = ::lseek(descriptor_, 0, SEEK_END);
  if (size < 0) {
    fail(path_);
  }
  return static_cast<std::size_t>(size);
}

void AtomicFile::read(const std::function<void(std::string_view)>& take) {
  const std::size_t end = size();
  std::vector<char> block(buffer_size);
  for (std::size_t done = 0; done < end;) {
    const ::ssize_t got = ::pread(descriptor_, block.data(), std::min(block.size(), end - done),
                                  static_cast<::off_t>(done));
    if (got == 0 || (got < 0 && errno != EINTR)) {
      fail(path_);
    }
    const auto count = static_cast<std::size_t>(got < 0 ? 0 : got);
    take({block.data(), count});
    done += count;
  }
}

void AtomicFile::restore(const FilePart& part) {
  buffer_.clear();
  if (::ftruncate(descriptor_, 0) != 0 || ::lseek(descriptor_, 0, SEEK_SET) != 0) {
    fail(path_);
  }
  part.file->read(part.begin, part.count, [this](std::string_view block) { write(block); });
}

void AtomicFile::finish() {
  flush();
  // Some file systems cannot be synchronised (EINVAL), which is no failure of theirs.
  if (::fsync(descriptor_) != 0 && errno != EINVAL) {
    fail(path_);
  }
}

void AtomicFile::publish() {
  if (temporary_.empty()) {
    publish_anonymous();
  } else if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    fail(path_);
  }
  temporary_.clear();
}

// The system gives a file without a name a new name only, so that a replacement takes two steps.
// The name between them is the same for every process, and who bears it is locked: what a kill
// between them left is told by its open lock and cleared away; a living writer is waited for.
void AtomicFile::publish_anonymous() {
  const std::string anonymous = fmt::format("/proc/self/fd/{}", descriptor_);
  const std::string name = hidden_name(path_, ".complete");
  ::flock(descriptor_, LOCK_EX);
  while (::linkat(AT_FDCWD, anonymous.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
    if (errno != EEXIST) {
      fail(path_);
    }
    remove_abandoned(name);
  }
  if (std::rename(name.c_str(), path_.c_str()) != 0) {
    const int why = errno;
    ::unlink(name.c_str());
    errno = why;
    fail(path_);
  }
  ::flock(descriptor_, LOCK_UN);
}

void write_file(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.finish();
  file.publish();
}

}  // namespace kairos::experiments
