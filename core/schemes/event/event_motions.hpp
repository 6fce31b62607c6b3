#pragma once

#include "core/memoryless_stepper.hpp"
#include "core/schemes/event/event_run.hpp"
#include "core/schemes/event/motion_table.hpp"
#include "core/schemes/shared/island_run.hpp"
#include "core/schemes/shared/support.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// How every body of an event-driven run moves, each for itself and from a time of its own.
///
/// An island is *launched* at a state: its stepper says how it moves, segment by segment, until it
/// is launched again. Every new motion makes stale what the agenda holds of the body. The ledger
/// follows an island when it is *booked*, up to the time that is told.
class EventMotions {
 public:
  EventMotions(EventRun& run, const Method& method);

  /// First motions of all bodies, from the model's initial state.
  void begin();

  [[nodiscard]] Motion of(BodyIndex i) const { return table_.of(i); }
  [[nodiscard]] Instant start_of(BodyIndex i) const {
    return flies_parabola(i) ? table_.start_of_flight(i) : table_.start(i);
  }
  [[nodiscard]] double duration_of(BodyIndex i) const {
    return flies_parabola(i) ? std::numeric_limits<double>::infinity() : table_.duration(i);
  }
  [[nodiscard]] Instant end_of(BodyIndex i) const { return start_of(i) + duration_of(i); }
  /// How a driven body moves from t on, also where that is where its motion ends.
  [[nodiscard]] Motion driven_from(BodyIndex i, Instant t) const;
  /// A shape with the motion that it has, for as long as this lives.
  [[nodiscard]] MotionTable::Moving moving(BodyIndex i) const { return table_.moving(i); }
  /// No coordinate of body i is greater in the first `s` seconds of its motion, m.
  [[nodiscard]] double coordinates_reached(BodyIndex i, double s) const {
    return table_.coordinates_reached(i, s);
  }
  [[nodiscard]] double error_radius(BodyIndex i) const {
    return flies_parabola(i) ? 0.0 : table_.error_radius(i);
  }
  /// Whether its flight is all there is to know of the motion of i.
  [[nodiscard]] bool is_flight(BodyIndex i) const {
    return flies_parabola(i) || table_.is_flight(i);
  }
  /// Whether i is a ball on a parabola until it is launched again, and held by nothing.
  [[nodiscard]] bool flies(BodyIndex i) const { return (ways_[i] & flies_bit) != 0; }
  /// Whether besides its flight says all of its motion, as a parabola, and it is upright.
  [[nodiscard]] bool flies_parabola(BodyIndex i) const {
    return (ways_[i] & (flies_bit | parabola_bit)) == (flies_bit | parabola_bit);
  }
  /// Whether besides nothing ties it, and it is alone in its island: all that most of a gas is.
  [[nodiscard]] bool is_plain(BodyIndex i) const { return (ways_[i] & all_bits) == all_bits; }
  /// Whether besides it is as large as most, and falls as they do.
  [[nodiscard]] bool is_usual(BodyIndex i) const {
    return (ways_[i] & (all_bits | usual_bit)) == (all_bits | usual_bit);
  }
  /// The flights of those of these bodies that `takes(k)`, which are such balls, beside that of
  /// another.
  template <typename Takes>
  void add_usual(std::span<const std::uint32_t> bodies, FlightsBeside& beside,
                 const Takes& takes) const {
    table_.add_usual(bodies, beside, takes);
  }
  /// `flight` of such a ball, and when that starts.
  [[nodiscard]] BallFlight usual_flight(BodyIndex i) const { return table_.usual_flight(i); }
  [[nodiscard]] Instant start_of_usual(BodyIndex i) const { return table_.start_of_flight(i); }
  /// The ball that bounds body i, on its way; its radius is infinite if it is on no parabola, or
  /// the body is unbounded.
  [[nodiscard]] BallFlight flight(BodyIndex i) const {
    return (ways_[i] & usual_bit) != 0 ? table_.usual_flight(i) : table_.flight(i);
  }
  /// That is about to be asked for.
  void look_up(BodyIndex i) const { table_.look_up(i); }
  /// It is about to be opened and launched.
  void look_up_all(BodyIndex i) const {
    table_.look_up(i);
    prefetch(booked_until_[i]);
  }
  [[nodiscard]] BodyState at(BodyIndex i, Instant t) const {
    return flies_parabola(i) ? fallen(flight(i), t) : table_.at(i, t);
  }
  /// Scratch of the event at hand, by body: an event brings a state here, changes it, and launches
  /// the body from it. Meaningless otherwise, except for fixed bodies.
  [[nodiscard]] BodyState& now(BodyIndex i) { return now_[i]; }
  [[nodiscard]] const BodyState& now(BodyIndex i) const { return now_[i]; }
  void bring(BodyIndex i, Instant t) {
    now_[i] = at(i, t);
    mark_brought(i, t);
  }
  /// The ledger follows the island of i up to t, and all its bodies are brought: before it jumps.
  void open(BodyIndex i, Instant t);
  /// Of two that meet: the ledger follows their islands, and both are brought.
  void open_pair(BodyIndex a, BodyIndex b, Instant t);
  /// `open` of a ball that `is_plain`, to where it is, which it gives.
  [[nodiscard]] BodyState open_ball(BodyIndex i, const PlainBall& ball, Instant t);
  /// `launch` of it from such a state.
  void launch_ball(BodyIndex i, const PlainBall& ball, const BodyState& state, Instant t);
  /// Every body of the island of i but i itself.
  void bring_others(BodyIndex i, Instant t);
  [[nodiscard]] const std::vector<BodyIndex>& island(BodyIndex i) const {
    return run_.model.islands()[run_.model.island_of(i)].bodies;
  }

