// Where the bodies of a group that turns touch, as `EventModes` tells its steps.
#include "core/contacts/shape_pieces.hpp"
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/turning_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

/// What comes nearer than this part of what counts as touch strikes; gaps that are less than half
/// of that are made as large.
constexpr double least_gap = 1.0 / 16.0;
/// Infinite friction: as this, so that what is hardly pressed any more may slide.
constexpr double rough = 1e8;

}  // namespace

/// The touches that are at rest along their normals, and the planes between bodies; why there are
/// none.
std::string EventModes::add_touches(Gathered& found, Instant t, Turning& turning) const {
  TurningGroup& group = turning.group;
  group.start.bodies = found.group.bodies;
  group.start.states = found.states;
  group.start.loads = found.group.loads;
  group.start.radius = found.group.radius;
  group.bodies = found.bodies;
  group.mechanisms = found.mechanisms;
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    if (run_.model.mobility(found.bodies[k]) == Mobility::driven) {
      group.drivers.push_back({k, motions_.driven_from(found.bodies[k], t)});
      const Motion& motion = group.drivers.back().motion;
      group.start.states[k] = {motion.pose(t - motion.start), motion.twist(t - motion.start)};
      group.start.loads[k] = accelerations_of(motion, t);
    }
  }
  for (const BodyIndex i : found.bodies) {
    const bool free = run_.model.is_free(i);
    group.inertia.push_back(free ? run_.model.inertia(i) : BodyInertia{});
    group.constant_force.push_back(free ? motions_.steady_force(i) : Vector3(Vector3::Zero()));
    const Island* const island = free ? &run_.model.islands()[run_.model.island_of(i)] : nullptr;
    group.forces.push_back(island != nullptr && !hangs_together(*island)
                               ? island->forces
                               : std::vector<const Force*>());
  }
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    if (std::string why = add_pair(found, p, turning); !why.empty()) {
      return why;
    }
  }
  if (!group.mechanisms.empty()) {
    turning.driven = put_velocities_onto_joints(group.mechanisms, t, group.start.states);
    TurningState start = turning_state(group, t, free_states(group));
    start.touches = std::move(group.start.touches);
    group.start = std::move(start);
  }
  return {};
}

/// The touches of a pair of bodies, or of their pieces, and what watches that they stay apart; why
/// they are not known.
std::string EventModes::add_pair(const Gathered& found, std::size_t p, Turning& turning) const {
  TurningGroup& group = turning.group;
  const auto [a, b] = found.pairs[p];
  const GroupPatch& patch = found.group.patches[p];
  const Shape& shape_a = run_.model.shape(a);
  const Shape& shape_b = run_.model.shape(b);
  const Pose& at_a = found.states[patch.a].pose;
  const Pose& at_b = found.states[patch.b].pose;
  const bool of_pieces = has_pieces(shape_a) || has_pieces(shape_b);
  if (!of_pieces) {
    const Vector3 apart = run_.detector.overlap(shape_a, at_a, shape_b, at_b).normal;
    return add_touches_of(
        found, p, {&shape_a, {}, &shape_b, {}, patch.manifold, false, apart, 0.0, 0, 0}, turning);
  }
  // Others are too far away to come near within a step.
  const double within = far_pieces(found, patch);
  double reach = predictor_.touching_gap(a, b);
  for (std::size_t k = 0; k < patch.manifold.size; ++k) {
    reach = std::max(reach, patch.manifold.points[k].gap);
  }
  group.unwatched.push_back({patch.a, patch.b, within});
  const std::size_t first = group.pairs.size();
  const std::vector<ShapePiece> pieces_b = near_pieces(b, at_b, a, at_a, within);
  bool touches = false;
  const std::vector<ShapePiece> pieces_a = near_pieces(a, at_a, b, at_b, within);
  for (std::size_t i = 0; i < pieces_a.size(); ++i) {
    for (std::size_t j = 0; j < pieces_b.size(); ++j) {
      const ShapePiece& of_a = pieces_a[i];
      const ShapePiece& of_b = pieces_b[j];
      const Pose piece_a = in_world(at_a, of_a.pose);
      const Pose piece_b = in_world(at_b, of_b.pose);
      const ContactManifold manifold = touching_pieces({of_a, piece_a}, {of_b, piece_b}, reach);
      const auto keep = [&](const Shape& shape) {
        return group.pieces.emplace_back(std::make_shared<const Shape>(shape)).get();
      };
      PiecePair pair{
          keep(of_a.shape), of_a.pose, keep(of_b.shape), of_b.pose, manifold, true, {}, 0.0, i, j};
      const Overlap o = run_.detector.overlap(of_a.asked, piece_a, of_b.asked, piece_b);
      pair.apart = o.normal;
      pair.apart_by = manifold.size == 0 ? o.gap : 0.0;
      if (std::string why = add_touches_of(found, p, pair, turning); !why.empty()) {
        return why;
      }
      touches = touches || manifold.size > 0;
    }
  }
  share_faces(p, first, group);
  return touches ? std::string()
                 : fmt::format("{} touch where no piece of theirs is known to", run_.names(a, b));
}

