#pragma once

#include "core/contacts/contact_graph.hpp"
#include "core/contacts/friction_modes.hpp"
#include "core/contacts/shape_pieces.hpp"
#include "core/contacts/touch.hpp"
#include "core/schemes/event/event_accumulation.hpp"
#include "core/schemes/event/event_motions.hpp"
#include "core/schemes/event/event_predictor.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

struct Clearance;
struct TurningGroup;
struct TurningPair;

/// Contact that lasts among several bodies: who holds whom, since when, and until what happens.
///
/// A group of bodies in touch is *settled*: `flat_mode` says who presses, and that nothing turns
/// that must not. The pairs that stay join the contact graph (no detector is asked about them), and
/// their bodies move in closed form. What ends this (an impact, a field, a body that comes to the
/// rim of what carries it) settles the group anew.
class EventModes {
 public:
  EventModes(EventRun& run, EventMotions& motions, EventPredictor& predictor,
             const EventAccumulation& accumulation, ContactGraph& graph,
             std::function<std::unique_ptr<Stepper>(double)> stepper);

  /// When the bounces of a ball on the face that supports it have died down; it is supported by
  /// nothing but the group from then on.
  using Adopt = std::function<Instant(BodyIndex ball)>;
  /// Which groups `settle` may keep, and how.
  struct SettleOptions {
    bool unloaded = false;   ///< keep what touches without pressing, too
    bool unite = false;      ///< an accumulation ends here: what is slow stays together
    double remaining = 0.0;  ///< unite: how long it would still have taken, s
    std::size_t pairs = 0;   ///< unite: how many pairs must be in touch at least
    std::optional<BodyPair> pressed = {};  ///< only if what holds these two is pressed
    bool impact = false;                   ///< what approaches is of interest, too
    bool held_only = false;                ///< impact: only what is held, and these two
    bool turning = false;                  ///< pairs of which some points are at rest, too
    bool turning_only = false;             ///< only if it turns
    bool near = false;                     ///< what is in touch and not at rest, too
    bool far = false;                      ///< near: what is a little further away, too
    std::span<const BodyPair> apart = {};  ///< unite: what parts, however slowly
    /// Bodies that are taken to be elsewhere.
    std::span<const std::pair<BodyIndex, BodyState>> moved = {};
    /// What cannot go on otherwise may turn: the run would stop. What has turned may always.
    bool may_turn = false;
    bool may_part = true;   ///< may_turn: what nothing presses goes on by itself
    bool not_flat = false;  ///< that nothing turns was tried in vain
    /// Time does not go on otherwise: a step is made over all that is in touch, pressed or not.
    bool step_over = false;
    /// The run would stop: what is rough may be held along the surfaces where nothing presses it.
    bool last_resort = false;
  };
  /// Settles all that touches the seeds at t, whose states are at `now`; false, and nothing has
  /// changed, where they cannot go on in touch. `why_not` then says why.
  [[nodiscard]] bool settle(std::span<const BodyIndex> seeds, Instant t, const Adopt& adopt,
                            const SettleOptions& options);
  [[nodiscard]] const std::string& why_not() const { return why_not_; }

