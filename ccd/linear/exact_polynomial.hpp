#pragma once

#include "ccd/linear/exact_integer.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace kairos::ccd {

/// The number m / 2^e, exactly; e >= 0.
struct Dyadic {
  ExactInteger m;
  int e = 0;

  Dyadic() = default;
  /// A double in [0, 1].
  explicit Dyadic(double value);
};
/// The sign of a - b.
[[nodiscard]] int compare(const Dyadic& a, const Dyadic& b);
[[nodiscard]] Dyadic middle(const Dyadic& a, const Dyadic& b);
/// The largest double that is not above it, for numbers in [0, 1].
[[nodiscard]] double rounded_down(const Dyadic& a);

/// A polynomial in time with whole coefficients, in powers of t; of degree at most 11.
class ExactPolynomial {
 public:
  static constexpr int highest_degree = 11;

  ExactPolynomial() = default;
  // Only the coefficients in use are copied.
  ExactPolynomial(const ExactPolynomial& other) { *this = other; }
  ExactPolynomial(ExactPolynomial&& other) noexcept { *this = std::move(other); }
  ExactPolynomial& operator=(const ExactPolynomial& other);
  ExactPolynomial& operator=(ExactPolynomial&& other) noexcept;
  ~ExactPolynomial() = default;
  /// a + b t
  ExactPolynomial(ExactInteger a, ExactInteger b);

  /// -1 for the zero polynomial.
  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] bool is_zero() const { return degree_ < 0; }
  [[nodiscard]] const ExactInteger& operator[](int power) const {
    return c_[static_cast<std::size_t>(power)];
  }
  /// To be set from outside; then `trim`.
  [[nodiscard]] ExactInteger& operator[](int power) { return c_[static_cast<std::size_t>(power)]; }
  /// Finds the degree again, which is at most `highest`.
  void trim(int highest);

  void negate();
  ExactPolynomial& operator+=(const ExactPolynomial& other);
  ExactPolynomial& operator-=(const ExactPolynomial& other);
  friend ExactPolynomial operator*(const ExactPolynomial& a, const ExactPolynomial& b);

  /// Takes out what powers of two all coefficients have in common: keeps roots and signs.
  void remove_powers_of_two();
  [[nodiscard]] ExactPolynomial derivative() const;
  /// Of the value at a number.
  [[nodiscard]] int sign_at(const Dyadic& t) const;

 private:
  std::array<ExactInteger, highest_degree + 1> c_;
  int degree_ = -1;
};

[[nodiscard]] ExactPolynomial operator*(const ExactPolynomial& a, const ExactPolynomial& b);
[[nodiscard]] inline ExactPolynomial operator+(ExactPolynomial a, const ExactPolynomial& b) {
  return a += b;
}
[[nodiscard]] inline ExactPolynomial operator-(ExactPolynomial a, const ExactPolynomial& b) {
  return a -= b;
}

/// What the Bernstein coefficients of a polynomial on an open interval tell.
struct Variations {
  int count = 0;  ///< of sign changes: at least the number of roots within, and of its parity
  int first = 0;  ///< sign right of the lower end
  int last = 0;   ///< sign left of the upper end
};
/// Of a polynomial that is not 0.
[[nodiscard]] Variations variations(const ExactPolynomial& p, const Dyadic& lower,
                                    const Dyadic& upper);

/// The sum, over the distinct roots r of p between two numbers that are no roots of p, of the sign
/// of q(r): the Tarski query, by a signed sequence of subresultants [Basu2006, ch. 2.2]. With
/// one root it is the sign there, and 0 exactly if the two polynomials share it.
[[nodiscard]] int sum_of_signs(const ExactPolynomial& p, const ExactPolynomial& q,
                               const Dyadic& lower, const Dyadic& upper);

/// A polynomial with the same roots, each once.
[[nodiscard]] ExactPolynomial square_free_part(const ExactPolynomial& p);

}  // namespace kairos::ccd
