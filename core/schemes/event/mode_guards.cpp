#include "core/schemes/event/mode_guards.hpp"

#include "core/contacts/face_parts.hpp"
#include "core/schemes/event/event_run.hpp"
#include "core/schemes/shared/support.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Guards {
  const EventRun& run;
  const Model& model;
  std::span<const BodyIndex> bodies;
  const ContactGroup& group;
  const FlatMode& mode;
  double duration;
  std::vector<Motion> motions;

  [[nodiscard]] bool free(std::size_t k) const { return group.bodies[k].inverse_mass > 0.0; }

  /// Whether all free bodies move as one, on half-spaces or not at all: then loads cannot shift.
  [[nodiscard]] bool rigid() const {
    std::optional<std::size_t> first;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (!free(k)) {
        continue;
      }
      if (!first) {
        first = k;
      } else if (mode.velocities[k].linear != mode.velocities[*first].linear ||
                 mode.accelerations[k].linear != mode.accelerations[*first].linear) {
        return false;
      }
    }
    const bool still = first && mode.velocities[*first].linear.isZero(0.0) &&
                       mode.accelerations[*first].linear.isZero(0.0);
    for (std::size_t p = 0; p < group.patches.size() && !still; ++p) {
      for (const std::size_t k : {group.patches[p].a, group.patches[p].b}) {
        if (mode.kept[p] != 0 && !free(k) &&
            !std::holds_alternative<HalfSpace>(model.shape(bodies[k]))) {
          return false;
        }
      }
    }
    return true;
  }

  /// Places of the free bodies that depend on patch p alone, on the side of `from`; nothing if they
  /// are held elsewhere too.
  [[nodiscard]] std::vector<std::size_t> hanging(std::size_t p, std::size_t from) const {
    std::vector<std::size_t> side{from};
    for (std::size_t k = 0; k < side.size(); ++k) {
      if (!free(side[k])) {
        return {};
      }
      for (std::size_t q = 0; q < group.patches.size(); ++q) {
        const GroupPatch& patch = group.patches[q];
        if (q == p || mode.kept[q] == 0 || (patch.a != side[k] && patch.b != side[k])) {
          continue;
        }
        const std::size_t other = patch.a == side[k] ? patch.b : patch.a;
        if (std::find(side.begin(), side.end(), other) == side.end()) {
          side.push_back(other);
        }
      }
    }
    return side;
  }

  /// Where the force of patch p acts: r x F = sum x_i x F_i for the bodies that hang on it.
  [[nodiscard]] std::optional<Motion> centre_of_pressure(std::size_t p) const {
    const GroupPatch& patch = group.patches[p];
    std::vector<std::size_t> side = hanging(p, patch.a);
    if (side.empty()) {
      side = hanging(p, patch.b);
    }
    if (side.empty()) {
      return std::nullopt;
    }
    const Vector3& n = patch.manifold.normal;
    double force = 0.0;
    Vector3 along = Vector3::Zero();  // of the force, on the plane of the patch
    Polynomial<3> moment;
    moment.resize(2);
    for (const std::size_t k : side) {
      const Vector3 f =
          (mode.accelerations[k].linear - group.loads[k].linear) / group.bodies[k].inverse_mass;
      force += n.dot(f);
      along += f - n * n.dot(f);
      const Polynomial<3>& x = motions[k].position;
      for (int c = 0; c <= x.degree(); ++c) {
        moment[c] += Vector3(x[c]).cross(f);
      }
    }
    Motion point = motions[patch.a];
    point.position.resize(2);
    for (int c = 0; c <= 2; ++c) {
      point.position[c] = n.cross(Vector3(moment[c])) / force;
    }
    if (!mode.force.empty()) {
      point.position[0] += along * (n.dot(patch.manifold.points[0].position) / force);
    }
    return point;
  }

  /// When a point passes the rim of the face with this outward normal that is touched at `at`.
  [[nodiscard]] double rim(std::size_t place, const Motion& point, const Vector3& outward,
                           const Vector3& at) const {
    return face_exit_time(model.shape(bodies[place]), motions[place], point, outward, at, duration);
  }

  /// When the centre of pressure, which is on none of the pieces of a body, as between the legs of
  /// a table, leaves what it stands on: the outline of the points at which it touches, each until
  /// it leaves the face of the other.
  [[nodiscard]] double off_its_feet(std::size_t p, std::size_t place, const Motion& point) const {
    const GroupPatch& patch = group.patches[p];
    const std::size_t other = place == patch.a ? patch.b : patch.a;
    const Vector3& n = patch.manifold.normal;
    const Vector3 outward = place == patch.a ? n : Vector3(-n);
    const Vector3& at = patch.manifold.points[0].position;
    double until = infinity;
    std::vector<Vector3> feet;
    for (std::size_t k = 0; k < patch.manifold.size; ++k) {
      Motion foot = motions[place];
      foot.position[0] = patch.manifold.points[k].position;
      const double leaves = rim(other, foot, -outward, at);
      if (leaves > at_once * run.epoch()) {
        feet.push_back(patch.manifold.points[k].position);
        until = std::min(until, leaves);
      }
    }
    return feet.size() < 3
               ? 0.0
               : std::min(until, outline_exit_time(feet, outward, motions[place], point, duration));
  }

  /// Whether bodies at two places move alike.
  [[nodiscard]] bool alike(std::size_t a, std::size_t b) const {
    return mode.velocities[a].linear == mode.velocities[b].linear &&
           mode.accelerations[a].linear == mode.accelerations[b].linear;
  }

  [[nodiscard]] std::string of_patch(std::size_t p, double& until) const {
    until = infinity;
    std::string why = rim_of_patch(p, until);
    const GroupPatch& patch = group.patches[p];
    if (!why.empty() || alike(patch.a, patch.b) || until <= at_once * run.epoch()) {
      return why;
    }
    const TouchingPair pair{bodies[patch.a], bodies[patch.b], patch.manifold.normal,
                            patch.manifold.points[0].position};
    return meets_elsewhere(run, pair, of_place(patch.a), of_place(patch.b), Instant{}, duration,
                           until);
  }

  [[nodiscard]] Moving of_place(std::size_t place) const {
    return {motions[place], !mode.velocities[place].angular.isZero(0.0)};
  }

  [[nodiscard]] std::string rim_of_patch(std::size_t p, double& until) const {
    const GroupPatch& patch = group.patches[p];
    const Vector3& n = patch.manifold.normal;
    const Vector3& at = patch.manifold.points[0].position;
    for (const auto& [round, other] : {std::pair{patch.a, patch.b}, std::pair{patch.b, patch.a}}) {
      if (std::holds_alternative<Sphere>(model.shape(bodies[round]))) {
        const bool on_face = other == patch.b ? patch.manifold.face_of_b : patch.manifold.face_of_a;
        if (on_face) {
          until = rim(other, motions[round], other == patch.a ? n : Vector3(-n), at);
        } else if (const Shape& shape = model.shape(bodies[other]);
                   !std::holds_alternative<Sphere>(shape) && !alike(patch.a, patch.b)) {
          return "a ball slides along an edge or a round side";
        }
        return {};
      }
    }
    if (patch.manifold.size == 1) {
      const bool a_points = patch.manifold.face_of_b;
      Motion point = motions[a_points ? patch.a : patch.b];
      point.position[0] = patch.manifold.points[0].position;
      if (patch.manifold.face_of_a != patch.manifold.face_of_b) {
        until = a_points ? rim(patch.b, point, -n, at) : rim(patch.a, point, n, at);
      }
      return {};
    }
    const Vector3 v = mode.velocities[patch.b].linear - mode.velocities[patch.a].linear;
    if (!(mode.pressing[p] > 0.0)) {
      return v.isZero(0.0) ? std::string()
                           : "two faces slide along each other and nothing presses them together";
    }
    if (!patch.manifold.face_of_a || !patch.manifold.face_of_b) {
      return "a body slides on an edge";
    }
    const std::optional<Motion> point = centre_of_pressure(p);
    if (!point) {
      return "a body that is carried by several others slides";
    }
    for (const std::size_t k : {patch.a, patch.b}) {
      if (!mode.velocities[k].angular.isZero(0.0)) {
        continue;  // a body that spins is carried under its middle
      }
      double leaves = rim(k, *point, k == patch.a ? n : Vector3(-n), at);
      const bool other_spins =
          !mode.velocities[k == patch.a ? patch.b : patch.a].angular.isZero(0.0);
      if (leaves <= at_once * run.epoch() && !other_spins) {
        leaves = off_its_feet(p, k, *point);
      }
      until = std::min(until, leaves);
    }
    return {};
  }
};

}  // namespace

