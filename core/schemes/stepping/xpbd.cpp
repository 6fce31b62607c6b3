#include "core/schemes/stepping/xpbd.hpp"

#include "core/schemes/stepping/step_world.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

/// What a contact is to the position solve, beside its frame.
struct Projection {
  Vector3 on_a = Vector3::Zero();  ///< the deepest point of a, in the frame of a
  Vector3 on_b = Vector3::Zero();
  double lambda = 0.0;    ///< of the normal, kg m
  double approach = 0.0;  ///< before positions were solved, m/s
};

class Solver {
 public:
  Solver(StepWorld& world, const TimeSteppingOptions& options) : world_(world), options_(options) {}

  /// Prepares the contacts, which were found where bodies are now that they moved without contacts.
  void prepare() {
    projections_.clear();
    for (StepContact& c : world_.contacts()) {
      const Pose& a = world_.bodies()[c.a].pose;
      const Pose& b = world_.bodies()[c.b].pose;
      const Vector3 half = 0.5 * c.gap * c.normal_W();
      projections_.push_back({a.to_body(a.position + c.arm_a_W - half),
                              b.to_body(b.position + c.arm_b_W + half), 0.0,
                              -world_.velocity(c)[0]});
      c.impulse.setZero();
    }
  }

  void solve_positions() {
    for (std::size_t k = 0; k < projections_.size(); ++k) {
      separate(world_.contacts()[k], projections_[k]);
      hold(world_.contacts()[k], projections_[k]);
    }
    world_.count_solves(projections_.size());
  }

  /// Derives velocities from the changes of positions in h.
  void derive_velocities() {
    const double h = world_.h();
    for (const BodyIndex i : world_.model().free_by_name()) {
      const Pose& from = world_.start()[i].pose;
      BodyState& now = world_.bodies()[i];
      now.twist.linear = (now.pose.position - from.position) / h;
      if (world_.model().rotates(i)) {
        const Quaternion q = now.pose.orientation * from.orientation.conjugate();
        const double sign = q.w() >= 0.0 ? 2.0 : -2.0;
        now.twist.angular = sign / h * Vector3(q.x(), q.y(), q.z());
      }
    }
  }

  void solve_velocities() {
    for (std::size_t k = 0; k < projections_.size(); ++k) {
      StepContact& c = world_.contacts()[k];
      const Projection& projection = projections_[k];
      if (projection.lambda <= 0.0) {
        continue;
      }
      slide(c, projection.lambda);
      rebound(c, projection.approach);
    }
    world_.count_solves(projections_.size());
  }

 private:
  /// The share of a unit impulse along n that moves the point, 1/kg.
  double response(BodyIndex i, const Vector3& arm, const Vector3& n) const {
    if (!world_.model().is_free(i)) {
      return 0.0;
    }
    const Vector3 lever = arm.cross(n);
    const Matrix3 inverse = world_.inverse_inertia(i, world_.bodies()[i].pose.orientation);
    return world_.inverse_mass(i) + lever.dot(inverse * lever);
  }

  void displace(BodyIndex i, const Vector3& arm, const Vector3& p) {
    if (!world_.model().is_free(i)) {
      return;
    }
    Pose& pose = world_.bodies()[i].pose;
    pose.position += world_.inverse_mass(i) * p;
    if (world_.model().rotates(i)) {
      const Vector3 turn = world_.inverse_inertia(i, pose.orientation) * arm.cross(p);
      const Quaternion& q = pose.orientation;
      const Quaternion rate = Quaternion(0.0, turn.x(), turn.y(), turn.z()) * q;
      pose.orientation = Quaternion(q.w() + 0.5 * rate.w(), q.x() + 0.5 * rate.x(),
                                    q.y() + 0.5 * rate.y(), q.z() + 0.5 * rate.z())
                             .normalized();
    }
  }

  /// Both points where bodies are now, in the world, from the origins.
  std::pair<Vector3, Vector3> arms(const StepContact& c, const Projection& projection) const {
    return {world_.bodies()[c.a].pose.orientation * projection.on_a,
            world_.bodies()[c.b].pose.orientation * projection.on_b};
  }

  void apply(StepContact& c, const Vector3& arm_a, const Vector3& arm_b, const Vector3& p) {
    displace(c.a, arm_a, -p);
    displace(c.b, arm_b, p);
    c.impulse += c.frame_W.transpose() * p / world_.h();
  }

