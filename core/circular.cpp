#include "core/circular.hpp"

#include "core/double_double.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

/// sin(k pi / 32), k = 0 to 16.
constexpr std::array<DoubleDouble, 17> sines_of_quarter{{
    {0.0, 0.0},
    {0x1.917a6bc29b42cp-4, -0x1.e2718d26ed688p-60},
    {0x1.8f8b83c69a60bp-3, -0x1.26d19b9ff8d82p-57},
    {0x1.294062ed59f06p-2, -0x1.5d28da2c4612dp-56},
    {0x1.87de2a6aea963p-2, -0x1.72cedd3d5a610p-57},
    {0x1.e2b5d3806f63bp-2, 0x1.e0d891d3c6841p-58},
    {0x1.1c73b39ae68c8p-1, 0x1.b25dd267f6600p-55},
    {0x1.44cf325091dd6p-1, 0x1.8076a2cfdc6b3p-57},
    {0x1.6a09e667f3bcdp-1, -0x1.bdd3413b26456p-55},
    {0x1.8bc806b151741p-1, -0x1.2c5e12ed1336dp-55},
    {0x1.a9b66290ea1a3p-1, 0x1.9f630e8b6dac8p-60},
    {0x1.c38b2f180bdb1p-1, -0x1.6e0b1757c8d07p-56},
    {0x1.d906bcf328d46p-1, 0x1.457e610231ac2p-56},
    {0x1.e9f4156c62ddap-1, 0x1.760b1e2e3f81ep-55},
    {0x1.f6297cff75cb0p-1, 0x1.562172a361fd3p-56},
    {0x1.fd88da3d12526p-1, -0x1.87df6378811c7p-55},
    {0x1.0000000000000p+0, 0.0},
}};

/// sin(k pi / 32) over a whole turn.
constexpr std::array<DoubleDouble, 64> sines = [] {
  std::array<DoubleDouble, 64> all;
  for (std::size_t k = 0; k <= 16; ++k) {
    all[k] = all[(32 - k) % 64] = sines_of_quarter[k];
  }
  for (std::size_t k = 1; k < 32; ++k) {
    all[32 + k] = -all[k];
  }
  return all;
}();

/// atan(k / 32), k = 0 to 32.
constexpr std::array<DoubleDouble, 33> arc_tangents{{
    {0.0, 0.0},
    {0x1.ffd55bba97625p-6, -0x1.5ec431444912cp-60},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.7ee182602f10fp-4, -0x1.cfb654c0c3d98p-58},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.3d6eee8c6626cp-3, 0x1.61a3b0ce9281bp-57},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.b90d7529260a2p-3, 0x1.17b10d2e0e5abp-61},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.18bf5a30bf178p-2, 0x1.30ca4748b1bf9p-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.530ad9951cd4ap-2, -0x1.2566480884082p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.8b24d394a1b25p-2, 0x1.b6d0ba3748fa8p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.c0db4c94ec9f0p-2, -0x1.cc1ce70934c34p-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.f40dd0b541418p-2, -0x1.a3992dc382a23p-57},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1255d9bfbd2a9p-1, -0x1.2bdaee1c0ee35p-58},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.2958e59308e31p-1, -0x1.09e73b0c6c087p-56},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.3f13fb89e96f4p-1, 0x1.ecf8b492644f0p-56},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.538f57b89061fp-1, -0x1.1bb74abda520cp-55},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.66d663923e087p-1, -0x1.6ea6febe8bbbap-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.78f6bbd5d315ep-1, 0x1.406a089803740p-55},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.89ff5ff57f1f8p-1, -0x1.55b9a5e177a1bp-55},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
}};

/// Digits of 1 / pi after the point, 64 bits each, after as many zeros.
constexpr std::array<std::uint64_t, 20> inverse_pi{0x0,
                                                   0x517CC1B727220A94,
                                                   0xFE13ABE8FA9A6EE0,
                                                   0x6DB14ACC9E21C820,
                                                   0xFF28B1D5EF5DE2B0,
                                                   0xDB92371D2126E970,
                                                   0x0324977504E8C90E,
                                                   0x7F0EF58E5894D39F,
                                                   0x74411AFA975DA242,
                                                   0x74CE38135A2FBF20,
                                                   0x9CC8EB1CC1A99CFA,
                                                   0x4E422FC5DEFC941D,
                                                   0x8FFC4BFFEF02CC07,
                                                   0xF79788C5AD05368F,
                                                   0xB69B3F6793E584DB,
                                                   0xA7A31FB34F2FF516,
                                                   0xBA93DD63F5F2F8BD,
                                                   0x9E839CFBC5294975,
                                                   0x35FDAFD88FC6AE84,
                                                   0x2B0198237E3DB5D5};

