#include "core/schemes/frame/frame_joints.hpp"

#include <fmt/format.h>

namespace kairos {
inline namespace core {

std::string why_not_jointed(const Model& model) {
  if (model.scene().joints.empty()) {
    return {};
  }
  const auto hangs = [&model](BodyIndex i) {
    return model.is_free(i) && model.islands()[model.island_of(i)].joints != nullptr;
  };
  for (const auto& [a, b] : model.pairs()) {
    if (model.interacts(a, b) && !model.is_field(a) && !model.is_field(b) &&
        (hangs(a) || hangs(b))) {
      return fmt::format(
          "'{}' and '{}' may meet, and of these at least one hangs on joints, which "
          "pass impacts on under event-driven only",
          model.body(a).name, model.body(b).name);
    }
  }
  return {};
}

}  // namespace core
}  // namespace kairos