  /// The state of the island of i has jumped to `now`: new motions from there.
  void launch(BodyIndex i, Instant t);
  /// The same for a body that contact forces hold, alone in its island: it moves in closed form
  /// from `now`, at this acceleration (m/s^2; rad/s^2 for spheres, 0 for all others), until it is
  /// launched again.
  void hold(BodyIndex i, Instant t, const Twist& acceleration);
  /// The same along a motion that is known.
  void hold(BodyIndex i, Instant t, const Motion& motion);

  /// Body i, alone in its island, turns while it touches: it moves along `motion` from `now` to
  /// `end`. `worked`, from the motion's start on, J: what contact forces do to it as the x, what of
  /// all that they do is truncation as the y, and as the z what drives the joints of its mechanism
  /// does because of them; the last two are told with one body each.
  struct Turn {
    Motion motion;
    BodyState end;
    Polynomial<3> worked{};
  };
  void turn(BodyIndex i, Instant t, const Turn& turn);
  /// The same for the bodies of the island of i, which joints hold together, in its order.
  void turn_together(BodyIndex i, Instant t, std::span<const Turn> turns);

  /// The island of i, which joints and a contact hold, is at rest from `now` on, until it is
  /// launched again.
  void rest(BodyIndex i, Instant t);
  /// Velocities at `now` of an island with joints, up to which it has been booked, are put back
  /// onto their constraints. Positions are so at the end of the next segment: here they might push
  /// bodies that touch into each other.
  void put_onto_joints(BodyIndex i, Instant t);

  /// What a force does between two surfaces in touch that slide along each other, or are driven.
  struct SurfaceForce {
    BodyIndex a = 0;
    BodyIndex b = 0;
    bool slides = false;
    bool rides = false;   ///< goes with what is driven
    bool curved = false;  ///< `spent` tells the work: its direction or its force changes
    Vector3 force = Vector3::Zero();  ///< on b, N
    Vector3 along = Vector3::Zero();  ///< its tangential part
    Vector3 arm_a = Vector3::Zero();  ///< of spheres, from the centre to where they touch, m
    Vector3 arm_b = Vector3::Zero();
    Vector3 belt_a = Vector3::Zero();  ///< velocity of the surface beside that of the body, m/s
    Vector3 belt_b = Vector3::Zero();
    Polynomial<3> spent{};  ///< since `begun`, J: x, friction; y, belts; z, what is driven
    Instant begun{};
    BodyState from_a{};  ///< as far as the ledger has followed it
    BodyState from_b{};
    Instant booked{};

    void persist(Archive& archive);
  };
  /// Body i, held since t, is rubbed until it is held or launched anew: its work is booked with i.
  void add_surface_force(BodyIndex i, Instant t, SurfaceForce force);
  /// The segment of a body has ended: the next one.
  void go_on(BodyIndex i, Instant t);
  /// Body i has the hand's translation from t on, and its own orientation; what takes it from where
  /// it was to `state` is the hand's work. Until `let_go`.
  void carry(BodyIndex i, BodyIndex hand, const BodyState& state, Instant t);
  void let_go(BodyIndex i) { own_flow(i).carried = false; }

  /// Body i, which nothing holds, goes on as its image n: it is the same for whoever is told. The
  /// ledger has followed it to where it is `now`; it is launched before it is asked about again.
  void go_on_as(BodyIndex i, const Image& n);

