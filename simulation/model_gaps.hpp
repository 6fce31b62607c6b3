#pragma once

#include "core/gap_function.hpp"
#include "core/model.hpp"

#include <string>
#include <vector>

namespace kairos {
inline namespace simulation {

/// The gaps of one island of a model: of its bodies with each other and with what is fixed or
/// driven. Refers to the model.
class ModelGaps final : public GapFunction {
 public:
  ModelGaps(const Model& model, std::size_t island);
  [[nodiscard]] std::size_t size() const override { return pairs_.size(); }
  void evaluate(Instant t, std::span<const BodyState> states,
                std::span<double> gaps) const override;

 private:
  [[nodiscard]] Pose pose(BodyIndex i, Instant t, std::span<const BodyState> states) const;

  const Model& model_;
  std::vector<BodyPair> pairs_;
  std::vector<std::size_t> place_;  ///< in the island, of each body
};

/// A pair that no island sees, as a reason to refuse; empty if there is none.
[[nodiscard]] std::string pair_across_islands(const Model& model);

}  // namespace simulation
}  // namespace kairos
