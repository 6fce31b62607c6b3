#include "ccd/linear/exact_polynomial.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace kairos::ccd {

Dyadic::Dyadic(double value) {
  if (value != 0.0) {
    e = std::max(0, -ExactInteger::lowest_exponent(value));
    m = ExactInteger::from_double(value, -e);
  }
}

int compare(const Dyadic& a, const Dyadic& b) {
  ExactInteger difference = a.m << std::max(0, b.e - a.e);
  difference -= b.m << std::max(0, a.e - b.e);
  return difference.sign();
}

Dyadic middle(const Dyadic& a, const Dyadic& b) {
  Dyadic result;
  result.e = std::max(a.e, b.e) + 1;
  result.m = a.m << (result.e - 1 - a.e);
  result.m += b.m << (result.e - 1 - b.e);
  if (!result.m.is_zero()) {
    const int common = std::min(result.e, result.m.trailing_zeros());
    result.m >>= common;
    result.e -= common;
  }
  return result;
}

double rounded_down(const Dyadic& a) {
  double near = a.m.scaled(a.e);
  while (compare(Dyadic(near), a) > 0) {
    near = std::nextafter(near, 0.0);
  }
  for (double next = std::nextafter(near, 1.0); near < 1.0 && compare(Dyadic(next), a) <= 0;
       next = std::nextafter(near, 1.0)) {
    near = next;
  }
  return near;
}

ExactPolynomial::ExactPolynomial(ExactInteger a, ExactInteger b) {
  c_[0] = std::move(a);
  c_[1] = std::move(b);
  trim(1);
}

ExactPolynomial& ExactPolynomial::operator=(const ExactPolynomial& other) {
  for (int i = 0; i <= std::max(degree_, other.degree_); ++i) {
    (*this)[i] = other[i];
  }
  degree_ = other.degree_;
  return *this;
}

ExactPolynomial& ExactPolynomial::operator=(ExactPolynomial&& other) noexcept {
  for (int i = 0; i <= std::max(degree_, other.degree_); ++i) {
    (*this)[i] = std::move(other[i]);
  }
  degree_ = std::exchange(other.degree_, -1);
  return *this;
}

void ExactPolynomial::trim(int highest) {
  degree_ = highest;
  while (degree_ >= 0 && (*this)[degree_].is_zero()) {
    --degree_;
  }
}

void ExactPolynomial::negate() {
  for (int i = 0; i <= degree_; ++i) {
    (*this)[i].negate();
  }
}

ExactPolynomial& ExactPolynomial::operator+=(const ExactPolynomial& other) {
  for (int i = 0; i <= other.degree_; ++i) {
    (*this)[i] += other[i];
  }
  trim(std::max(degree_, other.degree_));
  return *this;
}

ExactPolynomial& ExactPolynomial::operator-=(const ExactPolynomial& other) {
  for (int i = 0; i <= other.degree_; ++i) {
    (*this)[i] -= other[i];
  }
  trim(std::max(degree_, other.degree_));
  return *this;
}

ExactPolynomial operator*(const ExactPolynomial& a, const ExactPolynomial& b) {
  ExactPolynomial product;
  assert(a.degree_ + b.degree_ <= ExactPolynomial::highest_degree);
  for (int i = 0; i <= a.degree_; ++i) {
    for (int j = 0; j <= b.degree_; ++j) {
      product[i + j] += a[i] * b[j];
    }
  }
  product.degree_ = a.degree_ < 0 || b.degree_ < 0 ? -1 : a.degree_ + b.degree_;
  return product;
}

void ExactPolynomial::remove_powers_of_two() {
  int common = std::numeric_limits<int>::max();
  for (int i = 0; i <= degree_; ++i) {
    common = (*this)[i].is_zero() ? common : std::min(common, (*this)[i].trailing_zeros());
  }
  for (int i = 0; i <= degree_; ++i) {
    (*this)[i] >>= common;
  }
}

ExactPolynomial ExactPolynomial::derivative() const {
  ExactPolynomial result;
  for (int i = 1; i <= degree_; ++i) {
    result[i - 1] = (*this)[i] * ExactInteger(i);
  }
  result.degree_ = std::max(-1, degree_ - 1);
  return result;
}

int ExactPolynomial::sign_at(const Dyadic& t) const {
  if (degree_ < 0 || t.m.is_zero()) {
    return c_[0].sign();
  }
  ExactInteger value = (*this)[degree_];
  for (int i = degree_ - 1, shift = t.e; i >= 0; --i, shift += t.e) {
    value = value * t.m;
    if (!(*this)[i].is_zero()) {
      value += (*this)[i] << shift;
    }
  }
  return value.sign();
}