  /// Whether it is of parts that others may touch at several places: a mesh or a compound.
  [[nodiscard]] bool has_parts(BodyIndex i) const { return has_pieces(run_.model.shape(i)); }
  /// Of a pair in which one is a mesh or a compound: of the places where pieces are nearer than
  /// `reach`, m, the one that approaches fastest, or parts slowest; nothing where none are.
  [[nodiscard]] std::optional<Contact> least_parting(BodyIndex a, BodyIndex b, double reach) const;
  /// Whether contact forces hold this free body.
  [[nodiscard]] bool holds(BodyIndex i) const {
    return run_.model.is_free(i) && (graph_.holds(i) || (hangs_and_touches(i) && holds_island(i)));
  }
  /// Free bodies that lie on a surface, by name.
  [[nodiscard]] std::vector<BodyIndex> held_by(BodyIndex surface) const;
  /// Free bodies that are held together with one of these, they included, by name.
  [[nodiscard]] std::vector<BodyIndex> group(std::span<const BodyIndex> seeds) const;
  /// Books and brings these bodies, before something changes them.
  void bring_group(std::span<const BodyIndex> bodies, Instant t);
  /// Two bodies in touch that approach each other, and where.
  struct Approach {
    BodyIndex a = 0;
    BodyIndex b = 0;
    Contact contact;
    double speed = 0.0;  ///< m/s, > 0
  };
  /// Where a pair in touch that turns, whose states are at `now`, comes together: the middle of the
  /// points that approach fastest, however slowly; nothing for other pairs, or if none approaches.
  [[nodiscard]] std::optional<Approach> landing(BodyIndex a, BodyIndex b) const;
  /// Whether a contact has no speed along its normal that is worth a hop.
  [[nodiscard]] bool stays(BodyIndex a, BodyIndex b, const Contact& contact) const;
  /// A pair in touch, as it lies at an instant.
  struct TouchingPair {
    BodyIndex a = 0;
    BodyIndex b = 0;
    ContactManifold manifold = {};
    Contact nearest = {};      ///< at the centroid of the patch; unless it turns
    bool turns = false;        ///< as its patch does
    bool corners_too = false;  ///< it approaches also if only a point of its patch does
  };
  /// `others` and the pairs in touch of `bodies`, whose states are at `now`, as long as these do
  /// not move. `corners_too`: as in `TouchingPair`; so it is always once the bodies of a pair have
  /// turned.
  [[nodiscard]] std::vector<TouchingPair> touching_pairs(std::span<const BodyIndex> bodies,
                                                         std::span<const BodyPair> others,
                                                         bool corners_too = false) const;
  /// The pair that approaches fastest, with the velocities that bodies have `now`: at the centroid
  /// of its patch, or at a point of it if that does not approach. Nothing if all are slower than
  /// they may be at rest.
  [[nodiscard]] std::optional<Approach> worst_approach(std::span<const TouchingPair> pairs) const;
  /// A contact that begins or ends, to be told when its bodies have their new motions.
  struct Change {
    EventKind kind = EventKind::contact_ends;
    BodyIndex a = 0;
    BodyIndex b = 0;
    Grade grade = Grade::exact;
    double bracket = Event{}.bracket;  ///< s
  };
  /// An impact of several bodies in touch, as an impact law sees it.
  struct GroupImpact {
    std::vector<BodyIndex> bodies;  ///< by place in the system; free ones and what they touch
    std::vector<BodyPair> pairs;
    ContactSystem system;
    std::vector<std::size_t> pair_of_row;
    Eigen::VectorXd restitution;  ///< by row
    std::vector<Twist> velocities;
    std::vector<double> gaps;  ///< by row, m
    double driven = 0.0;       ///< work of what is driven in what led to the velocities, J
    std::string refusal;       ///< why it is none
  };
  /// What these bodies, whose states are at `now`, are in touch with: all of it, or what is held.
  /// Pairs and rows that part are left out, unless they are asked for.
  [[nodiscard]] GroupImpact impact_group(std::span<const BodyIndex> seeds, Instant t, bool all,
                                         bool parting = false);

  /// A pair is in touch from now on, its bodies at rest; its bounces will have died down after
  /// `remaining`, s.
  void join(BodyIndex i, BodyIndex j, Instant t, double remaining);
  /// The bodies are held no longer; takes effect with their next launch.
  [[nodiscard]] std::vector<Change> part(std::span<const BodyIndex> bodies);
  void tell(std::span<const Change> changes, Instant t);
  /// The bounces of a pair have died down.
  void begin_contact(BodyIndex a, BodyIndex b, Instant t);
  /// Groups that move are looked at for one epoch only.
  [[nodiscard]] std::vector<BodyIndex> moving() const;

  void persist(Archive& archive);

