// The bound E of the rounding of a separation: it is what the proof asks for, and no separation in
// doubles is further than E from the one in long double. KAIROS_BOUND_LOOKS=N looks N times at each
// pair and prints how much of E rounding takes.

#include "ccd/moving_cores.hpp"
#include "tests/catch.hpp"
#include "tests/ccd/convex_query.hpp"

#include <fmt/format.h>

#include <cstdlib>

using namespace kairos;
using namespace kairos::convex;

namespace {

constexpr double u = 0x1p-53;

std::uint64_t looks() {
  const char* text = std::getenv("KAIROS_BOUND_LOOKS");
  return text != nullptr ? std::strtoull(text, nullptr, 10) : 50;
}

/// The least n . (x_b - x_a) of two bodies without their roundings, in long double.
Real exact_separation(const Query& q, Real t, const Vec& n, Real reach) {
  return n.dot(highest(q.at(true, t), -n) - highest(q.at(false, t), n)) + reach * n.norm();
}

/// What eq. (11) of ccd/README.md and the cores below it ask for, for motions on parabolas that
/// start with the window: rho is 8 u at rest and 40 u at a constant rate. 1.75 stands for sqrt(3).
double asked_for(const Query& q, const ccd::PairMotion& motion, const ccd::Kinematics& k) {
  const auto rho = [](const Shape& shape, const Motion& m) {
    const bool turns = m.rotation == RotationKind::constant_rate && m.rotation_rate.norm() > 0.0;
    return (std::holds_alternative<Sphere>(shape) ? 0.0 : turns ? 40.0 : 8.0) * u;
  };
  double position = 0.0;
  double power = 1.0;
  for (int i = 0; i <= 2; ++i) {
    const auto coefficient = [i](const Motion& m) {
      return i <= m.position.degree() ? Vector3(m.position[i]) : Vector3(Vector3::Zero());
    };
    const Vector3 d = coefficient(q.motion_b) - coefficient(q.motion_a);
    position += (4.0 * i + 8.0) * u * d.lpNorm<Eigen::Infinity>() * power;
    power *= k.t;
  }
  const double turning = rho(q.a, q.motion_a) + rho(q.b, q.motion_b);
  const double extents = 1.75 * (motion.core_a().extent() + motion.core_b().extent());
  return position + turning * k.d.lpNorm<1>() + (turning + 16.0 * u) * extents;
}

}  // namespace

TEST_CASE("the bound of rounding is the one that is proven, and rounding stays below it",
          "[convex][rounding]") {
  const std::uint64_t count = looks();
  constexpr std::uint64_t seed = 20261122;
  INFO("seed " << seed);
  for (int a = 0; a < 6; ++a) {
    for (int b = std::max(a, 2); b < 6; ++b) {
      double most = 0.0;
      for (std::uint64_t i = 0; i < count; ++i) {
        Random random(seed, static_cast<std::uint64_t>(a * 7 + b), 1'000'000 * i);
        const Query q = random_query(random, a, b, static_cast<Course>(i % 5));
        const ccd::PairMotion motion(MovingShape{q.a, q.motion_a}, MovingShape{q.b, q.motion_b},
                                     Window{Instant{}, q.duration});
        for (const double t : {0.0, q.touch, random.uniform()}) {
          ccd::Kinematics k;
          motion.evaluate(t, k);
          CAPTURE(a, b, i, t);
          CHECK(k.error >= asked_for(q, motion, k) * (1.0 - 1e-12));
          for (const Vector3& n : {random.direction(), ccd::between_cores(motion, k).n}) {
            const Real rounded = ccd::core_pair(motion, k).separation(n);
            const Real off = rounded - exact_separation(q, t, n.cast<Real>(), motion.reach());
            most = std::max(most, static_cast<double>(std::abs(off)) / k.error);
          }
        }
      }
      CAPTURE(a, b, most);
      CHECK(most < 1.0);
      CHECK(most > 1e-3);  // the bound is of this rounding, not of some other size
      if (count > 50) {
        fmt::print("{:<22}{:>8.4f} of E, slack {:>6.1f}\n",
                   fmt::format("{}-{}", shape_names[static_cast<std::size_t>(a)],
                               shape_names[static_cast<std::size_t>(b)]),
                   most, 1.0 / most);
      }
    }
  }
}
