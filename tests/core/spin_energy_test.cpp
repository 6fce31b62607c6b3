#include "core/spin_energy.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

TEST_CASE("the energy of a spin does not depend on the length of its quaternion", "[ledger]") {
  constexpr double eps = 0x1p-52;
  constexpr int bodies = 20'000;
  double worst = 0.0;
  double worst_of_eigen = 0.0;
  for (std::uint64_t i = 0; i < bodies; ++i) {
    Random random(7, i);
    BodyInertia inertia{.mass = 1.0, .principal = {}, .rotates = true};
    for (int k = 0; k < 3; ++k) {
      inertia.principal[k] = random.log_uniform(1e-3, 1e3);
    }
    BodyState state;
    state.twist.angular = random.log_uniform(1e-6, 1e6) * random.direction();
    // As long as `rotate` leaves them.
    state.pose.orientation = random.orientation();
    state.pose.orientation.coeffs() *= 1.0 + random.uniform(-2.0, 2.0) * eps;

    using Real = long double;
    using Vec = Eigen::Matrix<Real, 3, 1>;
    const Eigen::Quaternion<Real> q = state.pose.orientation.cast<Real>().normalized();
    const Vec w = q.conjugate() * state.twist.angular.cast<Real>();
    const Real energy = w.dot(inertia.principal.cast<Real>().cwiseProduct(w)) / 2;
    const auto off = [&](double told) { return double(std::abs((Real(told) - energy) / energy)); };
    worst = std::max(worst, off(spin_energy(inertia, state)));
    const Vector3 plain = state.pose.orientation.conjugate() * state.twist.angular;
    worst_of_eigen =
        std::max(worst_of_eigen, off(0.5 * plain.dot(inertia.principal.cwiseProduct(plain))));
  }
  CAPTURE(worst / eps, worst_of_eigen / eps);
  CHECK(worst <= 3.0 * eps);          // the bound of spin_energy.hpp
  CHECK(worst_of_eigen > 8.0 * eps);  // or else these quaternions show nothing
}
