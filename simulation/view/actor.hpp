#pragma once

#include "core/model.hpp"

#include <string>
#include <vector>

namespace kairos {
inline namespace simulation {

/// What a picture needs to know of a body.
struct Actor {
  std::string name;
  std::string entity;
  Shape shape;           ///< as it is seen
  Shape collides_as;     ///< its box where it collides as one
  bool is_free = false;  ///< moved by forces and impacts
  bool is_field = false;
  bool moves = false;              ///< free or driven
  Vector3 belt = Vector3::Zero();  ///< how its surface runs at the start, body frame, m/s
};

/// One per body, in their order.
[[nodiscard]] std::vector<Actor> actors_of(const Model& model);

}  // namespace simulation
}  // namespace kairos
