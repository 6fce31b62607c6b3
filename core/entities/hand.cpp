#include "core/entity.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {
namespace entities {
namespace {

/// 7.5: a hand in a tracked glove. While its fist is closed, the ball that it holds is where the
/// hand is; the worlds see to that, and to the ball having no contacts until it is released and
/// clear of the hand. Open, it is something solid that a ball meets as it meets a bat.
///
/// Our reading, where the thesis is silent: a held ball has the hand's velocity and, unless
/// `release` says otherwise, keeps it when it is let go; an open hand is solid (8.3.3 counts its
/// penetrations); its velocity is the true one, since 13.8 belongs to the bat.
class Hand : public Entity {
 public:
  explicit Hand(double release) : release_(release) {}

  [[nodiscard]] std::string_view kind() const override { return "hand"; }
  [[nodiscard]] PhysicsType physics_type() const override { return PhysicsType::none; }
  [[nodiscard]] Mobility mobility() const override { return Mobility::driven; }
  [[nodiscard]] bool is_hand() const override { return true; }
  [[nodiscard]] double release_share() const override { return release_; }
  [[nodiscard]] Momentum get_momentum(const Body& self, const BodyState& state) const override {
    return {self.mass, state.twist.linear};
  }

 private:
  double release_;
};

}  // namespace

EntityType hand() {
  return {.kind = "hand",
          .summary =
              "follows a tracker; its closed fist holds a ball, which has no contacts until "
              "it is released and clear",
          .source = "7.5",
          .mobility = Mobility::driven,
          .keys = {{"release", "", 1.0, 0.0, 1e3,
                    "share of the hand's velocity that a released ball keeps (our reading: all)"}},
          .make = [](std::span<const double> values) {
            return std::make_shared<const Hand>(values[0]);
          }};
}

}  // namespace entities
}  // namespace core
}  // namespace kairos
