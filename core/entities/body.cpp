#include "core/entities/ball.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {
namespace entities {
namespace {

/// A rigid body of any shape that impacts can turn. Under the thesis' law, which knows no rotation,
/// it exchanges momentum as a ball does.
class RigidBody : public Ball {
 public:
  [[nodiscard]] std::string_view kind() const override { return "body"; }
  [[nodiscard]] bool rotates() const override { return true; }
};

}  // namespace

EntityType body() {
  return {.kind = "body",
          .summary = "a rigid body of any shape; forces move it and impacts turn it",
          .source = "ours",
          .mobility = Mobility::free,
          .keys = {},
          .make = [](std::span<const double>) { return std::make_shared<const RigidBody>(); }};
}

}  // namespace entities
}  // namespace core
}  // namespace kairos
