#pragma once

#include "core/force.hpp"
#include "core/model.hpp"
#include "core/motion.hpp"

#include <functional>
#include <optional>
#include <span>

namespace kairos {
inline namespace core {

class Archive;

/// A ball that rests or slides on one face of a body that it cannot move.
struct Support {
  BodyIndex surface = 0;
  Vector3 normal = Vector3::Zero();  ///< of the face, unit, from the surface to the ball, world
  double height = 0.0;  ///< of the ball's centre over the surface's origin when it was met, m

  void persist(Archive& archive);
};

/// The face on which `ball` could be supported where it touches `surface` with this normal (from
/// the surface to the ball), if there is one: the surface is a half-space or a box that does not
/// turn, the normal is that of a face, and the ball's centre is above the face.
[[nodiscard]] std::optional<Support> find_support(const Model& model, BodyIndex ball,
                                                  const Vector3& centre, BodyIndex surface,
                                                  const Motion& surface_motion, double s,
                                                  const Vector3& normal);

/// When a point passes the rim of the face of `surface` with this normal (either way; world), that
/// is touched at `at` (world, m), within `duration` from both motions' common start, s; infinite
/// if it does not, 0 if it is beyond already or there is no such face. A face of a mesh is all its
/// triangles in one plane, of a compound all faces of its parts in one plane, whether they hang
/// together or not. The surface does not turn.
[[nodiscard]] double face_exit_time(const Shape& surface, const Motion& surface_motion,
                                    const Motion& point, const Vector3& normal, const Vector3& at,
                                    double duration);

/// When a point leaves the convex outline of these points (world, at the start of the motion) on a
/// plane with this normal, which goes with a body that does not turn, s; as `face_exit_time`.
[[nodiscard]] double outline_exit_time(std::span<const Vector3> outline, const Vector3& normal,
                                       const Motion& motion, const Motion& point, double duration);

/// When a driven surface draws away faster than the force on the ball (N) can follow: the first
/// zero of the contact force m a_s.n - F.n, local to the surface's motion, s; infinite if none.
[[nodiscard]] double lift_off_time(const Motion& surface_motion, const Vector3& normal, double mass,
                                   const Vector3& force);

/// First time in [0, duration] at which the x of a polynomial is positive, s, to the resolution of
/// the duration; infinite if it is nowhere.
[[nodiscard]] double first_positive(const Polynomial<3>& f, double duration);

/// When a surface first stops pressing, s: the first change of sign of the contact force (N, at a
/// local time) within `duration`, among 32 samples; infinite if it presses at all of them.
[[nodiscard]] double release_time(const std::function<double(double)>& contact_force,
                                  double duration);

/// Lets a motion along a surface ride with it: along the normal it moves as the surface does. Both
/// motions start together; the surface does not turn.
[[nodiscard]] Motion ride(const Motion& along, const Motion& surface_motion, const Vector3& normal);

/// Cancels the part of the forces on a ball that presses it against the surface. Must be the last
/// force of its island.
class SupportForce final : public Force {
 public:
  explicit SupportForce(const Vector3& normal) : normal_(normal) {}
  void add(Instant t, std::span<const BodyState> bodies, std::span<Wrench> wrenches) const override;
  [[nodiscard]] double potential(Instant, std::span<const BodyState>) const override { return 0.0; }
  [[nodiscard]] bool conservative() const override { return true; }
  [[nodiscard]] bool involves_rotation() const override { return false; }
  [[nodiscard]] std::string description() const override { return "support"; }
  [[nodiscard]] const Vector3& normal() const { return normal_; }

 private:
  Vector3 normal_;
};

}  // namespace core
}  // namespace kairos
