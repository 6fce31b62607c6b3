#include "core/contacts/completion.hpp"

#include "core/circular.hpp"
#include "core/contacts/nonnegative_solve.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rays that stand for a cone of friction, which is hardly wider than their hull.
constexpr int rays_of_cone = 16;

/// Directions in which a point may push; what friction without a bound does needs no normal force.
std::vector<Vector3> rays(const PushPoint& p) {
  if (p.friction == 0.0) {
    return {p.normal};
  }
  const Vector3 t1 = p.normal.unitOrthogonal();
  const Vector3 t2 = p.normal.cross(t1);
  if (std::isinf(p.friction)) {
    return {p.normal, t1, -t1, t2, -t2};
  }
  std::vector<Vector3> out{p.normal};
  for (int k = 0; k < rays_of_cone; ++k) {
    const double angle = 2.0 * M_PI * k / rays_of_cone;
    out.push_back((p.normal + p.friction * (cosine(angle) * t1 + sine(angle) * t2)).normalized());
  }
  return out;
}

}  // namespace

double pulled(const std::vector<GroupBody>& bodies, std::span<const double> radius,
              std::span<const PushPoint> points, std::span<const Twist> before,
              std::span<const Twist> after, const GroupJoints* joints) {
  std::vector<Index> row(bodies.size(), -1);
  Index rows = 0;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (moves(bodies[k])) {
      row[k] = rows;
      rows += 6;
    }
  }
  VectorXd change(rows);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (row[k] >= 0) {
      change.segment<3>(row[k]) = after[k].linear - before[k].linear;
      change.segment<3>(row[k] + 3) = radius[k] * (after[k].angular - before[k].angular);
    }
  }
  std::vector<VectorXd> columns;
  for (const PushPoint& p : points) {
    for (const Vector3& direction : rays(p)) {
      VectorXd column = VectorXd::Zero(rows);
      if (joints != nullptr) {
        VectorXd given = VectorXd::Zero(static_cast<Index>(6 * bodies.size()));
        for (const auto& [k, sign] : std::array{std::pair{p.a, -1.0}, std::pair{p.b, 1.0}}) {
          const auto at = static_cast<Index>(6 * k);
          given.segment<3>(at) = sign * bodies[k].inverse_mass * direction;
          given.segment<3>(at + 3) =
              sign * (bodies[k].inverse_inertia * (p.point - bodies[k].position).cross(direction));
        }
        joints->pass_on(given);
        for (std::size_t k = 0; k < bodies.size(); ++k) {
          if (row[k] >= 0) {
            const auto at = static_cast<Index>(6 * k);
            column.segment<3>(row[k]) = given.segment<3>(at);
            column.segment<3>(row[k] + 3) = radius[k] * given.segment<3>(at + 3);
          }
        }
      }
      for (const auto& [k, sign] : std::array{std::pair{p.a, -1.0}, std::pair{p.b, 1.0}}) {
        if (row[k] < 0 || joints != nullptr) {
          continue;
        }
        const GroupBody& body = bodies[k];
        const Vector3 arm = p.point - body.position;
        column.segment<3>(row[k]) = sign * body.inverse_mass * direction;
        column.segment<3>(row[k] + 3) =
            sign * radius[k] * (body.inverse_inertia * arm.cross(direction));
      }
      const double length = column.norm();
      if (length > 0.0) {
        columns.push_back(column / length);
      }
    }
  }
  MatrixXd pushes(rows, static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    pushes.col(static_cast<Index>(k)) = columns[k];
  }
  return solve_nonnegative(pushes, change, 0).residual;
}

}  // namespace core
}  // namespace kairos