/// The pieces of a body that another may touch, or comes within `within` of, m.
std::vector<ShapePiece> EventModes::near_pieces(BodyIndex of, const Pose& at, BodyIndex other,
                                                const Pose& there, double within) const {
  const Shape& shape = run_.model.shape(other);
  const bool plane = std::holds_alternative<HalfSpace>(shape);
  return pieces_of(run_.model.shape(of), plane, at.to_body(there.position),
                   plane ? 0.0 : bounding_radius(shape) + within);
}

/// Where two pieces touch that are nearer than `reach`. Detectors prefer the normals of faces,
/// along which they may be further apart, and a triangle alone has none for them.
ContactManifold EventModes::touching_pieces(const PlacedPiece& a, const PlacedPiece& b,
                                            double reach) const {
  ContactManifold manifold =
      run_.detector.manifold(a.piece.asked, a.pose, b.piece.asked, b.pose, reach);
  if (manifold.size == 0) {
    const Overlap o = run_.detector.overlap(a.piece.asked, a.pose, b.piece.asked, b.pose);
    if (!(o.gap <= reach)) {
      return manifold;
    }
    manifold = {};
    manifold.normal = o.normal;
    manifold.add(o.point, o.gap);
  }
  const auto is_face = [](const PlacedPiece& of, const Vector3& outward) {
    constexpr double same = 1e-9;
    const Vector3 n = of.pose.orientation.conjugate() * outward;
    const auto faces = faces_of(of.piece.shape);
    return std::any_of(faces.begin(), faces.end(),
                       [&](const TouchFeature& f) { return (f.direction - n).norm() <= same; });
  };
  manifold.face_of_a = manifold.face_of_a || is_face(a, manifold.normal);
  manifold.face_of_b = manifold.face_of_b || is_face(b, -manifold.normal);
  return manifold;
}

std::optional<Contact> EventModes::least_parting(BodyIndex a, BodyIndex b, double reach) const {
  const BodyState& at_a = motions_.now(a);
  const BodyState& at_b = motions_.now(b);
  const auto pieces_b = near_pieces(b, at_b.pose, a, at_a.pose, reach);
  std::optional<Contact> found;
  double least = std::numeric_limits<double>::infinity();
  for (const ShapePiece& of_a : near_pieces(a, at_a.pose, b, at_b.pose, reach)) {
    for (const ShapePiece& of_b : pieces_b) {
      const ContactManifold m = touching_pieces({of_a, in_world(at_a.pose, of_a.pose)},
                                                {of_b, in_world(at_b.pose, of_b.pose)}, reach);
      for (std::size_t k = 0; k < m.size; ++k) {
        const Contact contact{m.points[k].position, m.normal, m.points[k].gap};
        const double rate = normal_velocity(contact, at_a, at_b);
        if (rate < least) {
          least = rate;
          found = contact;
        }
      }
    }
  }
  return found;
}

/// How far away pieces of a pair may be that are not watched, m: what bodies move in a frame, and a
/// part of their size. Steps are shorter where that is not enough.
double EventModes::far_pieces(const Gathered& found, const GroupPatch& patch) const {
  constexpr double of_size = 0.25;
  double moves = 0.0;
  for (const std::size_t k : {patch.a, patch.b}) {
    const auto& [v, w] = found.states[k].twist;
    const double r = found.group.radius[k];
    moves += run_.mean_frame *
                 (v.norm() + r * w.norm() + run_.mean_frame * found.group.loads[k].linear.norm()) +
             of_size * r;
  }
  return moves;
}

