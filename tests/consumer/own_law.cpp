// An impact law of one's own: a wall that sends back everything at the same speed.
#include <kairos/simulation.hpp>

#include <iostream>
#include <memory>

namespace {

/// Whatever approaches leaves along the normal at one metre a second; the rest of its motion stays.
class Launcher final : public kairos::ImpactLaw {
 public:
  [[nodiscard]] kairos::LawInfo info() const override {
    return {.name = "launcher", .needs_contact = true, .summary = "sends back at 1 m/s"};
  }
  kairos::ImpactEnergy apply(const kairos::Contact& contact, kairos::ImpactBody a,
                             kairos::ImpactBody b) const override {
    if (kairos::normal_velocity(contact, a.state, b.state) >= 0.0) {
      return {};
    }
    kairos::ImpactBody& mover = a.inertia.mass > 0.0 ? a : b;
    const kairos::Vector3 out =
        a.inertia.mass > 0.0 ? kairos::Vector3(-contact.normal) : contact.normal;
    kairos::Vector3& v = mover.state.twist.linear;
    const double before = 0.5 * mover.inertia.mass * v.squaredNorm();
    v += (1.0 - v.dot(out)) * out;
    // What it gives or takes is booked: the ledger stays closed.
    return {.driven_work = 0.5 * mover.inertia.mass * v.squaredNorm() - before};
  }
};

}  // namespace

int main() {
  using namespace kairos;
  const Scene scene = SceneBuilder("launcher")
                          .set("duration", 2.0)
                          .set("G", 0.0)
                          .body("wall", {{"entity", "wall"}, {"shape", "half-space"}})
                          .body("ball", {{"entity", "ball"},
                                         {"radius", 0.1},
                                         {"mass", 1.0},
                                         {"position", Vector3(0.0, 3.1, 0.0)},
                                         {"velocity", Vector3(0.0, -3.0, 0.0)}})
                          .scene();
  const Simulation run = simulate(scene, {}, {.impact = std::make_shared<Launcher>()});
  std::cout << "y = " << run.result.state[1].pose.position.y() << " m, unexplained "
            << run.result.ledger.unexplained() << " J\n";
}
