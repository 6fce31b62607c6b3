#include "core/scheme.hpp"

#include "core/archive.hpp"

namespace kairos {
inline namespace core {

void Cost::persist(Archive& archive) {
  archive(frames, steps, right_hand_sides, overlap_tests, toi_queries, toi_evaluations,
          contact_solves, impacts, events);
  // Counting goes on from here and must not overflow.
  constexpr std::int64_t most = std::int64_t{1} << 62;
  for (const std::int64_t n : {frames, steps, right_hand_sides, overlap_tests, toi_queries,
                               toi_evaluations, contact_solves, impacts, events}) {
    archive.require(n >= 0 && n < most);
  }
}

}  // namespace core
}  // namespace kairos
