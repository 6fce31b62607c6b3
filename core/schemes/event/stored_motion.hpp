#pragma once

#include "core/motion.hpp"
#include "core/state.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace kairos {
inline namespace core {

/// A `Motion` in the room that its coefficients take: 250 bytes for a parabola, where a `Motion`
/// has 1552, for polynomials of degree 13. It comes back bit for bit.
class StoredMotion {
 public:
  StoredMotion() { *this = Motion(); }

  StoredMotion& operator=(const Motion& motion) {
    start_ = motion.start;
    duration_ = motion.duration;
    error_radius_ = motion.error_radius;
    rotation_ = motion.rotation;
    degrees_ = {degree_of(motion.position), degree_of(motion.velocity),
                degree_of(motion.quaternion), degree_of(motion.angular_velocity)};
    const std::size_t needed =
        3U * (degrees_[0] + degrees_[1] + degrees_[3] + 4U) + 4U * (degrees_[2] + 1U);
    if (needed > coefficients_.size() && more_ == nullptr) {
      more_ = std::make_unique<std::array<double, most>>();
    }
    is_long_ = needed > coefficients_.size();
    double* out = is_long_ ? more_->data() : coefficients_.data();
    out = put(motion.position, out);
    out = put(motion.velocity, out);
    out = put(motion.quaternion, out);
    out = put(motion.angular_velocity, out);
    for (int axis = 0; axis < 3; ++axis) {
      *out++ = motion.rotation_rate[axis];
    }
    return *this;
  }

  [[nodiscard]] Motion motion() const {
    Motion motion;
    motion.start = start_;
    motion.duration = duration_;
    motion.error_radius = error_radius_;
    motion.rotation = rotation_;
    const double* in = is_long_ ? more_->data() : coefficients_.data();
    in = take(degrees_[0], in, motion.position);
    in = take(degrees_[1], in, motion.velocity);
    in = take(degrees_[2], in, motion.quaternion);
    in = take(degrees_[3], in, motion.angular_velocity);
    motion.rotation_rate = Vector3(in[0], in[1], in[2]);
    return motion;
  }

  /// Where the body is at local time s and how it moves there: as the `Motion` says, bit for bit.
  [[nodiscard]] BodyState at(double s) const {
    if (rotation_ != RotationKind::fixed) {
      const Motion whole = motion();
      return {whole.pose(s), whole.twist(s)};
    }
    const double* p = is_long_ ? more_->data() : coefficients_.data();
    const double* v = p + 3U * (degrees_[0] + 1U);
    const double* q = v + 3U * (degrees_[1] + 1U);
    return {{value(p, degrees_[0], s), Quaternion(q[0], q[1], q[2], q[3])},
            {value(v, degrees_[1], s), Vector3::Zero()}};
  }

  /// No coordinate is greater up to local time s, m.
  [[nodiscard]] double coordinates_reached(double s) const {
    const double* p = is_long_ ? more_->data() : coefficients_.data();
    double reached = 0.0;
    for (int k = degrees_[0]; k >= 0; --k) {
      const double* c = p + 3 * k;
      reached = reached * s + std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])});
    }
    return reached;
  }

  [[nodiscard]] Instant start() const { return start_; }
  [[nodiscard]] double error_radius() const { return error_radius_; }
  [[nodiscard]] double duration() const { return duration_; }
  [[nodiscard]] Instant end() const { return start_ + duration_; }

 private:
  /// Of all polynomials at their highest degree, and of the rate of rotation.
  static constexpr std::size_t most = 14 * (3 + 3 + 4 + 3) + 3;
  static_assert(Polynomial<3>::max_degree == 13);

  template <int Dim>
  static std::uint8_t degree_of(const Polynomial<Dim>& p) {
    return static_cast<std::uint8_t>(p.degree());
  }
  template <int Dim>
  static double* put(const Polynomial<Dim>& p, double* out) {
    for (int k = 0; k <= p.degree(); ++k) {
      for (int axis = 0; axis < Dim; ++axis) {
        *out++ = p[k][axis];
      }
    }
    return out;
  }
  template <int Dim>
  static const double* take(std::uint8_t degree, const double* in, Polynomial<Dim>& p) {
    p.resize(degree);
    for (int k = 0; k <= degree; ++k) {
      for (int axis = 0; axis < Dim; ++axis) {
        p[k][axis] = *in++;
      }
    }
    return in;
  }

  /// Horner, as `Polynomial` does it.
  static Vector3 value(const double* c, int degree, double s) {
    Vector3 sum(c[3 * degree], c[3 * degree + 1], c[3 * degree + 2]);
    for (int k = degree - 1; k >= 0; --k) {
      sum = sum * s + Vector3(c[3 * k], c[3 * k + 1], c[3 * k + 2]);
    }
    return sum;
  }

  Instant start_;
  double duration_ = 0.0;
  double error_radius_ = 0.0;
  RotationKind rotation_ = RotationKind::fixed;
  std::array<std::uint8_t, 4> degrees_{};
  bool is_long_ = false;
  std::array<double, 25> coefficients_{};           ///< of a parabola that turns at a constant rate
  std::unique_ptr<std::array<double, most>> more_;  ///< null until a motion has more
};

}  // namespace core
}  // namespace kairos
