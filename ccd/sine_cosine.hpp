#pragma once

namespace kairos::ccd {

/// Sine and cosine of |x| <= 1.5 by their Taylor sums to x^21 and x^22: what is left out is below
/// 1e-18, and rounding costs at most 3 u (the terms add up to less than cosh 1.5 = 2.4, summed in
/// pairs). A quarter of the work of the library's, which knows all angles.
inline void sine_cosine(double x, double& sine, double& cosine) {
  const double z = x * x;
  const double z2 = z * z;
  const double z4 = z2 * z2;
  const double z8 = z4 * z4;
  const auto sum = [&](double a0, double a1, double a2, double a3, double a4, double a5, double a6,
                       double a7, double a8, double a9) {
    return ((a0 + a1 * z) + (a2 + a3 * z) * z2) + ((a4 + a5 * z) + (a6 + a7 * z) * z2) * z4 +
           (a8 + a9 * z) * z8;
  };
  sine = x + x * z *
                 sum(-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362880.0, -1.0 / 39916800.0,
                     1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0,
                     -1.0 / 121645100408832000.0, 1.0 / 51090942171709440000.0);
  cosine = 1.0 - 0.5 * z +
           z2 * sum(1.0 / 24.0, -1.0 / 720.0, 1.0 / 40320.0, -1.0 / 3628800.0, 1.0 / 479001600.0,
                    -1.0 / 87178291200.0, 1.0 / 20922789888000.0, -1.0 / 6402373705728000.0,
                    1.0 / 2432902008176640000.0, -1.0 / 1124000727777607680000.0);
}

}  // namespace kairos::ccd
