#include "simulation/view/actor.hpp"

namespace kairos {
inline namespace simulation {

std::vector<Actor> actors_of(const Model& model) {
  std::vector<Actor> actors;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    actors.push_back({body.name, std::string(body.entity->kind()), body.shape, model.shape(i),
                      model.is_free(i), model.is_field(i), model.mobility(i) != Mobility::fixed});
  }
  return actors;
}

}  // namespace simulation
}  // namespace kairos
