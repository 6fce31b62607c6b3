#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"

#include <vector>

namespace kairos::experiments {

/// Did a free body get to the other side of a solid that should have stopped it? Decided from the
/// geometry of the drawn frames alone, so that every scheme is judged by the same measure: the
/// side is that of the body's centre with respect to the middle of a box across its thinnest edge,
/// in the box's own frame (so that a moving bat is judged as a resting wall is), or above and below
/// a half-space. It changes when the centre passes within the box's face, widened by the body's
/// size, between two frames. Tunnelled: the last side is not the first.
class CrossingWatch {
 public:
  explicit CrossingWatch(const Model& model);
  void frame(const Frame& frame);

  [[nodiscard]] bool tunnelled() const;
  /// How often a centre passed through a solid, both ways together.
  [[nodiscard]] std::int64_t crossings() const;

 private:
  struct Gate {
    BodyIndex body = 0;
    BodyIndex solid = 0;
    int axis = 1;  ///< of the solid's frame
    bool half_space = false;
    Vector3 reach = Vector3::Zero();  ///< half-extents of the face plus the body's radius, m
    Vector3 last = Vector3::Zero();   ///< centre in the solid's frame, last frame
    std::int64_t crossings = 0;
  };
  [[nodiscard]] static bool passes(const Gate& gate, const Vector3& now);

  std::vector<Gate> gates_;
  bool drawn_ = false;
};

}  // namespace kairos::experiments
