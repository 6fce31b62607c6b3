#include "experiments/output/record_journal.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "experiments/output/file_part.hpp"
#include "experiments/output/fingerprint.hpp"
#include "experiments/run_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

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

/// Takes the next whole record off the text; empty where the rest is none.
std::string_view next_record(std::string_view& text) {
  std::size_t size = 0;
  if (text.size() < sizeof size + checksum_size) {
    return {};
  }
  std::memcpy(&size, text.data(), sizeof size);
  const std::string_view checksum = text.substr(sizeof size, checksum_size);
  const std::string_view rest = text.substr(sizeof size + checksum_size);
  if (size == 0 || rest.size() < size || fingerprint(rest.substr(0, size)) != checksum) {
    return {};
  }
  text = rest.substr(size);
  return rest.substr(0, size);
}

std::string error_text() { return std::generic_category().message(errno); }

}  // namespace

RecordJournal::RecordJournal(std::string path, const std::string& key) : path_(std::move(path)) {
  load(key);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw InputError(path_, 0, "", "cannot be created: " + error_text());
  }
  if (found_.empty()) {
    if (::ftruncate(descriptor_, 0) != 0) {
      throw RunError(path_ + ": cannot be written: " + error_text());
    }
    append(framed(key));
  }
}

RecordJournal::~RecordJournal() { ::close(descriptor_); }

void RecordJournal::load(const std::string& key) {
  std::error_code none;
  if (!std::filesystem::exists(path_, none)) {
    return;
  }
  std::string bytes;
  {
    const OpenFile file(path_);
    bytes = file.text(0, file.size());
  }
  std::string_view text = bytes;
  if (next_record(text) != key) {
    return;
  }
  for (std::string_view record = next_record(text); !record.empty(); record = next_record(text)) {
    found_.emplace_back(record);
  }
  // A record that was cut short must not hide those that follow.
  if (::truncate(path_.c_str(), static_cast<::off_t>(bytes.size() - text.size())) != 0) {
    throw RunError(path_ + ": cannot be written: " + error_text());
  }
}

void RecordJournal::add(std::string_view record) {
  const std::lock_guard lock(mutex_);
  append(framed(record));
}

void RecordJournal::append(const std::string& bytes) {
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ::ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno != EINTR) {
      throw RunError(path_ + ": cannot be written: " + error_text());
    }
    rest.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
  }
}

std::string program_identity() {
  struct stat program {};
  if (::stat("/proc/self/exe", &program) != 0) {
    return {};
  }
  return fmt::format("{} {}.{}", program.st_size, program.st_mtim.tv_sec, program.st_mtim.tv_nsec);
}

}  // namespace kairos::experiments
