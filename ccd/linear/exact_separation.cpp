// Stage 4 with a separation: pairs of features (points, a point and an edge, the point and the face
// or the two lines), each with the polynomial that says how far it is; equation (13).
#include "ccd/linear/exact_motion.hpp"
#include "ccd/linear/exact_root.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace kairos::ccd {
namespace {

using Polynomials = std::array<ExactPolynomial, 3>;

Polynomials components(const ExactVector& v) {
  return {v.component(0), v.component(1), v.component(2)};
}
Polynomials cross(const ExactVector& a, const ExactVector& b) {
  return {cross(a, b, 0), cross(a, b, 1), cross(a, b, 2)};
}
ExactPolynomial dot(const Polynomials& a, const Polynomials& b) {
  ExactPolynomial sum = a[0] * b[0];
  sum += a[1] * b[1];
  return sum += a[2] * b[2];
}

/// Two features are within the separation where `excess` <= 0, all of `sides` are >= 0 and `size`,
/// if there is one, is not 0.
struct FeaturePair {
  ExactPolynomial excess;
  std::vector<ExactPolynomial> sides;
  ExactPolynomial size;
  bool has_size = false;
};

class Features {
 public:
  explicit Features(const LinearQuery& query)
      : motion_(query, AxisUnits::common),
        separation_(ExactInteger::from_double(query.separation, motion_.unit_exponent())) {
    squared_[0] = separation_ * separation_;
    squared_.trim(0);
    const ExactVector& x = motion_.x();
    const ExactVector& y = motion_.y();
    const ExactVector& z = motion_.z();
    if (query.kind == LinearKind::vertex_face) {
      add_points({&x, &y, &z});
      add_edge(x, y);
      add_edge(y, z);
      add_edge(z, x);
      add_face(x, y, z);
    } else {
      const ExactVector y_b = y - x;
      const ExactVector z_b = z - x;
      add_points({&y, &z, &y_b, &z_b});
      add_edge(y, z);
      add_edge(y_b, z_b);
      add_edge(y, y_b);
      add_edge(z, z_b);
      add_lines(x, y, z);
    }
  }

  [[nodiscard]] const std::vector<FeaturePair>& pairs() const { return pairs_; }

 private:
  void add_points(std::initializer_list<const ExactVector*> differences) {
    for (const ExactVector* d : differences) {
      const Polynomials p = components(*d);
      pairs_.push_back({dot(p, p) - squared_, {}, {}, false});
    }
  }
  /// The origin and the edge from p to q.
  void add_edge(const ExactVector& p, const ExactVector& q) {
    const Polynomials along = components(q - p);
    const Polynomials moment = cross(p, q);
    ExactPolynomial before = dot(components(p), along);
    before.negate();
    const ExactPolynomial size = dot(along, along);
    pairs_.push_back(
        {dot(moment, moment) - squared_ * size, {before, dot(components(q), along)}, size, true});
  }
  void add_face(const ExactVector& x, const ExactVector& y, const ExactVector& z) {
    const Polynomials n = cross(y - x, z - x);
    add_plane(n, {dot(cross(x, y), n), dot(cross(y, z), n), dot(cross(z, x), n)});
  }
  void add_lines(const ExactVector& x, const ExactVector& y, const ExactVector& z) {
    const ExactVector v = z - y;
    const Polynomials n = cross(x, v);
    const ExactPolynomial size = dot(n, n);
    const ExactPolynomial s = dot(cross(y, v), n);
    const ExactPolynomial r = dot(cross(y, x), n);
    add_plane(n, {s, size - s, r, size - r});
  }
  void add_plane(const Polynomials& n, std::vector<ExactPolynomial> sides) {
    const ExactPolynomial f = motion_.volume();
    const ExactPolynomial size = dot(n, n);
    pairs_.push_back({f * f - squared_ * size, std::move(sides), size, true});
  }

  ExactMotion motion_;
  ExactInteger separation_;
  ExactPolynomial squared_;
  std::vector<FeaturePair> pairs_;
};

bool within(const std::vector<FeaturePair>& pairs, ExactRoots& roots, std::size_t i) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const FeaturePair& pair) {
    return roots.sign_at(i, pair.excess) <= 0 &&
           (!pair.has_size || roots.sign_at(i, pair.size) != 0) &&
           std::all_of(pair.sides.begin(), pair.sides.end(),
                       [&](const ExactPolynomial& side) { return roots.sign_at(i, side) >= 0; });
  });
}

void look_at_roots(const ExactPolynomial& p, const std::vector<FeaturePair>& pairs,
                   LinearImpact& first) {
  if (p.degree() < 1) {
    return;
  }
  ExactRoots roots(p);
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const ExactRoot& root = roots.refined(i);
    if (root.t_lo > first.t_lo || (root.t_lo == first.t_lo && root.t_hi >= first.t_hi)) {
      return;
    }
    if (within(pairs, roots, i)) {
      first = {true, root.t_lo, root.t_hi, LinearStage::integers};
      return;
    }
  }
}

}  // namespace

LinearImpact exact_impact_at_distance(const LinearQuery& query) {
  const Features features(query);
  LinearImpact first;
  first.stage = LinearStage::integers;
  look_at_roots(ExactPolynomial(0, 1), features.pairs(), first);
  for (const FeaturePair& pair : features.pairs()) {
    look_at_roots(pair.excess, features.pairs(), first);
  }
  return first;
}

}  // namespace kairos::ccd
