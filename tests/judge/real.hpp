#pragma once

#include "core/pose.hpp"

#include <cmath>

/// Arithmetic of the judge: `Long` (64 bits of mantissa) to look, `Quad` (113 bits) to be sure.
namespace kairos::judge {

using Long = long double;
// Not in ISO C++; GCC has it with its library libquadmath, whose header Clang does not find.
__extension__ using Quad = __float128;
extern "C" {
Quad sqrtq(Quad) noexcept;
Quad sinq(Quad) noexcept;
Quad cosq(Quad) noexcept;
}

inline Long root(Long x) { return std::sqrt(x); }
inline Quad root(Quad x) { return sqrtq(x); }
inline Long sine(Long x) { return std::sin(x); }
inline Quad sine(Quad x) { return sinq(x); }
inline Long cosine(Long x) { return std::cos(x); }
inline Quad cosine(Quad x) { return cosq(x); }
template <typename S>
S magnitude(S x) {
  return x < 0 ? -x : x;
}
template <typename S>
S larger(S x, S y) {
  return x > y ? x : y;
}
template <typename S>
S smaller(S x, S y) {
  return x < y ? x : y;
}
template <typename S>
S clamped(S x, S lowest, S highest) {
  return smaller(larger(x, lowest), highest);
}

/// A vector of three numbers of type S: Eigen has no `__float128`.
template <typename S>
struct Vector {
  S x{}, y{}, z{};

  Vector() = default;
  Vector(S x_, S y_, S z_) : x(x_), y(y_), z(z_) {}
  explicit Vector(const Vector3& v) : x(v.x()), y(v.y()), z(v.z()) {}

  friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector operator*(Vector a, S k) { return {a.x * k, a.y * k, a.z * k}; }
  Vector operator-() const { return {-x, -y, -z}; }
  S operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

template <typename S>
S dot(Vector<S> a, Vector<S> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename S>
Vector<S> cross(Vector<S> a, Vector<S> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename S>
S norm(Vector<S> a) {
  return root(dot(a, a));
}

/// Body axes in the world: the columns of a rotation.
template <typename S>
struct Axes {
  Vector<S> column[3];

  const Vector<S>& operator[](int i) const { return column[i]; }
  /// Components of a world vector along the axes.
  Vector<S> along(Vector<S> v) const {
    return {dot(column[0], v), dot(column[1], v), dot(column[2], v)};
  }
  Vector<S> world(Vector<S> v) const { return column[0] * v.x + column[1] * v.y + column[2] * v.z; }
};

}  // namespace kairos::judge
