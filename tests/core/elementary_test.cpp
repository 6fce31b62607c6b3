// Elementary functions against those of long double, whose 11 more bits tell what a half of an ulp
// is.
#include "core/circular.hpp"
#include "core/exponential.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

using namespace kairos;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// In units of the last place of the double nearest to the truth.
double ulps(double got, long double truth) {
  int exponent = 0;
  std::frexp(static_cast<double>(truth), &exponent);
  return static_cast<double>(std::abs(got - truth) / std::ldexp(1.0L, exponent - 53));
}

/// The worst of many arguments that `draw` makes.
template <typename Function, typename Truth, typename Draw>
double worst(const Function& function, const Truth& truth, const Draw& draw) {
  Random random(17, 4);
  double most = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double x = draw(random);
    most = std::max(most, ulps(function(x), truth(static_cast<long double>(x))));
  }
  return most;
}

auto between(double low, double high) {
  return [=](Random& random) { return random.uniform(low, high); };
}
double any_size(Random& random) {
  return std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.below(80)) - 60);
}
double enormous(Random& random) {
  return std::ldexp(random.uniform(0.5, 1.0), static_cast<int>(random.below(1024)));
}
/// The doubles next to multiples of pi / 32, where almost all digits of x cancel.
double next_to_a_part_of_pi(Random& random) {
  return static_cast<double>(static_cast<long double>(random.below(1u << 24)) *
                             (3.14159265358979323846264338327950288L / 32.0L));
}

bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

}  // namespace

TEST_CASE("sine and cosine are nearest to the truth, whatever the angle", "[elementary]") {
  const auto sine_of = [](long double x) { return std::sin(x); };
  const auto cosine_of = [](long double x) { return std::cos(x); };
  CHECK(worst(sine, sine_of, between(-10.0, 10.0)) < 0.51);
  CHECK(worst(cosine, cosine_of, between(-10.0, 10.0)) < 0.51);
  for (const auto& draw : {any_size, enormous, next_to_a_part_of_pi}) {
    CHECK(worst(sine, sine_of, draw) < 0.51);
    CHECK(worst(cosine, cosine_of, draw) < 0.51);
  }
  // Of all doubles the one nearest to an odd multiple of pi / 2.
  const double hard = 0x1.6ac5b262ca1ffp+849;
  CHECK(ulps(cosine(hard), std::cos(static_cast<long double>(hard))) < 0.51);
  CHECK(sine(hard) == 1.0);
  CHECK(same(sine(-0.0), -0.0));
  CHECK(cosine(0.0) == 1.0);
  CHECK(std::isnan(sine(infinity)));
  CHECK(std::isnan(cosine(-infinity)));
}

TEST_CASE("arc tangent knows its quadrant and its zeros", "[elementary]") {
  for (const double x : {1.0, -3.0, 1e-9}) {
    const auto got = [x](double y) { return arc_tangent(y, x); };
    const auto truth = [x](long double y) { return std::atan2(y, static_cast<long double>(x)); };
    CHECK(worst(got, truth, any_size) < 0.51);
    CHECK(worst(got, truth, between(-5.0, 5.0)) < 0.51);
  }
  const double special[] = {0.0, -0.0, 1.0, -1.0, infinity, -infinity, 1e308, -1e308};
  for (const double y : special) {
    for (const double x : special) {
      INFO("atan2(" << y << ", " << x << ")");
      CHECK(same(arc_tangent(y, x), std::atan2(y, x)));
    }
  }
  CHECK(worst(
            arc_sine, [](long double x) { return std::asin(x); }, between(-1.0, 1.0)) < 2.0);
  CHECK(worst(
            arc_cosine, [](long double x) { return std::acos(x); }, between(-1.0, 1.0)) < 2.0);
}

TEST_CASE("exponential, logarithm and power are nearest to the truth", "[elementary]") {
  CHECK(worst(
            exponential, [](long double x) { return std::exp(x); }, between(-700.0, 700.0)) < 0.52);
  CHECK(worst(
            exponential, [](long double x) { return std::exp(x); }, between(-1.0, 1.0)) < 0.52);
  CHECK(worst(
            logarithm, [](long double x) { return std::log(x); }, enormous) < 0.52);
  CHECK(worst(
            logarithm, [](long double x) { return std::log(x); }, between(0.5, 2.0)) < 0.52);
  for (const double y : {-0.2, 1.0 / 9.0, 3.0, -3.7, 0.5}) {
    const auto got = [y](double x) { return power(x, y); };
    const auto truth = [y](long double x) { return std::pow(x, static_cast<long double>(y)); };
    CHECK(worst(got, truth, between(1e-9, 1e9)) < 0.52);
  }
  CHECK(cube_root(27.0) == 3.0);
  CHECK(power(3.0, 4.0) == 81.0);
  CHECK(exponential(710.0) == infinity);
  CHECK(exponential(-746.0) == 0.0);
  CHECK(logarithm(0.0) == -infinity);
  CHECK(std::isnan(logarithm(-1.0)));
  const double special[] = {0.0, -0.0,     1.0,       -1.0,  2.0,   -3.0,
                            0.5, infinity, -infinity, 1e308, -1e308};
  for (const double x : special) {
    for (const double y : special) {
      INFO("pow(" << x << ", " << y << ")");
      CHECK(same(power(x, y), std::pow(x, y)));
    }
  }
  CHECK(worst(
            hyperbolic_tangent, [](long double x) { return std::tanh(x); }, any_size) < 2.0);
  CHECK(worst(
            hyperbolic_secant, [](long double x) { return 1.0L / std::cosh(x); },
            between(-30.0, 30.0)) < 2.0);
}
