#pragma once

#include "ccd/image_boxes.hpp"
#include "core/model.hpp"
#include "core/neighbourhood.hpp"

#include <memory>
#include <vector>

namespace kairos::ccd {

/// A broad phase of boxes as a neighbourhood: each body opens a window as long as it takes it to go
/// some way, its *reach*, and is near all whose swept boxes overlap its own, images included.
/// Reaches adapt: windows grow where few are near and shrink where many are. What does not move
/// freely has one window for its whole motion.
class SweptWindows final : public Neighbourhood {
 public:
  /// `tolerance` as in `NeighbourhoodFactory`.
  SweptWindows(const Model& model, std::unique_ptr<BroadPhase> boxes, double tolerance);

  Instant enter(BodyIndex i, const MovingShape& moving, Instant t, Instant until) override;
  void near(BodyIndex i, std::vector<Neighbour>& out) override;
  Instant cross(BodyIndex i, const MovingShape& moving, Instant t, Instant until,
                std::vector<Neighbour>& out) override;
  void go_on_as(BodyIndex i, const Image& n) override;
  void persist(Archive& archive) override;

  /// Body i is somewhere else.
  void leave(BodyIndex i);

  /// Whether body i is here.
  [[nodiscard]] bool is_known(BodyIndex i) const { return watched_[i] && watched_[i]->known; }
  /// What i, which is here, sweeps during its window, rounding and tolerance included.
  [[nodiscard]] const Aabb& swept(BodyIndex i) const { return watched_[i]->swept; }
  [[nodiscard]] ImageBoxes& boxes() { return boxes_; }

 private:
  struct Watched {
    double reach = 0.0;  ///< how far it goes before its neighbours are looked up again, m
    double least_reach = 0.0;
    Aabb swept{};
    bool known = false;

    void persist(Archive& archive);
  };

  [[nodiscard]] Watched& watch(BodyIndex i);
  [[nodiscard]] double window_length(BodyIndex i, const MovingShape& moving, Instant t);

  const Model& model_;
  ImageBoxes boxes_;
  double tolerance_;
  double longest_reach_;  ///< m: half a period, so that a box is near few images
  std::vector<std::unique_ptr<Watched>> watched_;  ///< by body; null: it has not been here
};

}  // namespace kairos::ccd
