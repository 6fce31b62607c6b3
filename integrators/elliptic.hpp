#pragma once

namespace kairos::integrators {

/// Carlson's symmetric integral of the first kind, R_F(x, y, z); arguments >= 0, at most one of
/// them 0. Relative error a few units of roundoff [Carlson1995].
[[nodiscard]] double carlson_rf(double x, double y, double z);
/// Carlson's symmetric integral of the third kind, R_J(x, y, z, p); x, y, z >= 0, at most one of
/// them 0, p > 0. Relative error a few tens of units of roundoff [Carlson1995].
[[nodiscard]] double carlson_rj(double x, double y, double z, double p);

/// Legendre's F(phi | m), |phi| <= pi/2, 0 <= m <= 1 (infinite for m = 1 at pi/2).
[[nodiscard]] double elliptic_f(double phi, double m);
/// The integral from 0 to phi of dt / ((1 + n sin^2 t) sqrt(1 - m sin^2 t)), |phi| <= pi/2,
/// 0 <= m <= 1, n > -1.
[[nodiscard]] double elliptic_pi(double phi, double n, double m);
/// The complete integrals, phi = pi/2; 0 <= m < 1.
[[nodiscard]] double complete_elliptic_k(double m);
[[nodiscard]] double complete_elliptic_pi(double n, double m);

/// Jacobi's functions of u at parameter m = k^2, 0 <= m <= 1, by descending Landen transformations
/// [DLMF 22.20(ii)]. Accurate to a few units of roundoff of 1 for |u| <= K(m).
struct JacobiFunctions {
  double sn = 0.0;
  double cn = 1.0;
  double dn = 1.0;
};
[[nodiscard]] JacobiFunctions jacobi_functions(double u, double m);

}  // namespace kairos::integrators
