#include "core/contacts/coulomb_cone.hpp"

#include "core/circular.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

using Vector2 = Eigen::Vector2d;

/// Sliding along d = (cos angle, sin angle): p_t = -mu p_n d, u_n = 0.
class Sliding {
 public:
  Sliding(const Matrix3& W, const Vector3& q, double mu) : W_(W), q_(q), mu_(mu) {}

  struct Try {
    double normal = 0.0;    ///< p_n
    double across = 0.0;    ///< of u_t, to the left of d
    double along = 0.0;     ///< of u_t, along d
    Vector2 direction;      ///< d
    bool possible = false;  ///< pressing along d stops the approach
  };
  [[nodiscard]] Try along(double angle) const {
    Try t;
    t.direction = {cosine(angle), sine(angle)};
    const double felt = W_(0, 0) - mu_ * (W_(0, 1) * t.direction[0] + W_(0, 2) * t.direction[1]);
    t.possible = felt > 0.0;
    t.normal = t.possible ? -q_[0] / felt : 0.0;
    const Vector2 u = q_.tail<2>() + t.normal * (W_.block<2, 1>(1, 0) -
                                                 mu_ * (W_.block<2, 2>(1, 1) * t.direction));
    t.along = u.dot(t.direction);
    t.across = t.direction[0] * u[1] - t.direction[1] * u[0];
    return t;
  }

  /// The solution with an angle in [from, to], where `across` changes its sign, if there is one.
  [[nodiscard]] std::optional<Vector3> between(double from, double to) const {
    Try low = along(from);
    const Try high = along(to);
    if (!low.possible || !high.possible || low.across * high.across > 0.0) {
      return std::nullopt;
    }
    Try middle = low;
    for (int halvings = 0; halvings < 60 && to - from > 0.0; ++halvings) {
      const double angle = 0.5 * (from + to);
      middle = along(angle);
      if (!middle.possible) {
        return std::nullopt;
      }
      if (low.across * middle.across <= 0.0) {
        to = angle;
      } else {
        from = angle;
        low = middle;
      }
    }
    if (middle.along < 0.0) {
      return std::nullopt;
    }
    const Vector2 tangential = -mu_ * middle.normal * middle.direction;
    return Vector3(middle.normal, tangential[0], tangential[1]);
  }

 private:
  const Matrix3& W_;
  const Vector3& q_;
  double mu_;
};

}  // namespace

Vector3 coulomb_impulse(const Matrix3& W, const Vector3& q, double mu) {
  if (q[0] >= 0.0) {
    return Vector3::Zero();
  }
  const Vector3 smooth(-q[0] / W(0, 0), 0.0, 0.0);
  if (mu == 0.0) {
    return smooth;
  }
  const Vector3 stick = -(W.inverse() * q);
  if (stick[0] >= 0.0 && stick.tail<2>().norm() <= mu * stick[0]) {
    return stick;
  }
  if (std::isinf(mu)) {
    return Vector3::Zero();  // sticking would pull: without a bound of friction the contact opens
  }
  const Sliding sliding(W, q, mu);
  // The direction of sliding is mostly near that which sticking would have to hold: try it first.
  const double guess = arc_tangent(-stick[2], -stick[1]);
  double reach = 0.0;
  for (double step = 1e-3; reach < M_PI; step *= 2.0) {
    const double next = std::min(reach + step, M_PI);
    for (const auto& [from, to] :
         {std::pair{guess + reach, guess + next}, std::pair{guess - next, guess - reach}}) {
      if (const auto found = sliding.between(from, to)) {
        return *found;
      }
    }
    reach = next;
  }
  constexpr int parts = 256;
  for (int k = 0; k < parts; ++k) {
    const double width = 2.0 * M_PI / parts;
    if (const auto found = sliding.between(k * width, (k + 1) * width)) {
      return *found;
    }
  }
  return smooth;
}

}  // namespace core
}  // namespace kairos
