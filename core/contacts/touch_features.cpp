// Which features of two shapes touch at a point of their manifold.
#include "core/circular.hpp"
#include "core/contacts/shape_features.hpp"
#include "core/contacts/touch.hpp"
#include "core/contacts/touch_rim.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

using Kind = TouchFeature::Kind;

/// A corner is beyond the rim of a face if it is by more than this part of the size.
constexpr double gone_over = 1e-13;
/// A vertex is at a point of a manifold if it is nearer than this part of the size.
constexpr double near_vertex = 1e-7;
constexpr double infinity = std::numeric_limits<double>::infinity();

double radius_of(const Shape& shape) {
  const double radius = bounding_radius(shape);
  return std::isfinite(radius) ? radius : 0.0;
}

/// The corner or cap at a point of the surface (body frame), the normal pointing out of the body.
std::optional<TouchFeature> ball_feature(const Shape& shape, const Vector3& x,
                                         const Vector3& outward) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return TouchFeature{Kind::ball, Vector3::Zero(), Vector3::Zero(), sphere->radius};
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    const Vector3 end = Vector3::UnitY() * std::copysign(0.5 * capsule->length, x.y());
    const Vector3 from = x - capsule->radius * outward - end;
    // The side goes on smoothly into the cap: it is the cap's only from its end on.
    const bool side = capsule->length > 0.0 &&
                      std::abs((from + end).y()) < std::abs(end.y()) - gone_over * capsule->radius;
    if (side || from.norm() > near_vertex * capsule->radius) {
      return std::nullopt;
    }
    return TouchFeature{Kind::ball, end, Vector3::Zero(), capsule->radius};
  }
  if (const auto c = polytope_corners(shape)) {
    const Vector3 inside = x - c->rounding * outward;
    for (const Vector3& vertex : c->vertices) {
      if ((vertex - inside).norm() <= near_vertex * c->size) {
        return TouchFeature{Kind::ball, vertex, Vector3::Zero(), c->rounding};
      }
    }
  }
  return std::nullopt;
}

/// What is perpendicular to an edge has no more than this along it.
constexpr double across_an_edge = 1e-6;

/// A point of the surface is on a round side if it is this near to it, relative to its radius:
/// where two of them touch at hardly any distance their normal is known only so well.
constexpr double near_side = 1e-3;

/// Whether a point of the surface is on a rim: as far from its axis, to this part of its size.
bool is_at_rim(const TouchFeature& rim, const Vector3& x, double near = near_vertex) {
  const double size = rim.radius + std::abs(rim.at.y());
  return std::abs(x.y() - rim.at.y()) <= near_vertex * size &&
         std::abs(Vector3(x.x(), 0.0, x.z()).norm() - rim.radius) <= near * size;
}

/// Tilted by less than this, rad, flat ends lie flat.
constexpr double lies_flat = 1e-8;

/// Whether a flat end looks there, as good as exactly.
bool is_flat_end(const Shape& shape, const Vector3& outward) {
  return !rims_of_shape(shape).empty() &&
         Vector3(outward.x(), 0.0, outward.z()).norm() < lies_flat &&
         (std::holds_alternative<Cylinder>(shape) || outward.y() < 0.0);
}

/// The rim that a point of the surface (body frame) is on, where it is tilted from what it touches
/// and the point is the lowest: of one that lies flat no point touches alone.
std::optional<TouchFeature> rim_feature(const Shape& shape, const Vector3& x,
                                        const Vector3& outward) {
  constexpr double lowest = 0.98;  // others are as far from it as corners of a polygon
  constexpr double near = 1e-5;    // what hardly tilts from it tells the place only so well
  const Vector3 slope(outward.x(), 0.0, outward.z());
  const Vector3 from_axis(x.x(), 0.0, x.z());
  if (slope.norm() < lies_flat || slope.dot(from_axis) < lowest * slope.norm() * from_axis.norm()) {
    return std::nullopt;
  }
  for (const TouchFeature& rim : rims_of_shape(shape)) {
    if (is_at_rim(rim, x, near)) {
      return rim;
    }
  }
  return std::nullopt;
}

/// The ball inside a cone that touches it around through a point of its side at which that lies on
/// a plane.
std::optional<TouchFeature> place_in_cone(const Cone& cone, const Vector3& x,
                                          const Vector3& outward) {
  const double slant = hypotenuse(cone.radius, cone.height);
  if (std::abs(outward.y() - cone.radius / slant) > across_an_edge) {
    return std::nullopt;
  }
  const double from_apex = (0.75 * cone.height - x.y()) * slant / cone.height;
  const double radius = from_apex * cone.radius / cone.height;
  const Vector3 middle = x - radius * outward;
  if (!(radius > 0.0) || Vector3(middle.x(), 0.0, middle.z()).norm() > near_side * radius) {
    return std::nullopt;
  }
  return TouchFeature{Kind::ball, middle.y() * Vector3::UnitY(), Vector3::Zero(), radius};
}