/// What watches two convex pieces.
TurningPair EventModes::watched(const Gathered& found, std::size_t p, const PiecePair& of,
                                const Pose& at_a, const Pose& at_b) const {
  const auto [a, b] = found.pairs[p];
  const GroupPatch& patch = found.group.patches[p];
  const ContactManifold& m = of.manifold;
  TurningPair pair{patch.a,
                   patch.b,
                   extremes_of(*of.shape_a).value(),
                   extremes_of(*of.shape_b).value(),
                   {},
                   {},
                   least_gap * predictor_.touching_gap(a, b),
                   of.shape_a,
                   of.shape_b,
                   of.apart,
                   of.of_pieces,
                   of.piece_a,
                   of.piece_b,
                   of.apart_by,
                   p,
                   of.index_a,
                   of.index_b};
  if (m.size > 0 && found.passes[p] == 0) {
    const Vector3& middle = m.points[0].position;
    const Vector3 half = 0.5 * m.points[0].gap * m.normal;
    if (m.face_of_a) {
      pair.planes_a.push_back(face_feature(*of.shape_a, at_a.to_body(middle - half),
                                           at_a.orientation.conjugate() * m.normal));
    }
    if (m.face_of_b) {
      pair.planes_b.push_back(face_feature(*of.shape_b, at_b.to_body(middle + half),
                                           at_b.orientation.conjugate() * -m.normal));
    }
  }
  // A half-space has one plane, whether a piece is near or not.
  const auto add_plane = [](const Shape& shape, std::vector<TouchFeature>& planes) {
    const auto* const half_space = std::get_if<HalfSpace>(&shape);
    if (half_space != nullptr) {
      planes.push_back({TouchFeature::Kind::plane, Vector3::Zero(), half_space->normal_B, 0.0});
    }
  };
  if (of.of_pieces && m.size == 0) {
    add_plane(*of.shape_a, pair.planes_a);
    add_plane(*of.shape_b, pair.planes_b);
  }
  return pair;
}

/// The touches of two convex pieces.
std::string EventModes::add_touches_of(const Gathered& found, std::size_t p, const PiecePair& of,
                                       Turning& turning) const {
  TurningGroup& group = turning.group;
  const auto [a, b] = found.pairs[p];
  const GroupPatch& patch = found.group.patches[p];
  const ContactManifold& m = of.manifold;
  const auto placed = [&](std::size_t place, const Pose& piece) {
    const Pose& body = found.states[place].pose;
    return of.of_pieces ? in_world(body, piece) : body;
  };
  const Pose at_a = placed(patch.a, of.piece_a);
  const Pose at_b = placed(patch.b, of.piece_b);
  TurningPair pair = watched(found, p, of, at_a, at_b);
  for (std::size_t k = 0; k < m.size; ++k) {
    auto touch = touch_at(m, k, *of.shape_a, at_a, *of.shape_b, at_b);
    if (!touch) {
      return fmt::format("{} touch where no face, edge and corner is known to", run_.names(a, b));
    }
    touch->a = patch.a;
    touch->b = patch.b;
    touch->friction = std::min(patch.friction, rough);
    touch->rough = std::isinf(patch.friction);
    touch->rest_speed = patch.rest_speed;
    touch->pair = p;
    touch->belt = patch.drift;
    touch->of_pieces = of.of_pieces;
    touch->piece_a = of.piece_a;
    touch->piece_b = of.piece_b;
    touch->watched = group.pairs.size();
    touch->point = k;
    if (of.of_pieces) {  // those of all pieces are counted
      const auto& touches = group.start.touches;
      const bool first = touches.empty() || touches.back().pair != p;
      touch->point = first ? 0 : touches.back().point + 1;
    }
    if (!has_belts_on_faces(*touch, a, b)) {
      return "a body turns at an edge of a belt";
    }
    const TouchNow now = look_at(*touch, found.states[patch.a], found.states[patch.b]);
    touch->gap = now.gap;
    if (of.of_pieces && is_told(found, *touch, now, group)) {
      continue;
    }
    group.start.touches.push_back(*touch);
  }
  group.pairs.push_back(std::move(pair));
  return {};
}

