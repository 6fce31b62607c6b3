#include "ccd/linear/exact_integer.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace kairos::ccd {
namespace {

using Limb = ExactInteger::Limb;
__extension__ using Wide = unsigned __int128;

constexpr int limb_bits = 64;
constexpr std::int64_t hidden_bit = std::int64_t{1} << 52;

/// A finite double as m 2^e with a whole m.
struct Parts {
  std::int64_t m;
  int e;
};
Parts parts_of(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int biased = static_cast<int>((bits >> 52) & 0x7FF);
  const auto fraction =
      static_cast<std::int64_t>(bits & (static_cast<std::uint64_t>(hidden_bit) - 1));
  const std::int64_t m = biased == 0 ? fraction : fraction | hidden_bit;
  return {(bits >> 63) != 0 ? -m : m, std::max(biased, 1) - 1075};
}

/// r = a + b, where a has at least as many limbs; returns the carry. r may be a.
Limb add_magnitudes(const Limb* a, std::size_t n, const Limb* b, std::size_t m, Limb* r) {
  Limb carry = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const Wide sum = Wide{a[i]} + b[i] + carry;
    r[i] = static_cast<Limb>(sum);
    carry = static_cast<Limb>(sum >> limb_bits);
  }
  for (std::size_t i = m; i < n; ++i) {
    r[i] = a[i] + carry;
    carry = r[i] < carry ? 1 : 0;
  }
  return carry;
}

/// r = a - b, where a is not smaller. r may be a or b.
void subtract_magnitudes(const Limb* a, std::size_t n, const Limb* b, std::size_t m, Limb* r) {
  Limb borrow = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Limb subtrahend = i < m ? b[i] : 0;
    const Wide difference = Wide{a[i]} - subtrahend - borrow;
    r[i] = static_cast<Limb>(difference);
    borrow = static_cast<Limb>(difference >> limb_bits) & 1;
  }
}

/// r += a * factor over n limbs; returns the limb that carries out.
Limb add_product(const Limb* a, std::size_t n, Limb factor, Limb* r) {
  Limb carry = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Wide sum = Wide{a[i]} * factor + r[i] + carry;
    r[i] = static_cast<Limb>(sum);
    carry = static_cast<Limb>(sum >> limb_bits);
  }
  return carry;
}

/// r -= a * factor over n limbs; returns the limb that is borrowed.
Limb subtract_product(const Limb* a, std::size_t n, Limb factor, Limb* r) {
  Limb carry = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Wide product = Wide{a[i]} * factor + carry;
    const Limb low = static_cast<Limb>(product);
    carry = static_cast<Limb>(product >> limb_bits) + (r[i] < low ? 1 : 0);
    r[i] -= low;
  }
  return carry;
}

}  // namespace

ExactInteger::ExactInteger(std::int64_t value) noexcept
    : size_(value == 0 ? 0 : 1), negative_(value < 0) {
  place_[0] = negative_ ? Limb{0} - static_cast<Limb>(value) : static_cast<Limb>(value);
}

ExactInteger ExactInteger::from_double(double x, int exponent) {
  const Parts parts = parts_of(x);
  ExactInteger result(parts.m);
  if (parts.m != 0) {
    if (parts.e >= exponent) {
      result <<= parts.e - exponent;
    } else {
      result >>= exponent - parts.e;
    }
  }
  return result;
}

int ExactInteger::lowest_exponent(double x) {
  const Parts parts = parts_of(x);
  return parts.e + std::countr_zero(static_cast<std::uint64_t>(parts.m));
}

int ExactInteger::bit_length() const {
  return size_ == 0 ? 0
                    : static_cast<int>(size_) * limb_bits - std::countl_zero(limbs()[size_ - 1]);
}

int ExactInteger::trailing_zeros() const {
  const Limb* l = limbs();
  int i = 0;
  while (l[i] == 0) {
    ++i;
  }
  return i * limb_bits + std::countr_zero(l[i]);
}

