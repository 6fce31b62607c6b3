#include "simulation/view/actor.hpp"

namespace kairos {
inline namespace simulation {

std::vector<Actor> actors_of(const Model& model) {
  std::vector<Actor> actors;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    const Vector3 belt = body.entity->surface_velocity(body, body.initial);
    actors.push_back({.name = body.name,
                      .entity = std::string(body.entity->kind()),
                      .shape = body.shape,
                      .collides_as = model.shape(i),
                      .is_free = model.is_free(i),
                      .is_field = model.is_field(i),
                      .moves = model.mobility(i) != Mobility::fixed,
                      .belt = body.initial.pose.orientation.conjugate() * belt});
  }
  return actors;
}

}  // namespace simulation
}  // namespace kairos
