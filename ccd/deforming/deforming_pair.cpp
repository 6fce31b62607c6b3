#include "ccd/deforming/deforming_pair.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kairos::ccd {
namespace {

/// Whether on one axis all of a node is beyond all of the other by more than the separation, at the
/// start and at the end of the step: then, as every difference of coordinates is linear in time,
/// throughout it (ccd/README.md, eq. 6). A difference that rounds to more than the separation is
/// more.
bool boxes_apart(const DeformingNode& a, const DeformingNode& b, double separation) {
  for (std::size_t k = 0; k < 3; ++k) {
    if ((a.lower[0][k] - b.upper[0][k] > separation &&
         a.lower[1][k] - b.upper[1][k] > separation) ||
        (b.lower[0][k] - a.upper[0][k] > separation &&
         b.lower[1][k] - a.upper[1][k] > separation)) {
      return true;
    }
  }
  return false;
}

bool has(const Triangle& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

void check(double separation) {
  if (!(separation >= 0.0 && std::isfinite(separation))) {
    throw InputError("", 0, "separation",
                     fmt::format("is {}; allowed: a finite number >= 0", separation));
  }
}

}  // namespace

DeformingPair::DeformingPair(const DeformingMesh& a, const DeformingMesh& b)
    : DeformingPair(a, b, Options()) {}

DeformingPair::DeformingPair(const DeformingMesh& a, const DeformingMesh& b, Options options)
    : a_(a), b_(b), self_(&a == &b), options_(options) {
  check(options.separation);
}

DeformingPair::DeformingPair(const DeformingMesh& mesh) : DeformingPair(mesh, mesh) {}

DeformingPair::DeformingPair(const DeformingMesh& mesh, Options options)
    : DeformingPair(mesh, mesh, options) {}

bool DeformingPair::is_leaf(NodePair pair) const {
  return a_.nodes()[pair.a].leaves == 1 && b_.nodes()[pair.b].leaves == 1;
}

bool DeformingPair::apart(NodePair pair) {
  if (self_ && pair.a == pair.b) {
    return false;
  }
  ++cost_.box_tests;
  return boxes_apart(a_.nodes()[pair.a], b_.nodes()[pair.b], options_.separation);
}

/// The node with more triangles is opened, the first of equals: so the way from the roots to a pair
/// is given by the two trees alone, and `parent` can go back on it.
std::size_t DeformingPair::children(NodePair pair, std::array<NodePair, 3>& out) const {
  const auto [a, b] = pair;
  if (self_ && a == b) {
    const std::uint32_t second = a_.second_child(a);
    out = {NodePair{a + 1, a + 1}, NodePair{a + 1, second}, NodePair{second, second}};
    return 3;
  }
  if (a_.nodes()[a].leaves >= b_.nodes()[b].leaves) {
    out = {NodePair{a + 1, b}, NodePair{a_.second_child(a), b}};
  } else {
    out = {NodePair{a, b + 1}, NodePair{a, b_.second_child(b)}};
  }
  return 2;
}

/// The last node opened on the way to a pair is the one of the two parents that has fewer
/// triangles, or the second of equals. The root has no parent: its own number.
DeformingPair::NodePair DeformingPair::parent(NodePair pair) const {
  const std::uint32_t a = a_.nodes()[pair.a].parent;
  const std::uint32_t b = b_.nodes()[pair.b].parent;
  if (self_ && a == b) {
    return {a, a};
  }
  const bool a_is_root = pair.a == 0;
  const bool b_is_root = pair.b == 0;
  if (!b_is_root && (a_is_root || a_.nodes()[a].leaves >= b_.nodes()[b].leaves)) {
    return {pair.a, b};
  }
  return {a, pair.b};
}

void DeformingPair::keep(NodePair pair, bool may_rise) {
  if (options_.keeps_front) {
    next_.push_back({pair, may_rise});
    rise();
  }
}

/// Where all children of a pair ended the search, apart, and the pair is apart as well, it takes
/// their place. Entries lie in the order of the descent: siblings are neighbours.
void DeformingPair::rise() {
  std::array<NodePair, 3> siblings;
  while (next_.back().may_rise && next_.back().pair != NodePair{}) {
    const NodePair above = parent(next_.back().pair);
    const std::size_t count = children(above, siblings);
    if (above.a == above.b && self_) {
      return;  // never apart from itself
    }
    if (next_.size() < count) {
      return;
    }
    for (std::size_t k = 0; k < count; ++k) {
      const Entry& entry = next_[next_.size() - count + k];
      if (!entry.may_rise || entry.pair != siblings[k]) {
        return;
      }
    }
    if (!apart(above)) {
      return;
    }
    next_.resize(next_.size() - count);
    next_.push_back({above, true});
  }
}

void DeformingPair::descend(NodePair from) {
  std::array<NodePair, 3> below;
  stack_.assign(1, from);
  while (!stack_.empty()) {
    const NodePair pair = stack_.back();
    stack_.pop_back();
    if (apart(pair)) {
      keep(pair, pair == from);
    } else if (is_leaf(pair)) {
      if (!(self_ && pair.a == pair.b)) {
        ask_triangles(a_.triangle_of(pair.a), b_.triangle_of(pair.b));
      }
      keep(pair, false);
    } else {
      for (std::size_t k = children(pair, below); k-- > 0;) {
        stack_.push_back(below[k]);
      }
    }
  }
}

const std::vector<Meeting>& DeformingPair::meetings() {
  meetings_.clear();
  cost_ = {};
  const bool same_trees = builds_a_ == a_.builds() && builds_b_ == b_.builds();
  if (!same_trees || front_.empty()) {
    front_.assign(1, NodePair{});
    builds_a_ = a_.builds();
    builds_b_ = b_.builds();
  }
  next_.clear();
  for (const NodePair pair : front_) {
    descend(pair);
  }
  front_.resize(next_.size());
  std::transform(next_.begin(), next_.end(), front_.begin(),
                 [](const Entry& entry) { return entry.pair; });
  const auto order = [](const Meeting& m) {
    return std::tuple(m.impact.t_lo, m.impact.t_hi, m.kind, m.a, m.b);
  };
  std::sort(meetings_.begin(), meetings_.end(),
            [&](const Meeting& x, const Meeting& y) { return order(x) < order(y); });
  return meetings_;
}

void DeformingPair::ask_triangles(std::uint32_t a, std::uint32_t b) {
  ++cost_.triangle_pairs;
  const OwnedFeatures& of_a = a_.owned(a);
  const OwnedFeatures& of_b = b_.owned(b);
  for (std::size_t i = 0; i < of_a.vertex_count; ++i) {
    ask_face(MeetingKind::vertex_face, a_, of_a.vertices[i], b_, b);
  }
  for (std::size_t i = 0; i < of_b.vertex_count; ++i) {
    ask_face(self_ ? MeetingKind::vertex_face : MeetingKind::face_vertex, b_, of_b.vertices[i], a_,
             a);
  }
  for (std::size_t i = 0; i < of_a.edge_count; ++i) {
    for (std::size_t j = 0; j < of_b.edge_count; ++j) {
      ask_edges(of_a.edges[i], of_b.edges[j]);
    }
  }
}

void DeformingPair::ask_face(MeetingKind kind, const DeformingMesh& of_vertex, std::uint32_t vertex,
                             const DeformingMesh& of_face, std::uint32_t face) {
  const Triangle& t = of_face.triangles()[face];
  if (self_ && has(t, vertex)) {
    return;
  }
  const auto points = [&](const std::vector<Vector3>& p, const std::vector<Vector3>& q) {
    return FourPoints{p[vertex], q[t[0]], q[t[1]], q[t[2]]};
  };
  const LinearImpact impact =
      vertex_face(points(of_vertex.start(), of_face.start()),
                  points(of_vertex.end(), of_face.end()), {.separation = options_.separation});
  const bool vertex_is_a = kind == MeetingKind::vertex_face;
  take({kind, vertex_is_a ? vertex : face, vertex_is_a ? face : vertex, impact});
}

void DeformingPair::ask_edges(std::uint32_t a, std::uint32_t b) {
  const MeshEdge& e = a_.edges()[a];
  const MeshEdge& f = b_.edges()[b];
  if (self_ && (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1])) {
    return;
  }
  const auto points = [&](const std::vector<Vector3>& p, const std::vector<Vector3>& q) {
    return FourPoints{p[e[0]], p[e[1]], q[f[0]], q[f[1]]};
  };
  const LinearImpact impact = edge_edge(points(a_.start(), b_.start()), points(a_.end(), b_.end()),
                                        {.separation = options_.separation});
  const bool turned = self_ && b < a;
  take({MeetingKind::edge_edge, turned ? b : a, turned ? a : b, impact});
}

void DeformingPair::take(const Meeting& meeting) {
  ++cost_.queries_by_stage[static_cast<std::size_t>(meeting.impact.stage)];
  if (meeting.impact.hit) {
    meetings_.push_back(meeting);
  }
}

}  // namespace kairos::ccd