double ExactInteger::scaled(int exponent) const {
  double value = 0.0;
  const std::uint32_t first = size_ > 2 ? size_ - 2 : 0;
  for (std::uint32_t i = size_; i > first; --i) {
    value = value * 0x1p64 + static_cast<double>(limbs()[i - 1]);
  }
  return std::ldexp(negative_ ? -value : value, static_cast<int>(first) * limb_bits - exponent);
}

void ExactInteger::reserve(std::uint32_t count) {
  if (count > capacity_) {
    heap_ = std::make_unique_for_overwrite<Limb[]>(count);
    capacity_ = count;
  }
}

void ExactInteger::grow(std::uint32_t count) {
  if (count > capacity_) {
    auto larger = std::make_unique_for_overwrite<Limb[]>(count);
    std::copy_n(limbs(), size_, larger.get());
    heap_ = std::move(larger);
    capacity_ = count;
  }
}

void ExactInteger::trim() {
  const Limb* l = limbs();
  while (size_ > 0 && l[size_ - 1] == 0) {
    --size_;
  }
}

int compare_magnitudes(const ExactInteger& a, const ExactInteger& b) {
  if (a.size_ != b.size_) {
    return a.size_ < b.size_ ? -1 : 1;
  }
  const Limb* x = a.limbs();
  const Limb* y = b.limbs();
  for (std::uint32_t i = a.size_; i > 0; --i) {
    if (x[i - 1] != y[i - 1]) {
      return x[i - 1] < y[i - 1] ? -1 : 1;
    }
  }
  return 0;
}

void ExactInteger::add(const ExactInteger& other, bool negated) {
  const bool other_negative = other.negative_ != negated;
  if (other.size_ == 0) {
    return;
  }
  if (negative_ == other_negative || size_ == 0) {
    const std::uint32_t n = std::max(size_, other.size_);
    const std::uint32_t own = size_;
    grow(n + 1);
    Limb* l = limbs();
    const Limb carry = own >= other.size_ ? add_magnitudes(l, own, other.limbs(), other.size_, l)
                                          : add_magnitudes(other.limbs(), other.size_, l, own, l);
    l[n] = carry;
    size_ = n + (carry != 0 ? 1 : 0);
    negative_ = other_negative;
    return;
  }
  if (compare_magnitudes(*this, other) >= 0) {
    subtract_magnitudes(limbs(), size_, other.limbs(), other.size_, limbs());
  } else {
    const std::uint32_t own = size_;
    grow(other.size_);
    subtract_magnitudes(other.limbs(), other.size_, limbs(), own, limbs());
    size_ = other.size_;
    negative_ = other_negative;
  }
  trim();
}

ExactInteger& ExactInteger::operator+=(const ExactInteger& other) {
  add(other, false);
  return *this;
}

ExactInteger& ExactInteger::operator-=(const ExactInteger& other) {
  add(other, true);
  return *this;
}

ExactInteger& ExactInteger::operator<<=(int bits) {
  if (size_ == 0 || bits == 0) {
    return *this;
  }
  const auto whole = static_cast<std::uint32_t>(bits / limb_bits);
  const int part = bits % limb_bits;
  const std::uint32_t count = size_ + whole + 1;
  grow(count);
  Limb* l = limbs();
  l[count - 1] = 0;
  for (std::uint32_t i = size_; i > 0; --i) {  // downwards: in place
    const Limb limb = l[i - 1];
    if (part != 0) {
      Limb& above = l[i + whole];
      above = (i == size_ ? 0 : above) | (limb >> (limb_bits - part));
    }
    l[i - 1 + whole] = limb << part;
  }
  std::fill_n(l, whole, Limb{0});
  size_ = count;
  trim();
  return *this;
}