  void separate(StepContact& c, Projection& projection) {
    const auto [arm_a, arm_b] = arms(c, projection);
    const Vector3 n = c.normal_W();
    const double depth = n.dot(world_.bodies()[c.a].pose.position + arm_a -
                               world_.bodies()[c.b].pose.position - arm_b);
    if (depth <= 0.0) {
      return;
    }
    const double alpha = options_.compliance / (world_.h() * world_.h());
    const double w = response(c.a, arm_a, n) + response(c.b, arm_b, n);
    const double change = (depth - alpha * projection.lambda) / (w + alpha);
    projection.lambda += change;
    apply(c, arm_a, arm_b, change * n);
  }

  /// Static friction: takes back what the points have moved along each other in this substep.
  void hold(StepContact& c, const Projection& projection) {
    if (projection.lambda <= 0.0 || c.friction == 0.0) {
      return;
    }
    const auto [arm_a, arm_b] = arms(c, projection);
    const auto moved = [this](BodyIndex i, const Vector3& arm, const Vector3& point_B) {
      return Vector3(world_.bodies()[i].pose.position + arm -
                     world_.start()[i].pose.to_world(point_B));
    };
    const Vector3 n = c.normal_W();
    Vector3 slip = moved(c.b, arm_b, projection.on_b) - moved(c.a, arm_a, projection.on_a) +
                   world_.h() * (c.frame_W * world_.belt_velocity(c));
    slip -= n.dot(slip) * n;
    const double distance = slip.norm();
    if (distance == 0.0) {
      return;
    }
    const Vector3 d = slip / distance;
    const double lambda = distance / (response(c.a, arm_a, d) + response(c.b, arm_b, d));
    if (lambda < c.friction * projection.lambda) {
      apply(c, arm_a, arm_b, -lambda * d);
    }
  }

  void give(StepContact& c, const Vector3& impulse) {
    world_.push(c, impulse);
    c.impulse += impulse;
  }

  void slide(StepContact& c, double lambda) {
    const Vector3 u = world_.velocity(c);
    const double slip = u.tail<2>().norm();
    if (slip == 0.0 || c.friction == 0.0) {
      return;
    }
    const Vector3 d(0.0, u[1] / slip, u[2] / slip);
    const double stopping = slip / d.dot(c.compliance * d);
    give(c, -std::min(c.friction * lambda / world_.h(), stopping) * d);
  }

  void rebound(StepContact& c, double approach) {
    const double g = std::max(world_.acceleration(c.a), world_.acceleration(c.b));
    const double e = approach <= 2.0 * g * world_.h() ? 0.0 : c.restitution;
    const double change = std::max(e * approach, 0.0) - world_.velocity(c)[0];
    give(c, Vector3(change / c.compliance(0, 0), 0.0, 0.0));
  }

  StepWorld& world_;
  const TimeSteppingOptions& options_;
  std::vector<Projection> projections_;
};

class Xpbd final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {.name = "xpbd",
            .summary = "extended position based dynamics: substeps that move overlaps apart",
            .source = "Mueller2020",
            .friction = true,
            .integrator = "symplectic-euler"};
  }
  [[nodiscard]] std::string refuses(const Model& model, const Method& method,
                                    const SchemeOptions&) const override {
    return stepping_refusal(model, method);
  }
  RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                Recorder& recorder) const override {
    const TimeSteppingOptions& stepping = options.stepping;
    StepWorld world(model, method, options, recorder,
                    stepping.substeps > 0 ? stepping.substeps : 20, Corrects::yes);
    Solver solver(world, options.stepping);
    std::vector<Pose> poses;
    return run_steps(world, [&] {
      world.kick();
      world.move(1.0);
      poses.clear();
      for (const BodyState& body : world.bodies()) {
        poses.push_back(body.pose);
      }
      world.find_contacts(poses);
      solver.prepare();
      for (std::int64_t i = 0; i < std::max<std::int64_t>(stepping.iterations, 1); ++i) {
        solver.solve_positions();
      }
      solver.derive_velocities();
      solver.solve_velocities();
    });
  }
};

}  // namespace

std::unique_ptr<Scheme> make_xpbd() { return std::make_unique<Xpbd>(); }

}  // namespace core
}  // namespace kairos