std::string meets_elsewhere(const EventRun& run, const TouchingPair& pair, const Moving& a,
                            const Moving& b, Instant t, double duration, double& until) {
  double meets = infinity;
  for (const bool of_a : {true, false}) {
    const Moving& own = of_a ? a : b;
    const Moving& other = of_a ? b : a;
    const Shape& shape = run.model.shape(of_a ? pair.a : pair.b);
    const Shape& other_shape = run.model.shape(of_a ? pair.b : pair.a);
    const Pose pose = own.motion.pose(t - own.motion.start);
    const Vector3 outward = of_a ? pair.normal : Vector3(-pair.normal);
    const auto rest =
        above_face(shape, pose.orientation.conjugate() * outward, pose.to_body(pair.at));
    if (!rest) {
      continue;
    }
    if (own.spins || (other.spins && !std::holds_alternative<Sphere>(other_shape))) {
      meets = 0.0;  // how it turns is not followed here
      continue;
    }
    const MovingShape part{*rest, own.motion}, whole{other_shape, other.motion};
    const bool sooner = shape_rank(*rest) <= shape_rank(other_shape);
    const TimeOfImpact met = run.detector.time_of_impact(
        sooner ? part : whole, sooner ? whole : part, {t, duration}, run.options.toi_tolerance);
    if (met.status != ToiStatus::separated) {
      meets = std::min(meets, met.t_lo);
    }
  }
  if (meets <= at_once * run.epoch()) {
    return run.names(pair.a, pair.b) + " touch in one place and meet in another";
  }
  until = std::min(until, meets);
  return {};
}

std::string guard_times(const EventRun& run, std::span<const BodyIndex> bodies,
                        std::span<const BodyState> states, const ContactGroup& group,
                        const FlatMode& mode, double duration, std::vector<double>& until) {
  until.assign(group.patches.size(), infinity);
  Guards guards{run, run.model, bodies, group, mode, duration, {}};
  if (guards.rigid()) {
    return {};
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    guards.motions.push_back(Motion::ballistic({}, infinity, states[k].pose,
                                               {mode.velocities[k].linear, Vector3::Zero()},
                                               mode.accelerations[k].linear));
  }
  for (std::size_t p = 0; p < group.patches.size(); ++p) {
    if (mode.kept[p] != 0) {
      if (std::string why = guards.of_patch(p, until[p]); !why.empty()) {
        return why;
      }
    }
  }
  return {};
}

}  // namespace core
}  // namespace kairos
