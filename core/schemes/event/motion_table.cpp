#include "core/schemes/event/motion_table.hpp"

#include "core/large_pages.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

/// So few bodies keep their motions as they are too, which is faster.
constexpr std::size_t few = 128;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Tells -0 from 0. std::bit_cast is not in the oldest libc++ that is built with.
bool same_bits(double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; }
bool same_bits(const Vector3& x, const Vector3& y) {
  return same_bits(x[0], y[0]) && same_bits(x[1], y[1]) && same_bits(x[2], y[2]);
}
bool same_bits(const Vector4& x, const Quaternion& q) {
  return same_bits(x[0], q.w()) && same_bits(x[1], q.x()) && same_bits(x[2], q.y()) &&
         same_bits(x[3], q.z());
}
bool same_bits(const Quaternion& p, const Quaternion& q) {
  return same_bits(p.w(), q.w()) && same_bits(p.x(), q.x()) && same_bits(p.y(), q.y()) &&
         same_bits(p.z(), q.z());
}
bool is_positive_zero(const Vector3& x) { return same_bits(x, Vector3(0.0, 0.0, 0.0)); }

Vector3 coefficient(const Polynomial<3>& p, int k) {
  return k <= p.degree() ? Vector3(p[k]) : Vector3(0.0, 0.0, 0.0);
}

}  // namespace

MotionTable::MotionTable(const Model& model)
    : model_(model),
      throws_(scattered<Throw>(model.size())),
      falls_(model.size()),
      forms_(model.size()),
      place_(model.size(), nowhere),
      whole_(model.size() <= few ? model.size() : 0) {}

void MotionTable::keep(BodyIndex i, const Motion& motion) {
  set_flight(i, motion);
  forms_[i] = form_of(i, motion);
  if (!whole_.empty()) {
    whole_[i] = motion;
    return;
  }
  if (!forms_[i].is_flight) {
    store(i, motion);
  } else if (place_[i] != nowhere) {
    free_.push_back(place_[i]);
    place_[i] = nowhere;
  }
}

bool MotionTable::goes_on_as_parabola(BodyIndex i, const BodyState& state) const {
  return is_parabola(i) && same_bits(state.pose.orientation, Quaternion(1.0, 0.0, 0.0, 0.0));
}

void MotionTable::keep_parabola(BodyIndex i, const BodyState& state, const Vector3& acceleration,
                                Instant t) {
  throws_[i] = {state.pose.position, state.twist.linear, t};
  if (!same_bits(falls_[i].acceleration, acceleration)) {
    falls_[i].acceleration = acceleration;
  }
  if (!whole_.empty()) {
    make(i, whole_[i]);
  }
}

bool MotionTable::keep_usual(BodyIndex i, const BodyState& state, const Vector3& acceleration,
                             Instant t) {
  if (!whole_.empty() || !same_bits(acceleration, usual_.acceleration)) {
    return false;
  }
  throws_[i] = {state.pose.position, state.twist.linear, t};
  return true;
}

bool MotionTable::is_usual(BodyIndex i) const {
  return same_bits(falls_[i].acceleration, usual_.acceleration) &&
         same_bits(falls_[i].radius, usual_.radius);
}

void MotionTable::store(BodyIndex i, const Motion& motion) {
  if (place_[i] == nowhere && free_.empty()) {
    place_[i] = static_cast<std::uint32_t>(others_.size());
    others_.emplace_back();
  } else if (place_[i] == nowhere) {
    place_[i] = free_.back();
    free_.pop_back();
  }
  others_[place_[i]] = motion;
}

void MotionTable::set_flight(BodyIndex i, const Motion& motion) {
  Fall& falls = falls_[i];
  if (motion.position.degree() > 2) {
    falls.radius = infinity;
    return;
  }
  const Shape& shape = model_.shape(i);
  // What is no ball may touch by what a detector leaves and its bounding ball, rounded, does not.
  const double more = std::holds_alternative<Sphere>(shape) ? 1.0 : 1.0 + 0x1p-20;
  throws_[i] = {coefficient(motion.position, 0), coefficient(motion.position, 1), motion.start};
  falls = {2.0 * coefficient(motion.position, 2),
           more * bounding_radius(shape) + motion.error_radius};
  if (usual_.radius == infinity && model_.is_free(i) && std::holds_alternative<Sphere>(shape)) {
    usual_ = falls;
  }
}