/// A ball about the place on the axis of a round side at which it touches a plane: as the side,
/// while that is across it.
std::optional<TouchFeature> place_on_side(const Shape& shape, const Vector3& x,
                                          const Vector3& outward) {
  if (const auto* cone = std::get_if<Cone>(&shape)) {
    return place_in_cone(*cone, x, outward);
  }
  const auto radius = radius_of_side(shape);
  if (!radius || std::abs(outward.y()) > across_an_edge) {
    return std::nullopt;
  }
  const Vector3 from = x - *radius * outward;
  if (Vector3(from.x(), 0.0, from.z()).norm() > near_side * *radius) {
    return std::nullopt;
  }
  return TouchFeature{Kind::ball, from.y() * Vector3::UnitY(), Vector3::Zero(), *radius};
}

/// The edge nearest to a point of the surface, of those that `across` (outward) is perpendicular
/// to, or tilted from that by so much; of a capsule its axis.
std::optional<TouchFeature> line_feature(const Shape& shape, const Vector3& x,
                                         const Vector3& across, double tilted = across_an_edge) {
  if (const auto radius = radius_of_side(shape)) {
    const Vector3 from = x - *radius * across;
    const bool is_on = std::abs(across.y()) <= tilted &&
                       Vector3(from.x(), 0.0, from.z()).norm() <= near_side * *radius;
    return is_on
               ? std::optional(TouchFeature{Kind::line, Vector3::Zero(), Vector3::UnitY(), *radius})
               : std::nullopt;
  }
  const auto c = polytope_corners(shape);
  if (!c || c->rounding > 0.0) {
    return std::nullopt;
  }
  std::optional<TouchFeature> best;
  double nearest = near_vertex * c->size;
  for (const auto& [i, j] : c->edges) {
    const Vector3 direction = (c->vertices[j] - c->vertices[i]).normalized();
    const Vector3 from = x - c->vertices[i];
    const double distance = (from - direction * direction.dot(from)).norm();
    if (std::abs(direction.dot(across)) <= tilted && distance <= nearest) {
      nearest = distance;
      best = TouchFeature{Kind::line, c->vertices[i], direction, 0.0};
    }
  }
  return best;
}

/// The side of a cone that a point of the surface is on.
std::optional<TouchFeature> side_of_cone(const Shape& shape, const Vector3& x,
                                         const Vector3& outward) {
  const auto* cone = std::get_if<Cone>(&shape);
  if (cone == nullptr) {
    return std::nullopt;
  }
  const Vector3 apex = 0.75 * cone->height * Vector3::UnitY();
  const double sine = cone->radius / hypotenuse(cone->radius, cone->height);
  const double size = cone->radius + cone->height;
  const TouchFeature side{Kind::cone, apex, Vector3::UnitY(), 0.0, Vector3::Zero(), sine};
  const TouchNow now = look_at(side, x);
  return std::abs(now.gap) <= near_vertex * size && (now.normal - outward).norm() <= near_side
             ? std::optional(side)
             : std::nullopt;
}

/// The face, edge or corner that a ball with its middle at x (body frame) is on: the one nearest to
/// x; nothing if none is known.
std::optional<TouchFeature> under_ball(const Shape& shape, const Vector3& on,
                                       const Vector3& outward, bool face, const Vector3& x) {
  std::optional<TouchFeature> best;
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const std::optional<TouchFeature>& feature) {
    const double beyond = feature ? beyond_region(*feature, shape, x) : least;
    if (beyond < least) {
      least = beyond;
      best = feature;
    }
  };
  if (face) {
    offer(face_feature(shape, on, outward));
  }
  offer(line_feature(shape, on, outward));
  offer(ball_feature(shape, on, outward));
  offer(side_of_cone(shape, on, outward));
  for (const TouchFeature& rim : rims_of_shape(shape)) {
    // Beside the rim of a cone is its side.
    const bool beside =
        std::holds_alternative<Cylinder>(shape) ? rim.at.y() * x.y() > 0.0 : is_at_rim(rim, on);
    offer(beside ? std::optional(rim) : std::nullopt);
  }
  return best;
}

/// Whether no corner and no rim of a shape is beyond the plane through x with this normal (body
/// frame), by more than roundoff.
bool is_behind(const Shape& shape, const Vector3& x, const Vector3& normal) {
  constexpr double rounded = 1e-14;
  const auto extremes = extremes_of(shape);
  return extremes && std::all_of(extremes->begin(), extremes->end(), [&](const TouchFeature& e) {
           return height_over(e, e.at, e.direction, -normal, x) >= -rounded * radius_of(shape);
         });
}

