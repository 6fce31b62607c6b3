#include "experiments/checkpoint/checkpoint_file.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "experiments/output/atomic_file.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>

namespace kairos::experiments {
namespace {

constexpr std::string_view magic = "kairos checkpoint ";
constexpr std::string_view format_version = "1";

std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) {
    throw InputError(path, 0, "", "cannot be read");
  }
  return std::move(text).str();
}

/// Takes the next line off the text; nullopt where none ends.
std::optional<std::string_view> next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

/// Values may hold anything: a line each, without line breaks.
std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    c = c == '\n' || c == '\r' ? ' ' : c;
  }
  return line;
}

}  // namespace

void write_checkpoint(const std::string& path, const RunIdentity& identity, double time,
                      std::string_view world) {
  AtomicFile file(path);
  file.write(fmt::format("{}{}\n", magic, format_version));
  for (const auto& [key, value] : identity) {
    file.write(fmt::format("{}: {}\n", key, one_line(value)));
  }
  file.write(fmt::format("\ntime: {}\nbytes: {}\nchecksum: {}\n\n", time, world.size(),
                         fingerprint(world)));
  file.write(world);
  file.finish();
  file.publish();
}

CheckpointFile read_checkpoint(const std::string& path) {
  const std::string bytes = read_bytes(path);
  std::string_view text = bytes;
  if (!text.starts_with(magic)) {
    throw InputError(path, 1, "", "is not a checkpoint of kairos");
  }
  const auto cut_off = [&path]() {
    return InputError(path, 0, "", "is cut off: its end is missing");
  };
  const auto head = next_line(text);
  if (!head) {
    throw cut_off();
  }
  if (head->substr(magic.size()) != format_version) {
    throw InputError(path, 1, "",
                     fmt::format("is a checkpoint of format {}; this program reads format {}",
                                 head->substr(magic.size()), format_version));
  }
  CheckpointFile file;
  RunIdentity size;
  for (RunIdentity* block : {&file.identity, &size}) {
    for (auto line = next_line(text);; line = next_line(text)) {
      if (!line) {
        throw cut_off();
      }
      if (line->empty()) {
        break;
      }
      const std::size_t colon = line->find(": ");
      block->emplace_back(line->substr(0, colon),
                          colon == std::string_view::npos ? "" : line->substr(colon + 2));
    }
  }
  if (size.size() != 3) {
    throw InputError(path, 0, "", "is damaged: its head is not that of a checkpoint");
  }
  file.time = parse_number(size[0].second).value_or(-1.0);
  if (fmt::format("{}", text.size()) != size[1].second) {
    throw text.size() < static_cast<std::size_t>(parse_number(size[1].second).value_or(0.0))
        ? cut_off()
        : InputError(path, 0, "", "is damaged: longer than its head says");
  }
  if (file.time < 0.0 || fingerprint(text) != size[2].second) {
    throw InputError(path, 0, "", "is damaged: its checksum is wrong");
  }
  file.world = text;
  return file;
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