constexpr DoubleDouble pi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr DoubleDouble half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr DoubleDouble part{0x1.921fb54442d18p-4, 0x1.1a62633145c07p-58};  ///< pi / 32

/// x = k pi / 32 + rest, k modulo 64, |rest| at most pi / 64 and a little.
struct Reduced {
  std::size_t k = 0;
  DoubleDouble rest;
};

/// |x| < 2^20: pi / 32 in three pieces of 29 bits, whose multiples are exact, and the rest of it.
Reduced reduced_small(double x) {
  constexpr double first = 0x1.921fb54000000p-4, second = 0x1.10b4611000000p-34;
  constexpr double third = 0x1.4c4c662000000p-63, fourth = 0x1.1701b839a2520p-92;
  constexpr double to_nearest = 0x1.8p+52;  // adding it rounds to an integer
  const double n = (x * 0x1.45f306dc9c883p+3 + to_nearest) - to_nearest;
  const DoubleDouble a = two_sum(x - n * first, -(n * second));
  const DoubleDouble b = two_sum(a.high, -(n * third));
  return {static_cast<std::size_t>(static_cast<std::int64_t>(n) & 63),
          fast_two_sum(b.high, (a.low + b.low) - n * fourth)};
}

/// 64 bits of 1 / pi, from the bit of weight 2^(63 - from) on.
std::uint64_t digits_from(int from) {
  const auto word = static_cast<std::size_t>(from / 64);
  const int shift = from % 64;
  const std::uint64_t left = inverse_pi[word] << shift;
  return shift == 0 ? left : left | (inverse_pi[word + 1] >> (64 - shift));
}

/// 2^20 <= x: x 32 / pi modulo 64 in fixed point, 6 bits before the point and 186 after it
/// [PayneHanek1983]. What of 1 / pi stands before makes whole turns; what stands behind is below
/// 2^-133.
Reduced reduced_large(double x) {
  int exponent = 0;
  const auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  const int from =
      64 + exponent - 53 - 1;              // of the bit of weight 2^5 in 2^(exponent - 53 + 5) / pi
  std::array<std::uint64_t, 6> product{};  // 32 bits each, the lowest first
  for (std::size_t j = 0; j < 2; ++j) {
    const std::uint64_t factor = j == 0 ? mantissa & 0xFFFFFFFF : mantissa >> 32;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i + j < 6; ++i) {
      const std::uint64_t word = digits_from(from + 128 - 64 * static_cast<int>(i / 2));
      const std::uint64_t digit = i % 2 == 0 ? word & 0xFFFFFFFF : word >> 32;
      const std::uint64_t sum = product[i + j] + factor * digit + carry;
      product[i + j] = sum & 0xFFFFFFFF;
      carry = sum >> 32;
    }
  }
  // To the nearest integer; the rest is signed.
  const std::uint64_t top = (product[5] << 32) | product[4];
  const std::uint64_t n = (top + (std::uint64_t{1} << 57)) >> 58;
  const auto signed_top = static_cast<std::int64_t>(top - (n << 58));
  const double high = std::ldexp(static_cast<double>(signed_top >> 32), -26);
  const double middle = std::ldexp(static_cast<double>(signed_top & 0xFFFFFFFF), -58);
  const double low = std::ldexp(static_cast<double>((product[3] << 21) | (product[2] >> 11)), -111);
  const DoubleDouble sum = fast_two_sum(high, middle);
  const DoubleDouble rest = two_sum(sum.high, low);
  return {static_cast<std::size_t>(n & 63), fast_two_sum(rest.high, rest.low + sum.low) * part};
}

