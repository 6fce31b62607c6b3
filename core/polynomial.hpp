#pragma once

#include "core/pose.hpp"

#include <array>
#include <cassert>

namespace kairos {
inline namespace core {

/// A vector-valued polynomial sum_k c_k s^k in local time s, of degree at most `max_degree`.
/// Fixed capacity, so that motions live on the stack; copies move only the coefficients in use.
template <int Dim>
class Polynomial {
 public:
  /// A coefficient, or a value.
  using Value = Eigen::Matrix<double, Dim, 1, Eigen::DontAlign>;
  static constexpr int max_degree = 13;  ///< Adams-Moulton of order 12 and its integral

  Polynomial() { coefficients_[0].setZero(); }
  template <typename... Values>
  /// c0 + c1 s + ...; at most `max_degree` + 1 coefficients.
  explicit Polynomial(const Value& c0, const Values&... higher)
      : degree_(static_cast<int>(sizeof...(higher))), coefficients_{c0, Value(higher)...} {}
  /// Copies the coefficients in use.
  Polynomial(const Polynomial& other) { *this = other; }
  /// Copies the coefficients in use.
  Polynomial& operator=(const Polynomial& other) {
    degree_ = other.degree_;
    for (int k = 0; k <= degree_; ++k) {
      coefficients_[index(k)] = other.coefficients_[index(k)];
    }
    return *this;
  }
  ~Polynomial() = default;

  /// Of the coefficients in use; the highest may be 0.
  [[nodiscard]] int degree() const { return degree_; }
  /// c_k, 0 <= k <= `degree()`.
  [[nodiscard]] const Value& operator[](int k) const { return coefficients_[index(k)]; }
  /// c_k, 0 <= k <= `degree()`.
  [[nodiscard]] Value& operator[](int k) { return coefficients_[index(k)]; }
  /// Changes the degree; coefficients that appear are zero.
  void resize(int degree) {
    assert(degree >= 0 && degree <= max_degree);
    for (int k = degree_ + 1; k <= degree; ++k) {
      coefficients_[index(k)].setZero();
    }
    degree_ = degree;
  }

  /// Value at local time s (Horner).
  [[nodiscard]] Value operator()(double s) const {
    Value sum = coefficients_[index(degree_)];
    for (int k = degree_ - 1; k >= 0; --k) {
      sum = sum * s + coefficients_[index(k)];
    }
    return sum;
  }
  /// First derivative at local time s.
  [[nodiscard]] Value derivative(double s) const {
    if (degree_ == 0) {
      return Value::Zero();
    }
    Value sum = coefficients_[index(degree_)] * degree_;
    for (int k = degree_ - 1; k >= 1; --k) {
      sum = sum * s + coefficients_[index(k)] * k;
    }
    return sum;
  }
  /// The derivative as a polynomial.
  [[nodiscard]] Polynomial differentiated() const {
    Polynomial d;
    d.resize(degree_ > 0 ? degree_ - 1 : 0);
    for (int k = 1; k <= degree_; ++k) {
      d[k - 1] = coefficients_[index(k)] * k;
    }
    return d;
  }
  /// The same curve in local time counted from s0: r(u) = p(s0 + u) (Taylor shift).
  [[nodiscard]] Polynomial shifted(double s0) const {
    Polynomial r = *this;
    for (int i = 0; i < degree_; ++i) {
      for (int k = degree_ - 1; k >= i; --k) {
        r[k] += r[k + 1] * s0;
      }
    }
    return r;
  }

 private:
  static constexpr std::size_t index(int k) { return static_cast<std::size_t>(k); }

  int degree_ = 0;
  std::array<Value, max_degree + 1> coefficients_;
};

}  // namespace core
}  // namespace kairos