/// What is held on a face is held on those of other pieces in the same plane, too. `first`: of the
/// pairs of pieces of the pair p.
void EventModes::share_faces(std::size_t p, std::size_t first, TurningGroup& group) {
  constexpr double same = 1e-13;  // a small part of the least gap that is held
  const auto plane_of = [](const Touch& touch, bool of_a) {
    const TouchFeature& f = of_a ? touch.on_a : touch.on_b;
    const Pose& piece = of_a ? touch.piece_a : touch.piece_b;
    return TouchFeature{f.kind, piece.to_world(f.at), piece.orientation * f.direction, f.radius};
  };
  for (std::size_t q = first; q < group.pairs.size(); ++q) {
    TurningPair& pair = group.pairs[q];
    for (const bool of_a : {true, false}) {
      for (const TouchFeature& face : faces_of(of_a ? *pair.shape_a : *pair.shape_b)) {
        Touch as{.on_a = face, .on_b = face, .piece_a = pair.piece_a, .piece_b = pair.piece_b};
        const TouchFeature mine = plane_of(as, of_a);
        bool shares = false;
        for (const Touch& touch : group.start.touches) {
          const TurningPair& other = group.pairs[touch.watched];
          const TouchFeature plane = plane_of(touch, of_a);
          const bool one_piece =
              of_a ? pair.index_b == other.index_b : pair.index_a == other.index_a;
          const double size = group.start.radius[of_a ? touch.a : touch.b];
          if (touch.pair != p || touch.watched == q || !one_piece ||
              plane.kind != TouchFeature::Kind::plane ||
              (plane.direction - mine.direction).norm() > same ||
              std::abs(plane.direction.dot(plane.at - mine.at)) > same * size) {
            continue;
          }
          Touch shared = touch;
          (of_a ? shared.on_a : shared.on_b) = face;
          (of_a ? shared.piece_a : shared.piece_b) = of_a ? pair.piece_a : pair.piece_b;
          shared.watched = q;
          group.shared.push_back(shared);
          shares = true;
        }
        auto& planes = of_a ? pair.planes_a : pair.planes_b;
        if (shares && planes.empty()) {
          planes.push_back(face);
        }
      }
    }
  }
}

/// Whether pieces beside these touch at the same place, with one normal. With features of the same
/// kinds it is one touch, seen from these, too; otherwise that on a face is taken: the edge of the
/// next face in the same plane bears nothing.
bool EventModes::is_told(const Gathered& found, Touch touch, const TouchNow& now,
                         TurningGroup& group) {
  constexpr double same = 1e-9;
  using Kind = TouchFeature::Kind;
  const double size = group.start.radius[touch.a] + group.start.radius[touch.b];
  const auto on_face = [](const Touch& t) {
    return t.on_a.kind == Kind::plane || t.on_b.kind == Kind::plane;
  };
  for (Touch& t : group.start.touches) {
    if (t.pair != touch.pair) {
      continue;
    }
    const TouchNow other = look_at(t, found.states[t.a], found.states[t.b]);
    if ((other.normal - now.normal).norm() > same ||
        (other.point_a - now.point_a).norm() > same * size) {
      continue;
    }
    if (t.on_a.kind == touch.on_a.kind && t.on_b.kind == touch.on_b.kind) {
      touch.point = t.point;
      group.shared.push_back(touch);
      return true;
    }
    if (on_face(t) != on_face(touch)) {
      touch.point = t.point;
      if (on_face(touch)) {
        std::erase_if(group.shared,
                      [&](const Touch& s) { return s.pair == t.pair && s.point == t.point; });
        t = touch;
      }
      return true;
    }
  }
  return false;
}

/// Whether belts of a touch are on faces of what never moves: their velocity is then along the
/// surface, and constant.
bool EventModes::has_belts_on_faces(const Touch& touch, BodyIndex a, BodyIndex b) const {
  const auto fits = [&](BodyIndex i, const TouchFeature& feature) {
    return belt(i, touch.normal).isZero(0.0) ||
           (run_.model.mobility(i) == Mobility::fixed && feature.kind == TouchFeature::Kind::plane);
  };
  return touch.belt.isZero(0.0) || (fits(a, touch.on_a) && fits(b, touch.on_b));
}

/// Where what is touched ends; why that is not known.
std::string EventModes::add_rims(const Gathered& found, Turning& turning) const {
  for (const Touch& touch : turning.group.start.touches) {
    const BodyIndex a = found.bodies[touch.a];
    const BodyIndex b = found.bodies[touch.b];
    const TurningPair& pair = turning.group.pairs[touch.watched];
    auto rims = rims_of(touch, *pair.shape_a, *pair.shape_b);
    if (!rims) {
      return fmt::format("{} touch, one turns, and what it is on may end", run_.names(a, b));
    }
    turning.group.rims.push_back(std::move(*rims));
  }
  return {};
}

}  // namespace core
}  // namespace kairos
