#include "integrators/top_splitting.hpp"

#include "core/circular.hpp"

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
    const SineCosine half = sine_cosine(0.5 * angle);
    Quaternion about_axis(half.cosine, 0.0, 0.0, 0.0);
    about_axis.vec()[i] = half.sine;
    q = q * about_axis;
    // The body turns by the angle, so the momentum turns back in its frame.
    const SineCosine whole = sine_cosine(angle);
    const double L_j = L_B[j], L_k = L_B[k];
    L_B[j] = whole.cosine * L_j + whole.sine * L_k;
    L_B[k] = whole.cosine * L_k - whole.sine * L_j;
  }
  return inertia.axes.vec().isZero(0.0) ? q.normalized()
                                        : (q * inertia.axes.conjugate()).normalized();
}

}  // namespace kairos::integrators
