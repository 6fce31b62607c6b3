#pragma once

#include "core/contact_detector.hpp"
#include "core/recorder.hpp"
#include "core/scene.hpp"
#include "experiments/rally/recording.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace kairos::experiments {

/// What the bat of a rally is: the scene's box, or a blade with a handle as one of its bounds.
struct RallyBat {
  const char* name;
  bool mesh;
  Bounds bounds;
};
inline constexpr std::array<RallyBat, 4> rally_bats{{{"the scene's box", false, Bounds::shape},
                                                     {"mesh, its box", true, Bounds::obb},
                                                     {"mesh, its hull", true, Bounds::hull},
                                                     {"mesh, itself", true, Bounds::shape}}};

/// The blade with a handle, meshes/bat.off of the scenes, as a solid. Throws as `read_mesh` does.
[[nodiscard]] Shape bat_mesh();
/// The scene's bat is this one, driven by the recording.
void take_bat(Scene& scene, const RallyRecording& rally, const Shape& mesh, Bounds bounds);

/// Watches bat and ball while no hand holds the ball.
class BatWatch : public Recorder {
 public:
  /// `mesh`: the bat that players see, whatever theirs collides as.
  explicit BatWatch(Shape mesh);
  void begin(const Model& model) override;
  void event(const Event& event) override;
  void frame(const Frame& frame) override;

  std::int64_t hits = 0;     ///< impacts
  std::int64_t inside = 0;   ///< frames with the ball in the bat, whatever that collides as
  std::int64_t passed = 0;   ///< frames between which it went through the blade without an impact
  std::int64_t early = 0;    ///< impacts farther than 0.1 mm from the bat that players see
  double farthest = 0.0;     ///< from that bat at an impact, m
  double sum_of_gaps = 0.0;  ///< over all impacts, m

 private:
  BodyIndex bat_ = 0;
  BodyIndex ball_ = 0;
  Shape seen_bat_;
  Shape shape_ = Sphere{1.0};
  Shape ball_shape_ = Sphere{1.0};
  Shape inner_ball_ = Sphere{1.0};  ///< a ball that touches is not inside
  std::shared_ptr<const ContactDetector> detector_;
  Vector3 last_ = Vector3::Zero();
  bool held_ = true;
  bool seen_ = false;
  bool hit_ = false;
};

}  // namespace kairos::experiments
