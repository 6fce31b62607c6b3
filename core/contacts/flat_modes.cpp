#include "core/contacts/flat_modes.hpp"

#include "core/contacts/complementarity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Accelerations below this part of the largest load are roundoff of the solve.
constexpr double solve_roundoff = 1e-10;
/// Roundings of a solve, and of the sums that use its result.
constexpr double solve_epsilons = 64.0;
/// Velocities below this part of the projected ones are roundoff of the projection.
constexpr double project_roundoff = 64.0 * epsilon;

double largest_load(const ContactGroup& group) {
  double largest = 0.0;
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    largest = std::max(
        largest, group.loads[i].linear.norm() + group.loads[i].angular.norm() * group.radius[i]);
  }
  return largest;
}

double speed(const Twist& v, double radius) { return v.linear.norm() + v.angular.norm() * radius; }

/// The search for the flat mode of one group.
class Attempt {
 public:
  Attempt(const ContactGroup& group, const FlatModeOptions& options)
      : group_(group), options_(options), load_(largest_load(group)) {
    for (std::size_t i = 0; i < group.bodies.size(); ++i) {
      fastest_ = std::max(fastest_, speed(group.velocities[i], group.radius[i]));
    }
    mode_.velocities = group.velocities;
    mode_.accelerations = group.loads;
    mode_.kept.assign(group.patches.size(), 0);
    mode_.pressing.assign(group.patches.size(), 0.0);
    mode_.rate.assign(group.patches.size(), 0.0);
  }

  FlatMode result() && {
    if (gather() && accelerate() && slow_down() && hold_still()) {
      clean();
    }
    return std::move(mode_);
  }

 private:
  bool refuse(std::string why) {
    mode_.refusal = std::move(why);
    return false;
  }

  /// Collects a row for each point at which two bodies are at rest relative to each other.
  bool gather() {
    all_.bodies = group_.bodies;
    for (std::size_t p = 0; p < group_.patches.size(); ++p) {
      const GroupPatch& patch = group_.patches[p];
      bool rests = true;
      for (std::size_t k = 0; k < patch.manifold.size; ++k) {
        all_.add(patch.a, patch.b, patch.manifold.points[k].position, patch.manifold.normal);
        const double rate = all_.rate(all_.rows.back(), group_.velocities);
        mode_.rate[p] = std::max(mode_.rate[p], std::abs(rate));
        if (rate < -patch.rest_speed) {
          return refuse("they approach each other");
        }
        rests = rests && rate <= patch.rest_speed;
      }
      if (!rests) {
        all_.rows.resize(all_.rows.size() - patch.manifold.size);
        continue;
      }
      of_row_.resize(all_.rows.size(), p);
    }
    return true;
  }

