#include "core/schemes/event/mode_guards.hpp"

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

  [[nodiscard]] double rim(std::size_t place, const Motion& point, const Vector3& normal) const {
    return face_exit_time(model.shape(bodies[place]), motions[place], point, normal, duration);
  }

  [[nodiscard]] std::string of_patch(std::size_t p, double& until) const {
    const GroupPatch& patch = group.patches[p];
    const Vector3& n = patch.manifold.normal;
    until = infinity;
    for (const auto& [round, other] : {std::pair{patch.a, patch.b}, std::pair{patch.b, patch.a}}) {
      if (std::holds_alternative<Sphere>(model.shape(bodies[round]))) {
        const bool on_face = other == patch.b ? patch.manifold.face_of_b : patch.manifold.face_of_a;
        until = on_face ? rim(other, motions[round], n) : infinity;
        return {};
      }
    }
    if (patch.manifold.size == 1) {
      const bool a_points = patch.manifold.face_of_b;
      Motion point = motions[a_points ? patch.a : patch.b];
      point.position[0] = patch.manifold.points[0].position;
      if (patch.manifold.face_of_a != patch.manifold.face_of_b) {
        until = rim(a_points ? patch.b : patch.a, point, n);
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
        until = std::min(until, rim(k, *point, n));
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
