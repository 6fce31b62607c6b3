#include "integrators/free_top.hpp"

#include "core/circular.hpp"
#include "core/exponential.hpp"
#include "integrators/dense_output.hpp"
#include "integrators/elliptic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kairos::integrators {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int nodes = 4;               // of the fit,
constexpr int conditions = 3 * nodes;  // with value and two derivatives at each
constexpr double fit_tolerance = 1e-13;

/// Jacobi's functions of any u; `quarter` is K, 0 if infinite.
struct Jacobi {
  double sn = 0.0, cn = 1.0, dn = 1.0;
  double half_turns = 0.0;  ///< multiples of 2K taken off u
  double amplitude = 0.0;   ///< am of the rest, in [-pi/2, pi/2]
};

Jacobi jacobi(double u, double modulus, double quarter) {
  Jacobi result;
  if (quarter > 0.0) {
    result.half_turns = std::nearbyint(u / (2.0 * quarter));
    u -= result.half_turns * 2.0 * quarter;
  }
  const JacobiFunctions rest = jacobi_functions(u, modulus * modulus);
  result.sn = rest.sn;
  result.cn = rest.cn;
  result.dn = rest.dn;
  result.amplitude = arc_tangent(result.sn, std::abs(result.cn));
  if (std::fmod(result.half_turns, 2.0) != 0.0) {
    result.sn = -result.sn;
    result.cn = -result.cn;
  }
  return result;
}

/// Angular velocity in sorted axes.
Vector3 turning(const Jacobi& f, const Vector3& amplitudes) {
  return amplitudes.cwiseProduct(Vector3(f.cn, f.sn, f.dn));
}

/// R_x(theta) R_z(chi) with L = |L| (sin theta sin chi, sin theta cos chi, cos theta): turns L to
/// z.
Quaternion nutation(const Vector3& L) {
  const double theta = arc_tangent(hypotenuse(L.x(), L.y()), L.z());
  const double chi = arc_tangent(L.x(), L.y());
  return Quaternion(cosine(0.5 * theta), sine(0.5 * theta), 0.0, 0.0) *
         Quaternion(cosine(0.5 * chi), 0.0, 0.0, sine(0.5 * chi));
}

/// w' and w'' in principal axes: Euler's equations and their derivative.
std::array<Vector3, 2> euler_derivatives(const Vector3& moments, const Vector3& w) {
  Vector3 first, second, factor;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    factor[i] = (moments[j] - moments[k]) / moments[i];
    first[i] = factor[i] * w[j] * w[k];
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    second[i] = factor[i] * (first[j] * w[k] + w[j] * first[k]);
  }
  return {first, second};
}

}  // namespace

FreeTop::FreeTop(const BodyInertia& inertia, const Quaternion& q_WB, const Vector3& w_W) {
  const Vector3& principal = inertia.principal;
  const Vector3 w_B = inertia.principal_axes(q_WB).conjugate() * w_W;
  const Vector3 L_B = principal.cwiseProduct(w_B);
  const double twice_energy = w_B.dot(L_B);
  L_ = L_B.norm();

  // Jacobi's order: the moments fall if 2 E I_2 > L^2 and rise otherwise; then w_3 keeps its sign.
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return principal[a] < principal[b]; });
  if (twice_energy * principal[order[1]] > L_ * L_) {
    std::swap(order[0], order[2]);
  }
  Matrix3 sorted = Matrix3::Zero();
  for (int i = 0; i < 3; ++i) {
    sorted(i, order[static_cast<std::size_t>(i)]) = 1.0;
  }
  sorted *= sorted.determinant();  // a mirrored order is turned back by reversing all axes
  body_to_sorted_ = Eigen::Quaterniond(sorted);
  if (!inertia.axes.vec().isZero(0.0)) {
    body_to_sorted_ = body_to_sorted_ * inertia.axes.conjugate();
  }
  moments_ = (sorted * principal).cwiseAbs();
  const Vector3 w = sorted * w_B;

  // L^2 - 2 E I_3 and L^2 - 2 E I_1 as sums of terms of one sign.
  const double I1 = moments_[0], I2 = moments_[1], I3 = moments_[2];
  const double above = I1 * (I1 - I3) * w[0] * w[0] + I2 * (I2 - I3) * w[1] * w[1];
  const double below = I2 * (I2 - I1) * w[1] * w[1] + I3 * (I3 - I1) * w[2] * w[2];
  amplitudes_[0] = std::sqrt(above / (I1 * (I1 - I3)));
  amplitudes_[1] = std::sqrt(above / (I2 * (I2 - I3)));
  amplitudes_[2] = std::copysign(std::sqrt(below / (I3 * (I3 - I1))), w[2]);
  frequency_ = (I3 - I2) / I1 * std::sqrt(I1 * (I1 - I3) / (I2 * (I2 - I3))) * amplitudes_[2];
  const double m = std::clamp(above * (I1 - I2) / (below * (I3 - I2)), 0.0, 1.0);
  modulus_ = std::sqrt(m);
  const bool periodic = modulus_ * modulus_ < 1.0;
  // L^2 - L_3^2 = (I1 w1)^2 (1 + n sn^2).
  characteristic_ = m * power(I3 * amplitudes_[2] / (I1 * amplitudes_[0]), 2);
  if (periodic) {
    quarter_ = complete_elliptic_k(modulus_ * modulus_);
    quarter_integral_ = complete_elliptic_pi(characteristic_, modulus_ * modulus_);
  }
  const double start = arc_tangent(w[1] / amplitudes_[1], w[0] / amplitudes_[0]);
  const double half_turns = std::nearbyint(start / pi);
  phase_ = elliptic_f(start - half_turns * pi, modulus_ * modulus_) + 2.0 * quarter_ * half_turns;
  const Vector3 w_start = turning(jacobi(phase_, modulus_, quarter_), amplitudes_);
  momentum_frame_ =
      q_WB * body_to_sorted_.conjugate() * nutation(moments_.cwiseProduct(w_start)).conjugate();

  // Formulas that lose the state they were made from would lose the motion.
  // Near the separatrix the time of the next flip, about log(16 / (1 - m)) / 2, hangs on roundoff
  // of m.
  constexpr double separatrix = 1e-12;
  resolved_ = frequency_ != 0.0 && 1.0 - m > separatrix &&
              (w_start - w).norm() <= 1e-9 * w.norm() && std::isfinite(phase(phase_).third_kind);

  const double least = principal.minCoeff();
  fastest_ = std::min(L_ / least, std::sqrt(twice_energy / least));
  for (int i = 0; i < 3; ++i) {
    const double spread = std::abs(moments_[(i + 1) % 3] - moments_[(i + 2) % 3]) / moments_[i];
    coupling_ = std::max(coupling_, spread * std::numbers::sqrt2 / 2.0);
  }
}

