#pragma once

#include "core/schemes/frame/frame_run.hpp"
#include "core/schemes/shared/island_run.hpp"

#include <memory>
#include <vector>

namespace kairos {
inline namespace core {

/// How the bodies of a frame-based run move: all of them, by the same time.
///
/// A *proposal* is where everything would go without contacts, as paths of motions end to end; its
/// times are seconds from now. A scheme accepts a part of it, or bends it at a contact. The ledger
/// follows what came true.
class FrameMotions {
 public:
  FrameMotions(FrameRun& run, const Method& method);

  /// Everything moves for h.
  void advance(double h);

  void propose(double h);
  [[nodiscard]] double proposed() const { return proposed_; }
  /// The first s of the proposal, 0 < s <= h, come true.
  void accept(double s);
  /// Where body i is at s of the proposal; where it is now, if none was made.
  [[nodiscard]] BodyState on_path(BodyIndex i, double s) const;
  [[nodiscard]] const Motion& path_motion(BodyIndex i, double s) const;
  /// Longest stretch from s on, at most to `until`, on which neither path changes its motion, s.
  [[nodiscard]] double common_stretch(BodyIndex a, BodyIndex b, double s, double until) const;
  /// The island of i has come as far as s: its path ends there, and the ledger follows to there.
  void cut(BodyIndex i, double s);
  /// The rest of the proposal of the island of i, which a contact at s has put where `meeting`
  /// says (by body).
  void fly_on(BodyIndex i, double s, const State& meeting);

  /// When a contact last bent the path of body i, s; what is before is settled. 0: none did.
  [[nodiscard]] double bent_at(BodyIndex i) const {
    return run_.model.is_free(i) ? movers_[run_.model.island_of(i)].bent_at : 0.0;
  }

  /// Motion of body i over the last step.
  [[nodiscard]] Motion last_motion(BodyIndex i) const;
  /// A body was moved by a contact or a hand: its stepper begins anew with the next step.
  void jump(BodyIndex i) { mover_of(i).jumped = true; }
  /// Takes a body to `state` in a hand, now; what that does to its energy is the hand's work.
  void carry(BodyIndex i, const BodyState& state);
  /// Whether a hand holds body i: it then has no steps of its own.
  void set_carried(BodyIndex i, bool carried) { mover_of(i).carried = carried; }

  /// Names a state that overflowed, if there is one, as reason for a stop.
  void check_finite();
  [[nodiscard]] std::int64_t evaluations() const;
  void persist(Archive& archive);

 private:
  /// An island, and how far the ledger has followed it.
  struct Mover : IslandRun {
    using IslandRun::IslandRun;

    bool jumped = false;               ///< restart before the next step
    std::vector<Motion> motions{};     ///< dense output of the last step
    double last_step = 0.0;            ///< s
    std::vector<BodyState> booked{};   ///< where the ledger is
    std::vector<BodyState> before{};   ///< scratch: where a leg begins
    std::vector<BodyState> reached{};  ///< scratch: where it ends
    /// `projection` of each motion of the proposal, and when it ends, s from now.
    std::vector<std::pair<double, JointProjection>> projections{};
    double booked_until = 0.0;  ///< of the proposal, s
    double bent_at = 0.0;       ///< last, in the proposal, s

    void persist(Archive& archive);
  };

  void begin_step(Mover& mover, Instant t);
  /// One step of the stepper, from `done` on and at most to `until` (s from now), which moves
  /// `done` on; its length is `Mover::last_step`. False: it failed, and the run is stopped.
  bool step(Mover& mover, double& done, double until);
  void fly(Mover& mover, double from, double to);
  void end_step(double h);
  void settle(BodyIndex i, double interval);

  void book_step(Mover& mover, const std::vector<BodyState>& from, const std::vector<BodyState>& to,
                 Instant t, double h, bool replayable, const JointProjection& projection);
  [[nodiscard]] static JointProjection projection_until(const Mover& mover, double from,
                                                        double end);
  void book_path(Mover& mover, double until);
  [[nodiscard]] double roundoff_of(Mover& mover, const std::vector<BodyState>& from,
                                   const std::vector<BodyState>& to, double h);

  [[nodiscard]] Mover& mover_of(BodyIndex i) { return movers_[run_.model.island_of(i)]; }

  FrameRun& run_;
  std::vector<Mover> movers_;
  std::vector<BodyIndex> driven_;
  std::vector<TrackerMemory> trackers_;
  std::vector<std::vector<Motion>> paths_;  ///< of the proposal, by body, end to end
  double proposed_ = 0.0;                   ///< s
  std::vector<Vector3> given_;              ///< scratch: what a leg is given, N
};

}  // namespace core
}  // namespace kairos