/// Whether its flight says all of a motion, every bit of it, and how.
MotionTable::Form MotionTable::form_of(BodyIndex i, const Motion& motion) const {
  Form form{.is_flight = false};
  if (!model_.is_free(i) || motion.rotation != RotationKind::fixed ||
      motion.position.degree() > 2 || motion.velocity.degree() > 1 ||
      motion.quaternion.degree() > 0 || motion.angular_velocity.degree() > 0) {
    return form;
  }
  const BallFlight flight = this->flight(i);
  form.position = static_cast<std::uint8_t>(motion.position.degree());
  form.velocity = static_cast<std::uint8_t>(motion.velocity.degree());
  form.upright = same_bits(motion.quaternion[0], Quaternion(1.0, 0.0, 0.0, 0.0));
  form.is_flight =
      motion.duration == infinity && motion.error_radius == 0.0 &&
      same_bits(coefficient(motion.position, 2), 0.5 * flight.acceleration) &&
      same_bits(motion.velocity[0], flight.velocity) &&
      (form.velocity == 0 ? flight.acceleration.isZero(0.0)
                          : same_bits(motion.velocity[1], flight.acceleration)) &&
      is_positive_zero(motion.rotation_rate) && is_positive_zero(motion.angular_velocity[0]) &&
      (form.upright || same_bits(motion.quaternion[0], model_.body(i).initial.pose.orientation));
  return form;
}

Motion MotionTable::of(BodyIndex i) const {
  if (!whole_.empty()) {
    return whole_[i];
  }
  Motion motion;
  make(i, motion);
  return motion;
}

void MotionTable::make(BodyIndex i, Motion& out) const {
  if (!is_flight(i)) {
    out = others_[place_[i]].motion();
    return;
  }
  const BallFlight flight = this->flight(i);
  const Form form = forms_[i];
  out.start = flight.start;
  out.duration = infinity;
  out.position.resize(form.position);
  out.velocity.resize(form.velocity);
  out.position[0] = flight.position;
  out.velocity[0] = flight.velocity;
  if (form.position > 0) {
    out.position[1] = flight.velocity;
  }
  if (form.position > 1) {
    out.position[2] = 0.5 * flight.acceleration;
  }
  if (form.velocity > 0) {
    out.velocity[1] = flight.acceleration;
  }
  if (!form.upright) {
    const Quaternion q = orientation(i);
    out.quaternion[0] = Vector4(q.w(), q.x(), q.y(), q.z());
  }
}

BodyState MotionTable::at(BodyIndex i, Instant t) const {
  if (!whole_.empty()) {
    const Motion& motion = whole_[i];
    const double s = std::min(t - motion.start, motion.duration);
    return {motion.pose(s), motion.twist(s)};
  }
  if (!is_flight(i)) {
    const StoredMotion& motion = others_[place_[i]];
    return motion.at(std::min(t - motion.start(), motion.duration()));
  }
  // Horner, as `Polynomial` does it.
  const BallFlight flight = this->flight(i);
  const Form form = forms_[i];
  const double s = t - flight.start;
  Vector3 p = flight.position;
  Vector3 v = flight.velocity;
  if (form.position == 2) {
    p = (0.5 * flight.acceleration * s + flight.velocity) * s + flight.position;
  } else if (form.position == 1) {
    p = flight.velocity * s + flight.position;
  }
  if (form.velocity == 1) {
    v = flight.acceleration * s + flight.velocity;
  }
  return {{p, orientation(i)}, {v, Vector3::Zero()}};
}

double MotionTable::coordinates_reached(BodyIndex i, double s) const {
  if (is_flight(i)) {
    const BallFlight flight = this->flight(i);
    return (0.5 * flight.acceleration.lpNorm<Eigen::Infinity>() * s +
            flight.velocity.lpNorm<Eigen::Infinity>()) *
               s +
           flight.position.lpNorm<Eigen::Infinity>();
  }
  if (whole_.empty()) {
    const StoredMotion& motion = others_[place_[i]];
    return motion.coordinates_reached(std::min(motion.duration(), s));
  }
  const Motion& motion = whole_[i];
  const double end = std::min(motion.duration, s);
  double reached = 0.0;
  for (int k = motion.position.degree(); k >= 0; --k) {
    reached = reached * end + motion.position[k].lpNorm<Eigen::Infinity>();
  }
  return reached;
}

double MotionTable::error_radius(BodyIndex i) const {
  if (is_flight(i)) {
    return 0.0;
  }
  return whole_.empty() ? others_[place_[i]].error_radius() : whole_[i].error_radius;
}

}  // namespace core
}  // namespace kairos
