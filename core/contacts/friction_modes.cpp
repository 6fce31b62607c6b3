#include "core/contacts/friction_modes.hpp"

#include "core/contacts/nonnegative_solve.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Accelerations below this part of the largest load are roundoff of the solve.
constexpr double solve_roundoff = 1e-11;
/// Velocities below this part of the fastest are roundoff of the projection.
constexpr double project_roundoff = 64.0 * epsilon;
/// Rows that the others imply.
constexpr double rank_threshold = 1e-12;
/// Of a cone: nowhere farther from it than 2 % of its width.
constexpr int rays_of_cone = 16;
/// All ways are tried up to here: 3^6.
constexpr std::size_t most_touches = 6;
constexpr int most_turns = 50;  ///< of the direction in which something begins to slide

bool moves(const GroupBody& body) { return body.inverse_mass > 0.0; }

/// A patch whose points are at rest along the normal.
struct Touch {
  std::size_t patch = 0;
  std::size_t a = 0;
  std::size_t b = 0;
  Vector3 n, t1, t2;  ///< t1: where loads pull
  double mu = 0.0;
  Vector3 slip;  ///< of b along a, m/s
};

enum class Does : char { opens, sticks, slides, begins };

struct Choice {
  Does does = Does::sticks;
  Vector3 direction = Vector3::Zero();  ///< of b along a, unit, where it slides or begins to
};

struct Solution {
  std::vector<Twist> accelerations;
  std::vector<Vector3> force;  ///< by touch, on b
  std::vector<Choice> choices;
};

/// One group while it is looked at. Bodies have three degrees of freedom, spheres that turn six.
class Attempt {
 public:
  Attempt(const ContactGroup& group, const FlatModeOptions& options)
      : group_(group), options_(options) {
    for (std::size_t i = 0; i < group.bodies.size(); ++i) {
      const double r = group.radius[i];
      load_ = std::max(load_, group.loads[i].linear.norm() + group.loads[i].angular.norm() * r);
      fastest_ = std::max(
          fastest_, group.velocities[i].linear.norm() + group.velocities[i].angular.norm() * r);
      first_.push_back(unknowns_);
      unknowns_ += !moves(group.bodies[i]) ? 0 : turns(i) ? 6 : 3;
    }
    mode_.velocities = group.velocities;
    mode_.accelerations = group.loads;
    const std::size_t n = group.patches.size();
    mode_.kept.assign(n, 0);
    mode_.pressing.assign(n, 0.0);
    mode_.rate.assign(n, 0.0);
    mode_.slip.assign(n, Slip::none);
    mode_.force.assign(n, Vector3::Zero());
    mode_.slip_ends.assign(n, std::numeric_limits<double>::infinity());
  }

  FlatMode result() && {
    if (gather()) {
      if (const std::optional<Solution> found = search()) {
        take(*found);
      } else if (mode_.refusal.empty()) {
        refuse(
            "a body begins to turn (it tips, or what supports it is beside its centre), or no "
            "contact forces were found that could be verified");
      }
    }
    return std::move(mode_);
  }

 private:
  bool refuse(std::string why) {
    mode_.refusal = std::move(why);
    return false;
  }

  [[nodiscard]] bool turns(std::size_t i) const {
    return group_.round[i] != 0 && !group_.bodies[i].inverse_inertia.isZero(0.0);
  }

  /// From the origin of body i, one of touch t, to where it touches.
  [[nodiscard]] Vector3 arm(const Touch& t, std::size_t i, const Vector3& point) const {
    if (group_.round[i] != 0) {
      return t.n * (i == t.a ? group_.radius[i] : -group_.radius[i]);
    }
    return point - group_.bodies[i].position;
  }

  /// Of b against a at the touch, of velocities or of accelerations.
  [[nodiscard]] Vector3 relative(const Touch& t, const std::vector<Twist>& v) const {
    const Vector3& point = group_.patches[t.patch].manifold.points[0].position;
    const auto at = [&](std::size_t i) -> Vector3 {
      const bool round = group_.round[i] != 0;
      return round ? Vector3(v[i].linear + v[i].angular.cross(arm(t, i, point))) : v[i].linear;
    };
    return at(t.b) - at(t.a);
  }

