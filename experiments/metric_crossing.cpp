#include "experiments/metric_crossing.hpp"

#include <algorithm>
#include <variant>

namespace kairos::experiments {

CrossingWatch::CrossingWatch(const Model& model) {
  const auto add = [&](BodyIndex body, BodyIndex solid) {
    if (!model.is_free(body) || model.is_free(solid) || model.is_field(solid)) {
      return;
    }
    Gate gate;
    gate.body = body;
    gate.solid = solid;
    if (const Box* box = std::get_if<Box>(&model.shape(solid))) {
      box->half_extents.minCoeff(&gate.axis);
      gate.reach = box->half_extents.array() + bounding_radius(model.shape(body));
    } else if (std::holds_alternative<HalfSpace>(model.shape(solid))) {
      gate.half_space = true;
    } else {
      return;  // a sphere has no other side
    }
    gates_.push_back(gate);
  };
  for (const auto& [a, b] : model.pairs()) {
    add(a, b);
    add(b, a);
  }
}

bool CrossingWatch::passes(const Gate& gate, const Vector3& now) {
  const double before = gate.last[gate.axis];
  const double after = now[gate.axis];
  if ((before < 0.0) == (after < 0.0)) {
    return false;
  }
  if (gate.half_space) {
    return true;
  }
  const Vector3 at = gate.last + (now - gate.last) * (before / (before - after));
  for (int i = 0; i < 3; ++i) {
    if (i != gate.axis && std::abs(at[i]) > gate.reach[i]) {
      return false;
    }
  }
  return true;
}

void CrossingWatch::frame(const Frame& frame) {
  for (Gate& gate : gates_) {
    const Vector3 now =
        frame.bodies[gate.solid].pose.to_body(frame.bodies[gate.body].pose.position);
    gate.crossings += drawn_ && passes(gate, now) ? 1 : 0;
    gate.last = now;
  }
  drawn_ = true;
}

bool CrossingWatch::tunnelled() const {
  return std::any_of(gates_.begin(), gates_.end(),
                     [](const Gate& gate) { return gate.crossings % 2 != 0; });
}

std::int64_t CrossingWatch::crossings() const {
  std::int64_t sum = 0;
  for (const Gate& gate : gates_) {
    sum += gate.crossings;
  }
  return sum;
}

}  // namespace kairos::experiments
