// A force of one's own: a spring to the origin, written here, added to a scene written here.
#include <kairos/simulation.hpp>

#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

namespace {

/// F = -k p on the one body that it is given.
class Tether final : public kairos::Force {
 public:
  explicit Tether(double stiffness) : k_(stiffness) {}
  void add(kairos::Instant, std::span<const kairos::BodyState> bodies,
           std::span<kairos::Wrench> wrenches) const override {
    wrenches[0].force += -k_ * bodies[0].pose.position;
  }
  [[nodiscard]] double potential(kairos::Instant,
                                 std::span<const kairos::BodyState> bodies) const override {
    return 0.5 * k_ * bodies[0].pose.position.squaredNorm();
  }
  [[nodiscard]] bool conservative() const override { return true; }
  [[nodiscard]] bool involves_rotation() const override { return false; }
  [[nodiscard]] std::string description() const override { return "tether"; }

 private:
  double k_;  // N/m
};

}  // namespace

int main() {
  using namespace kairos;
  Scene scene = SceneBuilder("tether")
                    .set("duration", 1.0)
                    .set("G", 0.0)
                    .body("bob", {{"entity", "ball"},
                                  {"radius", 0.1},
                                  {"mass", 1.0},
                                  {"position", Vector3(1.0, 0.0, 0.0)}})
                    .scene();
  const double pi = std::numbers::pi;
  scene.forces.push_back({std::make_shared<Tether>(pi * pi), {0}});  // half a period in a second
  const Simulation run = simulate(scene);
  std::cout.precision(9);
  std::cout << "x = " << run.result.state[0].pose.position.x() << " m after half a period\n";
}
