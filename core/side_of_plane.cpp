#include "core/polytope.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double u = 0.5 * std::numeric_limits<double>::epsilon();

/// A sum kept as doubles that do not overlap, ascending: exact [Shewchuk1997].
class ExactSum {
 public:
  void add(double x) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = parts_[i] + x;
      const double virtual_x = sum - parts_[i];
      const double lost = (parts_[i] - (sum - virtual_x)) + (x - virtual_x);
      if (lost != 0.0) {
        parts_[kept++] = lost;
      }
      x = sum;
    }
    size_ = kept;
    if (x != 0.0) {
      parts_[size_++] = x;
    }
  }
  [[nodiscard]] int sign() const { return size_ == 0 ? 0 : parts_[size_ - 1] > 0.0 ? 1 : -1; }

 private:
  std::array<double, 256> parts_{};
  std::size_t size_ = 0;
};

/// b - a as a sum of two doubles.
std::array<double, 2> exact_difference(double b, double a) {
  const double high = b - a;
  const double virtual_a = b - high;
  return {high, (b - (high + virtual_a)) + (virtual_a - a)};
}

void add_product(ExactSum& sum, double x, double y, double z, double sign) {
  const double xy = x * y;
  const double rest = std::fma(x, y, -xy);
  for (const double part : {xy, rest}) {
    const double product = part * z;
    sum.add(sign * product);
    sum.add(sign * std::fma(part, z, -product));
  }
}

int exact_side(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  std::array<std::array<std::array<double, 2>, 3>, 3> m;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    m[0][i] = exact_difference(b[k], a[k]);
    m[1][i] = exact_difference(c[k], a[k]);
    m[2][i] = exact_difference(d[k], a[k]);
  }
  constexpr std::array<std::array<std::size_t, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  ExactSum sum;
  for (std::size_t order = 0; order < 6; ++order) {
    const auto& [i, j, k] = orders[order];
    for (int parts = 0; parts < 8; ++parts) {
      add_product(sum, m[0][i][(parts & 1) != 0], m[1][j][(parts & 2) != 0],
                  m[2][k][(parts & 4) != 0], order < 3 ? 1.0 : -1.0);
    }
  }
  return sum.sign();
}

}  // namespace

int side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const Vector3 ab = b - a;
  const Vector3 ac = c - a;
  const Vector3 ad = d - a;
  const double volume = ab.cross(ac).dot(ad);
  const Vector3 x = ab.cwiseAbs();
  const Vector3 y = ac.cwiseAbs();
  const Vector3 z = ad.cwiseAbs();
  // Each of the six products carries 3 u of its factors, 2 u of its own and 3 u of the sums.
  const double products = (x.y() * y.z() + x.z() * y.y()) * z.x() +
                          (x.z() * y.x() + x.x() * y.z()) * z.y() +
                          (x.x() * y.y() + x.y() * y.x()) * z.z();
  if (std::abs(volume) > 16.0 * u * products) {
    return volume > 0.0 ? 1 : -1;
  }
  return exact_side(a, b, c, d);
}

}  // namespace core
}  // namespace kairos
