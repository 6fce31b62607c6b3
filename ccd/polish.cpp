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
constexpr int most_rounds = 4;

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

  /// A flat end that is nearly along an edge, or another one, is nearest where its rim crosses
  /// that, and the direction is across both there: so near to the axis that a step knows no
  /// curvature.
  void cross_rims() {
    const Vector3 n = n_;
    const ConvexCore::Rim of_a = world(pair_.a.rim(m_a()), pair_.R_WA, Vector3::Zero());
    const ConvexCore::Rim of_b = world(pair_.b.rim(m_b()), pair_.R_WB, pair_.d);
    const bool flat_a = lies_flat(of_a, n);
    const bool flat_b = lies_flat(of_b, n);
    const DifferencePoint p = pair_.support(n);
    if (flat_a && flat_b) {
      return cross(of_a, of_b, n);
    }
    const auto cross_edge = [&](const ConvexCore::Rim& rim, const Vector3& x, const Matrix3& R) {
      return [this, &rim, &n, x, &R](const Vector3& e) {
        if (std::abs((R * e).dot(n)) <= snapping) {
          cross_line(rim, x, R * e, n);
        }
      };
    };
    const auto none = [](const Vector3&) {};
    // A rim that is steep is there nearly its tangent.
    const auto tangent = [](const ConvexCore::Rim& rim, const Vector3& x) {
      return Vector3(rim.axis.cross(x - rim.middle).normalized());
    };
    if (flat_a && of_b.radius > 0.0) {
      cross_line(of_a, p.on_b, tangent(of_b, p.on_b), n);
    }
    if (flat_b && of_a.radius > 0.0) {
      cross_line(of_b, p.on_a, tangent(of_a, p.on_a), n);
    }
    if (flat_a) {
      pair_.b.nearby(m_b(), none, cross_edge(of_a, p.on_b, pair_.R_WB));
    }
    if (flat_b) {
      pair_.a.nearby(m_a(), none, cross_edge(of_b, p.on_a, pair_.R_WA));
    }
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

  static ConvexCore::Rim world(const ConvexCore::Rim& rim, const Matrix3& R, const Vector3& at) {
    return {at + R * rim.middle, R * rim.axis, rim.radius};
  }
  static bool lies_flat(const ConvexCore::Rim& rim, const Vector3& n) {
    return rim.radius > 0.0 && rim.axis.cross(n).squaredNorm() <= snapping * snapping;
  }
  /// Across a rim where `out` leads to from its middle, and across e.
  void try_across(const ConvexCore::Rim& rim, const Vector3& out, const Vector3& e,
                  const Vector3& n) {
    const Vector3 x = rim.axis.cross(out).cross(e);
    try_near(x.dot(n) < 0.0 ? Vector3(-x) : x, n);
  }
  /// A rim and a line through x along e, as seen along the axis.
  void cross_line(const ConvexCore::Rim& rim, const Vector3& x, const Vector3& e,
                  const Vector3& n) {
    const auto flat = [&rim](const Vector3& v) -> Vector3 {
      return v - rim.axis * rim.axis.dot(v);
    };
    const Vector3 from = flat(x - rim.middle);
    const Vector3 along = flat(e).normalized();
    const Vector3 foot = from - along * along.dot(from);
    const double half = rim.radius * rim.radius - foot.squaredNorm();
    if (half > 0.0) {
      for (const double side : {-1.0, 1.0}) {
        try_across(rim, foot + side * std::sqrt(half) * along, e, n);
      }
    }
  }
  /// Two rims that are nearly in a plane.
  void cross(const ConvexCore::Rim& a, const ConvexCore::Rim& b, const Vector3& n) {
    const Vector3 between = b.middle - a.middle;
    const Vector3 flat = between - a.axis * a.axis.dot(between);
    const double distance = flat.norm();
    if (!(distance > 0.0)) {
      return;
    }
    const Vector3 along = flat / distance;
    // How far the line through both crossings is from the middle of a.
    const double foot = 0.5 * (distance + (a.radius - b.radius) * (a.radius + b.radius) / distance);
    const double half = a.radius * a.radius - foot * foot;
    if (half > 0.0) {
      for (const double side : {-1.0, 1.0}) {
        const Vector3 out = foot * along + side * std::sqrt(half) * a.axis.cross(along);
        const Vector3 out_b = a.middle + out - b.middle;
        try_across(a, out, b.axis.cross(out_b), n);
      }
    }
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
  for (int i = 0; i < most_rounds; ++i) {
    const double before = separation;
    for (int k = 0; k < most_steps && polishing.step(); ++k) {
    }
    polishing.snap(r);
    polishing.snap(r);  // a cone's side turns with n
    polishing.cross_rims();
    if (!(separation > before)) {
      return;
    }
  }
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
