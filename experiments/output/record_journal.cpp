#include "experiments/output/record_journal.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "experiments/output/fingerprint.hpp"
#include "experiments/run_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace kairos::experiments {
namespace {

constexpr std::size_t checksum_size = 16;  // characters of a fingerprint

/// Length, checksum, bytes.
std::string framed(std::string_view bytes) {
  Archive archive;
  std::size_t size = bytes.size();
  archive(size);
  return archive.bytes() + fingerprint(bytes) + std::string(bytes);
}

std::string error_text() { return std::generic_category().message(errno); }

}  // namespace

bool RecordFile::read(std::size_t place, std::string& record, std::size_t& end) const {
  constexpr std::size_t head_size = sizeof(std::size_t) + checksum_size;
  const std::size_t left = file_.size() - std::min(place, file_.size());
  if (left < head_size) {
    return false;
  }
  const std::string head = file_.text(place, head_size);
  std::size_t size = 0;
  std::memcpy(&size, head.data(), sizeof size);
  if (size == 0 || left - head_size < size) {
    return false;
  }
  record = file_.text(place + head_size, size);
  end = place + head_size + size;
  return std::string_view(head).substr(sizeof size) == fingerprint(record);
}

std::string RecordFile::key() const {
  std::string key;
  std::size_t end = 0;
  return read(0, key, end) ? key : std::string();
}

std::size_t RecordFile::scan(const std::function<void(std::size_t, std::string_view)>& take) const {
  std::string record;
  std::size_t end = 0;
  if (!read(0, record, end)) {
    return 0;
  }
  for (std::size_t place = end; read(place, record, end); place = end) {
    take(place, record);
  }
  return end;
}

std::string RecordFile::at(std::size_t place) const {
  std::string record;
  std::size_t end = 0;
  if (!read(place, record, end)) {
    throw InputError(path_, 0, "", fmt::format("has no whole record at byte {}", place));
  }
  return record;
}

RecordJournal::RecordJournal(std::string path, const std::string& key,
                             const std::function<void(std::size_t, std::string_view)>& take)
    : path_(std::move(path)) {
  load(key, take);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw InputError(path_, 0, "", "cannot be created: " + error_text());
  }
  if (end_ == 0) {
    if (::ftruncate(descriptor_, 0) != 0) {
      throw RunError(path_ + ": cannot be written: " + error_text());
    }
    append(framed(key));
  }
}

RecordJournal::~RecordJournal() { ::close(descriptor_); }

void RecordJournal::load(const std::string& key,
                         const std::function<void(std::size_t, std::string_view)>& take) {
  std::error_code none;
  if (!std::filesystem::exists(path_, none)) {
    return;
  }
  {
    const RecordFile file(path_);
    if (file.key() != key) {
      return;
    }
    end_ = file.scan(take ? take : [](std::size_t, std::string_view) {});
  }
  // A record that was cut short must not hide those that follow.
  if (::truncate(path_.c_str(), static_cast<::off_t>(end_)) != 0) {
    throw RunError(path_ + ": cannot be written: " + error_text());
  }
}

std::size_t RecordJournal::add(std::string_view record) {
  const std::lock_guard lock(mutex_);
  return append(framed(record));
}

std::size_t RecordJournal::append(const std::string& bytes) {
  const std::size_t place = end_;
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ::ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno != EINTR) {
      throw RunError(path_ + ": cannot be written: " + error_text());
    }
    rest.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
  }
  end_ += bytes.size();
  return place;
}

std::string program_identity() {
  struct stat program {};
  if (::stat("/proc/self/exe", &program) != 0) {
    return {};
  }
  return fmt::format("{} {}.{}", program.st_size, program.st_mtim.tv_sec, program.st_mtim.tv_nsec);
}

std::string program_fingerprint() {
  static const std::string once = [] {
    const OpenFile program("/proc/self/exe");
    Fingerprint sum;
    program.read(0, program.size(), [&sum](std::string_view block) { sum.add(block); });
    return sum.text();
  }();
  return once;
}

}  // namespace kairos::experiments