/// sine(a + r) = s + c r' + s d, from s = sine(a), c = cosine(a), r' = sin r, d = cos r - 1.
double combined(const DoubleDouble& s, const DoubleDouble& c, const DoubleDouble& rest,
                double sine_more, double cosine_less) {
  const DoubleDouble turned = two_product(c.high, rest.high);
  const DoubleDouble sum = two_sum(s.high, turned.high);
  return sum.high + (sum.low + (turned.low + (s.low + c.low * rest.high + c.high * sine_more +
                                              s.high * cosine_less)));
}

}  // namespace

SineCosine sine_cosine(double x) {
  const double size = std::abs(x);
  if (!(size <= std::numeric_limits<double>::max())) {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
  if (size < 0x1p-27) {  // the next terms are below a quarter of an ulp
    return {x, 1.0};
  }
  Reduced at = size < 0x1p20 ? reduced_small(x) : reduced_large(size);
  if (size >= 0x1p20 && x < 0.0) {
    at = {(64 - at.k) & 63, -at.rest};
  }
  const double r = at.rest.high;
  const double z = r * r;
  // Taylor's: |r| < 0.0492, so that what is left out is below 2^-66 of what is kept.
  const double sine_more =
      at.rest.low +
      r * (z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z * (1.0 / 362880.0)))));
  const double cosine_less =
      z * (-0.5 + z * (1.0 / 24.0 + z * (-1.0 / 720.0 + z * (1.0 / 40320.0)))) - r * at.rest.low;
  const DoubleDouble& s = sines[at.k];
  const DoubleDouble& c = sines[(at.k + 16) & 63];
  return {combined(s, c, at.rest, sine_more, cosine_less),
          combined(c, -s, at.rest, sine_more, cosine_less)};
}

double sine(double x) { return sine_cosine(x).sine; }

double cosine(double x) { return sine_cosine(x).cosine; }

namespace {

/// atan(a / b), 0 <= a <= b, b > 0.
DoubleDouble octant_angle(double a, double b) {
  const auto k = static_cast<std::size_t>(32.0 * (a / b) + 0.5);
  const double tangent = static_cast<double>(k) / 32.0;
  // tan(angle - atan t) = (a - t b) / (b + t a); the products with t are exact sums.
  const DoubleDouble less = two_product(tangent, b);
  const DoubleDouble more = two_product(tangent, a);
  const DoubleDouble z = (DoubleDouble(a) - less) / (DoubleDouble(b) + more);
  const double square = z.high * z.high;
  // Taylor's: |z| < 1/63.
  const double bent =
      z.high *
      (square * (-1.0 / 3.0 + square * (1.0 / 5.0 + square * (-1.0 / 7.0 + square * (1.0 / 9.0)))));
  const DoubleDouble sum = two_sum(arc_tangents[k].high, z.high);
  return fast_two_sum(sum.high, sum.low + (z.low + bent + arc_tangents[k].low));
}

}  // namespace

double arc_tangent(double y, double x) {
  double a = std::abs(y), b = std::abs(x);
  if (std::isnan(a) || std::isnan(b)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (std::isinf(a) || std::isinf(b)) {
    a = std::isinf(a) ? 1.0 : 0.0;
    b = std::isinf(b) ? 1.0 : 0.0;
  }
  if (a == 0.0 && b == 0.0) {
    b = 1.0;
  }
  const double larger = std::fmax(a, b);
  if (larger > 0x1p900 || larger < 0x1p-900) {  // where products would over- or underflow
    int exponent = 0;
    std::frexp(larger, &exponent);
    a = std::ldexp(a, -exponent);
    b = std::ldexp(b, -exponent);
  }
  DoubleDouble angle;
  if (a <= b) {
    angle = octant_angle(a, b);
  } else {
    angle = half_pi - octant_angle(b, a);
  }
  if (std::signbit(x)) {
    angle = pi - angle;
  }
  return std::copysign(angle.rounded(), y);
}

double hypotenuse(double x, double y) { return std::sqrt(x * x + y * y); }

double arc_sine(double x) { return arc_tangent(x, std::sqrt((1.0 - x) * (1.0 + x))); }

double arc_cosine(double x) { return arc_tangent(std::sqrt((1.0 - x) * (1.0 + x)), x); }

}  // namespace core
}  // namespace kairos
