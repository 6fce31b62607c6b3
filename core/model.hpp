#pragma once

#include "core/body_pairs.hpp"
#include "core/scene.hpp"

#include <string>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

/// Savings that can be switched off, to show that they change cost and not results.
struct ModelOptions {
  bool leave_out_orientation =
      true;                      ///< bodies that nothing can turn are not integrated in rotation
  bool closed_form = true;       ///< parabolas instead of an integrator, where `auto` is asked
  bool prune_pairs = true;       ///< pairs that can never interact are never tested
  std::string_view broad_phase;  ///< finds which of those are near; empty: the model chooses
};

/// A hand and the body that its closed fist holds.
struct Grip {
  BodyIndex hand = 0;
  BodyIndex held = 0;
};

/// Why the model leaves something out or puts it in.
struct Decision {
  std::string topic;   ///< "bodies", "rotation", "motion", "pairs", "broad phase", ...
  std::string text;    ///< what was decided
  std::string reason;  ///< why
};

/// The least physics that a scene requires. Const after construction: who can move, rotate,
/// collide; which motions are closed-form; which pairs can ever meet. It can say why.
class Model {
 public:
  /// Throws `InputError` where the scene cannot work: a free body with no mass, a bat that nothing
  /// drives, a number that is not finite. Solids that overlap at the start are not refused here:
  /// that takes a detector.
  explicit Model(Scene scene, const ModelOptions& options = {});

  /// As it was given.
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// As they were given.
  [[nodiscard]] const ModelOptions& options() const { return options_; }
  /// How many bodies there are; i, a, b below are less than this.
  [[nodiscard]] std::size_t size() const { return scene_.bodies.size(); }
  /// As it was given.
  [[nodiscard]] const Body& body(BodyIndex i) const { return scene_.bodies[i]; }
  /// What it is in the thesis' taxonomy.
  [[nodiscard]] const Entity& entity(BodyIndex i) const { return *scene_.bodies[i].entity; }
  /// What it collides as.
  [[nodiscard]] const Shape& shape(BodyIndex i) const { return shapes_[i]; }
  /// What moves it.
  [[nodiscard]] Mobility mobility(BodyIndex i) const { return mobility_[i]; }
  /// Whether forces and impacts move it.
  [[nodiscard]] bool is_free(BodyIndex i) const { return mobility_[i] == Mobility::free; }
  /// Whether its orientation is followed.
  [[nodiscard]] bool rotates(BodyIndex i) const { return rotates_[i]; }
  /// Whether it acts on what overlaps it, and is not solid.
  [[nodiscard]] bool is_field(BodyIndex i) const { return roles_[i].field; }
  /// Inertia as islands and impact laws see it; mass -1 for bodies that are not free.
  [[nodiscard]] const BodyInertia& inertia(BodyIndex i) const { return inertia_[i]; }
  /// Gravity on body i and what else is uniform (buoyancy), N; 0 for bodies that are not free.
  [[nodiscard]] const Vector3& gravity_force(BodyIndex i) const { return gravity_force_[i]; }

  /// Restitution of the pair as the scene combines it, from 0 to 1.
  [[nodiscard]] double restitution(BodyIndex a, BodyIndex b) const {
    return scene_.restitution(body(a), body(b));
  }
  /// Coulomb's coefficient of friction of the pair, as the scene combines it: >= 0 or infinite.
  [[nodiscard]] double friction(BodyIndex a, BodyIndex b) const {
    return scene_.friction(body(a), body(b));
  }
  /// Whether some pair that can meet has friction.
  [[nodiscard]] bool has_friction() const { return has_friction_; }

