#pragma once

#include "core/schemes/shared/frame_clock.hpp"
#include "core/schemes/shared/scheme_run.hpp"
#include "core/schemes/stepping/step_contact.hpp"
#include "core/schemes/stepping/step_fields.hpp"

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

/// Whether what separates a contact faster than restitution lets it is booked as the correction of
/// a penetration, or as part of what restitution does.
enum class Corrects { no, yes };

/// The world of the schemes that step over contacts (moreau-jean, pgs, xpbd, penalty): all bodies
/// by the same time, in steps that divide a frame; contacts found once in a step and answered by
/// impulses over it. A scheme says where contacts are looked for, what their impulses are and where
/// bodies go; the world moves what is driven, and keeps the ledger and the clock.
///
/// The ledger: over a step the forces F and the impulses p change velocities at fixed arms, and the
/// kinetic energy by the sum of h F.(v- + v+)/2 and p.(u- + u+)/2, u the relative velocities at the
/// contacts. The second is booked: its normal part as restitution loss, its tangential part as
/// friction (as `impact_friction` in the step in which a pair meets), and under `Corrects::yes` the
/// separation that no restitution accounts for as position correction. What h F.(v- + v+)/2 and the
/// work of F along the way differ by, and what turning does to the energy of spin, is truncation.
class StepWorld {
 public:
  /// `substeps`: steps in a frame.
  StepWorld(const Model& model, const Method& method, const SchemeOptions& options,
            Recorder& recorder, std::int64_t substeps, Corrects corrects);

  /// Draws the world as it is, and divides the frame that follows; false when the run is over.
  bool draw();
  [[nodiscard]] std::int64_t steps() const { return substeps_; }
  [[nodiscard]] double h() const { return h_; }

  /// Begins a step: asks forces and fields, and what is driven for its velocity.
  void begin_step();
  /// Free bodies take the velocities that forces and their own turning give them in h: those of
  /// the start of the step, and with weight theta those of its end, predicted by an Euler step.
  void kick(double theta = 0.0);
  /// Finds the points between bodies at `poses` whose gap is at most `reach` (m), or the tolerance
  /// of contacts where that is more, with the impulses that they had in the last step.
  void find_contacts(std::span<const Pose> poses, double reach = 0.0);
  /// Where everything would be with the velocities at the start of the step, `ahead` s after it.
  [[nodiscard]] std::span<const Pose> poses_ahead(double ahead);
  /// All move for h, free bodies with theta of the velocities now and 1 - theta of those at the
  /// start.
  void move(double theta);
  /// Ends the step: books it, tells what met, moves what is driven.
  void end_step();

  [[nodiscard]] std::vector<StepContact>& contacts() { return contacts_; }
  /// u: velocity of b against a at the contact, of their surfaces, contact frame, m/s.
  [[nodiscard]] Vector3 velocity(const StepContact& contact) const {
    return relative_velocity(contact, bodies_);
  }
  /// How fast the surfaces of b and a run along themselves (belts), b against a, contact frame,
  /// m/s.
  [[nodiscard]] Vector3 belt_velocity(const StepContact& contact) const {
    return contact.frame_W.transpose() * (belt_[contact.b] - belt_[contact.a]);
  }
  /// What applied forces give body i in a second, m/s^2; 0 for what is not free.
  [[nodiscard]] double acceleration(BodyIndex i) const {
    return inverse_mass(i) * applied_[i].force.norm();
  }
  /// Changes the velocities of both by an impulse on b, contact frame, N s.
  void push(const StepContact& contact, const Vector3& impulse);
  /// Velocities again from those that forces gave and the impulses of all contacts: the same to
  /// roundoff as after many small pushes, whose roundings would add up.
  void sum_impulses();

  [[nodiscard]] const Model& model() const { return run_.model; }
  [[nodiscard]] State& bodies() { return bodies_; }
  [[nodiscard]] const State& start() const { return start_; }
  [[nodiscard]] double inverse_mass(BodyIndex i) const {
    return run_.model.is_free(i) ? 1.0 / run_.model.inertia(i).mass : 0.0;
  }
  /// World frame; zero for what does not turn.
  [[nodiscard]] Matrix3 inverse_inertia(BodyIndex i, const Quaternion& q) const;
  void count_solves(std::size_t n) { run_.cost.contact_solves += static_cast<std::int64_t>(n); }
  [[nodiscard]] bool stopped() const { return run_.stopped(); }
  [[nodiscard]] RunResult result() &&;

 private:
  void drive();
  void act(Instant t, const State& bodies, std::vector<Wrench>& wrenches);
  void add_contacts(BodyIndex a, BodyIndex b, std::span<const Pose> poses, double reach);
  void recognise();
  [[nodiscard]] Vector3 relative_velocity(const StepContact& contact, const State& bodies) const;
  void book_contact(const StepContact& contact);
  void book_island(std::size_t k);
  [[nodiscard]] Motion way(BodyIndex i) const;
  void tell_impacts();
  void check_finite();
  void persist(Archive& archive);

  SchemeRun run_;
  FrameClock clock_;
  StepFields fields_;
  std::unique_ptr<BroadPhase> broad_phase_;
  const SweptBounds swept_bounds_;
  const std::int64_t substeps_;
  const Corrects corrects_;
  bool resumed_;
  double h_ = 0.0;                      ///< s
  State bodies_;                        ///< now, or as far as the step has come
  State start_;                         ///< when the step began
  State kicked_;                        ///< velocities before contacts act
  State predicted_;                     ///< at the end of the step, by Euler
  std::vector<Wrench> applied_;         ///< by body
  std::vector<Wrench> applied_then_;    ///< by body, at the end of the step
  std::vector<Vector3> given_;          ///< by body, N: fields
  std::vector<Matrix3> spin_response_;  ///< inverse inertia, world, where contacts were found
  std::vector<Vector3> belt_;           ///< velocity of a belt along its surface, m/s
  std::vector<double> contact_work_;    ///< by body, J
  std::vector<StepContact> contacts_, last_contacts_;
  // Scratch, so that steps do not allocate.
  std::vector<BodyState> leg_from_, leg_to_;
  std::vector<Vector3> leg_given_;
  std::vector<Pose> poses_;
  std::vector<BodyState> island_states_;
  std::vector<Wrench> island_wrenches_;
  std::vector<Motion> island_motions_;
  std::vector<BodyIndex> near_;
};

/// The rotation vector that turns q0 to q1, the shorter way round, rad, world frame.
[[nodiscard]] Vector3 turn_between(const Quaternion& q0, const Quaternion& q1);

/// The loop of all of these schemes: frames, and in each so many steps. `step()` is what lies
/// between the beginning and the end of one.
template <typename Step>
RunResult run_steps(StepWorld& world, const Step& step) {
  while (world.draw()) {
    for (std::int64_t k = 0; k < world.steps(); ++k) {
      world.begin_step();
      step();
      world.end_step();
    }
  }
  return std::move(world).result();
}

/// Why a scheme that steps over contacts cannot run this; empty if it can.
[[nodiscard]] std::string stepping_refusal(const Model& model, const Method& method);

}  // namespace core
}  // namespace kairos