/// The edge, the side or the rim that a point of the surface is on, and where.
std::optional<TouchFeature> curve_feature(const Shape& shape, const Vector3& x,
                                          const Vector3& outward, double tilted) {
  auto curve = rim_feature(shape, x, outward);
  curve = curve ? curve : side_of_cone(shape, x, outward);
  curve = curve ? curve : line_feature(shape, x, outward, tilted);
  if (curve) {
    curve->near = x;
  }
  return curve;
}

/// What crosses at a point of the surfaces, edges, round sides or rims, none of whose corners is
/// there; nothing where they are nearly parallel: where they cross then runs away. The normal may
/// be that of a face, from which what crosses at its rim is tilted: it is what touches if it
/// separates the two.
std::optional<Touch> crossing(const Shape& shape_a, const Pose& a, const Vector3& on_a,
                              const Shape& shape_b, const Pose& b, const Vector3& on_b,
                              const Vector3& n) {
  constexpr double nearly_parallel = 1e-3;
  constexpr double most_tilted = 0.3;
  const auto curve_a = curve_feature(shape_a, on_a, a.orientation.conjugate() * n, most_tilted);
  const auto curve_b = curve_feature(shape_b, on_b, b.orientation.conjugate() * -n, most_tilted);
  if (!curve_a || !curve_b || (curve_a->kind == Kind::cone && curve_b->kind == Kind::cone)) {
    return std::nullopt;
  }
  Touch touch;
  touch.on_a = *curve_a;
  touch.on_b = *curve_b;
  touch.normal = n;
  const BodyState at_a{a, {}};
  const BodyState at_b{b, {}};
  const bool is_round = (curve_a->kind == Kind::line ? curve_a->radius : 0.0) +
                            (curve_b->kind == Kind::line ? curve_b->radius : 0.0) >
                        0.0;
  if (!is_round && crossing_sine(touch, at_a, at_b) < nearly_parallel) {
    return std::nullopt;
  }
  const TouchNow now = look_at(touch, at_a, at_b);
  const bool lines = curve_a->kind == Kind::line && curve_b->kind == Kind::line;
  if ((!lines || !(now.normal - n).isZero(across_an_edge)) &&
      (!is_behind(shape_a, a.to_body(now.point_a), a.orientation.conjugate() * now.normal) ||
       !is_behind(shape_b, b.to_body(now.point_b), b.orientation.conjugate() * -now.normal))) {
    return std::nullopt;
  }
  return touch;
}

/// Whether a feature is that of a ball, which is round.
bool is_round(const std::optional<TouchFeature>& feature) {
  return feature && feature->kind == Kind::ball && feature->radius > 0.0;
}

/// Where a corner or a rim that touches at x is, body frame.
Vector3 place_of(const TouchFeature& feature, const Vector3& x) {
  return feature.kind == Kind::rim ? x : feature.at;
}

/// Whether two corners, two edges, or a corner and an edge tell the normal with which they touch:
/// two vertices do not, nor a vertex and an edge, nor edges that are parallel.
bool has_normal(const Touch& touch, const Pose& a, const Pose& b) {
  if (touch.on_a.kind == Kind::line && touch.on_b.kind == Kind::line) {
    return (a.orientation * touch.on_a.direction)
               .cross(b.orientation * touch.on_b.direction)
               .norm() >= 1e-6;
  }
  return touch.on_a.radius + touch.on_b.radius > 0.0;
}

}  // namespace

