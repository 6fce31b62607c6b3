#pragma once

#include "core/broad_phase.hpp"
#include "core/model.hpp"
#include "core/neighbourhood.hpp"

#include <memory>
#include <vector>

namespace kairos::ccd {

/// A broad phase of boxes that finds images: each box is kept where its middle is within the
/// periodic box, and looked for in as many neighbouring boxes as it takes. Without a periodic box
/// it is the broad phase itself. Half-spaces are the same in all images: they have one.
class ImageBoxes {
 public:
  /// Images as in the model's periodic box, if it has one; `boxes` finds what overlaps.
  ImageBoxes(const Model& model, std::unique_ptr<BroadPhase> boxes);

  /// The box of body i from now on, world frame, m.
  void update(BodyIndex i, const Aabb& box);
  /// Body i is not found any longer.
  void remove(BodyIndex i) { boxes_->remove(i); }
  /// Every image of another body that could overlap `box`, that of body i, appended.
  void near(BodyIndex i, const Aabb& box, std::vector<Neighbour>& out);
  /// The same for a box that is nobody's.
  void overlapping(const Aabb& box, std::vector<Neighbour>& out);

 private:
  struct Kept {
    Aabb box;
    Image image{};  ///< of the box as it was told
  };

  /// Which image of a box has its middle within the periodic box.
  [[nodiscard]] Image home(const Aabb& box) const;
  [[nodiscard]] Aabb moved(const Aabb& box, const Image& n) const;
  void look(const Aabb& box, const Image& at, const Image& of_box, std::vector<Neighbour>& out);

  const Model& model_;
  const PeriodicBox* periodic_;
  std::unique_ptr<BroadPhase> boxes_;
  std::vector<Kept> kept_;              ///< by body; empty where no box is periodic
  Vector3 greatest_ = Vector3::Zero();  ///< half extents of a box so far, m
  std::vector<BodyIndex> found_;        ///< scratch
};

}  // namespace kairos::ccd