  /// Touches, and what must not turn.
  bool gather() {
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      Vector3& w = mode_.velocities[i].angular;
      if (group_.round[i] != 0 || w.isZero(0.0)) {
        continue;
      }
      if (w.norm() * group_.radius[i] > project_roundoff * fastest_ || !moves(group_.bodies[i])) {
        return refuse("a body turns while it touches");
      }
      w.setZero();
    }
    for (std::size_t p = 0; p < group_.patches.size(); ++p) {
      const GroupPatch& patch = group_.patches[p];
      const ContactManifold& m = patch.manifold;
      Touch t{p, patch.a, patch.b, m.normal, m.normal, m.normal, patch.friction, m.normal};
      const Vector3 v = relative(t, mode_.velocities);
      const double rate = t.n.dot(v);
      mode_.rate[p] = std::abs(rate);
      if (rate < -patch.rest_speed) {
        return refuse("they approach each other");
      }
      if (rate > patch.rest_speed) {
        continue;
      }
      t.slip = v + patch.drift;
      t.slip -= t.n * t.n.dot(t.slip);
      Vector3 pull = relative(t, group_.loads);
      pull -= t.n * t.n.dot(pull);
      if (pull.norm() <= 1e-9 * load_) {
        pull = t.slip;
      }
      align(t, pull);
      touches_.push_back(t);
    }
    return !touches_.empty() || refuse("nothing stays in touch");
  }

  static void align(Touch& t, const Vector3& along) {
    const double length = along.norm();
    t.t1 = length > 0.0 ? Vector3(along / length) : t.n.unitOrthogonal();
    t.t1 = (t.t1 - t.n * t.n.dot(t.t1)).normalized();
    t.t2 = t.n.cross(t.t1);
  }

  [[nodiscard]] double still() const { return load_ * group_.instant + 64.0 * epsilon * fastest_; }

  [[nodiscard]] Choice as_it_moves(const Touch& t) const {
    const double u = t.slip.norm();
    if (t.mu == 0.0) {
      return {Does::slides, Vector3::Zero()};
    }
    return u > still() ? Choice{Does::slides, t.slip / u} : Choice{Does::sticks, Vector3::Zero()};
  }

  // --- Which way it goes on ---------------------------------------------------------------------

  std::optional<Solution> search() {
    std::vector<Choice> as_is;
    for (const Touch& t : touches_) {
      as_is.push_back(as_it_moves(t));
    }
    if (auto found = attempt(as_is)) {
      return found;
    }
    const std::size_t n = touches_.size();
    if (n > most_touches) {
      std::vector<Choice> all = as_is;
      for (Choice& c : all) {
        c.does = c.does == Does::sticks ? Does::begins : c.does;
      }
      if (auto found = attempt(all)) {
        return found;
      }
      refuse("more than 6 patches with friction, which neither stick nor slide together");
      return std::nullopt;
    }
    for (std::size_t changes = 1; changes <= n; ++changes) {
      if (auto found = change(as_is, 0, changes)) {
        return found;
      }
    }
    return std::nullopt;
  }

  /// With so many changes among the touches from `k` on.
  std::optional<Solution> change(std::vector<Choice>& choices, std::size_t k, std::size_t changes) {
    if (changes == 0) {
      return attempt(choices);
    }
    if (k + changes > choices.size()) {
      return std::nullopt;
    }
    const Choice before = choices[k];
    for (const Does does : {Does::begins, Does::opens}) {
      if (does == Does::begins && before.does != Does::sticks) {
        continue;
      }
      choices[k].does = does;
      if (auto found = change(choices, k + 1, changes - 1)) {
        return found;
      }
    }
    choices[k] = before;
    return change(choices, k + 1, changes);
  }

  /// What begins to slide does so where it then goes.
  std::optional<Solution> attempt(std::vector<Choice> choices) {
    const auto begins = [](const Choice& c) { return c.does == Does::begins; };
    if (std::none_of(choices.begin(), choices.end(), begins)) {
      return solve(choices);
    }
    for (Choice& c : choices) {
      if (begins(c)) {
        c.direction.setZero();  // without friction first
      }
    }
    for (int turn = 0; turn < most_turns; ++turn) {
      std::optional<Solution> found = solve(choices);
      if (!found) {
        return std::nullopt;
      }
      double turned = 0.0;
      for (std::size_t k = 0; k < choices.size(); ++k) {
        if (!begins(choices[k])) {
          continue;
        }
        const Touch& t = touches_[k];
        Vector3 a = relative(t, found->accelerations);
        a -= t.n * t.n.dot(a);
        if (a.norm() <= solve_roundoff * load_) {
          return std::nullopt;
        }
        a.normalize();
        if (!choices[k].direction.isZero(0.0) && a.dot(choices[k].direction) <= 0.0) {
          return std::nullopt;
        }
        turned = std::max(turned, (a - choices[k].direction).norm());
        choices[k].direction = a;
      }
      if (turned <= 16.0 * epsilon) {
        return found;
      }
    }
    return std::nullopt;
  }

  // --- One way, proposed and verified -----------------------------------------------------------

  /// A row of the constraints: J of the relative motion along d, by unknown, over the square root
  /// of the mass.
  [[nodiscard]] VectorXd row(const Touch& t, const Vector3& d) const {
    VectorXd out = VectorXd::Zero(unknowns_);
    const Vector3& point = group_.patches[t.patch].manifold.points[0].position;
    for (const auto& [i, sign] : {std::pair{t.a, -1.0}, std::pair{t.b, 1.0}}) {
      const GroupBody& body = group_.bodies[i];
      if (!moves(body)) {
        continue;
      }
      out.segment<3>(first_[i]) = sign * std::sqrt(body.inverse_mass) * d;
      if (turns(i)) {
        out.segment<3>(first_[i] + 3) =
            sign * std::sqrt(body.inverse_inertia(0, 0)) * arm(t, i, point).cross(d);
      }
    }
    return out;
  }

  struct Constraints {
    MatrixXd rows;
    VectorXd rates;   ///< that the velocities have, belts included
    VectorXd driven;  ///< accelerations of what is not free
  };
  [[nodiscard]] Constraints constraints(const std::vector<Choice>& choices) const {
    std::vector<std::pair<std::size_t, Vector3>> all;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const Touch& t = touches_[k];
      if (choices[k].does != Does::opens) {
        all.emplace_back(k, t.n);
      }
      if (choices[k].does == Does::sticks) {
        all.emplace_back(k, t.t1);
        all.emplace_back(k, t.t2);
      }
    }
    std::vector<Twist> of_driven = group_.loads;
    for (std::size_t i = 0; i < of_driven.size(); ++i) {
      if (moves(group_.bodies[i])) {
        of_driven[i] = {};
      }
    }
    const auto n = static_cast<Index>(all.size());
    Constraints c{MatrixXd(n, unknowns_), VectorXd(n), VectorXd(n)};
    for (Index k = 0; k < n; ++k) {
      const auto& [touch, d] = all[static_cast<std::size_t>(k)];
      const Touch& t = touches_[touch];
      const bool along = d != t.n;
      c.rows.row(k) = row(t, d);
      const Vector3 v = relative(t, mode_.velocities);
      c.rates[k] = d.dot(along ? Vector3(v + group_.patches[t.patch].drift) : v);
      c.driven[k] = d.dot(relative(t, of_driven));
    }
    return c;
  }

  [[nodiscard]] Twist scaled(std::size_t i, const VectorXd& z) const {
    const GroupBody& body = group_.bodies[i];
    Twist out;
    if (moves(body)) {
      out.linear = std::sqrt(body.inverse_mass) * z.segment<3>(first_[i]);
      if (turns(i)) {
        out.angular = std::sqrt(body.inverse_inertia(0, 0)) * z.segment<3>(first_[i] + 3);
      }
    }
    return out;
  }

  /// Directions in which the points of a touch may be pushed.
  [[nodiscard]] std::vector<Vector3> rays(const Touch& t, const Choice& c) const {
    if (c.does == Does::slides || c.does == Does::begins) {
      return {t.mu > 0.0 && !c.direction.isZero(0.0) ? Vector3(t.n - t.mu * c.direction) : t.n};
    }
    if (std::isinf(t.mu)) {
      return {t.n, t.t1, -t.t1, t.t2, -t.t2};
    }
    std::vector<Vector3> out;
    for (int k = 0; k < rays_of_cone; ++k) {
      const double angle = 2.0 * M_PI * k / rays_of_cone;
      // What lies along an axis does so exactly.
      const double c1 = k % 4 == 0 ? (k == 0 ? 1.0 : k == 8 ? -1.0 : 0.0) : std::cos(angle);
      const double c2 = k % 4 == 0 ? (k == 4 ? 1.0 : k == 12 ? -1.0 : 0.0) : std::sin(angle);
      out.emplace_back(t.n + t.mu * (c1 * t.t1 + c2 * t.t2));
    }
    return out;
  }

  /// Accelerations that the constraints allow, and forces inside the cones that bring them about.
  std::optional<Solution> solve(const std::vector<Choice>& choices) {
    if (std::any_of(choices.begin(), choices.end(), [&](const Choice& c) {
          const Touch& t = touches_[static_cast<std::size_t>(&c - choices.data())];
          return std::isinf(t.mu) && (c.does == Does::slides || c.does == Does::begins);
        })) {
      return std::nullopt;  // what is rough does not slide
    }
    for (int round = 0; round < 3; ++round) {
      std::optional<Solution> found = solve_once(choices);
      if (found || !realign(choices)) {
        return found;
      }
    }
    return std::nullopt;
  }

  /// The cones' rays along the forces that came nearest; false where they are already.
  bool realign(const std::vector<Choice>& choices) {
    bool turned = false;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      Touch& t = touches_[k];
      const Vector3 f = nearest_[k] - t.n * t.n.dot(nearest_[k]);
      if (choices[k].does == Does::sticks && f.norm() > 0.0 &&
          f.cross(t.t1).norm() > 1e-12 * f.norm()) {
        align(t, f);
        turned = true;
      }
    }
    return turned;
  }

  std::optional<Solution> solve_once(const std::vector<Choice>& choices) {
    const Constraints held = constraints(choices);
    VectorXd start = VectorXd::Zero(unknowns_);
    MatrixXd free = MatrixXd::Identity(unknowns_, unknowns_);
    if (held.rows.rows() > 0 && unknowns_ > 0) {
      Eigen::CompleteOrthogonalDecomposition<MatrixXd> by_rows;
      by_rows.setThreshold(rank_threshold);
      by_rows.compute(held.rows);
      start = by_rows.solve(-held.driven);
      if ((held.rows * start + held.driven).lpNorm<Eigen::Infinity>() > solve_roundoff * load_) {
        return std::nullopt;
      }
      Eigen::ColPivHouseholderQR<MatrixXd> by_columns;
      by_columns.setThreshold(rank_threshold);
      by_columns.compute(held.rows.transpose());
      const MatrixXd all = by_columns.householderQ() * MatrixXd::Identity(unknowns_, unknowns_);
      free = all.rightCols(unknowns_ - by_columns.rank());
    }
    // Rows: m/s^2 of each body, and of its rim where it could turn.
    std::vector<Index> at(group_.bodies.size(), 0);
    Index rows = 0;
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      at[i] = rows;
      rows += !moves(group_.bodies[i]) ? 0 : can_turn(i) ? 6 : 3;
    }
    struct Ray {
      std::size_t touch;
      Vector3 push;
    };
    std::vector<Ray> pushes;
    std::vector<VectorXd> columns;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      if (choices[k].does == Does::opens) {
        continue;
      }
      const Touch& t = touches_[k];
      const ContactManifold& m = group_.patches[t.patch].manifold;
      for (const Vector3& push : rays(t, choices[k])) {
        for (std::size_t j = 0; j < m.size; ++j) {
          VectorXd column = VectorXd::Zero(rows);
          for (const auto& [i, sign] : {std::pair{t.a, -1.0}, std::pair{t.b, 1.0}}) {
            const GroupBody& body = group_.bodies[i];
            if (!moves(body)) {
              continue;
            }
            column.segment<3>(at[i]) = sign * body.inverse_mass * push;
            if (can_turn(i)) {
              const Vector3 lever = arm(t, i, m.points[j].position);
              column.segment<3>(at[i] + 3) =
                  sign * group_.radius[i] * (body.inverse_inertia * lever.cross(push));
            }
          }
          pushes.push_back({k, push});
          columns.push_back(std::move(column));
        }
      }
    }
    const Index n = free.cols();
    MatrixXd A(rows, n + static_cast<Index>(columns.size()));
    VectorXd b(rows);
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      if (!moves(group_.bodies[i])) {
        continue;
      }
      b.segment<3>(at[i]) = scaled(i, start).linear - group_.loads[i].linear;
      for (Index k = 0; k < n; ++k) {
        A.block<3, 1>(at[i], k) = -scaled(i, free.col(k)).linear;
      }
      if (can_turn(i)) {
        const double r = group_.radius[i];
        b.segment<3>(at[i] + 3) = r * (scaled(i, start).angular - group_.loads[i].angular);
        for (Index k = 0; k < n; ++k) {
          A.block<3, 1>(at[i] + 3, k) = -r * scaled(i, free.col(k)).angular;
        }
      }
    }
    VectorXd length = VectorXd::Ones(A.cols());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const Index column = n + static_cast<Index>(k);
      length[column] = std::max(columns[k].norm(), 1e-300);
      A.col(column) = columns[k] / length[column];
    }
    const NonnegativeSolution answer = solve_nonnegative(A, b, n);
    mode_.solves += answer.solves;
    Solution found;
    found.choices = choices;
    found.force.assign(touches_.size(), Vector3::Zero());
    for (std::size_t k = 0; k < pushes.size(); ++k) {
      const Index column = n + static_cast<Index>(k);
      found.force[pushes[k].touch] += answer.x[column] / length[column] * pushes[k].push;
    }
    nearest_ = found.force;
    if (answer.residual > solve_roundoff * load_) {
      return std::nullopt;
    }
    const VectorXd z = start + free * answer.x.head(n);
    found.accelerations = group_.loads;
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      if (moves(group_.bodies[i])) {
        found.accelerations[i] = scaled(i, z);
      }
    }
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const Touch& t = touches_[k];
      if (choices[k].does == Does::opens &&
          t.n.dot(relative(t, found.accelerations)) < -solve_roundoff * load_) {
        return std::nullopt;
      }
    }
    return found;
  }

  [[nodiscard]] bool can_turn(std::size_t i) const {
    return !group_.bodies[i].inverse_inertia.isZero(0.0);
  }

  // --- What was found ---------------------------------------------------------------------------

  void take(const Solution& found) {
    mode_.accelerations = found.accelerations;
    bool any = false;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const Touch& t = touches_[k];
      if (found.choices[k].does == Does::opens) {
        continue;
      }
      mode_.kept[t.patch] = 1;
      mode_.force[t.patch] = found.force[k];
      mode_.pressing[t.patch] = std::max(t.n.dot(found.force[k]), 0.0);
      any = any || mode_.pressing[t.patch] > 0.0;
    }
    if (!any && !options_.unloaded) {
      refuse("nothing presses");
      return;
    }
    slow_down(found.choices);
    clean();
    for (std::size_t k = 0; k < touches_.size() && mode_.refusal.empty(); ++k) {
      if (found.choices[k].does != Does::opens) {
        follow(touches_[k], found.choices[k]);
      }
    }
  }

  /// Nothing is left along the normals, nor where it sticks: the nearest velocities, as the kinetic
  /// energy measures.
  void slow_down(const std::vector<Choice>& choices) {
    for (int round = 0; round < 2 && unknowns_ > 0; ++round) {
      const Constraints held = constraints(choices);
      if (held.rates.isZero(0.0)) {
        return;
      }
      Eigen::CompleteOrthogonalDecomposition<MatrixXd> by_rows;
      by_rows.setThreshold(rank_threshold);
      by_rows.compute(held.rows);
      const VectorXd z = by_rows.solve(-held.rates);
      for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
        const Twist change = scaled(i, z);
        mode_.velocities[i].linear += change.linear;
        mode_.velocities[i].angular += change.angular;
      }
    }
  }

  /// Roundoff of what was solved for to be nothing is nothing.
  void clean() {
    for (std::size_t i = 0; i < group_.bodies.size(); ++i) {
      if (!moves(group_.bodies[i])) {
        continue;
      }
      const double r = std::max(group_.radius[i], 1e-300);
      const double v = project_roundoff * fastest_;
      const double a = 0.01 * solve_roundoff * load_;
      for (int axis = 0; axis < 3; ++axis) {
        for (auto& [x, least] : {std::pair<double&, double>{mode_.velocities[i].linear[axis], v},
                                 {mode_.velocities[i].angular[axis], v / r},
                                 {mode_.accelerations[i].linear[axis], a},
                                 {mode_.accelerations[i].angular[axis], a / r}}) {
          x = std::abs(x) <= least ? 0.0 : x;
        }
      }
    }
  }

  /// What a touch does from here on, and how long it slides.
  void follow(const Touch& t, const Choice& choice) {
    const GroupPatch& patch = group_.patches[t.patch];
    const Vector3 v = mode_.velocities[t.b].linear - mode_.velocities[t.a].linear;
    Vector3 a = mode_.accelerations[t.b].linear - mode_.accelerations[t.a].linear;
    const bool plane = patch.manifold.face_of_a || patch.manifold.face_of_b;
    if (!plane && (v.norm() > project_roundoff * fastest_ + patch.rest_speed * 1e-3 ||
                   a.norm() > solve_roundoff * load_)) {
      refuse("a contact moves along a curved surface or over an edge");
      return;
    }
    if (t.mu == 0.0) {
      return;
    }
    mode_.slip[t.patch] = choice.does == Does::sticks   ? Slip::sticks
                          : choice.does == Does::begins ? Slip::begins
                                                        : Slip::slides;
    if (choice.does != Does::slides) {
      return;
    }
    a = relative(t, mode_.accelerations);
    a -= t.n * t.n.dot(a);
    const double along = a.dot(choice.direction);
    // Nearly stopped, it is on the line on which it stops.
    const bool slow = t.slip.norm() <= 128.0 * still();
    if (!slow && (a - along * choice.direction).norm() > solve_roundoff * load_) {
      mode_.curved = true;
      refuse("a body slides on a curved path");
      return;
    }
    if (along < 0.0) {
      mode_.slip_ends[t.patch] = t.slip.dot(choice.direction) / -along;
    }
  }

  const ContactGroup& group_;
  const FlatModeOptions& options_;
  double load_ = 0.0;
  double fastest_ = 0.0;  ///< m/s
  Index unknowns_ = 0;
  std::vector<Index> first_;  ///< by body: of its unknowns
  std::vector<Touch> touches_;
  std::vector<Vector3> nearest_;  ///< forces of the last attempt, by touch
  FlatMode mode_;
};

