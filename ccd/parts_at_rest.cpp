#include "ccd/parts_at_rest.hpp"

#include "ccd/core_patch.hpp"
#include "ccd/core_witness.hpp"
#include "ccd/gjk.hpp"
#include "ccd/mesh/mesh_queries.hpp"
#include "ccd/mesh/point_in_solid.hpp"
#include "ccd/rounding/rotation_matrix.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <tuple>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;
/// How near below the distance a separation of two parts or boxes is sought, as a part of it.
constexpr double precision = 1e-14;
constexpr double box_precision = 0.3;
/// Parts that overlap along a normal by more, as a part of the size, touch elsewhere.
constexpr double beside = 1e-9;

/// Points that are outlined at once.
constexpr std::size_t most_outlined = 64;

/// Where two parts touch: halfway between both, and how far apart they are along the normal.
struct TouchingPoint {
  Vector3 position;  ///< from the origin of a, world axes, m
  double gap;
};

struct NearestParts {
  double gap = infinity;
  Vector3 n = Vector3::UnitY();
  ObbChild a, b;
};

/// Two bodies that are bounded.
class Pair {
 public:
  Pair(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b)
      : a_(a),
        b_(b),
        R_WA_(rotation_matrix(pose_a.orientation)),
        R_WB_(rotation_matrix(pose_b.orientation)),
        d_(pose_b.position - pose_a.position),
        size_(a_.whole().radius() + b_.whole().radius()),
        error_(24.0 * u * (d_.lpNorm<1>() + 3.5 * (a_.whole().extent() + b_.whole().extent()))) {}

  /// The least gap of all pairs of parts; stops at one that is at most `enough`.
  NearestParts nearest(double enough) {
    NearestParts best;
    heap_.clear();
    each_root([&](ObbChild a, ObbChild b) { look(a, b, best); });
    while (!heap_.empty() && heap_.front().lower < best.gap && best.gap > enough) {
      std::pop_heap(heap_.begin(), heap_.end(), later);
      const Key key = heap_.back();
      heap_.pop_back();
      open(key.a, key.b, [&](ObbChild a, ObbChild b) { look(a, b, best); });
    }
    return best;
  }

  /// Points of all parts whose gap is at most `most` and along n no less than `gap`.
  std::vector<TouchingPoint> points(const Vector3& n, double gap, double most) {
    std::vector<TouchingPoint> found;
    heap_.clear();
    const auto visit = [&](ObbChild a, ObbChild b) {
      PlacedCore memory_a, memory_b;
      const ConvexCore core_a = a_.core(a, memory_a);
      const ConvexCore core_b = b_.core(b, memory_b);
      const CorePair pair{core_a, core_b, R_WA_, R_WB_, d_};
      const double reach = core_a.rounding() + core_b.rounding();
      if (!(pair.separation(n) - reach <= most)) {
        return;
      }
      if (!is_part(a, b)) {
        if (gjk(pair, n, box_precision).lower - reach <= most) {
          heap_.push_back({0.0, a, b});
        }
        return;
      }
      if (pair.separation(n) - reach >= gap - beside * size_ &&
          core_witness(pair, reach, precision, error_).separation - reach <= most) {
        add(pair, n, reach, most, found);
      }
    };
    each_root(visit);
    while (!heap_.empty()) {
      const Key key = heap_.back();
      heap_.pop_back();
      open(key.a, key.b, visit);
    }
    return found;
  }

  /// Whether n is across a face of either of two parts.
  [[nodiscard]] CorePatch patch(const NearestParts& at) const {
    PlacedCore memory_a, memory_b;
    const ConvexCore core_a = a_.core(at.a, memory_a);
    const ConvexCore core_b = b_.core(at.b, memory_b);
    return core_patch({core_a, core_b, R_WA_, R_WB_, d_}, at.n);
  }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] double error() const { return error_; }

 private:
  struct Key {
    double lower;
    ObbChild a, b;
  };
  /// Equal keys have an order, too: otherwise the heap of another library could take another.
  static bool later(const Key& x, const Key& y) {
    return std::tuple(x.lower, x.a, x.b) > std::tuple(y.lower, y.a, y.b);
  }
  static bool is_part(ObbChild a, ObbChild b) { return a.is_triangle() && b.is_triangle(); }

  template <typename Visit>
  void each_root(const Visit& visit) const {
    a_.each_root([&](ObbChild a) { b_.each_root([&](ObbChild b) { visit(a, b); }); });
  }
  template <typename Visit>
  void open(ObbChild a, ObbChild b, const Visit& visit) const {
    const bool first = b.is_triangle() || (!a.is_triangle() && a_.size(a) > b_.size(b));
    for (const ObbChild child : first ? a_.children(a) : b_.children(b)) {
      first ? visit(child, b) : visit(a, child);
    }
  }

  void look(ObbChild a, ObbChild b, NearestParts& best) {
    PlacedCore memory_a, memory_b;
    const ConvexCore core_a = a_.core(a, memory_a);
    const ConvexCore core_b = b_.core(b, memory_b);
    const CorePair pair{core_a, core_b, R_WA_, R_WB_, d_};
    const double reach = core_a.rounding() + core_b.rounding();
    if (!is_part(a, b)) {
      // Along any direction parts are no nearer than the boxes around them.
      const Vector3 between = d_.isZero(0.0) ? Vector3(Vector3::UnitY()) : Vector3(d_.normalized());
      const double lower = gjk(pair, between, box_precision).lower - reach;
      if (lower < best.gap) {
        heap_.push_back({lower, a, b});
        std::push_heap(heap_.begin(), heap_.end(), later);
      }
      return;
    }
    const CoreWitness witness = core_witness(pair, reach, precision, error_);
    if (witness.separation - reach < best.gap) {
      best = {witness.separation - reach, witness.n, a, b};
    }
  }

  void add(const CorePair& pair, const Vector3& n, double reach, double most,
           std::vector<TouchingPoint>& found) const {
    const double least = pair.separation(n) - reach;
    const CorePatch patch = core_patch(pair, n, std::max(0.0, most - least));
    for (int i = 0; i < patch.points.size; ++i) {
      const double gap = patch.gaps[static_cast<std::size_t>(i)] - reach;
      if (gap <= most) {
        found.push_back({patch.points[i] + n * (pair.a.rounding() + 0.5 * gap), gap});
      }
    }
  }

  BodyParts a_, b_;
  Matrix3 R_WA_, R_WB_;
  Vector3 d_;
  double size_;
  double error_;
  std::vector<Key> heap_;
};

