#ifdef KAIROS_WITH_GMP
#include "tests/ccd/linear_reference.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace kairos::reference {
namespace {

using ccd::FourPoints;
using ccd::LinearImpact;
using ccd::LinearKind;
using ccd::LinearQuery;

/// Coefficients in powers of t; the last one is not 0.
using Poly = std::vector<mpz_class>;

Poly trimmed(Poly p) {
  while (!p.empty() && p.back() == 0) {
    p.pop_back();
  }
  return p;
}
Poly operator+(const Poly& a, const Poly& b) {
  Poly sum(std::max(a.size(), b.size()));
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = (i < a.size() ? a[i] : mpz_class(0)) + (i < b.size() ? b[i] : mpz_class(0));
  }
  return trimmed(sum);
}
Poly operator-(Poly a) {
  for (mpz_class& c : a) {
    c = -c;
  }
  return a;
}
Poly operator-(const Poly& a, const Poly& b) { return a + (-b); }
Poly operator*(const Poly& a, const Poly& b) {
  if (a.empty() || b.empty()) {
    return {};
  }
  Poly product(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      product[i + j] += a[i] * b[j];
    }
  }
  return product;
}
Poly derivative(const Poly& p) {
  Poly d;
  for (std::size_t i = 1; i < p.size(); ++i) {
    d.push_back(p[i] * static_cast<unsigned long>(i));
  }
  return d;
}
/// Divided by the greatest common divisor of its coefficients.
Poly primitive(Poly p) {
  mpz_class content = 0;
  for (const mpz_class& c : p) {
    content = gcd(content, c);
  }
  for (mpz_class& c : p) {
    c /= content;
  }
  return p;
}
/// A positive multiple of the rest of a by b; and that of the quotient.
std::pair<Poly, Poly> divided(Poly a, const Poly& b) {
  Poly quotient;
  while (a.size() >= b.size()) {
    const mpz_class factor = abs(b.back());
    const mpz_class top = sgn(b.back()) * a.back();
    const std::size_t shift = a.size() - b.size();
    quotient.resize(std::max(quotient.size(), shift + 1));
    for (mpz_class& c : quotient) {
      c *= factor;
    }
    quotient[shift] += top;
    for (mpz_class& c : a) {
      c *= factor;
    }
    for (std::size_t i = 0; i < b.size(); ++i) {
      a[i + shift] -= top * b[i];
    }
    a = trimmed(a);
  }
  return {a.empty() ? a : primitive(a), quotient};
}
Poly common_divisor(Poly a, Poly b) {
  while (!b.empty()) {
    Poly rest = divided(a, b).first;
    a = std::exchange(b, std::move(rest));
  }
  return primitive(a);
}
int sign_at(const Poly& p, const mpq_class& t) {
  mpz_class value = 0;
  mpz_class denominators = 1;
  for (std::size_t i = p.size(); i > 0; --i) {
    value = value * t.get_num() + p[i - 1] * denominators;
    denominators *= t.get_den();
  }
  return sgn(value);
}

/// Counts distinct roots of a square-free polynomial by Sturm's theorem.
class Sturm {
 public:
  explicit Sturm(const Poly& p) : chain_{p, derivative(p)} {
    while (chain_.back().size() > 1) {
      Poly rest = divided(chain_[chain_.size() - 2], chain_.back()).first;
      if (rest.empty()) {
        break;
      }
      chain_.push_back(-rest);
    }
  }
  /// In (lower, upper].
  [[nodiscard]] int roots(const mpq_class& lower, const mpq_class& upper) const {
    return changes(lower) - changes(upper);
  }

 private:
  [[nodiscard]] int changes(const mpq_class& t) const {
    int count = 0;
    int before = 0;
    for (const Poly& p : chain_) {
      const int sign = sign_at(p, t);
      count += sign * before < 0 ? 1 : 0;
      before = sign != 0 ? sign : before;
    }
    return count;
  }
  std::vector<Poly> chain_;
};

Poly square_free(const Poly& p) {
  const Poly common = common_divisor(p, derivative(p));
  return common.size() <= 1 ? primitive(p) : primitive(divided(p, common).second);
}

/// A number in [0, 1]: lower = upper, or the only root of p in (lower, upper).
struct Root {
  Poly p;
  mpq_class lower, upper;
  [[nodiscard]] bool rational() const { return lower == upper; }
};

