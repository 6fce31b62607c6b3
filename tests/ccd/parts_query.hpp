#pragma once

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_shapes.hpp"
#include "tests/ccd/convex_query.hpp"

/// Bodies of several parts against the reference for convex ones: all pairs of parts, each by
/// Wolfe's algorithm in long double, a triangle as the hull of its corners.
namespace kairos::convex {

/// A convex part, and where it is in its body.
struct ReferencePart {
  Shape shape;
  Vec p = Vec::Zero();
  Quat q = Quat::Identity();
};

inline std::vector<ReferencePart> parts_of(const Shape& shape) {
  std::vector<ReferencePart> parts;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    for (const Triangle& t : mesh->body->mesh.triangles()) {
      auto corners = std::make_shared<Polytope>();
      for (const std::uint32_t i : t) {
        corners->vertices.push_back(mesh->body->mesh.vertices()[i]);
      }
      add_sizes(*corners);
      parts.push_back({Hull{std::move(corners)}});
    }
    return parts;
  }
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    for (const CompoundPart& part : compound->body->parts) {
      parts.push_back({part.shape, part.pose.position.cast<Real>(),
                       part.pose.orientation.cast<Real>().normalized()});
    }
    return parts;
  }
  return {{shape}};
}

/// A query about two bodies of parts.
struct PartsQuery {
  Query whole;  ///< shapes, motions, when they were made to touch
  std::vector<ReferencePart> parts_a, parts_b;

  [[nodiscard]] static Posed placed(const Posed& body, const ReferencePart& part) {
    Posed posed;
    posed.shape = &part.shape;
    posed.p = body.p + body.q * part.p;
    posed.q = body.q * part.q;
    return posed;
  }
  /// Calls visit(a, b) for pairs of parts whose balls are nearer than `within`.
  template <typename Visit>
  void each_pair(Real t, Real within, const Visit& visit) const {
    const Posed body_a = whole.at(false, t);
    const Posed body_b = whole.at(true, t);
    const bool plane = std::holds_alternative<HalfSpace>(whole.b);
    for (const ReferencePart& a : parts_a) {
      const Posed posed_a = placed(body_a, a);
      for (const ReferencePart& b : parts_b) {
        const Posed posed_b = placed(body_b, b);
        const Real reach = plane ? Real(INFINITY)
                                 : Real(bounding_radius(a.shape)) + Real(bounding_radius(b.shape));
        if (plane || (posed_b.p - posed_a.p).norm() <= reach + within) {
          visit(posed_a, posed_b);
        }
      }
    }
  }
  [[nodiscard]] Real gap(Real t) const {
    Real least = INFINITY;
    each_pair(t, INFINITY, [&](const Posed& a, const Posed& b) {
      least = std::min(least, distance(a, b).lower);
    });
    return least;
  }
  /// Do two parts overlap by more than what rounding hides: wherever b is moved by so much?
  [[nodiscard]] bool overlap(Real t) const {
    const Real size = std::min(smallest_extent(whole.a), smallest_extent(whole.b));
    const Real hidden = Real(1e-12) * size;
    bool found = false;
    if (std::holds_alternative<HalfSpace>(whole.b)) {
      each_pair(t, 0, [&](const Posed& a, const Posed& b) {
        found = found || distance(a, b).lower < -hidden;
      });
      return found;
    }
    each_pair(t, 0, [&](const Posed& a, const Posed& b) {
      const auto overlap_moved = [&](const Vec& by) {
        Posed moved = b;
        moved.p += by;
        return distance(a, moved).upper < Real(1e-17) * size;
      };
      if (found || !overlap_moved(Vec::Zero())) {
        return;
      }
      found = true;
      for (int k = 0; k < 3; ++k) {
        found =
            found && overlap_moved(hidden * Vec::Unit(k)) && overlap_moved(-hidden * Vec::Unit(k));
      }
    });
    return found;
  }
};

inline const std::array<const char*, 5> mesh_names{"box", "torus", "icosahedron", "hull", "soup"};

/// Triangles anywhere, some of them slivers.
inline MeshData soup(Random& random) {
  MeshData mesh;
  const auto count = 1 + random.below(8);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vector3 at = 0.7 * random.direction();
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.emplace_back(at + random.log_uniform(1e-2, 1.0) * random.direction());
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

inline MeshData hull_mesh(const Polytope& polytope) {
  MeshData mesh{polytope.vertices, {}};
  for (std::size_t f = 0; f < polytope.faces.size(); ++f) {
    const auto corners = polytope.faces[f];
    for (std::size_t k = 2; k < corners.size(); ++k) {
      mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
    }
  }
  return mesh;
}

inline Shape random_mesh(Random& random, std::uint64_t kind) {
  using Kind = CollisionMesh::Kind;
  switch (kind) {
    case 0:
      return Mesh{solid_body(box_mesh(std::get<Box>(random_shape(random, 1)).half_extents)).body};
    case 1:
      return Mesh{solid_body(torus_mesh(1.0, random.uniform(0.2, 0.5), 5, 4)).body};
    case 2:
      return Mesh{solid_body(icosphere_mesh(0)).body};
    case 3:
      return Mesh{
          mesh_in_place(hull_mesh(*std::get<Hull>(random_shape(random, 5)).core), Kind::surface)};
    default:
      return Mesh{mesh_in_place(soup(random), Kind::surface)};
  }
}

inline Shape random_compound(Random& random) {
  std::vector<CompoundPart> parts;
  const auto count = 1 + random.below(4);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Shape part = random_shape(random, static_cast<int>(random.below(6)));
    parts.push_back({part, {any_vector(random, 1.0), random.orientation()}});
  }
  return Compound{compound_body(std::move(parts)).body};
}

