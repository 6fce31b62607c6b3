#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"

#include <vector>

namespace kairos::experiments {

/// Did a free body get to the other side of a solid that should have stopped it? Decided from the
/// geometry of the drawn frames alone, so that every scheme is judged by the same measure. A body
/// is on one side of a box when it is clear of it along its thinnest edge, in the box's own frame
/// (so that a moving bat is judged as a resting wall is); of a half-space, when it is wholly above
/// or below. It has crossed when it becomes clear on the other side, its centre having passed
/// within the box's face, widened by the body's size. Tunnelled: an odd number of crossings.
class CrossingWatch {
 public:
  /// Every free body and every solid that it may meet.
  explicit CrossingWatch(const Model& model);
  /// One body and one solid, whose face is not widened: a ball that brushes past its edge has not
  /// gone through.
  CrossingWatch(const Model& model, BodyIndex body, BodyIndex solid) {
    add(model, body, solid, 0.0);
  }
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
    Vector3 normal_B = Vector3::Zero();  ///< of a half-space, seen as along its y
    double clear = 0.0;                  ///< from here on along the axis it is clear, m
    Vector3 face = Vector3::Zero();      ///< half-extents of the face, widened, m
    Vector3 last = Vector3::Zero();      ///< centre in the solid's frame, last frame
    bool within_face = false;            ///< where the centre last changed sides
    int side = 0;  ///< on which the body was last clear: -1, 1; 0: nowhere yet
    std::int64_t crossings = 0;
  };
  void add(const Model& model, BodyIndex body, BodyIndex solid, double widening);
  [[nodiscard]] static bool within_face(const Gate& gate, const Vector3& now);
  static void look(Gate& gate, const Vector3& now);

  std::vector<Gate> gates_;
};

}  // namespace kairos::experiments
