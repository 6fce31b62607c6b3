#include "ccd/core_witness.hpp"

#include "ccd/expanding_polytope.hpp"
#include "ccd/nearest_points.hpp"
#include "ccd/polish.hpp"
#include "ccd/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Of the size of the cores: nearer than that GJK's direction is not trusted.
constexpr double near = 1e-6;
/// Where the distance is so near the reach, as a part of that, it matters to roundoff.
constexpr double resolved = 1e-4;
/// How far b is moved into a, as a part of the thinner one.
constexpr double push = 1e-4;
Vector3 any_across(const Vector3& x) {
  int least = 0;
  x.cwiseAbs().minCoeff(&least);
  return x.cross(Vector3::Unit(least)).normalized();
}

/// Points and segments: no volume, but a closed form.
CoreWitness between_lines(const CorePair& pair) {
  const Vector3 along_a = pair.R_WA.col(1);
  const Vector3 along_b = pair.R_WB.col(1);
  const NearestPoints nearest = nearest_of_segments(Vector3::Zero(), along_a, pair.a.sizes().y(),
                                                    pair.d, along_b, pair.b.sizes().y());
  CoreWitness witness;
  witness.on_a = nearest.on_a;
  witness.on_b = nearest.on_b;
  witness.upper = nearest.distance;
  const auto try_along = [&](const Vector3& n) {
    const double length = n.norm();
    if (length > 0.0) {
      const Vector3 unit = (n.dot(pair.d) < 0.0 ? -1.0 : 1.0) / length * n;
      const double separation = pair.separation(unit);
      if (separation > witness.separation) {
        witness.separation = separation;
        witness.n = unit;
      }
    }
  };
  witness.separation = -infinity;
  try_along(nearest.on_b - nearest.on_a);
  if (!(witness.separation > 0.5 * witness.upper)) {  // crossing: noise over the distance
    try_along(along_a.cross(along_b));
    try_along(any_across(along_a));
  }
  return witness;
}

double thinner(const CorePair& pair) {
  const double a = pair.a.has_volume() ? pair.a.width() : infinity;
  const double b = pair.b.has_volume() ? pair.b.width() : infinity;
  return std::min(a, b);
}

/// Expands with b moved by `length` against n; keeps what separates better.
Expansion expand_pushed(const CorePair& pair, const Vector3& n, double length, double precision,
                        double error) {
  const Vector3 shift = -length * n;
  const CorePair moved{pair.a, pair.b, pair.R_WA, pair.R_WB, pair.d + shift};
  const GjkResult inside = gjk(moved, n, 0.0);
  return inside.inside ? expand(moved, shift, inside.simplex, precision, error) : Expansion{};
}

void keep(const CorePair& pair, const Expansion& e, CoreWitness& witness) {
  if (!e.found) {
    return;
  }
  const double separation = pair.separation(e.n);
  if (separation > witness.separation) {
    witness.separation = separation;
    witness.n = e.n;
  }
  const double distance = (e.on_b - e.on_a).norm();
  if (distance < witness.upper || e.depth > 0.0) {
    witness.on_a = e.on_a;
    witness.on_b = e.on_b;
    witness.upper = distance;
  }
  witness.depth = std::max(witness.depth, e.depth);
}

/// Direction and points of cores that are well apart, to roundoff.
void resolve(const CorePair& pair, CoreWitness& witness) {
  polish(pair, witness.on_b - witness.on_a, witness.n, witness.separation);
  const GjkResult again = gjk(pair, witness.n, 0.0);
  if (!again.inside && again.upper < witness.upper) {
    witness.upper = again.upper;
    witness.on_a = again.on_a;
    witness.on_b = again.on_b;
  }
  if (again.lower > witness.separation) {
    witness.separation = again.lower;
    witness.n = again.n;
  }
}

/// They seem to overlap: by a tetrahedron, or by a finer polytope.
void prove_overlap(const CorePair& pair, double error, CoreWitness& witness) {
  const double depth = -witness.separation;
  witness.depth = depth_by_tetrahedron(pair, witness.n, depth, error);
  if (witness.depth > 0.0) {
    return;
  }
  const double pushed = std::max(4.0 * depth, push * thinner(pair));
  keep(pair, expand_pushed(pair, witness.n, pushed, 0.25 * depth, error), witness);
}

}  // namespace

CoreWitness core_witness(const CorePair& pair, double reach, double precision, double error) {
  if (!pair.a.has_volume() && !pair.b.has_volume()) {
    return between_lines(pair);
  }
  const double length = pair.d.norm();
  const Vector3 start = length > 0.0 ? Vector3(pair.d / length) : Vector3(Vector3::UnitY());
  const GjkResult found = gjk(pair, start, precision);
  CoreWitness witness{found.n, found.lower, found.inside ? 0.0 : found.upper,
                      0.0,     found.on_a,  found.on_b};
  if (!found.inside && found.upper > near * pair.size()) {
    if (std::abs(found.upper - reach) < resolved * reach) {
      resolve(pair, witness);
    }
    return witness;
  }
  if (found.inside) {
    witness.upper = infinity;
  }
  const double gap = found.inside ? 0.0 : found.upper;
  const double pushed = std::max(2.0 * gap, push * thinner(pair));
  const double enough = std::max(error, 1e-4 * pushed);
  const bool trusted = !found.inside && found.upper > 64.0 * error;
  keep(pair, expand_pushed(pair, trusted ? found.n : start, pushed, enough, error), witness);
  if (-witness.separation <= pushed) {  // deep inside no push is needed
    keep(pair, expand_pushed(pair, witness.n, pushed, enough, error), witness);
  }
  if (found.inside) {  // at a corner a push hides which of many directions is the shortest
    keep(pair, expand(pair, Vector3::Zero(), found.simplex, error, error), witness);
  }
  polish(pair, witness.on_b - witness.on_a, witness.n, witness.separation);
  if (witness.depth == 0.0 && witness.separation < -2.0 * error) {
    prove_overlap(pair, error, witness);
  }
  return witness;
}

}  // namespace kairos::ccd
