#pragma once

#include "core/collision_mesh.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace kairos::ccd {

class MeshPair;

/// What a query cost.
struct MeshCost {
  std::int64_t box_tests = 0;
  std::int64_t triangle_tests = 0;
  std::int64_t exact_tests = 0;  ///< of these, what only whole numbers could decide
};

/// A triangle of each mesh, by their places in `triangles()`.
struct TrianglePair {
  std::uint32_t a = 0, b = 0;
  /// By the place of a, then of b.
  friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// Whether two meshes touch.
enum class MeshVerdict : std::uint8_t {
  apart,
  touching,  ///< a triangle of each has a point in common
  a_inside,  ///< the surfaces do not touch, but a part of a's is inside the solid b
  b_inside
};

/// Whether two meshes touch, and where.
struct MeshContact {
  MeshVerdict verdict = MeshVerdict::apart;
  TrianglePair pair;  ///< if they are touching
  MeshCost cost;
};

/// How far two meshes are apart.
struct MeshDistance {
  double lower = 0.0, upper = 0.0;  ///< the distance is between these, m; both 0: they touch
  MeshVerdict verdict = MeshVerdict::apart;
  TrianglePair pair;                                       ///< that `upper` is of
  Vector3 on_a = Vector3::Zero(), on_b = Vector3::Zero();  ///< at most `upper` apart, world, m
  MeshCost cost;
};

/// Whether two meshes are nearer than a tolerance; undecided: their distance is within rounding of
/// it.
enum class WithinVerdict : std::uint8_t { within, beyond, undecided };

/// Whether two meshes are nearer than a tolerance.
struct MeshWithin {
  WithinVerdict verdict = WithinVerdict::beyond;
  MeshDistance distance;  ///< as far as it took to decide
};

/// Two triangles whose distance is between these, m.
struct NearPair {
  TrianglePair pair;
  double lower = 0.0, upper = 0.0;
};

/// Questions about two posed meshes (those of RAPID [Gottschalk1996] and PQP [Larsen2000]). Keeps
/// memory from one question to the next: one per thread. What is exact is said in `MeshPair`.
class MeshQueries {
 public:
  /// Do they touch? Exact. Of surfaces: has a triangle of each a point in common; solids also touch
  /// where one is inside the other. Stops at the first pair.
  [[nodiscard]] MeshContact collide(const PosedMesh& a, const PosedMesh& b);
  /// All pairs of triangles that touch, ascending; exact. Valid until the next question.
  const std::vector<TrianglePair>& touching_pairs(const PosedMesh& a, const PosedMesh& b,
                                                  MeshCost* cost = nullptr);
  /// Their distance, proven from both sides: apart by 1e-12 of it and some roundings of the
  /// coordinates, unless the nearest triangles are so thin that no direction can be computed.
  [[nodiscard]] MeshDistance distance(const PosedMesh& a, const PosedMesh& b);
  /// Are they within `tolerance` (m, >= 0) of each other? Stops once that is proven. Undecided: the
  /// tolerance is between the bounds of the distance. 0 asks whether they touch: always decided.
  [[nodiscard]] MeshWithin within(const PosedMesh& a, const PosedMesh& b, double tolerance);
  /// All pairs of triangles that are not proven to be farther apart than `tolerance`, ascending;
  /// those with upper <= tolerance are proven to be within it. Exact for 0. Valid until the next
  /// question.
  const std::vector<NearPair>& pairs_within(const PosedMesh& a, const PosedMesh& b,
                                            double tolerance, MeshCost* cost = nullptr);

 private:
  struct Node {
    ObbChild a, b;
  };
  struct Key {
    double lower;
    Node node;
  };
  /// Of equals, too, one comes first: a heap of another library would take another.
  static bool later(const Key& x, const Key& y) {
    return std::tuple(x.lower, x.node.a, x.node.b) > std::tuple(y.lower, y.node.a, y.node.b);
  }
  /// Calls leaf(pair of triangles) for all that no box proves to be farther apart than `tolerance`,
  /// until it says true.
  template <typename Leaf>
  void descend(const MeshPair& pair, double tolerance, MeshCost& cost, const Leaf& leaf);
  /// Ends early once the distance is proven to be at most, or to be more than `tolerance`;
  /// negative: never, it is asked for itself.
  MeshDistance search(const MeshPair& pair, double tolerance);
  /// Looks at the two children: those not proven to be farther apart than `at_once` go on the
  /// stack, what is farther than `enough` is left.
  void open(const MeshPair& pair, const Key& key, double at_once, double enough,
            MeshDistance& best);
  void measure(const MeshPair& pair, TrianglePair triangles, double enough, MeshDistance& best);

  std::vector<Node> stack_;
  std::vector<Key> stack_of_keys_;
  std::vector<Key> heap_;
  std::vector<TrianglePair> touching_;
  std::vector<NearPair> near_;
};

}  // namespace kairos::ccd