 private:
  /// Whether joints hold its bodies together, or forces between them.
  [[nodiscard]] static bool hangs_together(const Island& island) {
    return island.joints != nullptr || island.bodies.size() > 1;
  }
  [[nodiscard]] bool hangs_and_touches(BodyIndex i) const { return !graph_.empty() && hangs(i); }
  [[nodiscard]] bool hangs(BodyIndex i) const {
    return some_hang_ && run_.model.is_free(i) &&
           hangs_together(run_.model.islands()[run_.model.island_of(i)]);
  }
  [[nodiscard]] bool holds_island(BodyIndex i) const;
  struct Gathered;
  /// A step of a group that turns.
  struct Turning;
  void go_on_hanging(const Gathered& found, std::size_t k, Instant t, const Turning* turning);
  [[nodiscard]] Gathered gather(std::span<const BodyIndex> seeds, Instant t,
                                const SettleOptions& options);
  [[nodiscard]] bool rattles(BodyIndex i) const;
  [[nodiscard]] double rest_speed(BodyIndex a, BodyIndex b, const BodyState& at_a,
                                  const BodyState& at_b, const SettleOptions& options) const;
  [[nodiscard]] ContactManifold manifold(BodyIndex a, BodyIndex b) const;
  [[nodiscard]] std::optional<Approach> approach(const TouchingPair& pair) const;
  [[nodiscard]] std::optional<Approach> fastest_points(BodyIndex a, BodyIndex b,
                                                       const ContactManifold& m) const;
  [[nodiscard]] Twist load(BodyIndex i, const BodyState& state) const;
  /// One body on one surface, along a motion that is no parabola.
  struct GivenMotion {
    Motion motion;
    bool curved = false;
    Polynomial<3> spent{};  ///< curved: as `EventMotions::SurfaceForce::spent`
  };
  void commit(const Gathered& group, const FlatMode& mode, Instant t, const Adopt& adopt,
              const GivenMotion* alone = nullptr, const Turning* turning = nullptr);
  [[nodiscard]] bool settle_curved(const Gathered& found, Instant t, const Adopt& adopt);
  [[nodiscard]] bool completes(const Gathered& found, const FlatMode& mode,
                               const SettleOptions& options, const Turning* turning = nullptr);
  [[nodiscard]] std::vector<BodyPair> parting_pairs(std::span<const BodyIndex> seeds, Instant t,
                                                    const SettleOptions& options);
  [[nodiscard]] bool settle_once(std::span<const BodyIndex> seeds, Instant t, const Adopt& adopt,
                                 const SettleOptions& options);
  [[nodiscard]] bool settle_flat(Gathered found, Instant t, const Adopt& adopt,
                                 const SettleOptions& options);
  [[nodiscard]] std::vector<double> better_gaps(const Gathered& found, const FlatMode& mode) const;
  [[nodiscard]] std::optional<Gathered> at_gaps(const Gathered& found,
                                                const std::vector<double>& gaps, Instant t,
                                                SettleOptions options);
  [[nodiscard]] bool touches_again(Gathered& found) const;
  void put_in_order(Gathered& found, FlatMode& mode, Instant t, SettleOptions options);
  [[nodiscard]] bool settle_turning(std::span<const BodyIndex> seeds, Instant t, const Adopt& adopt,
                                    const SettleOptions& options);
  [[nodiscard]] std::string add_touches(Gathered& found, Instant t, Turning& turning) const;
  /// Two convex pieces that touch, or nearly, and where they are in the frames of the bodies.
  struct PiecePair {
    const Shape* shape_a = nullptr;
    Pose piece_a;
    const Shape* shape_b = nullptr;
    Pose piece_b;
    ContactManifold manifold;
    bool of_pieces = false;
    Vector3 apart;  ///< see `TurningPair`
    double apart_by = 0.0;
    std::size_t index_a = 0;
    std::size_t index_b = 0;
  };
  [[nodiscard]] std::string add_pair(const Gathered& found, std::size_t p, Turning& turning) const;
  [[nodiscard]] TurningPair watched(const Gathered& found, std::size_t p, const PiecePair& of,
                                    const Pose& at_a, const Pose& at_b) const;
  [[nodiscard]] std::string add_touches_of(const Gathered& found, std::size_t p,
                                           const PiecePair& of, Turning& turning) const;
  struct PlacedPiece {
    const ShapePiece& piece;
    Pose pose;  ///< in the world
  };
  [[nodiscard]] std::vector<ShapePiece> near_pieces(BodyIndex of, const Pose& at, BodyIndex other,
                                                    const Pose& there, double within) const;
  [[nodiscard]] ContactManifold touching_pieces(const PlacedPiece& a, const PlacedPiece& b,
                                                double reach) const;
  static void share_faces(std::size_t p, std::size_t first, TurningGroup& group);
  [[nodiscard]] double far_pieces(const Gathered& found, const GroupPatch& patch) const;
  [[nodiscard]] static bool is_told(const Gathered& found, Touch touch, const TouchNow& now,
                                    TurningGroup& group);
  [[nodiscard]] bool has_belts_on_faces(const Touch& touch, BodyIndex a, BodyIndex b) const;
  [[nodiscard]] std::string add_rims(const Gathered& found, Turning& turning) const;
  [[nodiscard]] static bool presses(const Gathered& found, const Turning& turning,
                                    const BodyPair& pair);
  [[nodiscard]] double next_step(const Gathered& found);
  [[nodiscard]] int short_steps(const Gathered& found) const;
  [[nodiscard]] std::pair<int, int> implicit_steps(const Gathered& found) const;
  [[nodiscard]] bool goes_on_implicitly(const Gathered& found, Instant t) const;
  [[nodiscard]] int pieces_turned(const Gathered& found, Instant t) const;
  [[nodiscard]] static bool has_joints(const Gathered& found);
  void find_forces(const Gathered& found, Turning& turning, Instant t);
  [[nodiscard]] Instant given_until(const Turning& turning) const;
  [[nodiscard]] bool ends_in_touch(const Gathered& found, const Turning& turning) const;
  void correct(Turning& turning, Instant t, double h, const SettleOptions& asked);
  [[nodiscard]] bool step_over(const Gathered& found, Turning& turning, Instant t,
                               const SettleOptions& asked);
  static void count_implicit(const Turning& turning, const std::pair<int, int>& left, bool is_short,
                             Patch& patch);
  void keep_forces(const Gathered& found, const Turning& turning);
  [[nodiscard]] bool turned(std::span<const BodyIndex> bodies);
  [[nodiscard]] bool has_turned(std::span<const BodyIndex> bodies) const;
  [[nodiscard]] std::string why_not_turn(const Gathered& found, Instant t) const;
  void count_step(const Gathered& found, Instant t);
  void still_hold(ContactGroup& group, GroupImpact& impact) const;
  [[nodiscard]] bool make_room(std::span<const BodyIndex> seeds, Instant t, SettleOptions options,
                               Gathered& found, Turning& turning);
  void lift(Gathered& found, Turning& turning, Instant t, bool at_least);
  void raise(Gathered& found, Turning& turning, Instant t, bool at_least);
  [[nodiscard]] std::vector<Clearance> beside_touches(const Gathered& found,
                                                      const TurningGroup& group) const;
  [[nodiscard]] static bool let_hop(Turning& turning, double roundoff);
  void let_jam(const Gathered& found, Turning& turning, Instant t, double still);
  [[nodiscard]] static bool slides_roughly(const Turning& turning, double still);
  void tell_jam(const Gathered& found, const Turning& turning, Instant t);
  [[nodiscard]] bool has_room(std::span<const BodyState> before, const Gathered& found, Instant t);
  [[nodiscard]] bool part_ways(const Gathered& found, Turning& turning, Instant t,
                               const Adopt& adopt);
  [[nodiscard]] std::vector<double> hops(const Gathered& found);
  [[nodiscard]] static std::vector<char> struck_pairs(const Gathered& found,
                                                      const Turning& turning);
  [[nodiscard]] bool fly(const Gathered& found, const Turning& turning, Instant t,
                         const Adopt& adopt);
  void book_lift(const Gathered& found, Instant t);
  void carry_on(const Gathered& found, const Turning& turning, Instant t, const Adopt& adopt);
  void end_together(const Gathered& found, const FlatMode& mode, Instant end, bool strikes);
  [[nodiscard]] bool let_go(const Gathered& found, Instant t, const Adopt& adopt,
                            const SettleOptions& options);
  [[nodiscard]] bool settle_driven(Gathered found, Instant t, const Adopt& adopt,
                                   const SettleOptions& options);
  [[nodiscard]] static double speed(const Gathered& found, const GroupPatch& patch);
  [[nodiscard]] std::vector<Change> join_and_part(const Gathered& found, const FlatMode& mode,
                                                  Instant t);
  void set_friction(const Gathered& found, const FlatMode& mode, Instant t,
                    std::vector<Change>& changes, const GivenMotion* alone, const Turning* turning);
  [[nodiscard]] Vector3 belt(BodyIndex i, const Vector3& normal) const;

