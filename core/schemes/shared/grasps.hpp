#pragma once

#include "core/model.hpp"

#include <optional>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {

class Archive;

/// What a hand is doing with the body that it can hold (7.5).
enum class Grasp {
  open,
  holding,  ///< closed: the body is where the hand is, with the hand's velocity (our reading)
  leaving,  ///< let go of, and not yet clear of the hand
};
constexpr Grasp last_of(Grasp) { return Grasp::leaving; }

/// One `Grasp` for each grip of the model, by its index. While it is not `open`, the held body has
/// no contacts and feels no field.
class Grasps {
 public:
  explicit Grasps(const Model& model)
      : model_(model), grasps_(model.grips().size(), Grasp::open), in_hand_(model.size(), 0) {}

  [[nodiscard]] Grasp of(std::size_t grip) const { return grasps_[grip]; }
  void set(std::size_t grip, Grasp grasp) {
    grasps_[grip] = grasp;
    in_hand_[model_.grips()[grip].held] = grasp == Grasp::open ? 0 : 1;
  }
  [[nodiscard]] bool involve(BodyIndex a, BodyIndex b) const {
    return in_hand_[a] != 0 || in_hand_[b] != 0;
  }
  /// By body: 1 where it has no contacts.
  [[nodiscard]] std::span<const char> in_hand() const { return in_hand_; }
  /// The grip in which one of the two is the hand and the other leaves it, if there is one.
  [[nodiscard]] std::optional<std::size_t> leaving(BodyIndex a, BodyIndex b) const;

  void persist(Archive& archive);

 private:
  const Model& model_;
  std::vector<Grasp> grasps_;
  std::vector<char> in_hand_;
};

}  // namespace core
}  // namespace kairos
