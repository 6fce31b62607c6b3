#include "core/entity.hpp"
#include "core/model.hpp"
#include "core/reading/scene_reader.hpp"
#include "tests/catch.hpp"
#include "tests/locations.hpp"

using namespace kairos;

TEST_CASE("balloon: a ball whose gravity is scaled and reversed", "[entity]") {
  const EntityType* type = find_entity("balloon");
  REQUIRE(type != nullptr);
  const double buoyancy[] = {0.5};
  const auto balloon = type->make(buoyancy);
  CHECK(balloon->gravity_direction() == Vector3(0, 0.5, 0));
  CHECK(balloon->mobility() == Mobility::free);
  // In a collision it is a ball: it exchanges momentum, and takes forces.
  CHECK(balloon->physics_type() == PhysicsType::ball);
  Body self;
  self.mass = 1.0;
  BodyState state;
  balloon->give_momentum(self, state, {PhysicsType::ball, {1.0, {3, 2, 1}}, std::nullopt, {}});
  CHECK(state.twist.linear == Vector3(3, 2, 1));
  Vector3 force = Vector3::Zero();
  balloon->give_force(force, {0, 1, 0});
  CHECK(force == Vector3(0, 1, 0));
}

TEST_CASE("balloon: rises in its scene", "[entity]") {
  const Model model(read_scene(tests::source_path("scenes/balloon.toml")));
  CHECK(model.gravity_force(1).y() == Approx(0.01 * 0.2 * 9.8).epsilon(1e-15));
  CHECK(model.closed_form(0));
}
