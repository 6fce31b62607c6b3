#include "ccd/polish.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;
/// A face or a pair of edges is tried if its direction is off by less, rad.
constexpr double snapping = 2e-3;
/// A direction that is across an edge within this angle stays across it, rad.
constexpr double pinned = 1e-4;
constexpr int most_steps = 12;

class Polish {
 public:
  Polish(const CorePair& pair, Vector3& n, double& separation)
      : pair_(pair), n_(n), separation_(separation) {}

  void snap(const Vector3& r) {
    const Vector3 n = n_;
    const auto normal = [&](const Matrix3& R, double sign) {
      return [this, &R, sign, &n](const Vector3& x) { try_near(sign * (R * x), n); };
    };
    const auto across = [&](const Vector3& e) { try_near(r - e * e.dot(r), n); };
    pair_.a.nearby(m_a(), normal(pair_.R_WA, 1.0), [&](const Vector3& a) {
      const Vector3 edge_a = pair_.R_WA * a;
      if (std::abs(edge_a.dot(n)) > snapping) {
        return;
      }
      across(edge_a);
      pair_.b.nearby(
          m_b(), [](const Vector3&) {},
          [&](const Vector3& b) {
            const Vector3 cross = edge_a.cross(pair_.R_WB * b);
            try_near(cross.dot(n) < 0.0 ? Vector3(-cross) : cross, n);
          });
    });
    pair_.b.nearby(m_b(), normal(pair_.R_WB, -1.0), [&](const Vector3& b) {
      const Vector3 edge_b = pair_.R_WB * b;
      if (std::abs(edge_b.dot(n)) <= snapping) {
        across(edge_b);
      }
    });
  }

  /// One step of Newton's method; false if it does not separate better.
  bool step() {
    find_pins();
    if (pins_ <= 1) {
      return step_pinned();
    }
    // Nearly across an edge of each, it is across one of them, or across both, which was tried.
    const std::array<Vector3, 2> pins = both_;
    pins_ = 1;
    for (const Vector3& pin : pins) {
      pin_ = pin;
      if (step_pinned()) {
        return true;
      }
    }
    return false;
  }

