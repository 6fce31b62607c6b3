#include "core/contacts/coulomb_cone.hpp"

#include "core/circular.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

using Vector2 = Eigen::Vector2d;

/// What sticks parts by less than this part of what a normal impulse does: by roundoff of joints.
constexpr double locked = 1e-12;
/// What joints block to 1e-12 of what it would be moves by the root of that.
constexpr double hardly_moves = 1e-6;
/// Steps of a bracketed root, each fourth of which halves the bracket.
constexpr int most_evaluations = 240;
/// Of Newton's method, which mostly takes three to six; no step turns by more than a half.
constexpr int most_turns = 12;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Of a normal impulse that is the smallest that locks.
constexpr double roundoff = 1e-13;

/// Sliding along d = (cos angle, sin angle): p_t = -mu p_n d, u_n = 0.
class Sliding {
 public:
  Sliding(const Matrix3& W, const Vector3& q, double mu)
      : W_(W),
        q_(q),
        mu_(mu),
        without_(W(0, 0) * q.tail<2>() - q[0] * W.block<2, 1>(1, 0)),
        turns_(mu * (q[0] * W.block<2, 2>(1, 1) - q.tail<2>() * W.block<1, 2>(0, 1))) {}

  struct Try {
    double normal = 0.0;    ///< p_n
    double across = 0.0;    ///< of u_t, to the left of d
    double along = 0.0;     ///< of u_t, along d
    Vector2 direction;      ///< d
    bool possible = false;  ///< pressing along d stops the approach
  };
  [[nodiscard]] Try along(double angle) const {
    Try t;
    const SineCosine of = sine_cosine(angle);
    t.direction = {of.cosine, of.sine};
    const double felt = W_(0, 0) - mu_ * (W_(0, 1) * t.direction[0] + W_(0, 2) * t.direction[1]);
    t.possible = felt > 0.0;
    t.normal = t.possible ? -q_[0] / felt : 0.0;
    const Vector2 u = q_.tail<2>() + t.normal * (W_.block<2, 1>(1, 0) -
                                                 mu_ * (W_.block<2, 2>(1, 1) * t.direction));
    t.along = u.dot(t.direction);
    t.across = t.direction[0] * u[1] - t.direction[1] * u[0];
    return t;
  }

  /// An angle, and what sliding along it comes to.
  struct End {
    double angle = 0.0;
    Try there;
  };
  [[nodiscard]] End at(double angle) const { return {angle, along(angle)}; }

  /// The solution that Newton's method finds from `d`, if there is one. With f = W_nn - mu W_nt d,
  /// f u_t is without_ + turns_ d, and what is across d is zero.
  [[nodiscard]] std::optional<Vector3> from(Vector2 d) const {
    const double most = without_.lpNorm<1>() + turns_.lpNorm<1>();
    for (int turn = 0; turn < most_turns; ++turn) {
      const Vector2 u = without_ + turns_ * d;
      const Vector2 side(-d[1], d[0]);
      const double across = side.dot(u);
      const double slope = side.dot(turns_ * side) - d.dot(u);
      const double step = -across / slope;
      if (!std::isfinite(step)) {
        return std::nullopt;
      }
      d = (d + std::clamp(step, -0.5, 0.5) * side).normalized();
      if (std::abs(step) <= 2.0 * epsilon || std::abs(across) <= epsilon * most) {
        const double felt = W_(0, 0) - mu_ * W_.block<1, 2>(0, 1).dot(d);
        const double normal = -q_[0] / felt;
        if (!(felt > 0.0) || d.dot(without_ + turns_ * d) < 0.0) {
          return std::nullopt;
        }
        return Vector3(normal, -mu_ * normal * d[0], -mu_ * normal * d[1]);
      }
    }
    return std::nullopt;
  }