/// Whether nothing slides or would: friction has nothing to do.
bool idle(const ContactGroup& group, const FlatMode& mode) {
  double load = 0.0;
  for (const Twist& l : group.loads) {
    load = std::max(load, l.linear.norm());
  }
  for (std::size_t p = 0; p < group.patches.size(); ++p) {
    const GroupPatch& patch = group.patches[p];
    if (mode.kept[p] == 0 || patch.friction == 0.0) {
      continue;
    }
    const Twist& va = mode.velocities[patch.a];
    const Twist& vb = mode.velocities[patch.b];
    const Vector3 a = mode.accelerations[patch.b].linear - mode.accelerations[patch.a].linear;
    if (!(vb.linear + patch.drift - va.linear).isZero(0.0) || !a.isZero(0.0) ||
        !va.angular.isZero(0.0) || !vb.angular.isZero(0.0)) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool has_friction(const ContactGroup& group) {
  return std::any_of(group.patches.begin(), group.patches.end(),
                     [](const GroupPatch& patch) { return patch.friction > 0.0; });
}

FlatMode friction_mode(const ContactGroup& group, const FlatModeOptions& options) {
  return Attempt(group, options).result();
}

FlatMode contact_mode(const ContactGroup& group, const FlatModeOptions& options) {
  if (!has_friction(group)) {
    return flat_mode(group, options);
  }
  FlatMode smooth = flat_mode(group, options);
  if (!smooth.refusal.empty() || !idle(group, smooth)) {
    return friction_mode(group, options);
  }
  const std::size_t n = group.patches.size();
  smooth.slip.assign(n, Slip::none);
  smooth.force.assign(n, Vector3::Zero());
  smooth.slip_ends.assign(n, std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < n; ++p) {
    const GroupPatch& patch = group.patches[p];
    if (smooth.kept[p] != 0) {
      smooth.slip[p] = patch.friction > 0.0 ? Slip::sticks : Slip::none;
      smooth.force[p] = smooth.pressing[p] * patch.manifold.normal;
    }
  }
  return smooth;
}

}  // namespace core
}  // namespace kairos