void halve(Root& root, const Sturm& sturm) {
  const mpq_class half = (root.lower + root.upper) / 2;
  if (sign_at(root.p, half) == 0) {
    root.lower = root.upper = half;
  } else if (sturm.roots(root.lower, half) == 1) {
    root.upper = half;
  } else {
    root.lower = half;
  }
}

void find_roots(const Poly& p, const Sturm& sturm, const mpq_class& lower, const mpq_class& upper,
                std::vector<Root>& roots) {
  const int inside = sturm.roots(lower, upper) - (sign_at(p, upper) == 0 ? 1 : 0);
  if (inside == 1) {
    roots.push_back({p, lower, upper});
  }
  if (inside > 1) {
    const mpq_class half = (lower + upper) / 2;
    find_roots(p, sturm, lower, half, roots);
    if (sign_at(p, half) == 0) {
      roots.push_back({p, half, half});
    }
    find_roots(p, sturm, half, upper, roots);
  }
}

std::vector<Root> roots_in_the_step(const Poly& any) {
  std::vector<Root> roots;
  if (any.size() < 2) {
    return roots;
  }
  const Poly p = square_free(any);
  if (sign_at(p, 0) == 0) {
    roots.push_back({p, 0, 0});
  }
  find_roots(p, Sturm(p), 0, 1, roots);
  if (sign_at(p, 1) == 0) {
    roots.push_back({p, 1, 1});
  }
  return roots;
}

int sign_at(const Poly& q, Root& root) {
  if (q.empty()) {
    return 0;
  }
  if (root.rational()) {
    return sign_at(q, root.lower);
  }
  const Poly common = common_divisor(root.p, q);
  if (common.size() > 1) {
    const Sturm shared(common);
    if (shared.roots(root.lower, root.upper) - (sign_at(common, root.upper) == 0 ? 1 : 0) > 0) {
      return 0;
    }
  }
  const Sturm own(root.p);
  const Poly simple = q.size() > 1 ? square_free(q) : q;
  const Sturm other(simple);
  while (!root.rational() && (sign_at(q, root.lower) == 0 ||
                              (q.size() > 1 && other.roots(root.lower, root.upper) > 0))) {
    halve(root, own);
  }
  return sign_at(q, root.upper);
}

/// As two doubles, adjacent or equal.
std::pair<double, double> in_doubles(const Root& root) {
  const auto ordinal = [](double x) { return std::bit_cast<std::int64_t>(x); };
  const Sturm sturm(root.p);
  std::int64_t low = ordinal(0.0);
  std::int64_t high = ordinal(1.0);
  for (const double end : {0.0, 1.0}) {
    if (root.rational() && root.lower == end) {
      return {end, end};
    }
  }
  while (high - low > 1) {
    const std::int64_t half = low + (high - low) / 2;
    const auto t = std::bit_cast<double>(half);
    const mpq_class exact(t);
    if (root.rational() ? exact == root.lower
                        : exact > root.lower && exact < root.upper && sign_at(root.p, exact) == 0) {
      return {t, t};
    }
    const bool root_is_above = root.rational()       ? exact < root.lower
                               : exact <= root.lower ? true
                               : exact >= root.upper ? false
                                                     : sturm.roots(root.lower, exact) == 0;
    (root_is_above ? low : high) = half;
  }
  return {std::bit_cast<double>(low), std::bit_cast<double>(high)};
}

using Vec = std::array<Poly, 3>;
Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Poly dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// All of `none_negative` >= 0, all of `zero` = 0, and `positive`, if there is one, > 0.
struct Condition {
  std::vector<Poly> none_negative, zero, positive;

  bool holds(Root& t) const {
    const auto all = [&](const std::vector<Poly>& polys, auto accepts) {
      return std::all_of(polys.begin(), polys.end(),
                         [&](const Poly& p) { return accepts(sign_at(p, t)); });
    };
    return all(none_negative, [](int s) { return s >= 0; }) &&
           all(zero, [](int s) { return s == 0; }) && all(positive, [](int s) { return s > 0; });
  }
};

/// Points in whole numbers of one unit, as functions of time; and the separation, squared.
struct Scene {
  std::array<Vec, 4> p;
  Poly separation_squared;
  std::vector<Condition> any;  ///< they touch where one of these holds

