#include "core/reading/orientation_reader.hpp"

#include "core/reading/scene_limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

Quaternion from_components(const Item& item) {
  const std::vector<double> q = item.numbers(4, limits::component);
  const Eigen::Vector4d c(q[0], q[1], q[2], q[3]);
  const double norm = c.stableNorm();
  if (!(std::abs(norm - 1.0) <= limits::quaternion_norm)) {
    item.fail(
        fmt::format("has norm {}; allowed: a unit quaternion [w, x, y, z], norm within {} "
                    "of 1",
                    norm, limits::quaternion_norm));
  }
  return Quaternion(c[0], c[1], c[2], c[3]).normalized();
}

}  // namespace

Vector3 read_direction(const Item& item, const Vector3& v) {
  const double norm = v.stableNorm();
  if (!(norm > 0.0)) {
    item.fail("has length 0; allowed: any other direction");
  }
  // One that is unit to its roundings stays as it was written.
  const bool unit = std::abs(v.squaredNorm() - 1.0) <= 4.0 * std::numeric_limits<double>::epsilon();
  return unit ? v : (v / norm).normalized();
}

Quaternion read_orientation(const TableReader& table) {
  const auto components = table.find("orientation");
  const auto turn = table.find("axis_angle");
  if (components && turn) {
    turn->fail("orientation is given too; allowed: one of orientation and axis_angle");
  }
  if (components) {
    return from_components(*components);
  }
  if (turn) {
    const std::vector<double> x = turn->numbers(4, limits::component);
    const Vector3 axis = read_direction(*turn, {x[0], x[1], x[2]});
    return rotate(x[3] * axis, Quaternion::Identity()).normalized();
  }
  return Quaternion::Identity();
}

}  // namespace core
}  // namespace kairos
