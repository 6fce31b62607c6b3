#pragma once

#include "core/contact_detector.hpp"
#include "experiments/toi/line_blocks.hpp"

#include <cstdint>
#include <memory>

namespace kairos::experiments {

struct ToiStreamOptions {
  std::shared_ptr<const ContactDetector> detector;
  double tolerance = 0.0;   ///< m; 0: the detector's default
  bool keep_going = false;  ///< answer a bad row with the status `invalid` instead of stopping
  std::size_t threads = 0;  ///< 0: one per core
};

/// Answers a file of queries on stdout, row by row and in order, in constant memory, on several
/// threads; the answers do not depend on their number. Bad rows are named on stderr with their
/// line. Returns how many there were; without `keep_going` the first one throws `InputError` after
/// the answers before it are written.
std::int64_t answer_toi_queries(LineBlocks& queries, const ToiStreamOptions& options);

}  // namespace kairos::experiments
