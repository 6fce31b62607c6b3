#include "core/schemes/event/mode_guards.hpp"

#include "core/contacts/touch_rim.hpp"
#include "core/schemes/shared/support.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Guards {
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

  /// When a point passes the rim of the face with this outward normal.
  [[nodiscard]] double rim(std::size_t place, const Motion& point, const Vector3& outward) const {
    const Shape& shape = model.shape(bodies[place]);
    if (std::holds_alternative<Hull>(shape)) {
      return hull_rim(shape, place, point, outward);
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      return round_rim(cylinder->radius, place, point);
    }
    if (const auto* cone = std::get_if<Cone>(&shape)) {
      return round_rim(cone->radius, place, point);
    }
    return face_exit_time(shape, motions[place], point, outward, duration);
  }

  /// Position of a point in the frame of a body that does not turn, as a polynomial of degree 2.
  [[nodiscard]] Polynomial<3> in_frame(std::size_t place, const Motion& point) const {
    const Quaternion to_body = motions[place].orientation(0.0).conjugate();
    Polynomial<3> x;
    x.resize(2);
    for (int c = 0; c <= 2; ++c) {
      const auto part = [c](const Polynomial<3>& p) {
        return c <= p.degree() ? Vector3(p[c]) : Vector3(Vector3::Zero());
      };
      x[c] = to_body * Vector3(part(point.position) - part(motions[place].position));
    }
    return x;
  }

  [[nodiscard]] double hull_rim(const Shape& shape, std::size_t place, const Motion& point,
                                const Vector3& outward) const {
    const Quaternion to_body = motions[place].orientation(0.0).conjugate();
    const auto sides = sides_of_face(shape, to_body * outward);
    if (!sides) {
      return infinity;
    }
    const Polynomial<3> x = in_frame(place, point);
    double earliest = infinity;
    for (const TouchRim::Side& side : *sides) {
      Polynomial<3> beyond;
      beyond.resize(2);
      for (int c = 0; c <= 2; ++c) {
        beyond[c] =
            Vector3(side.normal.dot(Vector3(x[c])) - (c == 0 ? side.offset : 0.0), 0.0, 0.0);
      }
      earliest = std::min(earliest, first_positive(beyond, duration));
    }
    return earliest;
  }

  /// Of the round end of a body about its y axis.
  [[nodiscard]] double round_rim(double radius, std::size_t place, const Motion& point) const {
    const Polynomial<3> x = in_frame(place, point);
    Polynomial<3> beyond;  // |x across the axis|^2 - radius^2
    beyond.resize(4);
    for (int j = 0; j <= 2; ++j) {
      for (int k = 0; k <= 2; ++k) {
        beyond[j + k].x() += x[j].x() * x[k].x() + x[j].z() * x[k].z();
      }
    }
    beyond[0].x() -= radius * radius;
    return first_positive(beyond, duration);
  }

  /// Whether bodies at two places move alike.
  [[nodiscard]] bool alike(std::size_t a, std::size_t b) const {
    return mode.velocities[a].linear == mode.velocities[b].linear &&
           mode.accelerations[a].linear == mode.accelerations[b].linear;
  }

  [[nodiscard]] std::string of_patch(std::size_t p, double& until) const {
    const GroupPatch& patch = group.patches[p];
    const Vector3& n = patch.manifold.normal;
    until = infinity;
    for (const auto& [round, other] : {std::pair{patch.a, patch.b}, std::pair{patch.b, patch.a}}) {
      if (std::holds_alternative<Sphere>(model.shape(bodies[round]))) {
        const bool on_face = other == patch.b ? patch.manifold.face_of_b : patch.manifold.face_of_a;
        if (on_face) {
          until = rim(other, motions[round], other == patch.a ? n : Vector3(-n));
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
        until = a_points ? rim(patch.b, point, -n) : rim(patch.a, point, n);
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
      if (mode.velocities[k].angular.isZero(
              0.0)) {  // a body that spins is carried under its middle
        until = std::min(until, rim(k, *point, k == patch.a ? n : Vector3(-n)));
      }
    }
    return {};
  }
};

}  // namespace

std::string guard_times(const Model& model, std::span<const BodyIndex> bodies,
                        std::span<const BodyState> states, const ContactGroup& group,
                        const FlatMode& mode, double duration, std::vector<double>& until) {
  until.assign(group.patches.size(), infinity);
  Guards guards{model, bodies, group, mode, duration, {}};
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
