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

/// For how long from the later start ball k is clear of `a`.
KAIROS_INLINE double clear_time(const BallFlight& a, const FlightsBeside::Block& b, std::size_t k,
                                double tolerance) {
  const double s_a = positive_part(b.lag[k]);
  const double s_b = positive_part(-b.lag[k]);
  double d[3];             // b - a at the later start
  double v[3];             // how fast that changes
  double way = 0.0;        // how fast the two go, m/s
  double coordinates = 0;  // how large the numbers are that d is computed from, m
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
  const double touch = a.radius + b.radius[k];
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
  const bool known = (coordinates <= largest * touch) & (b.comparable[k] != 0.0);
  double clear = meets ? sooner * time : 0.0;
  clear = parts | passes ? infinity : clear;
  return known ? clear : 0.0;
}

KAIROS_WIDE void clear_times_of(const BallFlight& one, const FlightsBeside::Block& others,
                                std::size_t count, double tolerance, double* clear) {
  for (std::size_t k = 0; k < count; ++k) {
    clear[k] = clear_time(one, others, k, tolerance);
  }
}

}  // namespace

void filter_balls(const FlightsBeside& balls, double tolerance, std::span<double> clear) {
  assert(clear.size() >= (balls.size() + widest - 1) / widest * widest);
  for (std::size_t first = 0; first < balls.size(); first += FlightsBeside::block) {
    const std::size_t count = std::min(FlightsBeside::block, balls.size() - first);
    // Registers are filled with what is there already.
    const std::size_t whole = (count + widest - 1) / widest * widest;
    clear_times_of(balls.one(), balls.blocks()[first / FlightsBeside::block], whole, tolerance,
                   clear.data() + first);
  }
}

}  // namespace kairos::ccd
