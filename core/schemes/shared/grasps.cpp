#include "core/schemes/shared/grasps.hpp"

#include "core/archive.hpp"

namespace kairos {
inline namespace core {

std::optional<std::size_t> Grasps::leaving(BodyIndex a, BodyIndex b) const {
  for (std::size_t k = 0; k < grasps_.size(); ++k) {
    const auto [hand, held] = model_.grips()[k];
    if (grasps_[k] == Grasp::leaving && ((hand == a && held == b) || (hand == b && held == a))) {
      return k;
    }
  }
  return std::nullopt;
}

void Grasps::persist(Archive& archive) { archive(grasps_, in_hand_); }

}  // namespace core
}  // namespace kairos