// p((a + b s)/(1 + s)) (1 + s)^n for s > 0, by Horner's rule: its coefficients are, up to positive
// factors, the Bernstein coefficients of p on (a, b).
Variations variations(const ExactPolynomial& p, const Dyadic& lower, const Dyadic& upper) {
  const int n = p.degree();
  const int e = std::max(lower.e, upper.e);
  const ExactInteger a = lower.m << (e - lower.e);
  const ExactInteger b = upper.m << (e - upper.e);
  const bool upper_is_one = e == 0 && !b.is_zero();
  std::array<ExactInteger, ExactPolynomial::highest_degree + 1> c;
  std::array<std::int64_t, ExactPolynomial::highest_degree + 1> binomials{1};  // of (1 + s)^(n-i)
  c[0] = p[n];
  for (int i = n - 1; i >= 0; --i) {
    const auto width = static_cast<std::size_t>(n - i);
    for (std::size_t j = width; j > 0; --j) {
      binomials[j] += binomials[j - 1];
      ExactInteger from_below = upper_is_one ? c[j - 1] : c[j - 1] * b;
      c[j] = j == width || a.is_zero() ? std::move(from_below) : from_below += c[j] * a;
    }
    c[0] = c[0] * a;
    if (!p[i].is_zero()) {
      const ExactInteger scaled = p[i] << (e * (n - i));
      for (std::size_t j = 0; j <= width; ++j) {
        c[j] += binomials[j] == 1 ? scaled : scaled * ExactInteger(binomials[j]);
      }
    }
  }
  Variations result;
  for (int i = 0; i <= n; ++i) {
    const int sign = c[static_cast<std::size_t>(i)].sign();
    if (sign != 0) {
      result.count += result.last != 0 && sign != result.last ? 1 : 0;
      result.first = result.first == 0 ? sign : result.first;
      result.last = sign;
    }
  }
  return result;
}

namespace {

/// A positive multiple of the remainder of a by b, and on request the quotient that belongs to it.
ExactPolynomial signed_remainder(ExactPolynomial a, const ExactPolynomial& b,
                                 ExactPolynomial* quotient = nullptr) {
  const int n = b.degree();
  const int steps = a.degree() - n + 1;
  const ExactInteger& leading = b[n];
  ExactPolynomial q;
  for (int k = a.degree(); k >= n; --k) {  // every step multiplies by the leading coefficient
    const ExactInteger top = a[k];
    for (int i = 0; i < k; ++i) {
      a[i] = a[i] * leading;
      if (i >= k - n) {
        a[i] -= top * b[i - (k - n)];
      }
    }
    a[k] = ExactInteger();
    if (quotient != nullptr) {
      for (int i = k - n + 1; i <= steps - 1; ++i) {
        q[i] = q[i] * leading;
      }
      q[k - n] = top;
    }
  }
  a.trim(n - 1);
  if (steps % 2 != 0 && leading.sign() < 0) {
    a.negate();
  }
  if (quotient != nullptr) {
    q.trim(steps - 1);
    *quotient = std::move(q);
  }
  return a;
}

ExactInteger power(const ExactInteger& base, int exponent) {
  ExactInteger result(1);
  for (int i = 0; i < exponent; ++i) {
    result = result * base;
  }
  return result;
}

/// p, q, and the negated remainders that follow, each up to a positive factor; the last one divides
/// all. The factors are those of subresultants, so that coefficients grow linearly [Knuth1997,
/// 4.6.1].
class SignedRemainders {
 public:
  /// The degree of q is less than that of p.
  SignedRemainders(const ExactPolynomial& p, const ExactPolynomial& q) {
    s_[0] = p;
    s_[1] = q;
    size_ = q.is_zero() ? 1 : 2;
    ExactInteger g(1);
    ExactInteger h(1);
    while (size_ >= 2 && s_[size_ - 1].degree() > 0) {
      const ExactPolynomial& a = s_[size_ - 2];
      const ExactPolynomial& b = s_[size_ - 1];
      const int delta = a.degree() - b.degree();
      ExactPolynomial rest = signed_remainder(a, b);
      if (rest.is_zero()) {
        break;
      }
      const ExactInteger factor = g * power(h, delta);
      for (int i = 0; i <= rest.degree(); ++i) {
        rest[i] = exact_quotient(rest[i], factor);
      }
      rest.negate();
      g = b[b.degree()];
      if (g.sign() < 0) {
        g.negate();
      }
      h = exact_quotient(power(g, delta), power(h, delta - 1));
      s_[size_++] = std::move(rest);
    }
  }

  [[nodiscard]] const ExactPolynomial& last() const { return s_[size_ - 1]; }

  [[nodiscard]] int sign_changes_at(const Dyadic& t) const {
    int changes = 0;
    int before = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const int sign = s_[i].sign_at(t);
      changes += sign * before < 0 ? 1 : 0;
      before = sign != 0 ? sign : before;
    }
    return changes;
  }

 private:
  std::array<ExactPolynomial, 8> s_;
  std::size_t size_ = 0;
};

}  // namespace

int sum_of_signs(const ExactPolynomial& p, const ExactPolynomial& q, const Dyadic& lower,
                 const Dyadic& upper) {
  if (q.is_zero()) {
    return 0;
  }
  ExactPolynomial weighted = p.derivative() * q;
  if (weighted.degree() >= p.degree()) {
    weighted = signed_remainder(weighted, p);
  }
  const SignedRemainders sequence(p, weighted);
  return sequence.sign_changes_at(lower) - sequence.sign_changes_at(upper);
}

ExactPolynomial square_free_part(const ExactPolynomial& p) {
  const SignedRemainders sequence(p, p.derivative());
  if (sequence.last().degree() <= 0) {
    return p;
  }
  ExactPolynomial divisor = sequence.last();
  divisor.remove_powers_of_two();
  ExactPolynomial quotient;
  static_cast<void>(signed_remainder(p, divisor, &quotient));
  quotient.remove_powers_of_two();
  return quotient;
}

}  // namespace kairos::ccd