FreeTop::Phase FreeTop::phase(double u) const {
  const Jacobi f = jacobi(u, modulus_, quarter_);
  return {turning(f, amplitudes_),
          2.0 * f.half_turns * quarter_integral_ +
              elliptic_pi(f.amplitude, characteristic_, modulus_ * modulus_)};
}

FreeTop::Rotation FreeTop::at(double time) const { return at(time, phase(phase_).third_kind); }

FreeTop::Rotation FreeTop::at(double time, double third_kind_at_start) const {
  const auto [w_S, third_kind] = phase(phase_ + frequency_ * time);
  // Precession about L at the rate (w_1 L_1 + w_2 L_2) L / (L_1^2 + L_2^2), integrated.
  const double precession = L_ / moments_[2] * time - L_ * (1.0 / moments_[2] - 1.0 / moments_[0]) /
                                                          frequency_ *
                                                          (third_kind - third_kind_at_start);
  const Quaternion about_L(cosine(0.5 * precession), 0.0, 0.0, sine(0.5 * precession));
  const Quaternion q_WS = momentum_frame_ * about_L * nutation(moments_.cwiseProduct(w_S));
  return {(q_WS * body_to_sorted_).normalized(), q_WS * w_S};
}

// |q^(n)| / n! <= (W/2)^n prod_{k<n} (1 + 2 b k) / n!, where |w| <= W and |w'| <= b |w|^2: with
// u' = b u^2 a majorant of w, r = (1 - b W t)^(-1/(2b)) is one of q, as q' = q w / 2. The remainder
// of Hermite interpolation is that times the largest product of the distances to the nodes, which
// is (h^4 / 81)^3 for four equidistant ones.
double FreeTop::fit_error(double h) const {
  double bound = power(1.0 / 81.0, 3);
  for (int k = 0; k < conditions; ++k) {
    bound *= 0.5 * fastest_ * h * (1.0 + 2.0 * coupling_ * k) / (k + 1);
  }
  return bound;
}

double FreeTop::segment() const {
  const double radian =
      1.0 / fastest_;  // s: a second would be nothing to some tops and all to others
  return radian * power(fit_tolerance / fit_error(radian), 1.0 / conditions);
}

void FreeTop::fit(double time, double h, Motion& motion) const {
  std::array<HermiteNode<4>, nodes> orientation;
  std::array<HermiteNode<3>, nodes> angular;
  Vector4 previous = Vector4::Zero();
  const double third_kind_at_start = phase(phase_).third_kind;
  for (int n = 0; n < nodes; ++n) {
    const double s = h * n / (nodes - 1);
    const Rotation rotation = at(time + s, third_kind_at_start);
    const Quaternion q_WS = rotation.orientation * body_to_sorted_.conjugate();
    const Vector3& w = rotation.angular_velocity;
    const Vector3 w_S = q_WS.conjugate() * w;
    const auto [first_S, second_S] = euler_derivatives(moments_, w_S);
    const Vector3 first = q_WS * first_S;
    const Vector3 second = q_WS * Vector3(second_S + w_S.cross(first_S));
    Vector4 q = as_vector(rotation.orientation);
    q = q.dot(previous) < 0.0 ? Vector4(-q) : q;  // on the near side of its neighbour
    previous = q;
    const Vector4 q_rate = quaternion_rate(w, q);
    const auto index = static_cast<std::size_t>(n);
    orientation[index] = {
        s, 3, {q, q_rate, quaternion_rate(first, q) + quaternion_rate(w, q_rate)}};
    angular[index] = {s, 3, {w, first, second}};
  }
  motion.rotation = RotationKind::polynomial;
  motion.quaternion = hermite<4>(orientation);
  motion.angular_velocity = hermite<3>(angular);
}

}  // namespace kairos::integrators