  explicit Scene(const LinearQuery& query) {
    mpq_class unit = 1;
    const auto widen = [&unit](double x) {
      const mpq_class exact(x);
      unit = exact.get_den() > unit ? mpq_class(exact.get_den()) : unit;
    };
    for (std::size_t i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) {
        widen(query.start[i][k]);
        widen(query.end[i][k]);
      }
    }
    widen(query.separation);
    const auto whole = [&unit](double x) { return mpq_class(mpq_class(x) * unit).get_num(); };
    for (std::size_t i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) {
        const mpz_class start = whole(query.start[i][k]);
        p[i][static_cast<std::size_t>(k)] = trimmed({start, whole(query.end[i][k]) - start});
      }
    }
    const mpz_class s = whole(query.separation);
    separation_squared = trimmed({s * s});
  }
  void add_conditions(LinearKind kind) {
    kind == LinearKind::vertex_face ? add_vertex_face() : add_edge_edge();
  }

  /// A point within the separation of the edge from a to b.
  void add_point_edge(const Vec& point, const Vec& a, const Vec& b) {
    const Vec along = b - a;
    const Vec from = point - a;
    const Poly length = dot(along, along);
    const Poly on = dot(from, along);
    any.push_back(
        {{separation_squared * length - (dot(from, from) * length - on * on), on, length - on},
         {},
         {length}});
    add_points(point, a);
    add_points(point, b);
  }
  void add_points(const Vec& a, const Vec& b) {
    any.push_back({{separation_squared - dot(a - b, a - b)}, {}, {}});
  }
  void add_plane(const Vec& n, const Poly& height, std::vector<Poly> sides) {
    sides.push_back(separation_squared * dot(n, n) - height * height);
    any.push_back({std::move(sides), {}, {dot(n, n)}});
  }
  void add_vertex_face() {
    const Vec& a = p[1];
    const Vec& b = p[2];
    const Vec& c = p[3];
    const Vec n = cross(b - a, c - a);
    add_plane(n, dot(p[0] - a, n),
              {dot(cross(b - a, p[0] - a), n), dot(cross(c - b, p[0] - b), n),
               dot(cross(a - c, p[0] - c), n)});
    add_point_edge(p[0], a, b);
    add_point_edge(p[0], b, c);
    add_point_edge(p[0], c, a);
  }
  void add_edge_edge() {
    const Vec d = p[1] - p[0];
    const Vec e = p[3] - p[2];
    const Vec r = p[2] - p[0];
    const Vec n = cross(d, e);
    const Poly s = dot(cross(r, e), n);
    const Poly u = dot(cross(r, d), n);
    const Poly size = dot(n, n);
    add_plane(n, dot(r, n), {s, size - s, u, size - u});
    add_point_edge(p[0], p[2], p[3]);
    add_point_edge(p[1], p[2], p[3]);
    add_point_edge(p[2], p[0], p[1]);
    add_point_edge(p[3], p[0], p[1]);
  }
};

}  // namespace

ccd::LinearImpact reference_impact(const LinearQuery& query) {
  Scene scene(query);
  const auto touch = [&scene](Root& t) {
    return std::any_of(scene.any.begin(), scene.any.end(),
                       [&t](const Condition& condition) { return condition.holds(t); });
  };
  LinearImpact first;
  const auto consider = [&](Root& t) {
    if (first.hit && t.lower >= mpq_class(first.t_hi)) {
      return false;
    }
    if (!touch(t)) {
      return false;
    }
    const auto [low, high] = in_doubles(t);
    if (low < first.t_lo || (low == first.t_lo && high < first.t_hi)) {
      first = {true, low, high};
    }
    return true;
  };
  // A closed set begins at 0 or where one of its conditions changes. Without a separation all four
  // points are coplanar then: if they are not always, only the roots of the volume are left.
  const Vec n = cross(scene.p[1] - scene.p[0], scene.p[2] - scene.p[0]);
  const Poly volume = dot(scene.p[3] - scene.p[0], n);
  if (query.separation == 0.0 && !volume.empty()) {
    std::vector<Root> roots = roots_in_the_step(volume);
    if (!roots.empty()) {
      scene.add_conditions(query.kind);
    }
    static_cast<void>(std::any_of(roots.begin(), roots.end(), consider));
    return first;
  }
  scene.add_conditions(query.kind);
  Root start{{0, 1}, 0, 0};
  if (consider(start)) {
    return first;
  }
  for (const Condition& condition : scene.any) {
    for (const auto* polys : {&condition.none_negative, &condition.zero, &condition.positive}) {
      for (const Poly& p : *polys) {
        for (Root& root : roots_in_the_step(p)) {
          consider(root);
        }
      }
    }
  }
  return first;
}

}  // namespace kairos::reference
#endif
