#include "core/scheme.hpp"

#include "core/archive.hpp"

namespace kairos {
inline namespace core {

void Cost::persist(Archive& archive) {
  archive(frames, steps, right_hand_sides, overlap_tests, toi_queries, toi_evaluations, impacts,
          events);
}

}  // namespace core
}  // namespace kairos
