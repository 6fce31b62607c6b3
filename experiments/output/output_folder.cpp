#include "experiments/output/output_folder.hpp"

#include "core/error.hpp"
#include "experiments/run_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace kairos::experiments {

namespace fs = std::filesystem;

namespace {

/// This file exists while files get their names.
constexpr const char* publishing = ".publishing";

std::string reason() { return std::generic_category().message(errno); }

bool starts_with(const fs::path& file, const std::string& begins) {
  std::ifstream in(file, std::ios::binary);
  std::string head(begins.size(), '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  return in.gcount() == static_cast<std::streamsize>(head.size()) && head == begins;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path, OutputSet set)
    : path_(path), set_(std::move(set)) {
  if (path.empty()) {
    throw InputError("", 0, "--out", "is empty; allowed: the name of a folder");
  }
  std::error_code error;
  for (fs::path p = path; !p.empty() && !fs::exists(p, error); p = p.parent_path()) {
    if (p.has_filename()) {
      made_.push_back(p);
    }
  }
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path, error)) {
    throw InputError(path.string(), 0, "--out",
                     fmt::format("is not a folder and cannot be made one: {}",
                                 error ? error.message() : "something else has its name"));
  }
  take();
  ours_ = set_.replace || is_ours();
}

void OutputFolder::take() {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) {
    throw InputError(path_.string(), 0, "--out", "cannot be opened: " + reason());
  }
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(descriptor_);
    throw InputError(path_.string(), 0, "--out",
                     "is being written by another run; allowed: a folder of its own, or the same "
                     "one when that has ended");
  }
  // The former owner may have removed the file between the opening and the lock.
  struct stat locked {};
  struct stat named {};
  if (::fstat(descriptor_, &locked) != 0 || ::stat(path_.c_str(), &named) != 0 ||
      locked.st_ino != named.st_ino || locked.st_dev != named.st_dev) {
    ::close(descriptor_);
    throw InputError(path_.string(), 0, "--out", "was removed by another run just now; try again");
  }
}

OutputFolder::~OutputFolder() {
  files_.clear();
  std::error_code ignored;  // a folder that others have filled meanwhile stays
  for (const fs::path& path : made_) {
    fs::remove(path, ignored);
  }
  ::close(descriptor_);
}

bool OutputFolder::is_ours() const {
  return incomplete(path_) || (!set_.seal.empty() && !set_.begins.empty() &&
                               starts_with(path_ / set_.seal, set_.begins));
}

void OutputFolder::claim(std::string_view name) const {
  // Names are checked where they are read; this is the second check.
  if (name.empty() || name == "." || name == ".." ||
      name.find_first_of(std::string_view("/\0", 2)) != std::string_view::npos) {
    throw InputError(path_.string(), 0, "--out",
                     fmt::format("'{}' is no name of a file in it", name));
  }
  std::error_code none;
  if (!ours_ && fs::exists(fs::symlink_status(path_ / name, none))) {
    throw InputError(path_.string(), 0, "--out",
                     fmt::format("holds {}, which is not of an earlier run of this kind; allowed: "
                                 "another folder, or --force to replace it",
                                 name));
  }
}

AtomicFile& OutputFolder::file(std::string_view name) {
  claim(name);
  auto file = std::make_unique<AtomicFile>((path_ / name).string());
  for (const auto& other : files_) {
    if (other->path() == file->path()) {
      throw InputError(path_.string(), 0, "--out", fmt::format("would hold {} twice", name));
    }
  }
  // The seal stays last.
  const bool sealed = !files_.empty() && sealed_;
  sealed_ = sealed_ || name == set_.seal;
  return **files_.insert(sealed ? files_.end() - 1 : files_.end(), std::move(file));
}

void OutputFolder::publish() {
  for (const auto& file : files_) {
    file->finish();
  }
  if (files_.size() > 1) {
    const std::string mark = (path_ / publishing).string();
    const int made = ::open(mark.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (made < 0) {
      throw RunError(mark + ": cannot be written: " + reason());
    }
    ::close(made);
    if (sealed_) {
      ::unlink(files_.back()->path().c_str());
    }
    ::fsync(descriptor_);  // the disk, too, learns it in this order
  }
  for (const auto& file : files_) {
    if (file == files_.back()) {
      ::fsync(descriptor_);
    }
    file->publish();
  }
  std::error_code ignored;
  fs::remove(path_ / publishing, ignored);
  made_.clear();
}

bool incomplete(const fs::path& folder) {
  std::error_code none;
  return fs::exists(folder / publishing, none);
}

}  // namespace kairos::experiments
