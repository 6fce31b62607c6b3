#pragma once

#include "core/ball_flight.hpp"
#include "core/broad_phase.hpp"
#include "core/contact_detector.hpp"
#include "core/instant.hpp"
#include "core/periodic_box.hpp"
#include "core/state.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

class Archive;
class Model;

/// Somebody who is near: in a periodic box, which image of it.
struct Neighbour {
  BodyIndex body = 0;
  Image image{};
};

/// Port: which bodies could meet this one, while every body moves from a time of its own?
///
/// A body *enters* with each new motion, and *crosses* where what was told of it ends. Whoever of
/// two does so last is told of the other: before two bodies touch, `near` has told one of them, or
/// `cross` has. What is told costs a query and changes no result.
class Neighbourhood {
 public:
  virtual ~Neighbourhood() = default;

  /// Body i moves like this from t on, at least until `until`. Returns when it must cross at the
  /// latest; `Instant::never()`: what is told holds until then.
  virtual Instant enter(BodyIndex i, const MovingShape& moving, Instant t, Instant until) = 0;
  /// The same where body i has the centre of this ball, exactly and for ever, and perhaps sooner;
  /// nothing: that has to be asked, as always by default.
  virtual std::optional<Instant> enter(BodyIndex /*i*/, const BallFlight& /*flight*/, Instant /*t*/,
                                       Instant /*until*/) {
    return std::nullopt;
  }
  /// Every body that i could meet before it crosses, appended in any order; also all that touch it
  /// now. Some of them it cannot meet.
  virtual void near(BodyIndex i, std::vector<Neighbour>& out) = 0;
  /// The same, where some that are near as themselves are told apart, by their numbers; these may
  /// hold i too.
  virtual void near_apart(BodyIndex i, std::vector<std::uint32_t>& /*themselves*/,
                          std::vector<Neighbour>& others) {
    near(i, others);
  }
  /// Body i, on the motion with which it entered, has come to the end of what was told of it: those
  /// that it could meet from here on and of which nobody was told, appended. Returns as `enter`.
  virtual Instant cross(BodyIndex i, const MovingShape& moving, Instant t, Instant until,
                        std::vector<Neighbour>& out) = 0;
  /// The same as of `enter`, and as `near_apart` tells it.
  virtual std::optional<Instant> cross(BodyIndex /*i*/, const BallFlight& /*flight*/, Instant /*t*/,
                                       Instant /*until*/,
                                       std::vector<std::uint32_t>& /*themselves*/,
                                       std::vector<Neighbour>& /*others*/) {
    return std::nullopt;
  }
  /// Body i is counted on as its image n, on the motion that it has.
  virtual void go_on_as(BodyIndex i, const Image& n) = 0;

  /// What depends on how bodies came to be where they are.
  virtual void persist(Archive& archive) = 0;
};

/// `tolerance`: of the detector, m; 0: its default.
using NeighbourhoodFactory =
    std::function<std::unique_ptr<Neighbourhood>(const Model& model, double tolerance)>;

}  // namespace core
}  // namespace kairos
