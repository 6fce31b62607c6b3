#include "ccd/mesh/box_distance.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kairos::ccd {
namespace {

/// The length of what is positive; the greatest component where nothing is.
double length_of_gaps(const Vector3& gaps) {
  const double greatest = gaps.maxCoeff();
  return greatest > 0.0 ? gaps.cwiseMax(0.0).norm() * (1.0 - 8.0 * unit_roundoff) : greatest;
}

}  // namespace

double box_distance(const ObbBox& a, const ObbBox& b, double error, double enough) {
  const Matrix3 turn = a.axes.transpose() * b.axes;
  const Matrix3 magnitude = turn.cwiseAbs();
  const Vector3 d = a.axes.transpose() * (b.centre - a.centre);
  // Entries of `turn` are off by 128 u: 64 u sqrt(3) and u sqrt(3) of its factors, and its sum. d
  // by sqrt(3) `error` and 8 u |d|. A separation has at most two products of d with an entry, and
  // one of each extent; the edges' are sums of two such.
  const double bound =
      4.0 * error + 400.0 * unit_roundoff *
                        (d.lpNorm<1>() + a.half_extents.lpNorm<1>() + b.half_extents.lpNorm<1>());
  const Vector3 gaps_a =
      d.cwiseAbs() - a.half_extents - magnitude * b.half_extents - Vector3::Constant(bound);
  double proven = length_of_gaps(gaps_a);
  if (proven > enough) {
    return proven;
  }
  const Vector3 gaps_b = (turn.transpose() * d).cwiseAbs() - b.half_extents -
                         magnitude.transpose() * a.half_extents - Vector3::Constant(bound);
  proven = std::max(proven, length_of_gaps(gaps_b));
  if (proven > enough) {
    return proven;
  }
  for (int i = 0; i < 3; ++i) {
    const int l = (i + 1) % 3;
    const int k = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int m = (j + 1) % 3;
      const int n = (j + 2) % 3;
      const double apart = std::abs(d[k] * turn(l, j) - d[l] * turn(k, j));
      const double reach =
          a.half_extents[l] * magnitude(k, j) + a.half_extents[k] * magnitude(l, j) +
          b.half_extents[m] * magnitude(i, n) + b.half_extents[n] * magnitude(i, m);
      const double gap = apart - reach - bound;
      if (gap > 0.0) {
        // The product of the edges has a length of at most this, rounding included.
        const double length =
            std::min(1.0, std::sqrt(turn(l, j) * turn(l, j) + turn(k, j) * turn(k, j)) +
                              256.0 * unit_roundoff);
        proven = std::max(proven, gap / length * (1.0 - 4.0 * unit_roundoff));
      }
    }
  }
  return proven;
}

double box_distance(const ObbBox& box, const Corners& t, double error) {
  const Vector3 p = box.axes.transpose() * (t[0] - box.centre);
  const Vector3 q = box.axes.transpose() * (t[1] - box.centre);
  const Vector3 r = box.axes.transpose() * (t[2] - box.centre);
  const double size = p.lpNorm<1>() + q.lpNorm<1>() + r.lpNorm<1>() + box.half_extents.lpNorm<1>();
  const double bound = 4.0 * error + 400.0 * unit_roundoff * size;
  const Vector3 least = p.cwiseMin(q).cwiseMin(r);
  const Vector3 greatest = p.cwiseMax(q).cwiseMax(r);
  const Vector3 gaps = least.cwiseMax(-greatest) - box.half_extents - Vector3::Constant(bound);
  double proven = length_of_gaps(gaps);
  const Vector3 normal = (q - p).cross(r - p);
  const double length = normal.norm();
  if (length > 0.0) {
    // Any direction proves; only what is said of the corners along it must hold.
    const Vector3 n = normal / length;
    const std::array<double, 3> heights{n.dot(p), n.dot(q), n.dot(r)};
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    const double gap = std::max(*low, -*high) - n.cwiseAbs().dot(box.half_extents) - 2.0 * bound;
    proven = std::max(proven, gap > 0.0 ? gap * (1.0 - 8.0 * unit_roundoff) : gap);
  }
  return proven;
}

}  // namespace kairos::ccd
