#include "ccd/mesh/point_in_solid.hpp"

#include "ccd/mesh/box_distance.hpp"
#include "ccd/mesh/exact_triangles.hpp"
#include "ccd/mesh/triangle_contact.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace kairos::ccd {
namespace {

/// A segment from a vertex of b to a point outside of a, in the frame of a.
class Ray {
 public:
  Ray(const MeshPair& pair, std::uint32_t vertex, const Vector3& outside, std::int64_t& exact)
      : pair_(pair),
        vertex_B_(pair.b().vertices()[vertex]),
        from_(pair.seen(vertex_B_)),
        to_(outside),
        exact_(exact) {}

  /// How often the surface goes round the point; nothing if the segment meets an edge.
  [[nodiscard]] std::optional<int> winding() const {
    int sum = 0;
    std::vector<ObbChild> todo{pair_.a().tree().root};
    while (!todo.empty()) {
      const ObbChild child = todo.back();
      todo.pop_back();
      if (child.is_triangle()) {
        const std::optional<int> crossing = crosses(child.index());
        if (!crossing) {
          return std::nullopt;
        }
        sum += *crossing;
        continue;
      }
      const ObbNode& node = pair_.a().tree().nodes[child.index()];
      if (!(box_distance(box_of(node), {from_, to_, to_}, pair_.error()) > 0.0)) {
        todo.insert(todo.end(), node.children.begin(), node.children.end());
      }
    }
    return sum;
  }

 private:
  /// 1 or -1 if the segment goes out or in through the triangle, 0 if it misses it.
  [[nodiscard]] std::optional<int> crosses(std::uint32_t triangle) const {
    const Corners t = pair_.corners_a(triangle);
    Vector3 least = from_.cwiseMin(to_);
    Vector3 greatest = from_.cwiseMax(to_);
    for (const Vector3& v : t) {
      least = least.cwiseMin(v);
      greatest = greatest.cwiseMax(v);
    }
    const double bound = orientation_error((greatest - least).maxCoeff(), pair_.error());
    const int start = float_orientation(t[0], t[1], t[2], from_, bound);
    const int end = float_orientation(t[0], t[1], t[2], to_, bound);
    if (start != 0 && start == end) {
      return 0;
    }
    const std::array<int, 3> side{float_orientation(from_, to_, t[0], t[1], bound),
                                  float_orientation(from_, to_, t[1], t[2], bound),
                                  float_orientation(from_, to_, t[2], t[0], bound)};
    const auto [low, high] = std::minmax_element(side.begin(), side.end());
    if (*low < 0 && *high > 0) {
      return 0;
    }
    if (start != 0 && end != 0 && *low == *high && *low != 0) {
      return end;
    }
    return exactly_crosses(t);
  }

  [[nodiscard]] std::optional<int> exactly_crosses(const Corners& corners) const {
    ++exact_;
    std::array<ExactPoint, 4> of_a;
    std::array<ExactPoint, 1> of_b;
    pair_.exact_points(std::array{corners[0], corners[1], corners[2], to_}, std::array{vertex_B_},
                       of_a, of_b);
    const int start = exact_orientation(of_a[0], of_a[1], of_a[2], of_b[0]);
    const int end = exact_orientation(of_a[0], of_a[1], of_a[2], of_a[3]);
    if (end == 0) {
      return std::nullopt;
    }
    if (start == 0 || start == end) {
      return 0;  // it begins in the plane, and not on the triangle; or stays on one side
    }
    std::array<int, 3> side{};
    for (std::size_t i = 0; i < 3; ++i) {
      side[i] = exact_orientation(of_b[0], of_a[3], of_a[i], of_a[(i + 1) % 3]);
    }
    const auto [low, high] = std::minmax_element(side.begin(), side.end());
    if (*low < 0 && *high > 0) {
      return 0;
    }
    return *low == 0 || *high == 0 ? std::nullopt : std::optional<int>(end);
  }

  const MeshPair& pair_;
  Vector3 vertex_B_, from_, to_;
  std::int64_t& exact_;
};

}  // namespace

bool vertex_in_solid(const MeshPair& pair, std::uint32_t vertex_b, std::int64_t& exact) {
  const ObbTree& tree = pair.a().tree();
  if (!tree.root.is_triangle()) {
    const Vector3 p = pair.seen(pair.b().vertices()[vertex_b]);
    if (box_distance(box_of(tree.nodes[tree.root.index()]), {p, p, p}, pair.error()) > 0.0) {
      return false;
    }
  }
  // A direction that meets an edge is one in 2^50: another one follows.
  for (std::uint64_t i = 0;; ++i) {
    const Vector3 outside = 4.0 * tree.reach * Random(i).direction();
    const std::optional<int> winding = Ray(pair, vertex_b, outside, exact).winding();
    if (winding) {
      return *winding != 0;
    }
  }
}

}  // namespace kairos::ccd
