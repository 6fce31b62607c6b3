// What a spinning box passes: nearest points and the directions between them.

#include "ccd/spun_box.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <Eigen/Geometry>

#include <numbers>

using namespace kairos;

namespace {

Vector3 vector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Matrix3 axes(Random& random) {
  return Quaternion(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                    random.uniform(-1, 1))
      .normalized()
      .toRotationMatrix();
}

Vector3 extents(Random& random) {
  return {random.log_uniform(1e-2, 1.0), random.log_uniform(1e-2, 1.0),
          random.log_uniform(1e-2, 1.0)};
}

}  // namespace

TEST_CASE("The nearest point of what a box passes is no farther than any corner at any angle",
          "[ccd][spun]") {
  Random random(31);
  for (int n = 0; n < 200; ++n) {
    const Vector3 half = extents(random), centre = vector(random), w = vector(random);
    const Matrix3 R = axes(random);
    const ccd::SpunBox box = ccd::SpunBox::spinning(half, centre, R, w);
    const Vector3 x = centre + 2.0 * vector(random);
    const Vector3 nearest = box.nearest(x);
    // A projection onto a convex set: all of it is on the far side of the plane through the point.
    const Vector3 out = x - nearest;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 p = R * Vector3((corner & 1) != 0 ? half.x() : -half.x(),
                                    (corner & 2) != 0 ? half.y() : -half.y(),
                                    (corner & 4) != 0 ? half.z() : -half.z());
      for (int k = 0; k < 64; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / 64.0;
        const Vector3 y = centre + Eigen::AngleAxisd(angle, w.normalized()) * p;
        CHECK(out.dot(y - nearest) <= 1e-14);  // some roundings of lengths of 1
      }
    }
    // And it belongs to the set: it projects onto itself.
    CHECK((box.nearest(nearest) - nearest).norm() <= 1e-14);
  }
}

TEST_CASE("The direction between two spinning boxes separates all that they pass", "[ccd][spun]") {
  Random random(32);
  int apart = 0;
  for (int n = 0; n < 200; ++n) {
    const Vector3 h_a = extents(random), h_b = extents(random), w_a = vector(random),
                  w_b = vector(random);
    const Matrix3 R_a = axes(random), R_b = axes(random);
    const Vector3 d = 2.0 * vector(random);
    const ccd::SpunBox a = ccd::SpunBox::spinning(h_a, Vector3::Zero(), R_a, w_a);
    const ccd::SpunBox b = ccd::SpunBox::spinning(h_b, d, R_b, w_b);
    const Vector3 direction = ccd::direction_between(a, b, Vector3::Zero());
    if (direction.norm() < 1e-6) {
      continue;
    }
    ++apart;
    const Vector3 n_ab = direction.normalized();
    const auto support = [](const Vector3& half, const Matrix3& R, const Vector3& w,
                            const Vector3& m) {
      double most = 0.0;
      const Vector3 axis = w.normalized();
      for (int corner = 0; corner < 8; ++corner) {
        const Vector3 p = R * Vector3((corner & 1) != 0 ? half.x() : -half.x(),
                                      (corner & 2) != 0 ? half.y() : -half.y(),
                                      (corner & 4) != 0 ? half.z() : -half.z());
        most =
            std::max(most, m.dot(axis) * p.dot(axis) + m.cross(axis).norm() * p.cross(axis).norm());
      }
      return most;
    };
    CHECK(n_ab.dot(d) - support(h_a, R_a, w_a, n_ab) - support(h_b, R_b, w_b, -n_ab) > 0.0);
  }
  CHECK(apart > 100);
}
