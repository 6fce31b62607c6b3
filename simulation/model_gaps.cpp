#include "simulation/model_gaps.hpp"

#include "ccd/pair_overlap.hpp"

#include <fmt/format.h>

namespace kairos {
inline namespace simulation {

ModelGaps::ModelGaps(const Model& model, std::size_t island)
    : model_(model), place_(model.size(), 0) {
  const auto inside = [&](BodyIndex i) { return model.is_free(i) && model.island_of(i) == island; };
  for (const auto& [a, b] : model.pairs()) {
    const bool seen =
        (inside(a) && (inside(b) || !model.is_free(b))) || (inside(b) && !model.is_free(a));
    if (seen && model.interacts(a, b)) {
      pairs_.emplace_back(a, b);
    }
  }
  const std::vector<BodyIndex>& bodies = model.islands()[island].bodies;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    place_[bodies[k]] = k;
  }
}

Pose ModelGaps::pose(BodyIndex i, Instant t, std::span<const BodyState> states) const {
  if (model_.is_free(i)) {
    return states[place_[i]].pose;
  }
  const Body& body = model_.body(i);
  return body.drive != nullptr ? body.drive->motion(t, 1.0).pose(0.0) : body.initial.pose;
}

void ModelGaps::evaluate(Instant t, std::span<const BodyState> states,
                         std::span<double> gaps) const {
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const auto& [a, b] = pairs_[k];
    gaps[k] = ccd::measure_overlap(model_.shape(a), pose(a, t, states), model_.shape(b),
                                   pose(b, t, states))
                  .gap;
  }
}

std::string pair_across_islands(const Model& model) {
  for (const auto& [a, b] : model.pairs()) {
    if (model.interacts(a, b) && model.is_free(a) && model.is_free(b) &&
        model.island_of(a) != model.island_of(b)) {
      return fmt::format("'{}' and '{}' are integrated by themselves, and no solver sees both",
                         model.body(a).name, model.body(b).name);
    }
  }
  return {};
}

}  // namespace simulation
}  // namespace kairos