  /// The solution with an angle between the two, where `across` changes its sign, if there is one.
  [[nodiscard]] std::optional<Vector3> between(const End& first, const End& last) const {
    double from = first.angle;
    double to = last.angle;
    const Try& low = first.there;
    if (!low.possible || !last.there.possible || low.across * last.there.across > 0.0) {
      return std::nullopt;
    }
    // Regula falsi in which an end that stays counts by half [Dowell1971]; each fourth step halves.
    Try middle = low;
    double of_low = low.across;
    double of_high = last.there.across;
    double before = from;
    int stays = 0;  // < 0: the lower end did, > 0: the upper one
    if (of_low == 0.0 || of_high == 0.0) {
      middle = of_low == 0.0 ? low : last.there;
      to = from;
    }
    for (int evaluations = 1; to > from && evaluations < most_evaluations; ++evaluations) {
      double angle = from + (to - from) * (of_low / (of_low - of_high));
      if (evaluations % 4 == 0 || !(angle > from && angle < to)) {
        angle = 0.5 * (from + to);
      }
      if (angle == from || angle == to) {
        break;  // no number is between the two
      }
      middle = along(angle);
      if (!middle.possible) {
        return std::nullopt;
      }
      if (middle.across == 0.0 || std::abs(angle - before) <= epsilon * std::abs(angle)) {
        break;
      }
      before = angle;
      if ((of_low < 0.0) != (middle.across < 0.0)) {
        to = angle;
        of_high = middle.across;
        of_low = stays < 0 ? 0.5 * of_low : of_low;
        stays = -1;
      } else {
        from = angle;
        of_low = middle.across;
        of_high = stays > 0 ? 0.5 * of_high : of_high;
        stays = 1;
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
  Vector2 without_;
  Eigen::Matrix2d turns_;
};

/// What of a tangential impulse holds against x, p_n aside; where nothing moves it takes none.
Vector2 against(const Matrix3& W, const Vector2& x) {
  if (W(1, 1) > 0.0 && W(2, 2) > 0.0) {
    return -(W.block<2, 2>(1, 1).inverse() * x);
  }
  return {W(1, 1) > 0.0 ? -x[0] / W(1, 1) : 0.0, W(2, 2) > 0.0 ? -x[1] / W(2, 2) : 0.0};
}

/// Stops what moves; NaN where nothing does.
Vector3 sticking(const Matrix3& W, const Vector3& q, double mu) {
  const Vector2 hold = against(W, W.block<2, 1>(1, 0));
  const double parts = W(0, 0) + hold.dot(W.block<2, 1>(1, 0));
  if (W(1, 1) > 0.0 && W(2, 2) > 0.0 && parts > locked * W(0, 0)) {
    return -(W.inverse() * q);
  }
  const Vector2 first = against(W, q.tail<2>());
  const double left = q[0] + first.dot(W.block<2, 1>(1, 0));
  double normal = -left / parts;
  if (parts <= locked * W(0, 0)) {
    // Friction locks it, however hard it presses: hardly more than |first + s hold| <= mu s takes.
    const double b = hold.dot(first);
    const double root = b * b + (mu * mu - hold.squaredNorm()) * first.squaredNorm();
    const double least = first.squaredNorm() / (std::sqrt(std::max(root, 0.0)) - b);
    if (std::abs(left) > locked * q.norm() || !(root >= 0.0) || !(least >= 0.0)) {
      return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
    }
    normal = std::isinf(mu) ? first.norm() : (1.0 + roundoff) * least;
  }
  const Vector2 along = first + normal * hold;
  return {normal, along[0], along[1]};
}

/// Whether sticking stops all that slides: joints may let nothing move along a tangent.
bool stops(const Matrix3& W, const Vector3& q) {
  return (W(1, 1) > 0.0 || std::abs(q[1]) <= hardly_moves * q.norm()) &&
         (W(2, 2) > 0.0 || std::abs(q[2]) <= hardly_moves * q.norm());
}

}  // namespace

Vector3 coulomb_impulse(const Matrix3& W, const Vector3& q, double mu) {
  if (q[0] >= 0.0) {
    return Vector3::Zero();
  }
  const Vector3 smooth(-q[0] / W(0, 0), 0.0, 0.0);
  if (mu == 0.0) {
    return smooth;
  }
  const Vector3 stick = sticking(W, q, mu);
  if (stick[0] >= 0.0 && stick.tail<2>().norm() <= mu * stick[0] && stops(W, q)) {
    return stick;
  }
  if (std::isinf(mu)) {
    // Sticking would pull. Friction without a bound holds what is hardly pressed any more, and the
    // surfaces part.
    const Vector2 holds = -(W.block<2, 2>(1, 1).inverse() * q.tail<2>());
    return {0.0, holds[0], holds[1]};
  }
  const Sliding sliding(W, q, mu);
  // The direction of sliding is mostly near that which sticking would have to hold: try it first.
  const Vector2 held = -stick.tail<2>();
  if (const double size = held.norm(); size > 0.0 && std::isfinite(size)) {
    if (const auto found = sliding.from(held / size)) {
      return *found;
    }
  }
  const double guess = std::isnan(stick[0]) ? 0.0 : arc_tangent(-stick[2], -stick[1]);
  Sliding::End left = sliding.at(guess);
  Sliding::End right = left;
  double reach = 0.0;
  for (double step = 1e-3; reach < M_PI; step *= 2.0) {
    reach = std::min(reach + step, M_PI);
    const Sliding::End beyond_right = sliding.at(guess + reach);
    if (const auto found = sliding.between(right, beyond_right)) {
      return *found;
    }
    const Sliding::End beyond_left = sliding.at(guess - reach);
    if (const auto found = sliding.between(beyond_left, left)) {
      return *found;
    }
    right = beyond_right;
    left = beyond_left;
  }
  constexpr int parts = 256;
  Sliding::End from = sliding.at(0.0);
  for (int k = 0; k < parts; ++k) {
    const Sliding::End to = sliding.at((k + 1) * (2.0 * M_PI / parts));
    if (const auto found = sliding.between(from, to)) {
      return *found;
    }
    from = to;
  }
  return smooth;
}

}  // namespace core
}  // namespace kairos
