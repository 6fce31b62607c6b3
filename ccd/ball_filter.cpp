#include "ccd/ball_filter.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Sizes up to so many reaches: eight roundings of them are at most 2^-28 of a reach.
constexpr double largest = 0x1p22;
constexpr double more = 1.0 + 0x1p-22;
constexpr double sooner = 1.0 - 0x1p-20;

/// b - a and how fast it changes, at the later start.
struct Relative {
  double d[3];
  double v[3];
  double way = 0.0;          ///< how fast the two go, m/s, and
  double coordinates = 0.0;  ///< how large the numbers are that d was computed from, m

  Relative(const BallFlight& a, const BallFlight& b) {
    const double lag = b.start - a.start;
    const double s_a = std::max(lag, 0.0);
    const double s_b = std::max(-lag, 0.0);
    double size = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double g = a.acceleration[k];
      v[k] = (b.velocity[k] + g * s_b) - (a.velocity[k] + g * s_a);
      d[k] = (b.position[k] + (b.velocity[k] + 0.5 * g * s_b) * s_b) -
             (a.position[k] + (a.velocity[k] + 0.5 * g * s_a) * s_a);
      way += std::abs(a.velocity[k]) + std::abs(b.velocity[k]) + std::abs(g) * (s_a + s_b);
      size += std::abs(a.position[k]) + std::abs(b.position[k]);
    }
    coordinates = size + way * (s_a + s_b);
  }
};

double dot(const double (&x)[3], const double (&y)[3]) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

double clear_time(const BallFlight& a, const BallFlight& b, double tolerance) {
  if (a.acceleration != b.acceleration) {
    return 0.0;
  }
  const Relative at(a, b);
  const double touch = a.radius + b.radius;
  if (!(at.coordinates <= largest * touch)) {
    return 0.0;
  }
  const double reach = touch * more + 4.0 * tolerance;
  const double distance = dot(at.d, at.d);
  const double approach = dot(at.d, at.v);
  const double outside = distance - reach * reach;
  if (!(approach < 0.0)) {
    // Apart and parting: nearer than now by no more than rounding.
    const double least = tolerance == 0.0 ? touch * touch * (1.0 + 0x1p-50) : reach * reach;
    return approach > 0.0 && distance >= least ? infinity : 0.0;
  }
  if (!(outside > 0.0)) {
    return 0.0;
  }
  const double square = dot(at.v, at.v);
  const double cross[3] = {at.d[1] * at.v[2] - at.d[2] * at.v[1],
                           at.d[2] * at.v[0] - at.d[0] * at.v[2],
                           at.d[0] * at.v[1] - at.d[1] * at.v[0]};
  const double inwards = reach * reach * square - dot(cross, cross);
  // What velocities may be off by moves the pair by less than the reaches were made larger, while
  // they take less than this time to be nearest.
  const double resolved = 0x1p-24 * touch / (8.0 * unit_roundoff * at.way);
  if (inwards < 0.0) {
    return -approach <= resolved * square ? infinity : 0.0;
  }
  const double time = outside / (-approach + std::sqrt(inwards));
  return time <= resolved ? sooner * time : 0.0;
}

}  // namespace

void filter_balls(const BallFlight& one, std::span<const BallFlight> others, double tolerance,
                  std::span<double> clear) {
  assert(others.size() == clear.size());
  for (std::size_t k = 0; k < others.size(); ++k) {
    clear[k] = clear_time(one, others[k], tolerance);
  }
}

}  // namespace kairos::ccd
