#include "core/contacts/contact_system.hpp"

#include "core/contacts/least_norm.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {

GroupBody group_body(const BodyInertia& inertia, const Pose& pose) {
  GroupBody body;
  body.position = pose.position;
  if (!(inertia.mass > 0.0)) {
    return body;
  }
  body.inverse_mass = 1.0 / inertia.mass;
  if (inertia.rotates) {
    body.inverse_inertia = inertia.inverse(pose.orientation);
  }
  return body;
}

void ContactSystem::add(std::size_t a, std::size_t b, const Vector3& point,
                        const Vector3& direction) {
  rows.push_back({a, b, direction, point - bodies[a].position, point - bodies[b].position});
}

std::pair<Eigen::VectorXd, Eigen::VectorXd> ContactSystem::unpassed(const ContactRow& row) const {
  const auto n = static_cast<Eigen::Index>(6 * bodies.size());
  std::pair<Eigen::VectorXd, Eigen::VectorXd> out{Eigen::VectorXd::Zero(n),
                                                  Eigen::VectorXd::Zero(n)};
  const auto side = [&](std::size_t i, const Vector3& arm, double sign) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    const Vector3 moment = arm.cross(row.direction);
    out.first.segment<3>(at) += sign * row.direction;
    out.first.segment<3>(at + 3) += sign * moment;
    out.second.segment<3>(at) += sign * bodies[i].inverse_mass * row.direction;
    out.second.segment<3>(at + 3) += sign * (bodies[i].inverse_inertia * moment);
  };
  side(row.a, row.arm_a, -1.0);
  side(row.b, row.arm_b, 1.0);
  return out;
}

std::pair<Eigen::VectorXd, Eigen::VectorXd> ContactSystem::passed(const ContactRow& row) const {
  std::pair<Eigen::VectorXd, Eigen::VectorXd> out = unpassed(row);
  joints->pass_on(out.first, out.second);
  return out;
}

double ContactSystem::driven_work(const Eigen::VectorXd& impulses) const {
  double work = 0.0;
  for (std::size_t i = 0; i < rows.size() && joints != nullptr && joints->driven(); ++i) {
    const double p = impulses[static_cast<Eigen::Index>(i)];
    work += p == 0.0 ? 0.0 : p * joints->driven_work(unpassed(rows[i]).second).sum();
  }
  return work;
}

double ContactSystem::carrying_work(const Eigen::VectorXd& impulses,
                                    const std::vector<Twist>& v) const {
  double work = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ContactRow& row = rows[i];
    const double p = impulses[static_cast<Eigen::Index>(i)];
    for (const auto& [place, arm, sign] :
         {std::tuple{row.a, row.arm_a, 1.0}, {row.b, row.arm_b, -1.0}}) {
      if (!moves(bodies[place])) {
        work += sign * p * row.direction.dot(v[place].linear + v[place].angular.cross(arm));
      }
    }
  }
  return work;
}

Eigen::MatrixXd ContactSystem::coupling_through_joints() const {
  const auto n = static_cast<Eigen::Index>(rows.size());
  std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>> of_rows;
  for (const ContactRow& row : rows) {
    of_rows.push_back(passed(row));
  }
  Eigen::MatrixXd W(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = i; k < n; ++k) {
      W(i, k) = W(k, i) = of_rows[static_cast<std::size_t>(i)].first.dot(
          of_rows[static_cast<std::size_t>(k)].second);
    }
  }
  return W;
}

Eigen::MatrixXd ContactSystem::coupling() const {
  if (joints != nullptr) {
    return coupling_through_joints();
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(n, n);
  const auto felt = [this](std::size_t body, const Vector3& arm_i, const Vector3& d_i,
                           const Vector3& arm_k, const Vector3& d_k) {
    const GroupBody& g = bodies[body];
    return g.inverse_mass * d_i.dot(d_k) +
           arm_i.cross(d_i).dot(g.inverse_inertia * arm_k.cross(d_k));
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const ContactRow& r = rows[static_cast<std::size_t>(i)];
    for (Eigen::Index k = i; k < n; ++k) {
      const ContactRow& s = rows[static_cast<std::size_t>(k)];
      double sum = 0.0;
      if (r.a == s.a) sum += felt(r.a, r.arm_a, r.direction, s.arm_a, s.direction);
      if (r.b == s.b) sum += felt(r.b, r.arm_b, r.direction, s.arm_b, s.direction);
      if (r.a == s.b) sum -= felt(r.a, r.arm_a, r.direction, s.arm_b, s.direction);
      if (r.b == s.a) sum -= felt(r.b, r.arm_b, r.direction, s.arm_a, s.direction);
      W(i, k) = W(k, i) = sum;
    }
  }
  return W;
}

double ContactSystem::rate(const ContactRow& row, const std::vector<Twist>& v) const {
  const Twist& a = v[row.a];
  const Twist& b = v[row.b];
  return row.direction.dot((b.linear - a.linear) +
                           (b.angular.cross(row.arm_b) - a.angular.cross(row.arm_a)));
}

Eigen::VectorXd ContactSystem::rates(const std::vector<Twist>& v) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out[static_cast<Eigen::Index>(i)] = rate(rows[i], v);
  }
  return out;
}

