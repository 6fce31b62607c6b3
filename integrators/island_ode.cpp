#include "integrators/island_ode.hpp"

#include "integrators/dense_output.hpp"

namespace kairos::integrators {
namespace {

using ConstMap3 = Eigen::Map<const Vector3>;
using Map3 = Eigen::Map<Vector3>;
using ConstMap4 = Eigen::Map<const Vector4>;
using Map4 = Eigen::Map<Vector4>;

}  // namespace

void IslandOde::layout(const Island& island) {
  slots_.clear();
  size_ = 0;
  for (const BodyInertia& inertia : island.inertia) {
    slots_.push_back({size_, inertia.rotates});
    size_ += inertia.rotates ? 13 : 6;
  }
  states_.assign(slots_.size(), {});
  wrenches_.assign(slots_.size(), {});
}

void IslandOde::pack(std::span<const BodyState> states, double* y) const {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    double* const body = y + slots_[i].offset;
    Map3(body + position) = states[i].pose.position;
    Map3(body + velocity) = states[i].twist.linear;
    if (slots_[i].rotates) {
      Map4(body + quaternion) = as_vector(states[i].pose.orientation);
      Map3(body + angular) = states[i].twist.angular;
    }
  }
}

void IslandOde::unpack(const double* y, std::span<BodyState> states) const {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const double* const body = y + slots_[i].offset;
    states[i].pose.position = ConstMap3(body + position);
    states[i].twist.linear = ConstMap3(body + velocity);
    if (slots_[i].rotates) {
      const double* const q = body + quaternion;
      states[i].pose.orientation = Quaternion(q[0], q[1], q[2], q[3]).normalized();
      states[i].twist.angular = ConstMap3(body + angular);
    }
  }
}

void IslandOde::normalize(double* y) const {
  for (const Slot& slot : slots_) {
    if (slot.rotates) {
      Map4(y + slot.offset + quaternion).normalize();
    }
  }
}

void IslandOde::rhs(double s, const double* y, double* dy) {
  ++evaluations_;
  unpack(y, states_);
  island_->wrenches(epoch_ + s, states_, wrenches_);
  rate(*island_, states_, wrenches_, dy);
  for (const Slot& slot : slots_) {
    if (slot.rotates) {  // linear in the quaternion as it is, not as normalised for the forces
      const std::size_t q = slot.offset + quaternion;
      Map4(dy + q) = quaternion_rate(ConstMap3(y + slot.offset + angular), ConstMap4(y + q));
    }
  }
}

void IslandOde::rate(const Island& island, std::span<const BodyState> states,
                     std::span<const Wrench> wrenches, double* dy) const {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    double* const body = dy + slots_[i].offset;
    const BodyInertia& inertia = island.inertia[i];
    const BodyState& state = states[i];
    Map3(body + position) = state.twist.linear;
    Map3(body + velocity) = wrenches[i].force / inertia.mass;
    if (slots_[i].rotates) {
      Map4(body + quaternion) =
          quaternion_rate(state.twist.angular, as_vector(state.pose.orientation));
      Map3(body + angular) = angular_acceleration(inertia, state, wrenches[i].torque);
    }
  }
}

}  // namespace kairos::integrators
