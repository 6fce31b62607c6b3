#include "experiments/metrics/metric_crossing.hpp"

#include <algorithm>
#include <variant>

namespace kairos::experiments {

CrossingWatch::CrossingWatch(const Model& model) {
  for (const auto& [a, b] : model.pairs()) {
    add(model, a, b, bounding_radius(model.shape(a)));
    add(model, b, a, bounding_radius(model.shape(b)));
  }
}

void CrossingWatch::add(const Model& model, BodyIndex body, BodyIndex solid, double widening) {
  if (!model.is_free(body) || model.is_free(solid) || model.is_field(solid)) {
    return;
  }
  Gate gate;
  gate.body = body;
  gate.solid = solid;
  if (const Box* box = std::get_if<Box>(&model.shape(solid))) {
    box->half_extents.minCoeff(&gate.axis);
    gate.clear = box->half_extents[gate.axis] + bounding_radius(model.shape(body));
    gate.face = box->half_extents.array() + widening;
  } else if (const auto* half_space = std::get_if<HalfSpace>(&model.shape(solid))) {
    gate.half_space = true;
    gate.normal_B = half_space->normal_B;
    gate.clear = bounding_radius(model.shape(body));
  } else {
    return;  // a sphere has no other side
  }
  gates_.push_back(gate);
}

bool CrossingWatch::within_face(const Gate& gate, const Vector3& now) {
  const double before = gate.last[gate.axis];
  const Vector3 at = gate.last + (now - gate.last) * (before / (before - now[gate.axis]));
  for (int i = 0; i < 3; ++i) {
    if (!gate.half_space && i != gate.axis && std::abs(at[i]) > gate.face[i]) {
      return false;
    }
  }
  return true;
}

void CrossingWatch::look(Gate& gate, const Vector3& now) {
  if (gate.side != 0 && (gate.last[gate.axis] < 0.0) != (now[gate.axis] < 0.0)) {
    gate.within_face = within_face(gate, now);
  }
  if (std::abs(now[gate.axis]) > gate.clear) {
    const int side = now[gate.axis] < 0.0 ? -1 : 1;
    gate.crossings += gate.side == -side && gate.within_face ? 1 : 0;
    gate.side = side;
  }
  gate.last = now;
}

void CrossingWatch::frame(const Frame& frame) {
  for (Gate& gate : gates_) {
    if (!frame.in_hand.empty() && frame.in_hand[gate.body] != 0) {
      gate.side = 0;  // a hand may put it anywhere
      continue;
    }
    const Vector3 at = frame.bodies[gate.solid].pose.to_body(frame.bodies[gate.body].pose.position);
    look(gate, gate.half_space ? Vector3(0.0, gate.normal_B.dot(at), 0.0) : at);
  }
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
