#pragma once

#include "experiments/output/atomic_file.hpp"
#include "experiments/output/file_part.hpp"

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// What a run is a run of, as `key, value` lines that a person can read: the scene's text, what was
/// set, the method, the build. Runs of the same identity give the same bytes.
using RunIdentity = std::vector<std::pair<std::string, std::string>>;

/// A checkpoint on disk: a head of text that says what it is of, the world in binary, the files of
/// the run as far as they were written, and a checksum of all that.
struct CheckpointFile {
  RunIdentity identity;
  double time = 0.0;            ///< of the last frame in it, s
  std::string world;            ///< for `Continuation::resume`
  std::vector<FilePart> files;  ///< not in memory
};

/// Replaces the file in one go; `files` are copied in blocks. Throws `RunError`.
void write_checkpoint(const std::string& path, const RunIdentity& identity, double time,
                      std::string_view world, std::span<AtomicFile* const> files);
/// Throws `InputError` where the file is none of ours, of another version, cut off or changed.
[[nodiscard]] CheckpointFile read_checkpoint(const std::string& path);
/// Throws `InputError` with the first thing that differs.
void require_same_run(const std::string& path, const RunIdentity& saved, const RunIdentity& wanted);

}  // namespace kairos::experiments