ExactInteger& ExactInteger::operator>>=(int bits) {
  if (size_ == 0 || bits == 0) {
    return *this;
  }
  const auto whole = static_cast<std::uint32_t>(bits / limb_bits);
  const int part = bits % limb_bits;
  assert(trailing_zeros() >= bits);
  Limb* l = limbs();
  size_ -= whole;
  for (std::uint32_t i = 0; i < size_; ++i) {
    const Limb above = i + 1 < size_ ? l[i + 1 + whole] : 0;
    l[i] = part == 0 ? l[i + whole] : (l[i + whole] >> part) | (above << (limb_bits - part));
  }
  trim();
  return *this;
}

ExactInteger operator*(const ExactInteger& a, const ExactInteger& b) {
  ExactInteger product;
  if (a.size_ == 0 || b.size_ == 0) {
    return product;
  }
  const std::uint32_t n = a.size_;
  product.negative_ = a.negative_ != b.negative_;
  if (n == 1 && b.size_ == 1) {
    const Wide both = Wide{a.limbs()[0]} * b.limbs()[0];
    product.place_[0] = static_cast<Limb>(both);
    product.place_[1] = static_cast<Limb>(both >> limb_bits);
    product.size_ = product.place_[1] != 0 ? 2 : 1;
    return product;
  }
  product.reserve(n + b.size_);
  const Limb* x = a.limbs();
  const Limb* y = b.limbs();
  Limb* r = product.limbs();
  Limb carry = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Wide sum = Wide{x[i]} * y[0] + carry;
    r[i] = static_cast<Limb>(sum);
    carry = static_cast<Limb>(sum >> limb_bits);
  }
  r[n] = carry;
  for (std::uint32_t j = 1; j < b.size_; ++j) {
    r[n + j] = add_product(x, n, y[j], r + j);
  }
  product.size_ = n + b.size_;
  product.size_ -= r[product.size_ - 1] == 0 ? 1 : 0;
  return product;
}

// Knuth's algorithm D [Knuth1997, 4.3.1].
ExactInteger exact_quotient(const ExactInteger& a, const ExactInteger& b) {
  assert(!b.is_zero());
  ExactInteger quotient;
  if (a.size_ < b.size_) {
    assert(a.is_zero());
    return quotient;
  }
  const std::uint32_t n = b.size_;
  const std::uint32_t count = a.size_ - n + 1;
  const int shift = std::countl_zero(b.limbs()[n - 1]);
  ExactInteger rest = a;
  rest <<= shift;
  ExactInteger divisor = b;
  divisor <<= shift;
  rest.grow(a.size_ + 1);
  std::fill(rest.limbs() + rest.size_, rest.limbs() + a.size_ + 1, Limb{0});
  quotient.reserve(count);
  Limb* r = rest.limbs();
  const Limb* d = divisor.limbs();
  for (std::uint32_t j = count; j > 0; --j) {
    Limb* part = r + (j - 1);  // n + 1 limbs, less than divisor 2^64
    const Wide top = (Wide{part[n]} << limb_bits) | part[n - 1];
    Wide guess = part[n] >= d[n - 1] ? Wide{~Limb{0}} : top / d[n - 1];
    Wide over = top - guess * d[n - 1];
    while (n > 1 && (over >> limb_bits) == 0 &&
           guess * d[n - 2] > ((over << limb_bits) | part[n - 2])) {
      --guess;
      over += d[n - 1];
    }
    auto digit = static_cast<Limb>(guess);
    const Limb borrowed = subtract_product(d, n, digit, part);
    const bool too_much = part[n] < borrowed;
    part[n] -= borrowed;
    if (too_much) {
      --digit;
      part[n] += add_magnitudes(part, n, d, n, part);
    }
    quotient.limbs()[j - 1] = digit;
  }
  quotient.size_ = count;
  quotient.trim();
  quotient.negative_ = a.negative_ != b.negative_;
  return quotient;
}

}  // namespace kairos::ccd