  /// The surface that ball i rests or slides on.
  [[nodiscard]] const std::optional<Support>& support(BodyIndex i) const { return ties(i).support; }
  /// Takes effect with the next launch.
  void set_support(BodyIndex i, const std::optional<Support>& support);
  /// How many balls a surface supports.
  [[nodiscard]] std::uint32_t riders(BodyIndex surface) const { return riders_[surface]; }
  [[nodiscard]] bool is_supported_by(BodyIndex ball, BodyIndex surface) const {
    return support(ball) && support(ball)->surface == surface;
  }
  /// The fields that body i is in; they act from the next launch on.
  [[nodiscard]] const std::vector<BodyIndex>& fields(BodyIndex i) const { return ties(i).fields; }
  void set_fields(BodyIndex i, std::vector<BodyIndex> fields);
  [[nodiscard]] bool is_in_field(BodyIndex i, BodyIndex field) const;
  /// Whether a force takes energy from i, so that hops die down whatever the restitution.
  [[nodiscard]] bool is_damped(BodyIndex i) const;
  /// What surface and forces do to a ball on it, m/s^2: a_s.n - F.n / m, positive while it is
  /// pressed; the ball alone in its island and at `now`. `held`: the surface that supports it
  /// already carries what it can.
  [[nodiscard]] double pressing(BodyIndex ball, const Support& support, Instant t,
                                bool held = false) const;

  /// What acts on body i whatever its state, N: gravity and the fields that it is in.
  [[nodiscard]] Vector3 steady_force(BodyIndex i) const {
    return run_.model.gravity_force(i) + field_forces_at(i);
  }

  /// All that acts on a body at t but contacts, N, N m; of an island of several bodies, or with
  /// joints, what is constant.
  [[nodiscard]] Wrench acting(BodyIndex i, Instant t, const BodyState& state) const;

  /// The ledger follows the island of i up to t; `now` is then the state there.
  void book(BodyIndex i, Instant t) {
    if (is_plain(i)) {
      (void)book_plain(i, t);
    } else {
      book(flow_of(i), t);
    }
  }
  void book_all(Instant t);
  /// The states of all bodies at t, as they are told; until `end_drawing`, before the next event.
  [[nodiscard]] const State& draw(Instant t);
  void end_drawing() { swap_aside(); }
  /// What was drawn last, if there has been no event since.
  [[nodiscard]] State last_drawn() &&;

  /// Tells the recorder what happened to two bodies whose states did not jump.
  void note(EventKind kind, BodyIndex a, BodyIndex b, Instant t);
  /// The same of an event that lacks the states only.
  void note(Event event);
  [[nodiscard]] std::int64_t evaluations() const;
  /// What the event that is over left out of a jump, or nothing; see `JumpWatch`.
  [[nodiscard]] std::string_view left_out() const { return run_.jumps.left_out(now_); }

  void persist(Archive& archive);

 private:
  /// What holds a body, pushes it or rubs against it: of most that fly, nothing.
  struct Ties {
    std::optional<Support> support{};
    std::vector<BodyIndex> fields{};
    Vector3 field_force = Vector3::Zero();  ///< N, as of the last launch
    std::vector<SurfaceForce> surface_forces{};
    bool turns = false;                   ///< while it touches
    std::vector<Polynomial<3>> worked{};  ///< see `Turn`; none while nothing turns

    [[nodiscard]] bool any() const {
      return support || !fields.empty() || !surface_forces.empty() || turns;
    }
    void persist(Archive& archive);
  };
  /// An island. Its states are those at the end of the segment, and so is its projection.
  struct Flow : IslandRun {
    using IslandRun::IslandRun;

    bool exact = false;                       ///< the stepper has no error of its own
    bool held = false;                        ///< contact forces hold it: no stepper moves it
    std::unique_ptr<SupportForce> support{};  ///< while it slides under state-dependent forces
    std::vector<BodyState> launched{};        ///< where the segment began: for replays
    double lost = 0.0;                        ///< to roundoff, in the segment so far, J
    std::vector<BodyState> booked{};          ///< as far as the ledger has followed it

    void persist(Archive& archive);
  };

