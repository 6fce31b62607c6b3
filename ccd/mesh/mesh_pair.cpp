#include "ccd/mesh/mesh_pair.hpp"

#include "ccd/rounding/rotation_matrix.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::ccd {
namespace {

using ExactMatrix = std::array<ExactPoint, 3>;

void include_exponent(double x, int& exponent) {
  if (x != 0.0) {
    exponent = std::min(exponent, ExactInteger::lowest_exponent(x));
  }
}
void include_exponents(const Vector3& v, int& exponent) {
  for (int k = 0; k < 3; ++k) {
    include_exponent(v[k], exponent);
  }
}
ExactInteger whole(double x, int exponent) {
  return x == 0.0 ? ExactInteger() : ExactInteger::from_double(x, exponent);
}
ExactPoint whole(const Vector3& v, int exponent) {
  return {whole(v[0], exponent), whole(v[1], exponent), whole(v[2], exponent)};
}

/// |q|^2 and |q|^2 times the rotation, in whole numbers of the same unit.
struct ExactTurn {
  ExactInteger norm;
  ExactMatrix matrix;

  explicit ExactTurn(const Quaternion& q) {
    int exponent = std::numeric_limits<int>::max();
    for (const double c : {q.w(), q.x(), q.y(), q.z()}) {
      include_exponent(c, exponent);
    }
    const ExactInteger w = whole(q.w(), exponent), x = whole(q.x(), exponent),
                       y = whole(q.y(), exponent), z = whole(q.z(), exponent);
    const ExactInteger ww = w * w, xx = x * x, yy = y * y, zz = z * z;
    const auto twice = [](const ExactInteger& value) { return value << 1; };
    norm = ww + xx + yy + zz;
    matrix[0] = {ww + xx - yy - zz, twice(x * y - w * z), twice(x * z + w * y)};
    matrix[1] = {twice(x * y + w * z), ww - xx + yy - zz, twice(y * z - w * x)};
    matrix[2] = {twice(x * z - w * y), twice(y * z + w * x), ww - xx - yy + zz};
  }
  [[nodiscard]] ExactInteger turned(const ExactPoint& v, std::size_t k) const {
    return matrix[k][0] * v[0] + matrix[k][1] * v[1] + matrix[k][2] * v[2];
  }
};

}  // namespace

MeshPair::MeshPair(const PosedMesh& a, const PosedMesh& b) : a_(a), b_(b) {
  constexpr double farthest = 1e12;
  for (const Pose* pose : {&a.pose, &b.pose}) {
    if (!(pose->position.cwiseAbs().maxCoeff() <= farthest) ||
        !(std::abs(pose->orientation.norm() - 1.0) <= 1e-3)) {
      throw InputError("", 0, "pose",
                       "is not allowed; allowed: positions within 1e12 m, unit quaternions");
    }
  }
  const Matrix3 turn_a = rotation_matrix(a.pose.orientation);
  const Vector3 between = b.pose.position - a.pose.position;
  turn_ = turn_a.transpose() * rotation_matrix(b.pose.orientation);
  shift_ = turn_a.transpose() * between;
  // An entry of R_AB is off by 2 sqrt(3) 8 u and three products, two sums: 32 u. That times v, and
  // the rounding of R v + shift; the shift by 8 u of each entry, its products and sums, and the
  // difference.
  error_ = 40.0 * unit_roundoff * (b.mesh.tree().reach + between.lpNorm<1>()) +
           16.0 * std::numeric_limits<double>::denorm_min();
}

void MeshPair::exact_points(std::span<const Vector3> of_a, std::span<const Vector3> of_b,
                            std::span<ExactPoint> a, std::span<ExactPoint> b) const {
  int exponent = std::numeric_limits<int>::max();
  include_exponents(a_.pose.position, exponent);
  include_exponents(b_.pose.position, exponent);
  for (const Vector3& v : of_a) {
    include_exponents(v, exponent);
  }
  for (const Vector3& v : of_b) {
    include_exponents(v, exponent);
  }
  if (exponent == std::numeric_limits<int>::max()) {
    exponent = 0;  // all are zero
  }
  // Seen from the origin of a, with all coordinates times |q_a|^2 |q_b|^2.
  const ExactTurn turn_a(a_.pose.orientation);
  const ExactTurn turn_b(b_.pose.orientation);
  const ExactPoint from = whole(a_.pose.position, exponent);
  const ExactPoint to = whole(b_.pose.position, exponent);
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const ExactPoint v = whole(of_a[i], exponent);
    for (std::size_t k = 0; k < 3; ++k) {
      a[i][k] = turn_b.norm * turn_a.turned(v, k);
    }
  }
  for (std::size_t i = 0; i < of_b.size(); ++i) {
    const ExactPoint v = whole(of_b[i], exponent);
    for (std::size_t k = 0; k < 3; ++k) {
      b[i][k] = turn_a.norm * (turn_b.norm * (to[k] - from[k]) + turn_b.turned(v, k));
    }
  }
}

void MeshPair::exact_corners(std::uint32_t triangle_a, std::uint32_t triangle_b, ExactCorners& a,
                             ExactCorners& b) const {
  exact_points(corners(a_.mesh, triangle_a), corners(b_.mesh, triangle_b), a, b);
}

}  // namespace kairos::ccd
