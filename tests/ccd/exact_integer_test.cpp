// Whole numbers of any size, and polynomials over them, against laws that need no other library.
#include "ccd/linear/exact_integer.hpp"

#include "ccd/linear/exact_polynomial.hpp"
#include "ccd/linear/exact_root.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;
using namespace kairos::ccd;

namespace {

/// Of up to `limbs` limbs, with runs of ones and zeros, where carries travel.
ExactInteger random_integer(Random& random, std::uint64_t limbs) {
  ExactInteger value;
  for (std::uint64_t i = random.below(limbs + 1); i > 0; --i) {
    value <<= 64;
    const std::uint64_t kind = random.below(4);
    const std::uint64_t bits = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : random.bits();
    value += ExactInteger(static_cast<std::int64_t>(bits >> 32)) << 32;
    value += ExactInteger(static_cast<std::int64_t>(bits & 0xFFFFFFFF));
  }
  if (random.below(2) == 0) {
    value.negate();
  }
  return value;
}

bool equal(const ExactInteger& a, const ExactInteger& b) { return (a - b).is_zero(); }

}  // namespace

TEST_CASE("exact integers: the laws of a ring, and division undoes multiplication",
          "[ccd][linear]") {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    const ExactInteger a = random_integer(random, 20);
    const ExactInteger b = random_integer(random, 20);
    const ExactInteger c = random_integer(random, 6);
    CAPTURE(seed);
    REQUIRE(equal((a + b) - b, a));
    REQUIRE(equal(a * b, b * a));
    REQUIRE(equal((a + b) * c, a * c + b * c));
    REQUIRE((a - b).sign() == -(b - a).sign());
    REQUIRE((a * b).sign() == a.sign() * b.sign());
    if (!b.is_zero()) {
      REQUIRE(equal(exact_quotient(a * b, b), a));
    }
    const int shift = static_cast<int>(random.below(300));
    ExactInteger shifted = a << shift;
    REQUIRE(shifted.bit_length() == (a.is_zero() ? 0 : a.bit_length() + shift));
    shifted >>= shift;
    REQUIRE(equal(shifted, a));
  }
}

TEST_CASE("exact integers hold every finite double", "[ccd][linear]") {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    const double x =
        std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.below(2090)) - 1070);
    const int exponent = x == 0.0 ? 0 : ExactInteger::lowest_exponent(x);
    CAPTURE(x);
    REQUIRE(ExactInteger::from_double(x, exponent).scaled(-exponent) == x);
    REQUIRE(ExactInteger::from_double(x, -1074).scaled(1074) == x);
  }
  CHECK(ExactInteger::from_double(-6.0, 0).sign() == -1);
  CHECK(ExactInteger::lowest_exponent(6.0) == 1);
  CHECK(ExactInteger::lowest_exponent(0x1p-1074) == -1074);
}

TEST_CASE("exact roots: each once, whatever its multiplicity, with signs of others there",
          "[ccd][linear]") {
  const ExactPolynomial t(0, 1);
  const auto linear = [](int a, int b) { return ExactPolynomial(a, b); };
  // (3t - 1)^2 (t - 1) t^2: roots 0, 1/3, 1.
  const ExactPolynomial third = linear(-1, 3);
  ExactRoots roots(third * third * linear(-1, 1) * t * t);
  REQUIRE(roots.size() == 3);
  CHECK(roots.refined(0).t_hi == 0.0);
  CHECK(roots.refined(1).t_lo == 0.33333333333333331);
  CHECK(roots.refined(1).t_hi == std::nextafter(0.33333333333333331, 1.0));
  CHECK(roots.refined(2).t_lo == 1.0);
  CHECK(roots.sign_at(1, third) == 0);
  CHECK(roots.sign_at(1, third * linear(7, -9)) == 0);
  // 1/3 -+ 1/3 2^-80, within one gap of doubles.
  const ExactInteger large = ExactInteger(3) << 80;
  CHECK(roots.sign_at(1, ExactPolynomial(ExactInteger(-1) - (ExactInteger(1) << 80), large)) == -1);
  CHECK(roots.sign_at(1, ExactPolynomial(ExactInteger(1) - (ExactInteger(1) << 80), large)) == 1);
}

TEST_CASE("exact roots: two within one gap of doubles are told apart", "[ccd][linear]") {
  // 1/3 and 1/3 (1 + 2^-70)
  const ExactPolynomial first(-1, 3);
  const ExactPolynomial second(-(ExactInteger(1) << 70) - ExactInteger(1), ExactInteger(3) << 70);
  ExactRoots roots(first * second);
  REQUIRE(roots.size() == 2);
  CHECK(roots.refined(0).t_lo == roots.refined(1).t_lo);
  CHECK(roots.sign_at(0, first) == 0);
  CHECK(roots.sign_at(0, second) == -1);
  CHECK(roots.sign_at(1, first) == 1);
  CHECK(roots.sign_at(1, second) == 0);
}

TEST_CASE("exact roots: sums of signs count with the multiplicity left out", "[ccd][linear]") {
  // p = (2t - 1)^3 (4t - 1)(4t - 3), q = 2t - 1 + c.
  const ExactPolynomial half(-1, 2);
  const ExactPolynomial p = half * half * half * ExactPolynomial(-1, 4) * ExactPolynomial(-3, 4);
  const Dyadic zero(0.0);
  const Dyadic one(1.0);
  CHECK(sum_of_signs(p, ExactPolynomial(1, 0), zero, one) == 3);
  CHECK(sum_of_signs(p, half, zero, one) == 0);
  CHECK(sum_of_signs(p, half * half, zero, one) == 2);
  CHECK(sum_of_signs(p, ExactPolynomial(-3, 8), zero, one) == 1);
  CHECK(sum_of_signs(p, ExactPolynomial(-1, 0), zero, one) == -3);
}