/// A body with parts above a half-space.
class OverPlane {
 public:
  OverPlane(const Shape& shape, const Pose& pose, const Shape& plane, const Pose& pose_h)
      : parts_(shape, BodyParts::Against::plane),
        pose_(pose),
        up_(half_space_normal(std::get<HalfSpace>(plane), pose_h)),
        down_B_(-(pose.orientation.conjugate() * up_)),
        height_(up_.dot(pose.position - pose_h.position)) {}

  [[nodiscard]] const Vector3& up() const { return up_; }
  [[nodiscard]] double gap() const {
    double least = infinity;
    each([&](const ConvexCore& core) { least = std::min(least, gap_of(core)); });
    return least;
  }
  [[nodiscard]] std::vector<TouchingPoint> points(double most) const {
    std::vector<TouchingPoint> found;
    each([&](const ConvexCore& core) {
      const double least = gap_of(core);
      if (!(least <= most)) {
        return;
      }
      const FacePolygon face = highest_face(core, down_B_, most - least);
      for (int i = 0; i < face.size; ++i) {
        const double gap = height_ - down_B_.dot(face[i]) - core.rounding();
        found.push_back({pose_.orientation * face[i] - up_ * (core.rounding() + 0.5 * gap), gap});
      }
    });
    return found;
  }
  [[nodiscard]] double size() const { return parts_.whole().radius(); }

 private:
  [[nodiscard]] double gap_of(const ConvexCore& core) const {
    return height_ - core.support(down_B_) - core.rounding();
  }
  template <typename Visit>
  void each(const Visit& visit) const {
    parts_.each_root([&](ObbChild child) {
      PlacedCore memory;
      visit(parts_.core(child, memory));
    });
  }

  BodyParts parts_;
  const Pose& pose_;
  Vector3 up_, down_B_;
  double height_;
};

bool on_plane(const Shape& b) { return std::holds_alternative<HalfSpace>(b); }

/// The corners of the outline of points seen along n, with their gaps.
std::vector<TouchingPoint> outline(const std::vector<TouchingPoint>& points, const Vector3& n,
                                   double size) {
  std::vector<Vector3> some;
  const auto reduce = [&] {
    const FacePolygon polygon = outline_of(some, n, size);
    some.clear();
    for (int i = 0; i < polygon.size; ++i) {
      some.push_back(polygon[i]);
    }
  };
  for (const TouchingPoint& point : points) {
    some.push_back(point.position);
    if (some.size() == most_outlined) {
      reduce();
    }
  }
  reduce();
  std::vector<TouchingPoint> corners;
  for (const Vector3& x : some) {
    const auto at = std::find_if(points.begin(), points.end(),
                                 [&](const TouchingPoint& point) { return point.position == x; });
    corners.push_back(*at);
  }
  return corners;
}

Vector3 middle(const std::vector<TouchingPoint>& corners) {
  FacePolygon polygon;
  for (const TouchingPoint& corner : corners) {
    polygon.add(corner.position);
  }
  return polygon.centroid();
}

