#include "ccd/linear/exact_motion.hpp"

#include <algorithm>
#include <limits>

namespace kairos::ccd {
namespace {

constexpr int no_exponent = std::numeric_limits<int>::max();

int lowest_exponent(const LinearQuery& query, int k) {
  int lowest = no_exponent;
  for (const FourPoints* points : {&query.start, &query.end}) {
    for (const Vector3& p : *points) {
      lowest = p[k] == 0.0 ? lowest : std::min(lowest, ExactInteger::lowest_exponent(p[k]));
    }
  }
  return lowest;
}

}  // namespace

ExactVector operator-(const ExactVector& a, const ExactVector& b) {
  ExactVector result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.start[k] = a.start[k] - b.start[k];
    result.end[k] = a.end[k] - b.end[k];
    result.rate[k] = a.rate[k] - b.rate[k];
  }
  return result;
}

ExactPolynomial cross(const ExactVector& a, const ExactVector& b, std::size_t k) {
  const std::size_t i = (k + 1) % 3;
  const std::size_t j = (k + 2) % 3;
  const auto minor = [&](const std::array<ExactInteger, 3>& u,
                         const std::array<ExactInteger, 3>& v) {
    ExactInteger result = u[i] * v[j];
    return result -= u[j] * v[i];
  };
  ExactPolynomial result;
  result[0] = minor(a.start, b.start);
  result[2] = minor(a.rate, b.rate);
  result[1] = minor(a.end, b.end);
  result[1] -= result[0];
  result[1] -= result[2];
  result.trim(2);
  return result;
}

ExactMotion::ExactMotion(const LinearQuery& query, AxisUnits units) {
  std::array<int, 3> unit{};
  for (int k = 0; k < 3; ++k) {
    unit[static_cast<std::size_t>(k)] = lowest_exponent(query, k);
  }
  if (units == AxisUnits::common) {
    unit_ = std::min({unit[0], unit[1], unit[2]});
    if (query.separation > 0.0) {
      unit_ = std::min(unit_, ExactInteger::lowest_exponent(query.separation));
    }
    unit.fill(unit_);
  }
  ExactVector* const vectors[] = {&x_, &y_, &z_};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto whole = [&](const Vector3& p) {
      return ExactInteger::from_double(p[static_cast<Eigen::Index>(k)], unit[k]);
    };
    const ExactInteger start = whole(query.start[0]);
    const ExactInteger end = whole(query.end[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      ExactVector& v = *vectors[i];
      v.start[k] = whole(query.start[i + 1]) - start;
      v.end[k] = whole(query.end[i + 1]) - end;
      v.rate[k] = v.end[k] - v.start[k];
    }
  }
}

ExactPolynomial ExactMotion::volume() const {
  ExactPolynomial f;
  for (std::size_t k = 0; k < 3; ++k) {
    const ExactPolynomial n = cross(y_, z_, k);
    for (int i = 0; i <= n.degree(); ++i) {
      f[i] += x_.start[k] * n[i];
      f[i + 1] += x_.rate[k] * n[i];
    }
  }
  f.trim(3);
  return f;
}

int exact_volume_sign(const LinearQuery& query, double t) {
  return ExactMotion(query, AxisUnits::own).volume().sign_at(Dyadic(t));
}

}  // namespace kairos::ccd
