#include "experiments/checkpoint/checkpoint_file.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/output/fingerprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <system_error>

namespace kairos::experiments {
namespace {

constexpr std::string_view magic = "kairos checkpoint ";
constexpr std::string_view format_version = "9";
constexpr std::size_t checksum_size = 16;
/// Heads that are not damaged are shorter than this.
constexpr std::size_t longest_head = std::size_t{1} << 24;

/// Makes a value one line, as values may contain line breaks.
std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    c = c == '\n' || c == '\r' ? ' ' : c;
  }
  return line;
}

}  // namespace

void write_checkpoint(const std::string& path, const RunIdentity& identity, double time,
                      std::string_view world, std::span<AtomicFile* const> files) {
  AtomicFile file(path);
  Fingerprint sum;
  const auto write = [&](std::string_view text) {
    file.write(text);
    sum.add(text);
  };
  write(fmt::format("{}{}\n", magic, format_version));
  for (const auto& [key, value] : identity) {
    write(fmt::format("{}: {}\n", key, one_line(value)));
  }
  write(fmt::format("\ntime: {}\nbytes: {}\n", time, world.size()));
  for (AtomicFile* written : files) {
    write(fmt::format("file: {}\n", written->size()));
  }
  write("\n");
  write(world);
  for (AtomicFile* written : files) {
    written->read(write);
  }
  file.write(sum.text());
  file.finish();
  file.publish();
}

namespace {

/// The head of a checkpoint, read and understood.
class HeadReader {
 public:
  HeadReader(const std::string& path, const OpenFile& file)
      : path_(path), head_(file.text(0, std::min(file.size(), longest_head))), rest_(head_) {}

  void read(CheckpointFile& checkpoint) {
    if (!rest_.starts_with(magic)) {
      throw InputError(path_, 1, "", "is not a checkpoint of kairos");
    }
    const std::string_view version = line().substr(magic.size());
    if (version != format_version) {
      throw InputError(path_, 1, "",
                       fmt::format("is a checkpoint of format {}; this program reads format {}",
                                   version, format_version));
    }
    checkpoint.identity = block();
    for (const auto& [key, value] : block()) {
      if (key == "time") {
        checkpoint.time = parse_number(value).value_or(-1.0);
      } else {
        sizes_.push_back(size(value));
      }
    }
    if (sizes_.empty() || !(checkpoint.time >= 0.0)) {
      throw damaged("its head is not that of a checkpoint");
    }
  }
  /// Of the world, then of the files.
  [[nodiscard]] const std::vector<std::size_t>& sizes() const { return sizes_; }
  [[nodiscard]] std::size_t bytes() const { return head_.size() - rest_.size(); }

  [[nodiscard]] InputError damaged(const std::string& how) const {
    return {path_, 0, "", "is damaged: " + how};
  }
  [[nodiscard]] InputError cut_off() const {
    return {path_, 0, "", "is cut off: its end is missing"};
  }

 private:
  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) {
      throw cut_off();
    }
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return line;
  }
  RunIdentity block() {
    RunIdentity lines;
    for (std::string_view text = line(); !text.empty(); text = line()) {
      const std::size_t colon = text.find(": ");
      lines.emplace_back(text.substr(0, colon),
                         colon == std::string_view::npos ? "" : text.substr(colon + 2));
    }
    return lines;
  }
  [[nodiscard]] std::size_t size(const std::string& text) const {
    std::size_t n = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, n);
    if (error != std::errc() || stop != end || n > std::size_t{1} << 60) {
      throw damaged("its head is not that of a checkpoint");
    }
    return n;
  }

  const std::string& path_;
  std::string head_;
  std::string_view rest_;
  std::vector<std::size_t> sizes_;
};

}  // namespace

CheckpointFile read_checkpoint(const std::string& path) {
  const auto file = std::make_shared<const OpenFile>(path);
  CheckpointFile checkpoint;
  HeadReader head(path, *file);
  head.read(checkpoint);
  std::size_t end = head.bytes();
  for (const std::size_t size : head.sizes()) {
    checkpoint.files.push_back({file, end, size});
    end += std::min(size, std::size_t{1} << 60);
    if (end + checksum_size > file->size()) {
      throw head.cut_off();
    }
  }
  if (end + checksum_size < file->size()) {
    throw head.damaged("longer than its head says");
  }
  Fingerprint sum;
  file->read(0, end, [&sum](std::string_view block) { sum.add(block); });
  if (sum.text() != file->text(end, checksum_size)) {
    throw head.damaged("its checksum is wrong");
  }
  const FilePart world = checkpoint.files.front();
  checkpoint.files.erase(checkpoint.files.begin());
  checkpoint.world = file->text(world.begin, world.count);
  return checkpoint;
}

void require_same_run(const std::string& path, const RunIdentity& saved,
                      const RunIdentity& wanted) {
  const auto value = [](const RunIdentity& identity, const std::string& key) {
    for (const auto& [k, v] : identity) {
      if (k == key) {
        return one_line(v);
      }
    }
    return std::string("not given");
  };
  for (const RunIdentity* keys : {&wanted, &saved}) {
    for (const auto& [key, unused] : *keys) {
      const std::string then = value(saved, key);
      const std::string now = value(wanted, key);
      if (then != now) {
        throw InputError(path, 0, key,
                         fmt::format("was '{}' in the run that was saved and is '{}' here; a run "
                                     "can only be resumed as what it was",
                                     then, now));
      }
    }
  }
}

}  // namespace kairos::experiments