/// Tests a point of each connected part of a body.
bool has_point_inside(const Shape& solid, const Pose& pose_s, const Shape& other,
                      const Pose& pose_o) {
  const auto* mesh = std::get_if<Mesh>(&solid);
  if (mesh == nullptr || !mesh->body->mesh.solid()) {
    return false;
  }
  std::int64_t exact = 0;
  if (const auto* inner = std::get_if<Mesh>(&other)) {
    const MeshPair pair({mesh->body->mesh, pose_s}, {inner->body->mesh, pose_o});
    const auto& parts = inner->body->mesh.part_vertices();
    if (parts.empty()) {  // a surface
      return vertex_in_solid(pair, inner->body->mesh.triangles().front().front(), exact);
    }
    return std::any_of(parts.begin(), parts.end(),
                       [&](std::uint32_t v) { return vertex_in_solid(pair, v, exact); });
  }
  const BodyParts parts(other);
  bool inside = false;
  parts.each_root([&](ObbChild child) {
    PlacedCore memory;
    const Vector3 p = parts.core(child, memory).support_point(Vector3::UnitY());
    const Vector3 seen = pose_s.to_body(pose_o.to_world(p));
    if (inside || ((seen.cwiseAbs() - mesh->body->half_extents).array() > 0.0).any()) {
      return;
    }
    const CollisionMesh point({{p, p, p}, {{0, 1, 2}}});
    inside = vertex_in_solid(MeshPair({mesh->body->mesh, pose_s}, {point, pose_o}), 0, exact);
  });
  return inside;
}

}  // namespace

bool one_inside(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  return !on_plane(b) &&
         (has_point_inside(a, pose_a, b, pose_b) || has_point_inside(b, pose_b, a, pose_a));
}

bool parts_overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (on_plane(b)) {
    return OverPlane(a, pose_a, b, pose_b).gap() <= 0.0;
  }
  const double reach = bounding_radius(a) + bounding_radius(b);
  if ((pose_b.position - pose_a.position).squaredNorm() > reach * reach * (1.0 + 64.0 * u)) {
    return false;
  }
  const auto* mesh_a = std::get_if<Mesh>(&a);
  const auto* mesh_b = std::get_if<Mesh>(&b);
  if (mesh_a != nullptr && mesh_b != nullptr) {
    return MeshQueries()
               .collide({mesh_a->body->mesh, pose_a}, {mesh_b->body->mesh, pose_b})
               .verdict != MeshVerdict::apart;
  }
  return Pair(a, pose_a, b, pose_b).nearest(0.0).gap <= 0.0 || one_inside(a, pose_a, b, pose_b);
}

Overlap measure_parts(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (on_plane(b)) {
    const OverPlane over(a, pose_a, b, pose_b);
    const double gap = over.gap();
    const double rounding = 1024.0 * u * over.size();
    const Vector3 n = -over.up();
    return {gap <= 0.0, gap, n,
            pose_a.position + middle(outline(over.points(gap + rounding), n, over.size()))};
  }
  Pair pair(a, pose_a, b, pose_b);
  const NearestParts at = pair.nearest(-infinity);
  const Vector3 point = touching_point(a, pose_a, b, pose_b, at.n, at.gap, 4.0 * pair.error());
  if (at.gap > 0.0 && one_inside(a, pose_a, b, pose_b)) {
    return {true, -at.gap, at.n, point};
  }
  return {at.gap <= 0.0, at.gap, at.n, point};
}

Vector3 touching_point(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                       const Vector3& n, double gap, double within) {
  if (on_plane(b)) {
    const OverPlane over(a, pose_a, b, pose_b);
    const double most = std::max(gap, over.gap()) + within;  // never without the lowest
    return pose_a.position + middle(outline(over.points(most), n, over.size()));
  }
  Pair pair(a, pose_a, b, pose_b);
  std::vector<TouchingPoint> points = pair.points(n, gap, gap + within);
  if (points.empty()) {  // along n nothing is as near: where the nearest parts are
    NearestParts at = pair.nearest(-infinity);
    at.n = n;
    return pose_a.position + pair.patch(at).on_a() + 0.5 * gap * n;
  }
  return pose_a.position + middle(outline(points, n, pair.size()));
}

ContactManifold parts_manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                               const Pose& pose_b, double reach) {
  ContactManifold manifold;
  std::vector<TouchingPoint> points;
  double size = 0.0;
  if (on_plane(b)) {
    const OverPlane over(a, pose_a, b, pose_b);
    manifold.normal = -over.up();
    manifold.face_of_b = true;
    points = over.points(reach);
    size = over.size();
    manifold.face_of_a = points.size() > 2;
  } else {
    Pair pair(a, pose_a, b, pose_b);
    const NearestParts at = pair.nearest(-infinity);
    manifold.normal = at.n;
    if (at.gap > reach) {
      return manifold;
    }
    const CorePatch patch = pair.patch(at);
    manifold.face_of_a = patch.face_of_a;
    manifold.face_of_b = patch.face_of_b;
    points = pair.points(at.n, at.gap, reach);
    size = pair.size();
  }
  const std::vector<TouchingPoint> corners = outline(points, manifold.normal, size);
  const std::size_t most = ContactManifold::most_points;
  const std::size_t step = std::max<std::size_t>(1, (corners.size() + most - 1) / most);
  for (std::size_t i = 0; i < corners.size(); i += step) {
    manifold.add(pose_a.position + corners[i].position, corners[i].gap);
  }
  return manifold;
}

}  // namespace kairos::ccd