/// The highest point of all parts along n.
inline Vec highest_of(const std::vector<ReferencePart>& parts, const Posed& body, const Vec& n) {
  Vec best = Vec::Zero();
  Real most = -INFINITY;
  for (const ReferencePart& part : parts) {
    const Vec x = highest(PartsQuery::placed(body, part), n);
    if (n.dot(x) > most) {
      most = n.dot(x);
      best = x;
    }
  }
  return best;
}

/// As `random_query` for convex shapes; a graze and touching starts among them.
inline PartsQuery random_parts_query(Random& random, const Shape& a, const Shape& b,
                                     Course course) {
  PartsQuery query;
  Query& q = query.whole;
  q.a = a;
  q.b = b;
  query.parts_a = parts_of(a);
  query.parts_b = parts_of(b);
  q.family = course_names[static_cast<std::size_t>(course)];
  const bool starts_in_touch = course == Course::enter || course == Course::leave;
  const bool plane = std::holds_alternative<HalfSpace>(b);
  q.touch = starts_in_touch ? 0.0 : random.uniform(0.1, 0.9);
  const Pose at_a{any_vector(random, 3.0), random.orientation()};
  Pose at_b{Vector3::Zero(), random.orientation()};
  Vector3 n = random.direction();
  if (plane) {
    n = -(at_b.orientation * std::get<HalfSpace>(b).normal_B);
  } else if (random.below(3) == 0) {  // along an axis: faces of boxes
    n = (random.below(2) == 0 ? at_a : at_b).orientation *
        Vector3::Unit(static_cast<int>(random.below(3)));
  }
  const auto posed = [](const Pose& pose) {
    return Posed{nullptr, pose.position.cast<Real>(), pose.orientation.cast<Real>().normalized()};
  };
  const Vector3 on_a = rounded(highest_of(query.parts_a, posed(at_a), n.cast<Real>()));
  const Vector3 of_b = plane ? Vector3(Vector3::Zero())
                             : rounded(highest_of(query.parts_b, posed(at_b), -n.cast<Real>()));
  const double size = std::min(smallest_extent(a), smallest_extent(b));
  const double miss = course == Course::graze
                          ? size * random.log_uniform(1e-9, 1e-3) * (random.below(2) == 0 ? 1 : -1)
                          : 0.0;
  at_b.position = on_a + miss * n - of_b;
  q.closing = course == Course::leave   ? random.log_uniform(1e-3, 2.0)
              : course == Course::graze ? 0.0
                                        : -random.log_uniform(1e-3, 2.0);
  const Vector3 slide = random.direction().cross(n) * random.uniform(0.0, 2.0);
  const double spin = course == Course::spin ? 40.0 : random.below(3) == 0 ? 0.0 : 3.0;
  const Vector3 w_a = any_vector(random, spin);
  const Vector3 w_b = plane ? Vector3(Vector3::Zero()) : any_vector(random, spin);
  const Vector3 v_a = any_vector(random, 1.0);
  const Vector3 v_b =
      v_a + w_a.cross(on_a - at_a.position) - w_b.cross(of_b) + q.closing * n + slide;
  const Vector3 pull = random.below(2) == 0 ? any_vector(random, 5.0) : Vector3(Vector3::Zero());
  const auto back = [&](const Pose& pose, const Vector3& v, const Vector3& w, const Vector3& g) {
    const double t = q.touch;
    const Pose start{pose.position - t * v + 0.5 * t * t * g,
                     rotate(-t * w, pose.orientation).normalized()};
    return Motion::ballistic(Instant{}, q.duration, start, {v - t * g, w}, g);
  };
  q.motion_a = back(at_a, v_a, w_a, pull);
  q.motion_b = back(at_b, v_b, w_b, plane ? Vector3(Vector3::Zero()) : any_vector(random, 1.0));
  return query;
}

/// What an answer promises and does not keep; empty: all is kept.
inline std::string broken(const PartsQuery& q, const TimeOfImpact& toi, int samples,
                          Random& random) {
  const Query& w = q.whole;
  const bool plane = std::holds_alternative<HalfSpace>(w.b);
  const Real coordinates = w.motion_a.position[0].norm() + w.motion_b.position[0].norm() +
                           bounding_radius(w.a) + (plane ? 0.0 : bounding_radius(w.b));
  const Real roundoff = Real(1e-14) * (1 + coordinates);
  if (toi.status == ToiStatus::overlapping) {
    return "";  // one inside the other has no crossing parts
  }
  const bool separated = toi.status == ToiStatus::separated;
  const Real free_until = separated ? Real(w.duration) : Real(toi.t_lo);
  for (int i = 0; i < samples; ++i) {
    const Real part =
        i % 2 == 0 ? Real(random.uniform()) : 1 - std::exp2(Real(-random.uniform(0.0, 40.0)));
    if (q.overlap(part * free_until)) {
      return separated ? "missed" : "late";
    }
  }
  if (toi.status == ToiStatus::impact && q.gap(toi.t_hi) > roundoff) {
    return "false: apart at t_hi";
  }
  return "";
}

}  // namespace kairos::convex
