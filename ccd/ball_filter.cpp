#include "ccd/ball_filter.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

// Where the compiler can, the loop over pairs exists twice, and the processor decides at load time.
#if defined(KAIROS_WIDE)
// A test compiles this file for one processor after the other.
#elif defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) && \
    !defined(__SANITIZE_ADDRESS__)
#define KAIROS_WIDE [[gnu::target_clones("avx2", "default")]]
#else
#define KAIROS_WIDE
#endif
#define KAIROS_INLINE [[gnu::always_inline]] inline

// One loop over pairs, without branches, that the compiler turns into registers as wide as the
// processor's. Nothing is contracted: the same bits, however wide they are.
namespace kairos::ccd {
namespace {

/// Sizes up to so many reaches: eight roundings of them are at most 2^-28 of a reach.
constexpr double largest = 0x1p22;
constexpr double more = 1.0 + 0x1p-22;
constexpr double sooner = 1.0 - 0x1p-20;

/// What the widest registers hold.
constexpr std::size_t widest = 4;
static_assert(FlightsBeside::block % widest == 0);

KAIROS_INLINE double dot(const double (&x)[3], const double (&y)[3]) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
KAIROS_INLINE double positive_part(double x) { return x < 0.0 ? 0.0 : x; }

/// For how long two balls are clear of each other that are d apart (m) at the later start, which
/// changes by v (m/s); radii add up to `touch`. `way`: how fast the two go, m/s; `coordinates`: how
/// large the numbers are that d is computed from, m.
KAIROS_INLINE double clear_of(const double (&d)[3], const double (&v)[3], double touch,
                              double tolerance, double way, double coordinates) {
  const double reach = touch * more + 4.0 * tolerance;
  const double distance = dot(d, d);
  const double approach = dot(d, v);
  const double outside = distance - reach * reach;
  const double square = dot(v, v);
  const double cross[3] = {d[1] * v[2] - d[2] * v[1], d[2] * v[0] - d[0] * v[2],
                           d[0] * v[1] - d[1] * v[0]};
  const double inwards = reach * reach * square - dot(cross, cross);
  // What velocities may be off by moves the pair by less than the reaches were made larger, while
  // they take less than this time to be nearest.
  const double resolved = 0x1p-24 * touch / (8.0 * unit_roundoff * way);
  const double time = outside / (-approach + __builtin_sqrt(inwards));
  // Apart and parting: nearer than now by no more than rounding.
  const double least = tolerance == 0.0 ? touch * touch * (1.0 + 0x1p-50) : reach * reach;
  const bool parts = (approach > 0.0) & (distance >= least);
  const bool passes =
      (approach < 0.0) & (outside > 0.0) & (inwards < 0.0) & (-approach <= resolved * square);
  const bool meets = (approach < 0.0) & (outside > 0.0) & (inwards >= 0.0) & (time <= resolved);
  const bool known = coordinates <= largest * touch;
  double clear = meets ? sooner * time : 0.0;
  clear = (parts | passes) ? infinity : clear;
  return known ? clear : 0.0;
}

/// For how long from the later start ball k is clear of `a`.
KAIROS_INLINE double clear_time(const BallFlight& a, const FlightsBeside::Block& b, std::size_t k,
                                double radius_b, double tolerance) {
  const double s_a = positive_part(b.lag[k]);
  const double s_b = positive_part(-b.lag[k]);
  double d[3];  // b - a at the later start
  double v[3];  // how fast that changes
  double way = 0.0;
  double coordinates = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double g = a.acceleration.data()[i];
    const double p_a = a.position.data()[i];
    const double v_a = a.velocity.data()[i];
    const double p_b = b.position[i][k];
    const double v_b = b.velocity[i][k];
    v[i] = (v_b + g * s_b) - (v_a + g * s_a);
    d[i] = (p_b + (v_b + 0.5 * g * s_b) * s_b) - (p_a + (v_a + 0.5 * g * s_a) * s_a);
    way += __builtin_fabs(v_a) + __builtin_fabs(v_b) + __builtin_fabs(g) * (s_a + s_b);
    coordinates += __builtin_fabs(p_a) + __builtin_fabs(p_b);
  }
  coordinates += way * (s_a + s_b);
  return clear_of(d, v, a.radius + radius_b, tolerance, way, coordinates);
}

/// The same of two that are equally large and that nothing accelerates.
KAIROS_INLINE double clear_time_straight(const BallFlight& a, const FlightsBeside::Block& b,
                                         std::size_t k, double tolerance, double way_of_a,
                                         double coordinates_of_a) {
  const double s_a = positive_part(b.lag[k]);
  const double s_b = positive_part(-b.lag[k]);
  double d[3];
  double v[3];
  double way = way_of_a;
  double coordinates = coordinates_of_a;
  for (std::size_t i = 0; i < 3; ++i) {
    const double v_a = a.velocity.data()[i];
    const double p_b = b.position[i][k];
    const double v_b = b.velocity[i][k];
    v[i] = v_b - v_a;
    d[i] = (p_b + v_b * s_b) - (a.position.data()[i] + v_a * s_a);
    way += __builtin_fabs(v_b);
    coordinates += __builtin_fabs(p_b);
  }
  coordinates += way * (s_a + s_b);
  return clear_of(d, v, a.radius + a.radius, tolerance, way, coordinates);
}

KAIROS_WIDE void clear_times_straight(const BallFlight& one, const FlightsBeside::Block& others,
                                      std::size_t count, double tolerance, double* clear) {
  double way = 0.0;
  double coordinates = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    way += __builtin_fabs(one.velocity.data()[i]);
    coordinates += __builtin_fabs(one.position.data()[i]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    clear[k] = clear_time_straight(one, others, k, tolerance, way, coordinates);
  }
}

KAIROS_WIDE void clear_times_alike(const BallFlight& one, const FlightsBeside::Block& others,
                                   std::size_t count, double tolerance, double* clear) {
  for (std::size_t k = 0; k < count; ++k) {
    clear[k] = clear_time(one, others, k, one.radius, tolerance);
  }
}

KAIROS_WIDE void clear_times_of(const BallFlight& one, const FlightsBeside::Block& others,
                                std::size_t count, double tolerance, double* clear) {
  for (std::size_t k = 0; k < count; ++k) {
    const double time = clear_time(one, others, k, others.radius[k], tolerance);
    clear[k] = others.comparable[k] != 0.0 ? time : 0.0;
  }
}

}  // namespace

void filter_balls(const FlightsBeside& balls, double tolerance, std::span<double> clear) {
  assert(clear.size() >= (balls.size() + widest - 1) / widest * widest);
  for (std::size_t first = 0; first < balls.size(); first += FlightsBeside::block) {
    const std::size_t count = std::min(FlightsBeside::block, balls.size() - first);
    // Registers are filled with what is there already.
    const std::size_t whole = (count + widest - 1) / widest * widest;
    const FlightsBeside::Block& others = balls.blocks()[first / FlightsBeside::block];
    if (!balls.alike()) {
      clear_times_of(balls.one(), others, whole, tolerance, clear.data() + first);
    } else if (balls.one().acceleration.isZero(0.0)) {
      clear_times_straight(balls.one(), others, whole, tolerance, clear.data() + first);
    } else {
      clear_times_alike(balls.one(), others, whole, tolerance, clear.data() + first);
    }
  }
}

}  // namespace kairos::ccd
