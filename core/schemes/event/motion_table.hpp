#pragma once

#include "core/contact_detector.hpp"
#include "core/model.hpp"
#include "core/prefetch.hpp"
#include "core/schemes/event/stored_motion.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

/// The motions that bodies have. That of a body that falls freely and does not turn, most of a gas,
/// is its *flight*, which is kept of every body; a `Motion` is made of it where one is asked for,
/// the same bit for bit. All other motions are stored beside that.
class MotionTable {
 public:
  explicit MotionTable(const Model& model);

  /// Body i moves like this from now on.
  void keep(BodyIndex i, const Motion& motion);

  /// Whether its flight would say all of the motion of body i, as it does now, if it went on along
  /// a parabola from `state`.
  [[nodiscard]] bool goes_on_as_parabola(BodyIndex i, const BodyState& state) const;
  /// It does so from now on.
  void keep_parabola(BodyIndex i, const BodyState& state, const Vector3& acceleration, Instant t);
  /// The same of one that `is_usual` and is accelerated as before; false where it is not.
  [[nodiscard]] bool keep_usual(BodyIndex i, const BodyState& state, const Vector3& acceleration,
                                Instant t);

  [[nodiscard]] Motion of(BodyIndex i) const;
  [[nodiscard]] Instant start(BodyIndex i) const {
    return !whole_.empty() ? whole_[i].start
           : is_flight(i)  ? throws_[i].start
                           : others_[place_[i]].start();
  }
  [[nodiscard]] double duration(BodyIndex i) const {
    return !whole_.empty() ? whole_[i].duration
           : is_flight(i)  ? std::numeric_limits<double>::infinity()
                           : others_[place_[i]].duration();
  }
  [[nodiscard]] Instant end(BodyIndex i) const { return start(i) + duration(i); }
  /// Where body i is at t and how it moves there; after its motion ends: as at the end.
  [[nodiscard]] BodyState at(BodyIndex i, Instant t) const;
  /// Whether that is all there is to know of its motion: no error radius, no turning, no end.
  [[nodiscard]] bool is_flight(BodyIndex i) const { return forms_[i].is_flight; }
  /// Whether that is a parabola, told as one even where it is straight, of a body that is upright.
  [[nodiscard]] bool is_parabola(BodyIndex i) const {
    return forms_[i].is_flight && forms_[i].position == 2 && forms_[i].velocity == 1 &&
           forms_[i].upright;
  }
  /// Where the ball is that bounds body i; its radius is infinite where that is on no parabola, or
  /// the body has no end.
  [[nodiscard]] BallFlight flight(BodyIndex i) const { return of(throws_[i], falls_[i]); }
  /// Whether body i is a ball like most, and falls as they do: then `usual_flight` is its flight.
  [[nodiscard]] bool is_usual(BodyIndex i) const;
  /// The same for less: what is the same for most is not looked up.
  [[nodiscard]] BallFlight usual_flight(BodyIndex i) const { return of(throws_[i], usual_); }
  [[nodiscard]] Instant start_of_flight(BodyIndex i) const { return throws_[i].start; }
  [[nodiscard]] const Vector3& usual_acceleration() const { return usual_.acceleration; }
  /// The flights of those of these bodies that `takes(k)`, which are such, beside one of such a
  /// body.
  template <typename Takes>
  void add_usual(std::span<const std::uint32_t> bodies, FlightsBeside& beside,
                 const Takes& takes) const {
    beside.add_alike(
        bodies.size(),
        [bodies, throws = throws_.data()](std::size_t k) -> const Throw& {
          return throws[bodies[k]];
        },
        takes);
  }
  /// The flight of body i is about to be asked for.
  void look_up(BodyIndex i) const { prefetch(throws_[i]); }

  /// A shape with the motion that it has, for as long as this lives and no motion is kept.
  class Moving {
   public:
    Moving(const Shape& shape, const Motion& whole) : shape_(shape), motion_(&whole) {}
    Moving(const Shape& shape, const MotionTable& of, BodyIndex i)
        : shape_(shape), made_(std::in_place), motion_(&made_->motion) {
      of.make(i, made_->motion);
    }
    Moving(const Moving&) = delete;
    Moving& operator=(const Moving&) = delete;
    operator MovingShape() const { return {shape_, *motion_}; }
    [[nodiscard]] const Motion& motion() const { return *motion_; }

   private:
    /// Not filled with zeros, of which a motion has room for many.
    struct Made {
      Made() {}  // NOLINT(modernize-use-equals-default)
      Motion motion;
    };

    const Shape& shape_;
    std::optional<Made> made_;
    const Motion* motion_;
  };
  [[nodiscard]] Moving moving(BodyIndex i) const {
    return whole_.empty() ? Moving(model_.shape(i), *this, i) : Moving(model_.shape(i), whole_[i]);
  }

  /// No coordinate of body i is greater in the first `s` seconds of its motion, m.
  [[nodiscard]] double coordinates_reached(BodyIndex i, double s) const;
  /// m.
  [[nodiscard]] double error_radius(BodyIndex i) const;

 private:
  /// How a flight is told as a motion.
  struct Form {
    std::uint8_t position = 0;  ///< degrees
    std::uint8_t velocity = 0;
    bool upright = false;  ///< its orientation is the identity, and else what the body began with
    bool is_flight = true;
  };

  [[nodiscard]] Quaternion orientation(BodyIndex i) const {
    return forms_[i].upright ? Quaternion(1.0, 0.0, 0.0, 0.0)
                             : model_.body(i).initial.pose.orientation;
  }
  /// A flight in two parts: what is of one body, in one line of the cache, and what many share.
  struct alignas(64) Throw {
    Vector3 position = Vector3::Zero();
    Vector3 velocity = Vector3::Zero();
    Instant start;
  };
  struct Fall {
    Vector3 acceleration = Vector3::Zero();
    double radius = std::numeric_limits<double>::infinity();
  };
  static BallFlight of(const Throw& thrown, const Fall& falls) {
    return {thrown.position, thrown.velocity, falls.acceleration, thrown.start, falls.radius};
  }
  void set_flight(BodyIndex i, const Motion& motion);
  [[nodiscard]] Form form_of(BodyIndex i, const Motion& motion) const;
  void store(BodyIndex i, const Motion& motion);
  /// The motion of body i, if it is a flight or kept among others; `out` is as it is made, or was
  /// that of body i when it was told in the same way.
  void make(BodyIndex i, Motion& out) const;

  static constexpr std::uint32_t nowhere = ~std::uint32_t{0};

  const Model& model_;
  std::vector<Throw> throws_;
  std::vector<Fall> falls_;
  Fall usual_;  ///< of the first ball that fell; its radius is infinite before
  std::vector<Form> forms_;
  std::vector<std::uint32_t> place_;  ///< in `others_`; nowhere: not there
  std::vector<StoredMotion> others_;
  std::vector<std::uint32_t> free_;  ///< places in `others_` that nobody has
  std::vector<Motion> whole_;        ///< of few bodies, where room is no matter; else empty
};

}  // namespace core
}  // namespace kairos