void ContactSystem::push(const Eigen::VectorXd& impulses, std::vector<Twist>& v) const {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ContactRow& row = rows[i];
    if (joints != nullptr) {
      const Eigen::VectorXd given = impulses[static_cast<Eigen::Index>(i)] * passed(row).second;
      for (std::size_t k = 0; k < bodies.size(); ++k) {
        v[k].linear += given.segment<3>(static_cast<Eigen::Index>(6 * k));
        v[k].angular += given.segment<3>(static_cast<Eigen::Index>(6 * k + 3));
      }
      continue;
    }
    const Vector3 p = row.direction * impulses[static_cast<Eigen::Index>(i)];
    v[row.a].linear -= bodies[row.a].inverse_mass * p;
    v[row.a].angular -= bodies[row.a].inverse_inertia * row.arm_a.cross(p);
    v[row.b].linear += bodies[row.b].inverse_mass * p;
    v[row.b].angular += bodies[row.b].inverse_inertia * row.arm_b.cross(p);
  }
}

double ContactSystem::project(std::vector<Twist>& v, const Eigen::VectorXd* wanted) const {
  double driven = 0.0;
  if (rows.empty()) {
    return driven;
  }
  const LeastNorm decomposition(coupling());
  for (int k = 0; k < 2; ++k) {
    const Eigen::VectorXd off = wanted == nullptr ? rates(v) : Eigen::VectorXd(rates(v) - *wanted);
    const Eigen::VectorXd impulses = -decomposition.solve(off);
    push(impulses, v);
    driven += driven_work(impulses) + carrying_work(impulses, v);
  }
  return driven;
}

void ContactSystem::undo_where_faster(const std::vector<Twist>& before,
                                      std::vector<Twist>& v) const {
  constexpr double along =
      64.0 * std::numeric_limits<double>::epsilon();  // of a speed: less off a contact is along it
  const auto off = [](const ContactRow& row, const std::vector<Twist>& u) {
    return std::abs(row.direction.dot(u[row.b].linear - u[row.a].linear));
  };
  for (bool again = true; again;) {
    again = false;
    for (const ContactRow& row : rows) {
      const bool same =
          v[row.a].linear == before[row.a].linear && v[row.b].linear == before[row.b].linear;
      const double speed = v[row.a].linear.norm() + v[row.b].linear.norm();
      if (!same && off(row, v) > along * speed && off(row, v) > off(row, before)) {
        v[row.a].linear = before[row.a].linear;
        v[row.b].linear = before[row.b].linear;
        again = true;
      }
    }
  }
}

std::pair<Vector3, Vector3> contact_tangents(const ContactSystem& bodies, std::size_t a,
                                             std::size_t b, const Vector3& point, const Vector3& n,
                                             const Vector3& along) {
  Vector3 t1 = along - n * n.dot(along);
  t1 = t1.norm() > 0.0 ? Vector3(t1.normalized()) : n.unitOrthogonal();
  t1 = (t1 - n * n.dot(t1)).normalized();
  const Vector3 t2 = n.cross(t1);
  if (bodies.joints == nullptr) {
    return {t1, t2};
  }
  const auto felt = [&](const Vector3& d1, const Vector3& d2) {
    ContactSystem rows{bodies.bodies, {}, bodies.joints};
    rows.add(a, b, point, d1);
    rows.add(a, b, point, d2);
    return Eigen::Matrix2d(rows.coupling());
  };
  const Eigen::Matrix2d W = felt(t1, t2);
  if (W(0, 0) == 0.0 || W(1, 1) == 0.0) {
    return {t1, t2};  // what is blocked is one of them, or both are
  }
  // Of a singular W: what it makes nothing of.
  const Eigen::Vector2d none =
      W(0, 0) >= W(1, 1) ? Eigen::Vector2d(-W(0, 1), W(0, 0)) : Eigen::Vector2d(W(1, 1), -W(0, 1));
  const Vector3 blocked = (none[0] * t1 + none[1] * t2).normalized();
  const Vector3 free = blocked.cross(n);
  return felt(free, blocked)(1, 1) == 0.0 ? std::pair{free, blocked} : std::pair{t1, t2};
}

}  // namespace core
}  // namespace kairos
