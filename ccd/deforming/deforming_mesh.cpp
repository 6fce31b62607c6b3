#include "ccd/deforming/deforming_mesh.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace kairos::ccd {
namespace {

constexpr double twice_as_bad = 2.0;

void check_finite(std::span<const Vector3> vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) {
      throw InputError("", 0, fmt::format("vertex {}", i),
                       "is not finite; allowed: finite numbers");
    }
  }
}

void check(const MeshData& mesh) {
  if (mesh.triangles.empty() || mesh.triangles.size() > most_triangles) {
    throw InputError(
        "", 0, "triangles",
        fmt::format("are {}; allowed: 1 to {}", mesh.triangles.size(), most_triangles));
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (corner >= mesh.vertices.size()) {
        throw InputError("", 0, fmt::format("triangle {}", i),
                         fmt::format("has a corner {}; allowed: 0 to {}", corner,
                                     static_cast<std::int64_t>(mesh.vertices.size()) - 1));
      }
    }
  }
  check_finite(mesh.vertices);
}

MeshEdge edge_of(const Triangle& triangle, std::size_t k) {
  const std::uint32_t a = triangle[k];
  const std::uint32_t b = triangle[(k + 1) % 3];
  return {std::min(a, b), std::max(a, b)};
}

/// Half the surface of the box at the end of the step, of numbers divided by `unit`, which lets
/// nothing overflow.
double half_area(const DeformingNode& node, double unit) {
  std::array<double, 3> size{};
  for (std::size_t k = 0; k < 3; ++k) {
    size[k] = node.upper[1][k] / unit - node.lower[1][k] / unit;
  }
  return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

}  // namespace

DeformingMesh::DeformingMesh(MeshData mesh) {
  check(mesh);
  start_ = std::move(mesh.vertices);
  end_ = start_;
  triangles_ = std::move(mesh.triangles);
  own_features();
  build_tree();
}

void DeformingMesh::move_to(std::span<const Vector3> vertices) {
  if (vertices.size() != end_.size()) {
    throw InputError(
        "", 0, "vertices",
        fmt::format("are {}; allowed: {}, as many as the mesh has", vertices.size(), end_.size()));
  }
  check_finite(vertices);
  start_.swap(end_);
  std::copy(vertices.begin(), vertices.end(), end_.begin());
  refit();
  if (badness() > twice_as_bad * badness_when_built_) {
    build_tree();
  }
}

void DeformingMesh::own_features() {
  edges_.reserve(triangles_.size() * 3);
  for (const Triangle& triangle : triangles_) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges_.push_back(edge_of(triangle, k));
    }
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  edges_.shrink_to_fit();

  owned_.resize(triangles_.size());
  std::vector<bool> has_owner(start_.size());
  std::vector<bool> edge_has_owner(edges_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    OwnedFeatures& own = owned_[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = triangles_[i][k];
      if (!has_owner[vertex]) {
        has_owner[vertex] = true;
        own.vertices[own.vertex_count++] = vertex;
      }
      const auto at = std::lower_bound(edges_.begin(), edges_.end(), edge_of(triangles_[i], k));
      const auto edge = static_cast<std::size_t>(at - edges_.begin());
      if (!edge_has_owner[edge]) {
        edge_has_owner[edge] = true;
        own.edges[own.edge_count++] = static_cast<std::uint32_t>(edge);
      }
    }
  }
}

/// Cut at the median of the middles across the axis along which these are spread most.
void DeformingMesh::build_tree() {
  const auto count = static_cast<std::uint32_t>(triangles_.size());
  std::vector<Vector3> middles(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Triangle& t = triangles_[i];
    middles[i] = end_[t[0]] / 3.0 + end_[t[1]] / 3.0 + end_[t[2]] / 3.0;
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  nodes_.assign(2 * std::size_t{count} - 1, {});
  triangle_of_.assign(nodes_.size(), 0);

  struct Task {
    std::uint32_t node, parent, first, leaves;
  };
  std::vector<Task> tasks{{0, 0, 0, count}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    nodes_[task.node].leaves = task.leaves;
    nodes_[task.node].parent = task.parent;
    if (task.leaves == 1) {
      triangle_of_[task.node] = order[task.first];
      continue;
    }
    const auto first = order.begin() + task.first;
    const auto last = first + task.leaves;
    Vector3 lower = middles[*first];
    Vector3 upper = lower;
    for (auto i = first; i != last; ++i) {
      lower = lower.cwiseMin(middles[*i]);
      upper = upper.cwiseMax(middles[*i]);
    }
    Eigen::Index axis = 0;
    (upper / 2.0 - lower / 2.0).maxCoeff(&axis);
    const std::uint32_t half = task.leaves / 2;
    std::nth_element(first, first + half, last, [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(middles[a][axis], a) < std::pair(middles[b][axis], b);
    });
    tasks.push_back({task.node + 1, task.node, task.first, half});
    tasks.push_back({task.node + 2 * half, task.node, task.first + half, task.leaves - half});
  }
  refit();
  badness_when_built_ = badness();
  ++builds_;
}

void DeformingMesh::refit() {
  for (std::size_t i = nodes_.size(); i-- > 0;) {  // children come after their parents
    DeformingNode& node = nodes_[i];
    if (node.leaves == 1) {
      const Triangle& t = triangles_[triangle_of_[i]];
      for (std::size_t at = 0; at < 2; ++at) {
        const std::vector<Vector3>& p = at == 0 ? start_ : end_;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto axis = static_cast<Eigen::Index>(k);
          const auto [low, high] = std::minmax({p[t[0]][axis], p[t[1]][axis], p[t[2]][axis]});
          node.lower[at][k] = low;
          node.upper[at][k] = high;
        }
      }
      continue;
    }
    const DeformingNode& first = nodes_[i + 1];
    const DeformingNode& second = nodes_[i + 2 * first.leaves];
    for (std::size_t at = 0; at < 2; ++at) {
      for (std::size_t k = 0; k < 3; ++k) {
        node.lower[at][k] = std::min(first.lower[at][k], second.lower[at][k]);
        node.upper[at][k] = std::max(first.upper[at][k], second.upper[at][k]);
      }
    }
  }
}

double DeformingMesh::badness() const {
  const DeformingNode& root = nodes_.front();
  double unit = std::numeric_limits<double>::min();
  for (std::size_t k = 0; k < 3; ++k) {
    unit = std::max({unit, std::abs(root.lower[1][k]), std::abs(root.upper[1][k])});
  }
  double sum = 0.0;
  for (const DeformingNode& node : nodes_) {
    sum += half_area(node, unit);
  }
  const double whole = half_area(root, unit);
  return whole > 0.0 ? sum / whole : 1.0;
}

}  // namespace kairos::ccd
