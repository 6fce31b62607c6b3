#include "core/entities/ball.hpp"
#include "core/scene.hpp"

namespace kairos {
inline namespace core {
namespace entities {
namespace {

/// 9.2.1.1: a ball whose gravity is scaled and reversed, so that it floats upwards.
class Balloon : public Ball {
 public:
  explicit Balloon(double buoyancy) : buoyancy_(buoyancy) {}

  [[nodiscard]] std::string_view kind() const override { return "balloon"; }
  [[nodiscard]] Vector3 gravity_direction() const override { return {0.0, buoyancy_, 0.0}; }

 private:
  double buoyancy_;
};

}  // namespace

EntityType balloon() {
  return {.kind = "balloon",
          .summary = "a ball that falls upwards",
          .source = "9.2.1.1",
          .mobility = Mobility::free,
          .keys = {{"buoyancy", "", 1.0, 0.0, 1e6, "scale of its gravity, which is reversed"}},
          .make = [](std::span<const double> values) {
            return std::make_shared<const Balloon>(values[0]);
          }};
}

}  // namespace entities
}  // namespace core
}  // namespace kairos