  /// Pairs to test, in the order of creation: those that can ever interact; with `prune_pairs` off
  /// all pairs; still only those that `interacts` allows do anything.
  [[nodiscard]] const BodyPairs& pairs() const { return pairs_; }
  /// Whether a and b can ever do anything to each other.
  [[nodiscard]] bool interacts(BodyIndex a, BodyIndex b) const {
    return a != b && interaction(roles_[a], roles_[b]) && !pairs_.kept_apart(a, b);
  }
  /// Free bodies in the order of their names: what adds up over bodies does so in this order, so
  /// that no sum depends on the order in the file.
  [[nodiscard]] const std::vector<BodyIndex>& free_by_name() const { return free_by_name_; }
  /// The bodies that forces and joints couple, with their constant forces; free bodies only, by
  /// name.
  [[nodiscard]] const std::vector<Island>& islands() const { return islands_; }
  /// Island of a free body.
  [[nodiscard]] std::size_t island_of(BodyIndex i) const { return island_of_[i]; }
  /// Whether a joint holds this free body.
  [[nodiscard]] bool jointed(BodyIndex i) const { return jointed_[i]; }
  /// True if the island moves in closed form: a parabola, and a rotation that is left out or of
  /// constant rate.
  [[nodiscard]] bool closed_form(std::size_t island) const { return closed_form_[island]; }
  /// True if it would be so without a body that can tumble: a free top between impacts, which has a
  /// closed form of its own (elliptic functions).
  [[nodiscard]] bool tumbles(std::size_t island) const { return tumbles_[island]; }
  /// Name of the broad phase that the scene needs.
  [[nodiscard]] std::string_view broad_phase() const { return broad_phase_; }
  /// Whether that asks every pair, so that nothing has to be searched.
  [[nodiscard]] bool asks_every_pair() const { return broad_phase_ == every_pair; }

  /// Hands and what they hold, in the order of creation of the hands.
  [[nodiscard]] const std::vector<Grip>& grips() const { return grips_; }

  /// Bodies at t = 0; driven bodies where their drive puts them.
  [[nodiscard]] State initial_state() const;
  /// Potential energy of body i under that force, J (0 at the origin).
  [[nodiscard]] double gravity_potential(BodyIndex i, const Vector3& position) const {
    return -gravity_force_[i].dot(position);
  }
  /// Kinetic energy of body i, J; 0 for bodies that are not free.
  [[nodiscard]] double kinetic_energy(BodyIndex i, const BodyState& state) const;

  /// What was decided, and why: what `kairos explain` prints.
  [[nodiscard]] const std::vector<Decision>& decisions() const { return decisions_; }

 private:
  void choose_bodies();
  void choose_forces();
  void choose_friction();
  void choose_rotation();
  void choose_joints();
  void choose_pairs();
  [[nodiscard]] Decision choose_broad_phase();
  [[nodiscard]] std::vector<BodyPair> jointed_pairs() const;
  void build_joints(const std::vector<std::size_t>& place);
  void put_onto_joints(State& state) const;
  void choose_islands();
  void choose_grips();
  void choose_motion();
  [[nodiscard]] bool keeps_constant_rate(BodyIndex i) const;
  void decide(std::vector<Decision> decisions);

  Scene scene_;
  ModelOptions options_;
  std::vector<Shape> shapes_;
  std::vector<Mobility> mobility_;
  std::vector<BodyIndex> free_by_name_;
  std::vector<bool> rotates_;
  std::vector<BodyInertia> inertia_;
  std::vector<Vector3> gravity_force_;
  std::vector<bool> turned_by_force_;  ///< a force involves its rotation
  std::vector<bool> rubs_;             ///< has friction with something that it can meet
  bool has_friction_ = false;
  std::vector<PairRole> roles_;
  BodyPairs pairs_;
  std::vector<Island> islands_;
  std::vector<std::shared_ptr<const Force>> island_forces_;  ///< owns what islands refer to
  std::vector<bool> jointed_;
  std::vector<std::size_t> island_of_;
  std::vector<Grip> grips_;
  std::vector<bool> closed_form_;
  std::vector<bool> tumbles_;
  static constexpr std::string_view every_pair = "all-pairs";
  std::string_view broad_phase_ = every_pair;
  std::vector<Decision> decisions_;
};

}  // namespace core
}  // namespace kairos