  /// Finds the contacts that press, and the accelerations with their forces.
  bool accelerate() {
    if (all_.rows.empty()) {
      return refuse("nothing stays in touch");
    }
    const Eigen::MatrixXd W = all_.coupling();
    Eigen::VectorXd q = all_.rates(group_.loads);
    for (double& x : q) {
      x = std::abs(x) <= 16.0 * epsilon * load_ ? 0.0 : x;
    }
    const Complementarity forces = solve_complementarity(W, q);
    mode_.solves += forces.solves;
    if (!forces.solved) {
      return refuse("no contact forces were found that could be verified");
    }
    bool any = false;
    for (std::size_t r = 0; r < of_row_.size(); ++r) {
      const double force = forces.x[static_cast<Eigen::Index>(r)];
      mode_.pressing[of_row_[r]] += force;
      any = any || force > 0.0;
    }
    if (!any && !options_.unloaded) {
      return refuse("nothing presses");
    }
    all_.push(forces.x, mode_.accelerations);
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      Vector3& turning = mode_.accelerations[i].angular;
      if (moves(group_.bodies[i]) && turning.norm() * group_.radius[i] > solve_roundoff * load_) {
        return refuse("a body begins to turn: it tips, or its support is beside its centre");
      }
      turning.setZero();
    }
    // A patch whose points accelerate apart opens. A light body that is squeezed from both sides
    // accelerates by the roundoff of these forces, which may be more than that of the loads.
    const Eigen::VectorXd squeezed = W.cwiseAbs() * forces.x;
    std::fill(mode_.kept.begin(), mode_.kept.end(), char{0});
    for (std::size_t r = 0; r < of_row_.size(); ++r) {
      const double a = all_.rate(all_.rows[r], mode_.accelerations);
      const double none = solve_roundoff * load_ +
                          solve_epsilons * epsilon * squeezed[static_cast<Eigen::Index>(r)];
      mode_.kept[of_row_[r]] = std::abs(a) <= none ? 1 : 0;
    }
    const double most = *std::max_element(mode_.pressing.begin(), mode_.pressing.end());
    for (std::size_t p = 0; p < mode_.kept.size(); ++p) {
      if (mode_.kept[p] == 0 && mode_.pressing[p] > solve_roundoff * most) {
        return refuse("no contact forces were found that could be verified");
      }
    }
    return true;
  }

  [[nodiscard]] ContactSystem rows_of(const std::vector<char>& patches) const {
    ContactSystem system;
    system.bodies = group_.bodies;
    for (std::size_t r = 0; r < of_row_.size(); ++r) {
      if (patches[of_row_[r]] != 0) {
        system.rows.push_back(all_.rows[r]);
      }
    }
    return system;
  }

  /// Bodies in patches that are kept lose their relative velocity along the normal.
  bool slow_down() {
    std::vector<char> pressed = mode_.kept;
    for (std::size_t p = 0; p < pressed.size() && !options_.unite; ++p) {
      pressed[p] = mode_.kept[p] != 0 && mode_.pressing[p] > 0.0 ? 1 : 0;
    }
    (void)rows_of(pressed).project(mode_.velocities);
    // A patch that touches without pressing is kept as long as it does not move.
    for (std::size_t r = 0; r < of_row_.size(); ++r) {
      const std::size_t p = of_row_[r];
      if (pressed[p] == 0 &&
          std::abs(all_.rate(all_.rows[r], mode_.velocities)) > project_roundoff * fastest_) {
        mode_.kept[p] = 0;
      }
    }
    const ContactSystem held = rows_of(mode_.kept);
    (void)held.project(mode_.velocities);
    (void)held.project(mode_.accelerations);
    if (std::none_of(mode_.kept.begin(), mode_.kept.end(), [](char k) { return k != 0; })) {
      return refuse("nothing stays in touch");
    }
    return true;
  }

  /// Checks that loads, arms and normals are constant while the mode lasts.
  bool hold_still() {
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      if (!moves(group_.bodies[i])) {
        continue;
      }
      Vector3& w = mode_.velocities[i].angular;
      if (w.norm() * group_.radius[i] <= project_roundoff * fastest_) {
        w.setZero();
      }
      if (!w.isZero(0.0) && !spins(i)) {
        return refuse("a body turns while it touches");
      }
    }
    for (std::size_t p = 0; p < group_.patches.size(); ++p) {
      const GroupPatch& patch = group_.patches[p];
      const bool plane = patch.manifold.face_of_a || patch.manifold.face_of_b;
      if (mode_.kept[p] == 0 || plane) {
        continue;
      }
      const Vector3 v = mode_.velocities[patch.b].linear - mode_.velocities[patch.a].linear;
      const Vector3 a = mode_.accelerations[patch.b].linear - mode_.accelerations[patch.a].linear;
      if (v.norm() > project_roundoff * fastest_ + patch.still_speed ||
          a.norm() > solve_roundoff * load_) {
        return refuse("a contact moves along a curved surface or over an edge");
      }
    }
    return true;
  }

  /// Whether body i spins steadily about the normal of its only patch, on a body that does not
  /// turn.
  [[nodiscard]] bool spins(std::size_t i) const {
    const Vector3& w = mode_.velocities[i].angular;
    int patches = 0;
    for (std::size_t p = 0; p < group_.patches.size(); ++p) {
      const GroupPatch& patch = group_.patches[p];
      if (mode_.kept[p] == 0 || (patch.a != i && patch.b != i)) {
        continue;
      }
      const std::size_t other = patch.a == i ? patch.b : patch.a;
      const bool on_face = patch.a == i ? patch.manifold.face_of_b : patch.manifold.face_of_a;
      if (moves(group_.bodies[other]) || !on_face ||
          w.cross(patch.manifold.normal).norm() > 1e-12 * w.norm()) {
        return false;
      }
      ++patches;
    }
    // The gyroscopic load of a turn about a principal axis is roundoff.
    return patches == 1 && group_.loads[i].angular.norm() <= 64.0 * epsilon * w.squaredNorm();
  }

  /// Sets to zero what is roundoff of a projection to zero. Small components of a slow velocity
  /// along a contact are kept: without them it would lead into the contact, or out of it.
  void clean() {
    const std::vector<Twist> velocities = mode_.velocities;
    const std::vector<Twist> accelerations = mode_.accelerations;
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      if (!moves(group_.bodies[i])) {
        continue;
      }
      const double v = project_roundoff * fastest_;
      for (int axis = 0; axis < 3; ++axis) {
        double& linear = mode_.velocities[i].linear[axis];
        linear = std::abs(linear) <= v ? 0.0 : linear;
        double& a = mode_.accelerations[i].linear[axis];
        a = std::abs(a) <= 0.01 * solve_roundoff * load_ ? 0.0 : a;
      }
    }
    const ContactSystem held = rows_of(mode_.kept);
    held.undo_where_faster(velocities, mode_.velocities);
    held.undo_where_faster(accelerations, mode_.accelerations);
  }

  const ContactGroup& group_;
  const FlatModeOptions& options_;
  double load_;
  double fastest_ = 0.0;  ///< m/s
  FlatMode mode_;
  ContactSystem all_;
  std::vector<std::size_t> of_row_;
};

}  // namespace

FlatMode flat_mode(const ContactGroup& group, const FlatModeOptions& options) {
  return Attempt(group, options).result();
}

}  // namespace core
}  // namespace kairos
