#include "experiments/sweeps/sweep_journal.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "experiments/checkpoint/checkpoint_file.hpp"
#include "experiments/checkpoint/run_identity.hpp"
#include "experiments/run_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

namespace kairos::experiments {

// Found by the archive's argument-dependent lookup.
static void persist(Archive& archive, SeriesRecorder::Sample& sample) {
  archive(sample.time, sample.frame, sample.kinetic, sample.potential, sample.gain, sample.lines,
          sample.unexplained);
}
static void persist(Archive& archive, ApexWatch::Apex& apex) { archive(apex.time, apex.height); }

namespace {

constexpr std::size_t checksum_size = 16;  // characters of a fingerprint

void persist_row(Archive& archive, std::size_t& index, RunRecord& record) {
  archive(index, record.status, record.reason, record.metrics, record.samples, record.apexes,
          record.seconds);
}

/// Length, checksum, bytes.
std::string framed(const std::string& bytes) {
  Archive archive;
  std::size_t size = bytes.size();
  archive(size);
  return archive.bytes() + fingerprint(bytes) + bytes;
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

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

}  // namespace

SweepJournal::SweepJournal(std::string path, const std::string& key) : path_(std::move(path)) {
  load(key);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw InputError(path_, 0, "", "cannot be created: " + std::generic_category().message(errno));
  }
  if (found_.empty()) {
    if (::ftruncate(descriptor_, 0) != 0) {
      throw RunError(path_ + ": cannot be written: " + std::generic_category().message(errno));
    }
    append(framed(key));
  }
}

SweepJournal::~SweepJournal() { ::close(descriptor_); }

void SweepJournal::load(const std::string& key) {
  const std::string bytes = text_of(path_);
  std::string_view text = bytes;
  if (next_record(text) != key) {
    return;
  }
  std::string_view whole = text;
  for (std::string_view record = next_record(text); !record.empty(); record = next_record(text)) {
    Archive archive(record);
    std::size_t index = 0;
    RunRecord row;
    persist_row(archive, index, row);
    found_[index] = std::move(row);
    whole = text;
  }
  // A record that was cut short must not hide those that follow.
  if (::truncate(path_.c_str(), static_cast<::off_t>(bytes.size() - whole.size())) != 0) {
    throw RunError(path_ + ": cannot be written: " + std::generic_category().message(errno));
  }
}

void SweepJournal::add(std::size_t index, RunRecord& record) {
  Archive archive;
  persist_row(archive, index, record);
  const std::lock_guard lock(mutex_);
  append(framed(archive.bytes()));
}

void SweepJournal::append(const std::string& bytes) {
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ::ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno != EINTR) {
      throw RunError(path_ + ": cannot be written: " + std::generic_category().message(errno));
    }
    rest.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
  }
}

std::string sweep_key(const SweepSpec& spec, const std::vector<PlannedRun>& plan,
                      const std::string& scene) {
  std::string key = fmt::format("{} {} {} {} {} {}\n", spec.name, spec.subject, spec.series,
                                spec.samples, fmt::join(spec.metrics, " "), plan.size());
  struct stat program {};
  if (::stat("/proc/self/exe", &program) == 0) {
    key +=
        fmt::format("{} {}.{}\n", program.st_size, program.st_mtim.tv_sec, program.st_mtim.tv_nsec);
  }
  key += text_of(scene);
  for (const PlannedRun& run : plan) {
    key += fmt::format("{} {} {}\n", run.index, run.method, run.refused);
    for (const Override& o : run.overrides) {
      key += fmt::format("{}={}\n", o.key, o.value);
    }
    for (const auto& [name, value] : method_identity(run.choice)) {
      key += fmt::format("{}={}\n", name, value);
    }
    key += fmt::format("{}\n", run.choice.duration.value_or(0.0));
  }
  return "kairos sweep 1 " + fingerprint(key);
}

}  // namespace kairos::experiments
