#include "integrators/top_splitting.hpp"

#include <array>
#include <cmath>

namespace kairos::integrators {

Quaternion split_top(const BodyInertia& inertia, const Vector3& L_W, double h,
                     const Quaternion& q_WB) {
  Quaternion q = inertia.principal_axes(q_WB);
  Vector3 L_B = q.conjugate() * L_W;
  struct Turn {
    int axis;
    double fraction;
  };
  constexpr std::array<Turn, 5> turns{{{0, 0.5}, {1, 0.5}, {2, 1.0}, {1, 0.5}, {0, 0.5}}};
  for (const Turn& turn : turns) {
    const int i = turn.axis, j = (i + 1) % 3, k = (i + 2) % 3;
    const double angle = turn.fraction * h * L_B[i] / inertia.principal[i];
    Quaternion about_axis(std::cos(0.5 * angle), 0.0, 0.0, 0.0);
    about_axis.vec()[i] = std::sin(0.5 * angle);
    q = q * about_axis;
    // The body turns by the angle, so the momentum turns back in its frame.
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const double L_j = L_B[j], L_k = L_B[k];
    L_B[j] = cosine * L_j + sine * L_k;
    L_B[k] = cosine * L_k - sine * L_j;
  }
  return inertia.axes.vec().isZero(0.0) ? q.normalized()
                                        : (q * inertia.axes.conjugate()).normalized();
}

}  // namespace kairos::integrators
