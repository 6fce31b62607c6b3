#pragma once

#include "core/random.hpp"
#include "experiments/random/random_scene.hpp"

#include <string>

namespace kairos::experiments {

/// Gives a body one of all shapes but half-spaces, of 0.02 to 0.5 times `length`.
void draw_shape(Random& random, double length, RandomBody& body);

/// The keys of its shape and size, but for the parts of a compound: these are tables of their own,
/// which stand after all keys of the body.
[[nodiscard]] std::string shape_toml(const RandomBody& body);
[[nodiscard]] std::string parts_toml(const RandomBody& body);

}  // namespace kairos::experiments
