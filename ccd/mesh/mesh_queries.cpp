#include "ccd/mesh/mesh_queries.hpp"

#include "ccd/mesh/box_distance.hpp"
#include "ccd/mesh/mesh_pair.hpp"
#include "ccd/mesh/point_in_solid.hpp"
#include "ccd/mesh/triangle_contact.hpp"
#include "ccd/mesh/triangle_distance.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

const ObbNode& node_a(const MeshPair& pair, ObbChild child) {
  return pair.a().tree().nodes[child.index()];
}
const ObbNode& node_b(const MeshPair& pair, ObbChild child) {
  return pair.b().tree().nodes[child.index()];
}

/// Less than the distance of what is in two boxes, one of which may be a triangle.
double proven_distance(const MeshPair& pair, ObbChild a, ObbChild b, double enough) {
  if (a.is_triangle()) {
    return box_distance(pair.box_b(node_b(pair, b)), pair.corners_a(a.index()), pair.error());
  }
  const ObbBox box = box_of(node_a(pair, a));
  return b.is_triangle() ? box_distance(box, pair.corners_b(b.index()), pair.error())
                         : box_distance(box, pair.box_b(node_b(pair, b)), pair.error(), enough);
}

float size_of(const ObbNode& node) {
  return node.half_extents[0] + node.half_extents[1] + node.half_extents[2];
}
/// The larger of two boxes is opened.
bool opens_a(const MeshPair& pair, ObbChild a, ObbChild b) {
  return b.is_triangle() ||
         (!a.is_triangle() && size_of(node_a(pair, a)) > size_of(node_b(pair, b)));
}

/// Whether a part of the surface of b is inside the solid a.
bool has_part_inside(const PosedMesh& a, const PosedMesh& b, MeshCost& cost) {
  if (!a.mesh.solid()) {
    return false;
  }
  const MeshPair pair(a, b);
  if (!b.mesh.solid()) {
    return vertex_in_solid(pair, b.mesh.triangles().front().front(), cost.exact_tests);
  }
  const auto& parts = b.mesh.part_vertices();
  return std::any_of(parts.begin(), parts.end(), [&](std::uint32_t vertex) {
    return vertex_in_solid(pair, vertex, cost.exact_tests);
  });
}

/// Of meshes whose surfaces do not touch.
MeshVerdict inside_verdict(const PosedMesh& a, const PosedMesh& b, MeshCost& cost) {
  if (has_part_inside(a, b, cost)) {
    return MeshVerdict::b_inside;
  }
  return has_part_inside(b, a, cost) ? MeshVerdict::a_inside : MeshVerdict::apart;
}

MeshDistance in_world(MeshDistance distance, const Pose& pose) {
  distance.on_a = pose.to_world(distance.on_a);
  distance.on_b = pose.to_world(distance.on_b);
  return distance;
}

}  // namespace

template <typename Leaf>
void MeshQueries::descend(const MeshPair& pair, double tolerance, MeshCost& cost,
                          const Leaf& leaf) {
  stack_.clear();
  stack_.push_back({pair.a().tree().root, pair.b().tree().root});
  while (!stack_.empty()) {
    const auto [a, b] = stack_.back();
    stack_.pop_back();
    if (a.is_triangle() && b.is_triangle()) {
      ++cost.triangle_tests;
      if (leaf(TrianglePair{a.index(), b.index()})) {
        return;
      }
      continue;
    }
    ++cost.box_tests;
    if (proven_distance(pair, a, b, tolerance) > tolerance) {
      continue;
    }
    if (opens_a(pair, a, b)) {
      for (const ObbChild child : node_a(pair, a).children) {
        stack_.push_back({child, b});
      }
    } else {
      for (const ObbChild child : node_b(pair, b).children) {
        stack_.push_back({a, child});
      }
    }
  }
}