  EventRun& run_;
  EventMotions& motions_;
  EventPredictor& predictor_;
  const EventAccumulation& accumulation_;
  ContactGraph& graph_;
  std::function<std::unique_ptr<Stepper>(double)> stepper_;  ///< see `Method::contact_stepper`
  bool some_hang_ = false;                                   ///< some islands hang together
  std::string why_not_;
  bool not_by_pushing_ = false;  ///< see `completes`
  /// Whether a body has turned while it touched, and its steps in the frame in which it last did.
  struct Turned {
    bool once = false;
    double frame = 0.0;  ///< counted from the start of the run
    int steps = 0;
    int in_vain = 0;    ///< searches for its forces in that frame that found none, in a row
    int unsettled = 0;  ///< of steps over what forces are not known of: the same

    void persist(Archive& archive);
  };
  [[nodiscard]] Turned& turned_in_frame(BodyIndex i, Instant t);
  void count_in_vain(const Gathered& found, const Turning& turning, Instant t, int Turned::*what);
  [[nodiscard]] int halvings(const Gathered& found, Instant t, int Turned::*what);
  std::vector<Turned> has_turned_;
};

/// Whether a body was struck where the seeds of a group were: it is one, or joints hold it together
/// with one.
[[nodiscard]] bool struck_with(const Model& model, std::span<const BodyIndex> seeds, BodyIndex i);

}  // namespace core
}  // namespace kairos
