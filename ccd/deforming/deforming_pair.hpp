#pragma once

#include "ccd/deforming/deforming_mesh.hpp"
#include "ccd/linear/linear_impact.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace kairos::ccd {

/// What of a meets what of b.
enum class MeetingKind : std::uint8_t { vertex_face, face_vertex, edge_edge };
inline constexpr std::array meeting_kind_names{"vertex-face", "face-vertex", "edge-edge"};

/// A vertex and a face, or two edges, that meet within the step.
struct Meeting {
  MeetingKind kind = MeetingKind::vertex_face;
  /// The feature of each: its place in `start()`, `triangles()` or `edges()` of its mesh.
  std::uint32_t a = 0, b = 0;
  LinearImpact impact;
};

/// Two meshes that deform, or one and itself: all vertices and faces, and all edges, that meet
/// within a step, each exactly (`vertex_face`, `edge_edge`: none missed, none invented). Two meshes
/// that are apart at the start of a step and do not meet are apart throughout it: triangles first
/// touch at a vertex and a face or at two edges. Solids inside one another do not meet.
///
/// Between steps it keeps the front of its search, the pairs of boxes at which the last one ended,
/// and begins there (temporal coherence [Li1998]); answers do not depend on it.
class DeformingPair {
 public:
  /// What the last question cost.
  struct Cost {
    std::int64_t box_tests = 0;
    std::int64_t triangle_pairs = 0;  ///< whose boxes did not tell them apart
    std::array<std::int64_t, 4>
        queries_by_stage{};  ///< by `LinearStage`: of vertices, faces, edges
  };
  /// How it asks.
  struct Options {
    double separation = 0.0;  ///< features meet at this distance; >= 0, in the unit of the meshes
    bool keeps_front = true;  ///< false: every search begins at the roots
  };

  /// The meshes must outlive this. Throws `InputError` for a separation that is not finite or
  /// negative.
  DeformingPair(const DeformingMesh& a, const DeformingMesh& b);
  DeformingPair(const DeformingMesh& a, const DeformingMesh& b, Options options);  ///< the same
  /// A mesh and itself; features that share a vertex are not asked about.
  explicit DeformingPair(const DeformingMesh& mesh);
  DeformingPair(const DeformingMesh& mesh, Options options);  ///< the same

  /// All that meet in the step that the meshes are in: by time, then by kind, a and b; of a mesh
  /// and itself no `face_vertex`, and a < b for edges. The first is the first impact. Valid until
  /// the next call.
  const std::vector<Meeting>& meetings();
  /// What the last `meetings` cost.
  [[nodiscard]] const Cost& cost() const { return cost_; }
  /// Pairs of boxes of the front, 8 bytes each.
  [[nodiscard]] std::size_t front_size() const { return front_.size(); }

 private:
  /// A node of each tree. Equal ones, of a mesh and itself: all pairs of triangles below the node.
  struct NodePair {
    std::uint32_t a = 0, b = 0;
    friend bool operator==(const NodePair&, const NodePair&) = default;
  };
  struct Entry {
    NodePair pair;
    bool may_rise = false;  ///< told apart as it came from the last step
  };

  [[nodiscard]] bool apart(NodePair pair);
  [[nodiscard]] bool is_leaf(NodePair pair) const;
  [[nodiscard]] std::size_t children(NodePair pair, std::array<NodePair, 3>& out) const;
  [[nodiscard]] NodePair parent(NodePair pair) const;
  void descend(NodePair from);
  void keep(NodePair pair, bool may_rise);
  void rise();
  void ask_triangles(std::uint32_t a, std::uint32_t b);
  void ask_face(MeetingKind kind, const DeformingMesh& of_vertex, std::uint32_t vertex,
                const DeformingMesh& of_face, std::uint32_t face);
  void ask_edges(std::uint32_t a, std::uint32_t b);
  void take(const Meeting& meeting);

  const DeformingMesh& a_;
  const DeformingMesh& b_;
  bool self_;
  Options options_;
  std::vector<NodePair> front_;
  std::int64_t builds_a_ = 0, builds_b_ = 0;  ///< of the trees that the front is of
  std::vector<Entry> next_;
  std::vector<NodePair> stack_;
  std::vector<Meeting> meetings_;
  Cost cost_;
};

}  // namespace kairos::ccd