MeshContact MeshQueries::collide(const PosedMesh& a, const PosedMesh& b) {
  MeshContact contact;
  const MeshPair pair(a, b);
  descend(pair, 0.0, contact.cost, [&](TrianglePair triangles) {
    if (!triangles_touch(pair, triangles.a, triangles.b, contact.cost.exact_tests)) {
      return false;
    }
    contact.verdict = MeshVerdict::touching;
    contact.pair = triangles;
    return true;
  });
  if (contact.verdict == MeshVerdict::apart) {
    contact.verdict = inside_verdict(a, b, contact.cost);
  }
  return contact;
}

const std::vector<TrianglePair>& MeshQueries::touching_pairs(const PosedMesh& a, const PosedMesh& b,
                                                             MeshCost* cost) {
  MeshCost own;
  MeshCost& spent = cost == nullptr ? own : *cost;
  touching_.clear();
  const MeshPair pair(a, b);
  descend(pair, 0.0, spent, [&](TrianglePair triangles) {
    if (triangles_touch(pair, triangles.a, triangles.b, spent.exact_tests)) {
      touching_.push_back(triangles);
    }
    return false;
  });
  std::sort(touching_.begin(), touching_.end());
  return touching_;
}

void MeshQueries::measure(const MeshPair& pair, TrianglePair triangles, double enough,
                          MeshDistance& best) {
  const Corners a = pair.corners_a(triangles.a);
  const Corners b = pair.corners_b(triangles.b);
  const double quick = quick_triangle_distance(a, b, pair.error());
  if (quick >= best.upper || quick > enough) {
    best.lower = std::min(best.lower, quick);
    return;
  }
  ++best.cost.triangle_tests;
  TriangleDistance found = triangle_distance(a, b, pair.error());
  if (!(found.lower > 0.0) &&
      triangles_touch(pair, triangles.a, triangles.b, best.cost.exact_tests)) {
    best.verdict = MeshVerdict::touching;
    found.lower = found.upper = 0.0;
    found.on_a = found.on_b = common_point(a, b);
  }
  best.lower = std::min(best.lower, found.lower);
  if (found.upper < best.upper) {
    best.upper = found.upper;
    best.pair = triangles;
    best.on_a = found.on_a;
    best.on_b = found.on_b;
  }
}

void MeshQueries::open(const MeshPair& pair, const Key& key, double at_once, double enough,
                       MeshDistance& best) {
  const bool first = opens_a(pair, key.node.a, key.node.b);
  const std::size_t before = stack_of_keys_.size();
  for (const ObbChild child :
       first ? node_a(pair, key.node.a).children : node_b(pair, key.node.b).children) {
    const Node node = first ? Node{child, key.node.b} : Node{key.node.a, child};
    if (node.a.is_triangle() && node.b.is_triangle()) {
      measure(pair, {node.a.index(), node.b.index()}, enough, best);
      if (best.verdict == MeshVerdict::touching) {
        return;
      }
      continue;
    }
    ++best.cost.box_tests;
    const double lower =
        std::max(key.lower, proven_distance(pair, node.a, node.b, std::min(enough, best.upper)));
    if (lower >= best.upper || lower > enough) {
      best.lower = std::min(best.lower, lower);
    } else if (lower <= at_once) {
      stack_of_keys_.push_back({lower, node});
    } else {
      heap_.push_back({lower, node});
      std::push_heap(heap_.begin(), heap_.end(), later);
    }
  }
  if (stack_of_keys_.size() == before + 2 &&
      stack_of_keys_[before].lower < stack_of_keys_[before + 1].lower) {
    std::swap(stack_of_keys_[before], stack_of_keys_[before + 1]);  // the nearer one comes first
  }
}

