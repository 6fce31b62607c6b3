#include "experiments/checkpoint/file_keeper.hpp"

namespace kairos::experiments {

bool FileKeeper::wants(Instant /*t*/, bool last) {
  return last || Clock::now() - since_ >= interval_;
}

void FileKeeper::keep(Instant t, std::string_view world) {
  const Clock::time_point start = Clock::now();
  write_checkpoint(path_, identity_, t.seconds, world, files_);
  kept_ = true;
  since_ = Clock::now();
  // Large worlds are kept less often: at most a tenth of the time goes into it.
  constexpr double share = 10.0;
  const std::chrono::duration<double> took = since_ - start;
  interval_ = interval_.count() > 0.0 ? std::max(interval_, share * took) : interval_;
}

}  // namespace kairos::experiments