  /// Horner, as `Polynomial` does it.
  static BodyState fallen(const BallFlight& flight, Instant t) {
    const double s = t - flight.start;
    const Vector3& a = flight.acceleration;
    return {{(0.5 * a * s + flight.velocity) * s + flight.position, Quaternion(1.0, 0.0, 0.0, 0.0)},
            {a * s + flight.velocity, Vector3::Zero()}};
  }
  bool book_plain(BodyIndex i, Instant t);
  [[nodiscard]] bool launch_plain(BodyIndex i, Instant t);
  [[nodiscard]] bool fly_on(BodyIndex i, const BodyState& state, const Vector3& weight, double mass,
                            Instant t);
  void stay_at_start(Flow& flow, Instant t);
  void next_segment(Flow& flow, Instant t);
  void drive(BodyIndex i, Instant t);
  void set_motion(BodyIndex i, const Motion& motion);
  void keep_motion(BodyIndex i, const Motion& motion);
  void tell_motion(BodyIndex i, const Motion& motion);
  void hold(Flow& flow, Instant t);
  void set_forces(Flow& flow);
  [[nodiscard]] Vector3 field_forces_at(BodyIndex i) const;
  [[nodiscard]] Vector3 net_force(BodyIndex i) const;

  void book(Flow& flow, Instant t);
  void book_surface_forces(BodyIndex i, Instant t);
  void begin_turn(BodyIndex i, Flow& flow, std::size_t place, const Turn& turn);
  struct TurnedWork {
    double on_body = 0.0;         ///< of contact forces, J
    double through_joints = 0.0;  ///< of what its mechanism hangs on, because these act, J
  };
  [[nodiscard]] TurnedWork book_turn(BodyIndex i, Instant from, Instant to);
  [[nodiscard]] double riding_work(const Flow& flow, Instant t);
  [[nodiscard]] double new_roundoff(Flow& flow, Instant t);

  [[nodiscard]] std::unique_ptr<Flow> make_flow(std::size_t island) const;
  [[nodiscard]] bool may_share(std::size_t island);
  [[nodiscard]] bool is_shared(const Flow& flow) const { return &flow == shared_.get(); }
  /// That of the island of i: its own, or the one that all share which have none. Of no meaning
  /// once that of another island is asked for.
  [[nodiscard]] Flow& flow_of(BodyIndex i);
  /// One that the island of i has for itself from now on.
  Flow& own_flow(BodyIndex i);
  /// The one that its next launch takes: what nothing ties shares one.
  Flow& flow_to_launch(BodyIndex i);
  [[nodiscard]] Instant& booked_until(const Flow& flow) {
    return booked_until_[flow.island.bodies.front()];
  }
  [[nodiscard]] const Ties& ties(BodyIndex i) const { return ties_[i] ? *ties_[i] : no_ties_; }
  [[nodiscard]] Ties& tie(BodyIndex i);
  void forget_surface_forces(BodyIndex i);
  void swap_aside();
  void persist_bodies(Archive& archive);
  void set_forces_as_launched(Flow& flow);
  /// `now` of body i is its state at t.
  void mark_brought(BodyIndex i, Instant t) {
    if constexpr (watches_jumps) {
      run_.jumps.brought(i, t, now_[i]);
    }
  }
  void check_ready(BodyIndex first, Instant t) const;

  EventRun& run_;
  const Method& method_;
  MotionTable table_;
  const Ties no_ties_{};
  std::vector<std::unique_ptr<Ties>> ties_;  ///< null: none
  std::vector<std::uint32_t> riders_;        ///< by surface
  /// What is true of a body's motion, for `flies`, `flies_parabola` and `is_plain`.
  static constexpr std::uint8_t flies_bit = 1;
  static constexpr std::uint8_t parabola_bit = 2;
  static constexpr std::uint8_t untied_bit = 4;  ///< and it is no field
  static constexpr std::uint8_t usual_bit = 8;   ///< see `MotionTable`
  static constexpr std::uint8_t all_bits = flies_bit | parabola_bit | untied_bit;
  std::vector<std::uint8_t> ways_;
  std::vector<std::unique_ptr<Flow>> flows_;  ///< by island; null: it shares one
  std::vector<char> shares_;                  ///< by island: whether it may
  std::unique_ptr<Flow>
      shared_;  ///< of one body that falls freely, whichever it is now; null: none
  MemorylessStepper* falling_ = nullptr;  ///< its stepper
  std::vector<Instant> booked_until_;     ///< by first body of an island, as far as the ledger has
  std::int64_t evaluations_ = 0;          ///< of flows that are no more
  State now_;
  std::vector<BodyIndex> led_;  ///< bodies that are not free
  State aside_;                 ///< of these, what is not `now`: as they were drawn last
  // Scratch, by place in an island.
  std::vector<Motion> motions_;
  std::vector<BodyState> to_;
  std::vector<Vector3> given_;
};

}  // namespace core
}  // namespace kairos