std::optional<Touch> touch_at(const ContactManifold& manifold, std::size_t point,
                              const Shape& shape_a, const Pose& a, const Shape& shape_b,
                              const Pose& b) {
  const ContactManifold::Point& p = manifold.points[point];
  const Vector3& n = manifold.normal;
  const Vector3 on_a = a.to_body(p.position - 0.5 * p.gap * n);
  const Vector3 on_b = b.to_body(p.position + 0.5 * p.gap * n);
  const Vector3 n_A = a.orientation.conjugate() * n;
  const Vector3 n_B = b.orientation.conjugate() * n;
  Touch touch;
  touch.normal = n;
  auto corner_a = ball_feature(shape_a, on_a, n_A);
  auto corner_b = ball_feature(shape_b, on_b, -n_B);
  if (is_round(corner_a) && !std::holds_alternative<HalfSpace>(shape_b)) {
    const Vector3 middle = b.to_body(a.to_world(corner_a->at));
    const auto under = under_ball(shape_b, on_b, -n_B, manifold.face_of_b, middle);
    if (under) {
      touch.on_a = *corner_a;
      touch.on_b = *under;
      return touch;
    }
  } else if (is_round(corner_b) && !std::holds_alternative<HalfSpace>(shape_a)) {
    const Vector3 middle = a.to_body(b.to_world(corner_b->at));
    const auto under = under_ball(shape_a, on_a, n_A, manifold.face_of_a, middle);
    if (under) {
      touch.on_a = *under;
      touch.on_b = *corner_b;
      return touch;
    }
  }
  if (manifold.face_of_a || manifold.face_of_b) {
    const std::optional<TouchFeature> face_a =
        manifold.face_of_a ? std::optional(face_feature(shape_a, on_a, n_A)) : std::nullopt;
    const std::optional<TouchFeature> face_b =
        manifold.face_of_b ? std::optional(face_feature(shape_b, on_b, -n_B)) : std::nullopt;
    // A round side rolls on the face of the other.
    const auto rolls = [](const Shape& shape, const Vector3& x, const Vector3& outward) {
      auto rim = rim_feature(shape, x, outward);
      return rim ? rim : place_on_side(shape, x, outward);
    };
    corner_a = corner_a || !face_b ? corner_a : rolls(shape_a, on_a, n_A);
    corner_b = corner_b || !face_a ? corner_b : rolls(shape_b, on_b, -n_B);
    const double past_a =
        corner_b && face_a
            ? beyond_region(*face_a, shape_a, a.to_body(b.to_world(place_of(*corner_b, on_b))))
            : infinity;
    const double past_b =
        corner_a && face_b
            ? beyond_region(*face_b, shape_b, b.to_body(a.to_world(place_of(*corner_a, on_a))))
            : infinity;
    // A corner that has gone over the rim of the face is on it no more: its edge is, at the rim.
    const double size = radius_of(shape_a) + radius_of(shape_b);
    if (std::min(past_a, past_b) > gone_over * size) {
      if (auto edges = crossing(shape_a, a, on_a, shape_b, b, on_b, n)) {
        return edges;
      }
      // Nearly parallel: the place at the rim is held, which is no corner and has no rim.
      corner_a.reset();
      corner_b.reset();
    }
    // Of two corners at one place the one that is on the face of the other: it may slide on.
    const bool has_a = corner_a && !(corner_b && past_a < past_b);
    // Where edges that are nearly parallel cross, the point moves with a until the next look.
    if (face_b && (has_a || !(face_a && corner_b))) {
      touch.on_a = corner_a.value_or(TouchFeature{Kind::ball, on_a, Vector3::Zero(), 0.0});
      touch.on_b = *face_b;
    } else {
      touch.on_a = *face_a;
      touch.on_b = corner_b.value_or(TouchFeature{Kind::ball, on_b, Vector3::Zero(), 0.0});
    }
    return touch;
  }
  const auto edge_a = line_feature(shape_a, on_a, n_A);
  const auto edge_b = line_feature(shape_b, on_b, -n_B);
  if (edge_a && edge_b && !corner_a && !corner_b &&
      (a.orientation * edge_a->direction).cross(b.orientation * edge_b->direction).norm() <
          across_an_edge) {
    // Sides that are parallel touch at both ends.
    corner_a = place_on_side(shape_a, on_a, n_A);
    corner_b = corner_a ? edge_b : place_on_side(shape_b, on_b, -n_B);
  }
  if ((corner_a || edge_a) && (corner_b || edge_b)) {
    touch.on_a = corner_a ? *corner_a : *edge_a;
    touch.on_b = corner_b ? *corner_b : *edge_b;
    if (has_normal(touch, a, b)) {
      return touch;
    }
  }
  // A rim at the rim of the other, which is as good as flat. Where both are, the place is held.
  const auto rim_a = rim_feature(shape_a, on_a, n_A);
  const auto rim_b = rim_feature(shape_b, on_b, -n_B);
  if ((rim_a || is_flat_end(shape_a, n_A)) && is_flat_end(shape_b, -n_B)) {
    touch.on_a = rim_a.value_or(TouchFeature{Kind::ball, on_a, Vector3::Zero(), 0.0});
    touch.on_b = face_feature(shape_b, on_b, -n_B);
    return touch;
  }
  if (rim_b && is_flat_end(shape_a, n_A)) {
    touch.on_a = face_feature(shape_a, on_a, n_A);
    touch.on_b = *rim_b;
    return touch;
  }
  if (auto curves = crossing(shape_a, a, on_a, shape_b, b, on_b, n)) {
    return curves;
  }
  // Where both are round that place runs away.
  const bool has_corners = polytope_corners(shape_a) || polytope_corners(shape_b);
  if (!has_corners || is_round(corner_a) || is_round(corner_b) || !extremes_of(shape_a) ||
      !extremes_of(shape_b)) {
    return std::nullopt;
  }
  // The place is held until the next look, at the plane that separates them.
  touch.on_a = {Kind::plane, on_a, n_A, 0.0};
  touch.on_b = {Kind::ball, on_b, Vector3::Zero(), 0.0};
  return touch;
}

}  // namespace core
}  // namespace kairos