/// What no proof tells to be farther apart than 0, or than what is asked, must be opened whatever
/// else is: that is done depth first, so that what touches is soon found. The rest, best first.
MeshDistance MeshQueries::search(const MeshPair& pair, double tolerance) {
  constexpr double accuracy = 1e-12;  // of the distance: what is not worth another test
  const double roundoff = 64.0 * pair.error();
  const bool asked_within = tolerance >= 0.0;
  const double at_once = asked_within ? tolerance : 0.0;
  const double enough = asked_within ? tolerance : infinity;
  MeshDistance best;
  best.lower = best.upper = infinity;
  const Node roots{pair.a().tree().root, pair.b().tree().root};
  heap_.clear();
  stack_of_keys_.clear();
  if (roots.a.is_triangle() && roots.b.is_triangle()) {
    measure(pair, {roots.a.index(), roots.b.index()}, enough, best);
  } else {
    stack_of_keys_.push_back({0.0, roots});
  }
  while (best.verdict != MeshVerdict::touching && best.upper > tolerance) {
    if (!stack_of_keys_.empty()) {
      const Key key = stack_of_keys_.back();
      stack_of_keys_.pop_back();
      open(pair, key, at_once, enough, best);
      continue;
    }
    // What is left is farther than this: near enough to the bounds.
    if (heap_.empty() || heap_.front().lower >= (1.0 - accuracy) * best.upper - roundoff) {
      break;
    }
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const Key key = heap_.back();
    heap_.pop_back();
    open(pair, key, at_once, enough, best);
  }
  if (best.verdict != MeshVerdict::touching) {
    for (const Key& key : stack_of_keys_) {
      best.lower = std::min(best.lower, key.lower);
    }
    best.lower = std::min(best.lower, heap_.empty() ? infinity : heap_.front().lower);
  }
  return best;
}

MeshDistance MeshQueries::distance(const PosedMesh& a, const PosedMesh& b) {
  constexpr double never = -1.0;
  const MeshPair pair(a, b);
  MeshDistance best = in_world(search(pair, never), pair.pose());
  if (best.verdict == MeshVerdict::apart) {
    best.verdict = inside_verdict(a, b, best.cost);
    if (best.verdict != MeshVerdict::apart) {
      best.lower = best.upper = 0.0;
    }
  }
  return best;
}

MeshWithin MeshQueries::within(const PosedMesh& a, const PosedMesh& b, double tolerance) {
  const MeshPair pair(a, b);
  MeshWithin result;
  result.distance = in_world(search(pair, tolerance), pair.pose());
  MeshDistance& found = result.distance;
  if (found.verdict == MeshVerdict::apart && !(found.upper <= tolerance)) {
    found.verdict = inside_verdict(a, b, found.cost);
    if (found.verdict != MeshVerdict::apart) {
      found.lower = found.upper = 0.0;
    }
  }
  if (found.upper <= tolerance) {
    result.verdict = WithinVerdict::within;
  } else if (found.lower > tolerance || tolerance == 0.0) {
    // With a tolerance of 0 every pair that might touch was decided exactly.
    result.verdict = WithinVerdict::beyond;
  } else {
    result.verdict = WithinVerdict::undecided;
  }
  return result;
}

const std::vector<NearPair>& MeshQueries::pairs_within(const PosedMesh& a, const PosedMesh& b,
                                                       double tolerance, MeshCost* cost) {
  MeshCost own;
  MeshCost& spent = cost == nullptr ? own : *cost;
  near_.clear();
  const MeshPair pair(a, b);
  descend(pair, tolerance, spent, [&](TrianglePair triangles) {
    const Corners of_a = pair.corners_a(triangles.a);
    const Corners of_b = pair.corners_b(triangles.b);
    if (quick_triangle_distance(of_a, of_b, pair.error()) > tolerance) {
      return false;
    }
    const TriangleDistance found = triangle_distance(of_a, of_b, pair.error());
    if (found.lower > tolerance) {
      return false;
    }
    if (!(found.lower > 0.0)) {
      if (triangles_touch(pair, triangles.a, triangles.b, spent.exact_tests)) {
        near_.push_back({triangles, 0.0, 0.0});
        return false;
      }
      if (tolerance == 0.0) {
        return false;
      }
    }
    near_.push_back({triangles, found.lower, found.upper});
    return false;
  });
  std::sort(near_.begin(), near_.end(),
            [](const NearPair& x, const NearPair& y) { return x.pair < y.pair; });
  return near_;
}

}  // namespace kairos::ccd
