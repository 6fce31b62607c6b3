#include "ccd/core_witness.hpp"

#include "ccd/expanding_polytope.hpp"
#include "ccd/nearest_points.hpp"
#include "ccd/polish.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/triangle_witness.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Of the size of the cores: nearer than that GJK's direction is not trusted.
constexpr double near = 1e-6;
/// Where the distance is so near the reach, as a part of that, it matters to roundoff.
constexpr double resolved = 1e-4;
/// What is curved is resolved where GJK bounds its distance by no less than this part of it.
constexpr double bound_by = 1e-12;
/// How far b is moved into a, as a part of the thinner one.
constexpr double push = 1e-4;
Vector3 any_across(const Vector3& x) {
  int least = 0;
  x.cwiseAbs().minCoeff(&least);
  return x.cross(Vector3::Unit(least)).normalized();
}

/// Points and segments: no volume, but a closed form.
CoreWitness between_lines(const CorePair& pair) {
  const ConvexCore::Line a = pair.a.line();
  const ConvexCore::Line b = pair.b.line();
  const Vector3 along_a = pair.R_WA * a.direction;
  const Vector3 along_b = pair.R_WB * b.direction;
  const Vector3 between = pair.d + pair.R_WB * b.middle - pair.R_WA * a.middle;
  const NearestPoints nearest = nearest_of_segments(pair.R_WA * a.middle, along_a, a.half,
                                                    pair.d + pair.R_WB * b.middle, along_b, b.half);
  CoreWitness witness;
  witness.on_a = nearest.on_a;
  witness.on_b = nearest.on_b;
  witness.upper = nearest.distance;
  const auto try_along = [&](const Vector3& n) {
    const double length = n.norm();
    if (length > 0.0) {
      const Vector3 unit = (n.dot(between) < 0.0 ? -1.0 : 1.0) / length * n;
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
  const double a = pair.a.width() > 0.0 ? pair.a.width() : infinity;
  const double b = pair.b.width() > 0.0 ? pair.b.width() : infinity;
  const double least = std::min(a, b);
  return std::isfinite(least) ? least : pair.size();  // a triangle and what is thin as well
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

/// Around a vertex of a triangle directions that have nothing in common separate nearly as well: an
/// expanded polytope may end far from where GJK was, which was off by its noise only.
void keep_polished(const CorePair& pair, const GjkResult& found, CoreWitness& witness) {
  Vector3 n = found.n;
  double separation = found.lower;
  polish(pair, found.on_b - found.on_a, n, separation);
  if (separation > witness.separation) {
    witness.n = n;
    witness.separation = separation;
  }
}

/// A cylinder or a cone: beside one GJK's points are never as near as the cores are, whatever it
/// starts from, and its direction is as good as it gets.
bool is_curved(const ConvexCore& core) {
  return core.kind() == ConvexCore::Kind::cylinder || core.kind() == ConvexCore::Kind::cone;
}

/// Corner to corner between slivers GJK ends where rounding lets nothing improve, in a direction
/// that is off by more than the gap: other starts end elsewhere.
void start_elsewhere(const CorePair& pair, const GjkResult& found, CoreWitness& witness) {
  const auto from = [&](const Vector3& start) {
    if (witness.separation > 0.5 * found.upper) {
      return;
    }
    const GjkResult other = gjk(pair, start, 0.0);
    if (!other.inside && other.lower > witness.separation) {
      witness.separation = other.lower;
      witness.n = other.n;
    }
  };
  from(found.n);
  from(witness.n);
  for (int k = 0; k < 3; ++k) {
    for (const double sign : {1.0, -1.0}) {
      from(sign * pair.R_WA.col(k));
      from(sign * pair.R_WB.col(k));
    }
  }
}

/// What touches to roundoff may be inside, and nothing that expands there finds how little: along
/// an axis of one of them, as across a face that something lies on, they may overlap less, or, what
/// is curved, near that.
void try_axes(const CorePair& pair, CoreWitness& witness) {
  const bool curved = is_curved(pair.a) || is_curved(pair.b);
  for (int k = 0; k < 3; ++k) {
    for (const Vector3& axis : {Vector3(pair.R_WA.col(k)), Vector3(pair.R_WB.col(k))}) {
      for (const double sign : {1.0, -1.0}) {
        Vector3 n = sign * axis;
        double separation = pair.separation(n);
        if (curved && separation > -near * pair.size()) {
          polish(pair, witness.on_b - witness.on_a, n, separation);
        }
        if (separation > witness.separation) {
          witness.separation = separation;
          witness.n = n;
        }
      }
    }
  }
}

}  // namespace

CoreWitness core_witness(const CorePair& pair, double reach, double precision, double error) {
  if (!pair.a.has_volume() && !pair.b.has_volume()) {
    return between_lines(pair);
  }
  if (pair.a.kind() == ConvexCore::Kind::triangle && pair.b.kind() == ConvexCore::Kind::triangle) {
    return triangle_witness(pair, error);
  }
  const double length = pair.d.norm();
  const Vector3 start = length > 0.0 ? Vector3(pair.d / length) : Vector3(Vector3::UnitY());
  const GjkResult found = gjk(pair, start, precision);
  CoreWitness witness{found.n, found.lower, found.inside ? 0.0 : found.upper,
                      0.0,     found.on_a,  found.on_b};
  if (!found.inside && found.upper > near * pair.size()) {
    // Beside a flat end GJK ends where rounding lets no simplex improve, and may be far from it.
    const bool loose =
        (is_curved(pair.a) || is_curved(pair.b)) && found.lower < (1.0 - bound_by) * found.upper;
    if (loose || std::abs(found.upper - reach) < resolved * reach) {
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
  if (witness.separation < -64.0 * error) {
    try_axes(pair, witness);
  }
  if (!found.inside && (pair.a.width() == 0.0 || pair.b.width() == 0.0)) {
    keep_polished(pair, found, witness);
  }
  const bool angular = !is_curved(pair.a) && !is_curved(pair.b);
  if (!found.inside && angular && found.upper > 2.0 * error) {
    start_elsewhere(pair, found, witness);
  }
  if (witness.depth == 0.0 && witness.separation < -2.0 * error) {
    prove_overlap(pair, error, witness);
  }
  return witness;
}

}  // namespace kairos::ccd
