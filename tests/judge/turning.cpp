#include "tests/judge/turning.hpp"

#include <limits>

namespace kairos::judge {
namespace {

/// sum_k k (k - 1) ... |c_k| s^(k - order): a bound of the derivative on [0, s].
template <int Dim>
Long derivative_bound(const Polynomial<Dim>& p, int order, Long s) {
  Long sum = 0;
  for (int k = p.degree(); k >= order; --k) {
    Long factor = 1;
    for (int i = 0; i < order; ++i) {
      factor *= k - i;
    }
    sum = sum * s + factor * static_cast<Long>(p[k].stableNorm());
  }
  return sum;
}

/// The value, or the first derivative, of one component.
template <int Dim>
Long component(const Polynomial<Dim>& p, int i, int order, Long s) {
  Long sum = 0;
  for (int k = p.degree(); k >= order; --k) {
    sum = sum * s + (order == 1 ? k : 1) * static_cast<Long>(p[k][i]);
  }
  return sum;
}

Turning polynomial_turning(const Body& body, Long s, Long end) {
  const Polynomial<4>& q = body.turn;
  Turning turning;
  turning.steady = false;
  const Vector<Long> v(component(q, 1, 0, s), component(q, 2, 0, s), component(q, 3, 0, s));
  const Vector<Long> dv(component(q, 1, 1, s), component(q, 2, 1, s), component(q, 3, 1, s));
  const Long w = component(q, 0, 0, s);
  const Long dw = component(q, 0, 1, s);
  // Vector part of 2 Q' conj(Q) / |Q|^2.
  turning.w = (dv * w - v * dw - cross(dv, v)) * (2 / (w * w + dot(v, v)));
  const Long first = static_cast<Long>(q[0].stableNorm());
  const Long least = 2 * first - derivative_bound(q, 0, end);
  if (!(least > 0)) {
    turning.rate = turning.change = std::numeric_limits<Long>::infinity();
    return turning;
  }
  const Long speed = derivative_bound(q, 1, end) / least;
  turning.rate = 2 * speed;
  turning.change = 2 * derivative_bound(q, 2, end) / least + 4 * speed * speed;
  return turning;
}

}  // namespace

Turning turning_of(const Body& body, Long t, Long end) {
  if (body.polynomial) {
    return polynomial_turning(body, Long(body.age) + t, Long(body.age) + end);
  }
  Turning turning;
  turning.w = Vector<Long>(body.spin);
  turning.rate = norm(turning.w);
  return turning;
}

Travel travel_of(const Body& body, Long t, Long end) {
  const Long s = Long(body.age) + t;
  Travel travel;
  if (body.polynomial) {
    const Polynomial<3>& p = body.course;
    travel.velocity = {component(p, 0, 1, s), component(p, 1, 1, s), component(p, 2, 1, s)};
    travel.change = derivative_bound(p, 2, Long(body.age) + end);
    return travel;
  }
  travel.acceleration = Vector<Long>(body.acceleration);
  travel.velocity = Vector<Long>(body.velocity) + travel.acceleration * s;
  return travel;
}

Long travelled(const Body& body, Long s) {
  if (body.polynomial) {
    return derivative_bound(body.course, 0, s);
  }
  return Long(body.position.stableNorm()) + Long(body.velocity.stableNorm()) * s +
         Long(body.acceleration.stableNorm()) * s * s / 2;
}

Long angle_turned(const Body& body, Long s) {
  return (body.polynomial ? 2 * derivative_bound(body.turn, 1, s) : Long(body.spin.stableNorm())) *
         s;
}

}  // namespace kairos::judge
