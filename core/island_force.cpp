#include "core/island_force.hpp"

#include <array>
#include <cassert>

namespace kairos {
inline namespace core {

IslandForce::IslandForce(std::shared_ptr<const Force> force, std::vector<std::size_t> places)
    : force_(std::move(force)), places_(std::move(places)) {
  assert(places_.size() <= most_bodies);
}

void IslandForce::add(Instant t, std::span<const BodyState> bodies,
                      std::span<Wrench> wrenches) const {
  std::array<BodyState, most_bodies> states;
  std::array<Wrench, most_bodies> added;
  const std::size_t n = places_.size();
  for (std::size_t i = 0; i < n; ++i) {
    states[i] = bodies[places_[i]];
  }
  force_->add(t, std::span(states).first(n), std::span(added).first(n));
  for (std::size_t i = 0; i < n; ++i) {
    wrenches[places_[i]].force += added[i].force;
    wrenches[places_[i]].torque += added[i].torque;
  }
}

double IslandForce::potential(Instant t, std::span<const BodyState> bodies) const {
  std::array<BodyState, most_bodies> states;
  const std::size_t n = places_.size();
  for (std::size_t i = 0; i < n; ++i) {
    states[i] = bodies[places_[i]];
  }
  return force_->potential(t, std::span(states).first(n));
}

}  // namespace core
}  // namespace kairos
