#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

namespace kairos::ccd {

/// A whole number of any size: a sign and a magnitude in limbs of 64 bits. Twelve limbs are kept in
/// place, so that numbers below 2^768 never ask the heap; larger ones do.
class ExactInteger {
 public:
  using Limb = std::uint64_t;

  ExactInteger() noexcept {}
  ExactInteger(std::int64_t value) noexcept;  // NOLINT(google-explicit-constructor): a number
  ExactInteger(const ExactInteger& other) { copy(other); }
  ExactInteger(ExactInteger&& other) noexcept { move(other); }
  ExactInteger& operator=(const ExactInteger& other);
  ExactInteger& operator=(ExactInteger&& other) noexcept;
  ~ExactInteger() = default;

  /// x / 2^exponent, which must be whole; x finite.
  [[nodiscard]] static ExactInteger from_double(double x, int exponent);
  /// The largest exponent e with x / 2^e whole; x finite and not 0.
  [[nodiscard]] static int lowest_exponent(double x);

  /// -1, 0 or 1.
  [[nodiscard]] int sign() const { return size_ == 0 ? 0 : (negative_ ? -1 : 1); }
  [[nodiscard]] bool is_zero() const { return size_ == 0; }
  /// Bits of the magnitude: 0 for 0, 1 for 1, 2 for 2 and 3.
  [[nodiscard]] int bit_length() const;
  /// How often 2 divides it; not for 0.
  [[nodiscard]] int trailing_zeros() const;
  /// Its value divided by 2^exponent, to some 60 bits and rounded; 0 or infinite beyond the range.
  [[nodiscard]] double scaled(int exponent) const;

  void negate() { negative_ = !negative_; }
  ExactInteger& operator+=(const ExactInteger& other);
  ExactInteger& operator-=(const ExactInteger& other);
  ExactInteger& operator<<=(int bits);
  /// Division by 2^bits, which must leave no rest.
  ExactInteger& operator>>=(int bits);

  friend ExactInteger operator*(const ExactInteger& a, const ExactInteger& b);
  friend ExactInteger exact_quotient(const ExactInteger& a, const ExactInteger& b);
  friend int compare_magnitudes(const ExactInteger& a, const ExactInteger& b);

 private:
  static constexpr std::uint32_t in_place = 12;

  [[nodiscard]] const Limb* limbs() const { return heap_ ? heap_.get() : place_.data(); }
  [[nodiscard]] Limb* limbs() { return heap_ ? heap_.get() : place_.data(); }
  void reserve(std::uint32_t count);  ///< the limbs are lost if there were fewer
  void grow(std::uint32_t count);     ///< the limbs are kept
  void add(const ExactInteger& other, bool negated);
  void trim();
  void copy(const ExactInteger& other);
  void move(ExactInteger& other) noexcept;

  std::unique_ptr<Limb[]> heap_;
  std::uint32_t capacity_ = in_place;
  std::uint32_t size_ = 0;  ///< limbs in use; the last one is not 0
  bool negative_ = false;
  std::array<Limb, in_place> place_;
};

[[nodiscard]] ExactInteger operator*(const ExactInteger& a, const ExactInteger& b);
/// a / b where b divides a; b is not 0.
[[nodiscard]] ExactInteger exact_quotient(const ExactInteger& a, const ExactInteger& b);
/// The sign of |a| - |b|.
[[nodiscard]] int compare_magnitudes(const ExactInteger& a, const ExactInteger& b);

[[nodiscard]] inline ExactInteger operator+(ExactInteger a, const ExactInteger& b) {
  return a += b;
}
[[nodiscard]] inline ExactInteger operator-(ExactInteger a, const ExactInteger& b) {
  return a -= b;
}
[[nodiscard]] inline ExactInteger operator-(ExactInteger a) {
  a.negate();
  return a;
}
[[nodiscard]] inline ExactInteger operator<<(ExactInteger a, int bits) { return a <<= bits; }

// Blocks of a fixed length are copied faster than the limbs in use.
inline void ExactInteger::copy(const ExactInteger& other) {
  constexpr std::uint32_t few = 4;
  if (other.size_ <= few) {
    std::memcpy(limbs(), other.limbs(), few * sizeof(Limb));
  } else {
    reserve(other.size_);
    std::copy_n(other.limbs(), other.size_, limbs());
  }
  size_ = other.size_;
  negative_ = other.negative_;
}

inline void ExactInteger::move(ExactInteger& other) noexcept {
  if (other.heap_) {
    heap_ = std::move(other.heap_);
    capacity_ = std::exchange(other.capacity_, in_place);
    size_ = std::exchange(other.size_, 0);
    negative_ = other.negative_;
  } else {
    copy(other);
    other.size_ = 0;
  }
}

inline ExactInteger& ExactInteger::operator=(const ExactInteger& other) {
  if (this != &other) {
    copy(other);
  }
  return *this;
}

inline ExactInteger& ExactInteger::operator=(ExactInteger&& other) noexcept {
  if (this != &other) {
    move(other);
  }
  return *this;
}

}  // namespace kairos::ccd