 private:
  /// The same, staying across the edge that there is.
  bool step_pinned() {
    const DifferencePoint p = pair_.support(n_);
    // On the unit sphere a function of degree 1 bends by its own value more.
    const Matrix3 H = curvature(pair_.a, pair_.R_WA, m_a()) +
                      curvature(pair_.b, pair_.R_WB, m_b()) +
                      std::max(0.0, separation_) * Matrix3::Identity();
    Vector3 along = Vector3::Zero();
    if (pins_ == 1) {
      const Vector3 t = n_.cross(pin_).normalized();
      const double bend = t.dot(H * t);
      if (!(bend > 0.0)) {
        return false;
      }
      along = t * (t.dot(p.w) / bend);
    } else if (!solve_across(H, p.w, along)) {
      return false;
    }
    double part = 1.0;
    for (int i = 0; i < 6; ++i, part *= 0.25) {
      Vector3 next = n_ + part * along;
      if (pins_ == 1) {
        next -= pin_ * pin_.dot(next);
      }
      if (try_along(next)) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] Vector3 m_a() const { return pair_.R_WA.transpose() * n_; }
  [[nodiscard]] Vector3 m_b() const { return -(pair_.R_WB.transpose() * n_); }

  void find_pins() {
    pins_ = 0;
    const auto pin = [this](const Matrix3& R) {
      return [this, &R](const Vector3& e) {
        const Vector3 edge = R * e;
        if (std::abs(edge.dot(n_)) < pinned) {
          pin_ = edge;
          both_[pins_ < 1 ? 0 : 1] = edge;
          ++pins_;
        }
      };
    };
    const auto none = [](const Vector3&) {};
    pair_.a.nearby(m_a(), none, pin(pair_.R_WA));
    pair_.b.nearby(m_b(), none, pin(pair_.R_WB));
  }

  /// Second derivative of the support, world axes.
  static Matrix3 curvature(const ConvexCore& core, const Matrix3& R, const Vector3& m) {
    const ConvexCore::Bend bend = core.bend(m);
    const Vector3 tangent = R * bend.tangent;
    return bend.radius * (tangent * tangent.transpose());
  }

  /// H x = w within the plane across n, if it is known in all directions of it.
  bool solve_across(const Matrix3& H, const Vector3& w, Vector3& x) const {
    int least = 0;
    n_.cwiseAbs().minCoeff(&least);
    const Vector3 s = n_.cross(Vector3::Unit(least)).normalized();
    const Vector3 t = n_.cross(s);
    const double ss = s.dot(H * s);
    const double st = s.dot(H * t);
    const double tt = t.dot(H * t);
    const double determinant = ss * tt - st * st;
    if (!(determinant > 1e-6 * (ss + tt) * (ss + tt))) {
      return false;
    }
    const double ws = w.dot(s);
    const double wt = w.dot(t);
    x = ((tt * ws - st * wt) / determinant) * s + ((ss * wt - st * ws) / determinant) * t;
    return true;
  }

  void try_near(const Vector3& x, const Vector3& n) {
    const double length = x.norm();
    if (length > 0.0 && (x / length - n).squaredNorm() <= snapping * snapping) {
      try_along(x);
    }
  }

  bool try_along(const Vector3& x) {
    const double length = x.norm();
    if (!(length > 0.0)) {
      return false;
    }
    const Vector3 unit = x / length;
    const double separation = pair_.separation(unit);
    if (!(separation > separation_)) {
      return false;
    }
    separation_ = separation;
    n_ = unit;
    return true;
  }

  const CorePair& pair_;
  Vector3& n_;
  double& separation_;
  Vector3 pin_ = Vector3::Zero();
  std::array<Vector3, 2> both_;  ///< of several, the first and the last
  int pins_ = 0;
};

/// How deep 0 is inside a tetrahedron of points that are off by `error`; 0 where that is not
/// proven.
double depth_inside(const std::array<Vector3, 4>& x, double error) {
  constexpr std::array<std::array<std::size_t, 3>, 4> faces{
      {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  double sign = 0.0;
  double depth = infinity;
  for (const auto& [i, j, k] : faces) {
    const Vector3 side_1 = x[j] - x[i];
    const Vector3 side_2 = x[k] - x[i];
    const double turning = side_1.cross(side_2).dot(x[i]);
    const double areas =
        x[i].cross(x[j]).norm() + x[j].cross(x[k]).norm() + x[k].cross(x[i]).norm();
    const double doubt = 2.0 * error * areas +
                         4.0 * error * error * (x[i].norm() + x[j].norm() + x[k].norm()) +
                         16.0 * u * side_1.norm() * side_2.norm() * x[i].norm();
    if (!(std::abs(turning) > doubt) || (sign != 0.0 && (turning > 0.0) != (sign > 0.0))) {
      return 0.0;
    }
    sign = turning;
    depth = std::min(depth, (std::abs(turning) - doubt) / side_1.cross(side_2).norm());
  }
  return depth * (1.0 - 64.0 * u);
}

}  // namespace

void polish(const CorePair& pair, const Vector3& r, Vector3& n, double& separation) {
  Polish polishing(pair, n, separation);
  polishing.snap(r);
  if (!pair.a.is_round() && !pair.b.is_round()) {
    return;
  }
  for (int i = 0; i < most_steps && polishing.step(); ++i) {
  }
  polishing.snap(r);
  polishing.snap(r);  // a cone's side turns with n
}

double depth_by_tetrahedron(const CorePair& pair, const Vector3& n, double depth, double error) {
  if (!pair.a.is_round() && !pair.b.is_round()) {
    return 0.0;
  }
  int least = 0;
  n.cwiseAbs().minCoeff(&least);
  const Vector3 s = n.cross(Vector3::Unit(least)).normalized();
  const Vector3 t = n.cross(s);
  std::array<Vector3, 4> x;
  x[3] = pair.support(-n).w;
  const double fit = std::sqrt(depth / pair.size());
  for (const double spread : {fit, 0.3 * fit, 0.1 * fit, 3.0 * fit, 10.0 * fit}) {
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr std::array<double, 3> cosines{1.0, -0.5, -0.5};
      constexpr std::array<double, 3> sines{0.0, 0.8660254037844386, -0.8660254037844386};
      x[k] = pair.support((n + spread * (cosines[k] * s + sines[k] * t)).normalized()).w;
    }
    const double proven = depth_inside(x, error);
    if (proven > 0.0) {
      return proven;
    }
  }
  return 0.0;
}

}  // namespace kairos::ccd
