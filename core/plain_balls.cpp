#include "core/plain_balls.hpp"

#include <array>
#include <map>

namespace kairos {
inline namespace core {
namespace {

bool is_plain(const Model& model, BodyIndex i) {
  if (!model.is_free(i) || !std::holds_alternative<Sphere>(model.shape(i)) || model.rotates(i) ||
      model.is_field(i) || model.jointed(i) || model.body(i).friction != 0.0) {
    return false;
  }
  const Island& island = model.islands()[model.island_of(i)];
  return model.closed_form(model.island_of(i)) && island.bodies.size() == 1 &&
         island.forces.empty();
}

}  // namespace

PlainBalls::PlainBalls(const Model& model)
    : combine_(model.scene().restitution_combine), kind_of_(model.size(), none) {
  using Key = std::array<double, 6>;
  std::map<Key, std::uint32_t> known;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (!is_plain(model, i)) {
      continue;
    }
    const Vector3& weight = model.gravity_force(i);
    const PlainBall ball{std::get<Sphere>(model.shape(i)).radius, model.inertia(i).mass,
                         model.body(i).restitution, weight};
    const Key key{ball.radius, ball.mass, ball.restitution, weight.x(), weight.y(), weight.z()};
    const auto [found, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(kinds_.size()));
    if (is_new) {
      kinds_.push_back(ball);
    }
    kind_of_[i] = found->second;
    ++count_;
  }
  for (const Grip& grip : model.grips()) {
    count_ -= kind_of_[grip.held] == none ? 0 : 1;
    kind_of_[grip.held] = none;
  }
}

}  // namespace core
}  // namespace kairos
