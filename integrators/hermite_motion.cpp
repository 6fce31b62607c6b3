#include "integrators/hermite_motion.hpp"

#include "integrators/dense_output.hpp"

#include <cassert>

namespace kairos::integrators {
namespace {

constexpr std::size_t max_nodes = 6;

Vector3 vector3(const double* from) { return {from[0], from[1], from[2]}; }
Vector4 vector4(const double* from) { return {from[0], from[1], from[2], from[3]}; }

}  // namespace

void HermiteMotion::resize(std::size_t nodes, std::size_t size) {
  assert(nodes >= 2 && nodes <= max_nodes);
  size_ = size;
  used_ = 0;
  times_.assign(nodes, 0.0);
  values_.assign(2 * nodes * size, 0.0);
}

HermiteMotion::Node HermiteMotion::add(double s) {
  assert(used_ < times_.size() && (used_ > 0 || s == 0.0));
  times_[used_] = s;
  double* const y = &values_[2 * used_ * size_];
  ++used_;
  return {y, y + size_};
}

void HermiteMotion::motions(const IslandOde& ode, bool constant_acceleration,
                            std::span<const Quaternion> orientations, std::span<Motion> out) const {
  assert(used_ >= 2);
  const std::span<const IslandOde::Slot> slots = ode.slots();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t offset = slots[i].offset;
    Motion& motion = out[i];
    motion.start = start_;
    motion.duration = times_[used_ - 1];
    motion.error_radius = 0.0;
    if (constant_acceleration) {
      parabola(motion, vector3(y(0) + offset + IslandOde::position),
               vector3(y(0) + offset + IslandOde::velocity),
               vector3(rate(0) + offset + IslandOde::velocity));
    } else {
      translation(offset, motion);
    }
    if (slots[i].rotates) {
      rotation(offset, motion);
    } else {
      fixed_rotation(motion, orientations[i]);
    }
  }
}

void HermiteMotion::translation(std::size_t offset, Motion& motion) const {
  std::array<HermiteNode<3>, max_nodes> position, velocity;
  for (std::size_t n = 0; n < used_; ++n) {
    const bool is_end = n == 0 || n + 1 == used_;
    const Vector3 v = vector3(y(n) + offset + IslandOde::velocity);
    const Vector3 a = vector3(rate(n) + offset + IslandOde::velocity);
    position[n] = {times_[n], is_end ? 3 : 2, {vector3(y(n) + offset + IslandOde::position), v, a}};
    velocity[n] = {times_[n], 2, {v, a, Vector3::Zero()}};
  }
  motion.position = hermite<3>({position.data(), used_});
  motion.velocity = hermite<3>({velocity.data(), used_});
}

void HermiteMotion::rotation(std::size_t offset, Motion& motion) const {
  std::array<HermiteNode<4>, max_nodes> orientation;
  std::array<HermiteNode<3>, max_nodes> angular;
  Vector4 previous = vector4(y(0) + offset + IslandOde::quaternion);
  for (std::size_t n = 0; n < used_; ++n) {
    const bool is_end = n == 0 || n + 1 == used_;
    Vector4 q = vector4(y(n) + offset + IslandOde::quaternion);
    q = q.dot(previous) < 0.0 ? Vector4(-q) : q;  // on the near side of its neighbour
    previous = q;
    const Vector3 w = vector3(y(n) + offset + IslandOde::angular);
    const Vector3 acceleration = vector3(rate(n) + offset + IslandOde::angular);
    const Vector4 first = quaternion_rate(w, q);
    orientation[n] = {times_[n],
                      is_end ? 3 : 2,
                      {q, first, quaternion_rate(acceleration, q) + quaternion_rate(w, first)}};
    angular[n] = {times_[n], 2, {w, acceleration, Vector3::Zero()}};
  }
  motion.rotation = RotationKind::polynomial;
  motion.quaternion = hermite<4>({orientation.data(), used_});
  motion.angular_velocity = hermite<3>({angular.data(), used_});
}

}  // namespace kairos::integrators
