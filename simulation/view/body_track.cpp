#include "simulation/view/body_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace simulation {
namespace {

/// m; for orientations of the quaternion's components. Far below what a page can show, far above
/// what rounding adds to a path that is handed on from frame to frame.
constexpr double same_path = 1e-11;

bool simple(const Motion& motion) {
  return motion.position.degree() <= 2 && motion.velocity.degree() <= 1 &&
         motion.rotation != RotationKind::polynomial && motion.angular_velocity.degree() == 0;
}

/// Whether `next` is what `motion` does anyway. Parabolas that agree at three instants are the
/// same.
bool goes_on(const Motion& motion, const Motion& next) {
  const double s0 = next.start - motion.start;
  if (!simple(motion) || !simple(next) || motion.rotation != next.rotation ||
      motion.rotation_rate != next.rotation_rate || !(motion.duration >= s0 * (1.0 - 1e-12))) {
    return false;
  }
  const double h = std::isfinite(next.duration) ? next.duration : 10.0;
  const double scale = 1.0 + next.position[0].norm();
  for (const double part : {0.0, 0.5, 1.0}) {
    const double s = part * h;
    const Pose was = motion.pose(s0 + s);
    const Pose is = next.pose(s);
    if (!((was.position - is.position).norm() <= same_path * scale) ||
        !((was.orientation.coeffs() - is.orientation.coeffs()).norm() <= same_path) ||
        !((motion.velocity(s0 + s) - next.velocity(s)).norm() <=
          same_path * (1.0 + next.velocity[0].norm()))) {
      return false;
    }
  }
  return true;
}

bool is_derivative(const Polynomial<3>& velocity, const Polynomial<3>& position) {
  const Polynomial<3> derivative = position.differentiated();
  if (velocity.degree() != derivative.degree()) {
    return false;
  }
  for (int k = 0; k <= velocity.degree(); ++k) {
    if (velocity[k] != derivative[k]) {
      return false;
    }
  }
  return true;
}

template <int Dim>
void append(std::vector<double>& out, const Polynomial<Dim>& p) {
  for (int k = 0; k <= p.degree(); ++k) {
    out.insert(out.end(), p[k].data(), p[k].data() + Dim);
  }
}

template <int Dim>
std::uint8_t degree_of(const Polynomial<Dim>& p) {
  return static_cast<std::uint8_t>(p.degree());
}

}  // namespace

void BodyTrack::add(const Motion& motion) {
  if (last_ && last_->start < motion.start && goes_on(*last_, motion)) {
    last_->duration = (motion.start - last_->start) + motion.duration;
    return;
  }
  if (last_ && last_->start < motion.start) {
    encode(*last_, std::min(last_->duration, motion.start - last_->start));
    before_ = last_;
  }
  last_ = motion;
  while (!start.empty() && start.back() >= motion.start.seconds) {
    drop_last();
  }
}

void BodyTrack::count_at_start() {
  const double t = last_->start.seconds;
  last_->start = {std::nextafter(t, -std::numeric_limits<double>::infinity()), 0.0};
}

void BodyTrack::finish() {
  if (last_) {
    encode(*last_, last_->duration);
  }
}

Pose BodyTrack::leaving(Instant t) const {
  return last_->pose(std::clamp(t - last_->start, 0.0, last_->duration));
}

Pose BodyTrack::arriving(Instant t) const {
  if (last_->start < t || !before_) {
    return leaving(t);
  }
  const double until = std::min(before_->duration, last_->start - before_->start);
  return before_->pose(std::clamp(t - before_->start, 0.0, until));
}

void BodyTrack::encode(const Motion& motion, double duration_s) {
  start.push_back(motion.start.seconds);
  duration.push_back(duration_s);
  const bool velocity_derived = is_derivative(motion.velocity, motion.position);
  const Vector4& q = motion.quaternion[0];
  const bool is_upright =
      motion.rotation == RotationKind::fixed && q == Vector4(1.0, 0.0, 0.0, 0.0);
  const bool angular_derived =
      motion.rotation == RotationKind::fixed ||
      (motion.rotation == RotationKind::constant_rate && motion.angular_velocity.degree() == 0 &&
       motion.angular_velocity[0] == motion.rotation_rate);
  const auto rotation =
      is_upright ? upright : static_cast<std::uint8_t>(static_cast<int>(motion.rotation));
  for (const std::uint8_t part :
       {degree_of(motion.position), velocity_derived ? derived : degree_of(motion.velocity),
        rotation, degree_of(motion.quaternion),
        angular_derived ? derived : degree_of(motion.angular_velocity)}) {
    layout.push_back(part);
  }
  append(coefficients, motion.position);
  if (!velocity_derived) {
    append(coefficients, motion.velocity);
  }
  if (!is_upright) {
    append(coefficients, motion.quaternion);
  }
  if (motion.rotation == RotationKind::constant_rate) {
    append(coefficients, Polynomial<3>(motion.rotation_rate));
  }
  if (!angular_derived) {
    append(coefficients, motion.angular_velocity);
  }
}

/// Takes back the segment that was encoded last.
void BodyTrack::drop_last() {
  const std::uint8_t* of = layout.data() + layout.size() - layout_size;
  const auto size = [](std::uint8_t degree, std::size_t dimension) {
    return degree == derived ? 0U : (degree + std::size_t{1}) * dimension;
  };
  const auto constant_rate = static_cast<std::uint8_t>(RotationKind::constant_rate);
  const std::size_t count = size(of[0], 3) + size(of[1], 3) +
                            (of[2] == upright ? 0U : size(of[3], 4)) +
                            (of[2] == constant_rate ? 3U : 0U) + size(of[4], 3);
  coefficients.resize(coefficients.size() - count);
  layout.resize(layout.size() - layout_size);
  start.pop_back();
  duration.pop_back();
}

}  // namespace simulation
}  // namespace kairos
