#include "experiments/output/output_folder.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <system_error>

namespace kairos::experiments {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const fs::path& path) : path_(path) {
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
}

OutputFolder::~OutputFolder() {
  files_.clear();
  std::error_code ignored;  // a folder that others have filled meanwhile stays
  for (const fs::path& path : made_) {
    fs::remove(path, ignored);
  }
}

AtomicFile& OutputFolder::file(std::string_view name) {
  files_.push_back(std::make_unique<AtomicFile>((path_ / name).string()));
  return *files_.back();
}

void OutputFolder::publish() {
  for (const auto& file : files_) {
    file->finish();
  }
  for (const auto& file : files_) {
    file->publish();
  }
  made_.clear();
}

}  // namespace kairos::experiments
