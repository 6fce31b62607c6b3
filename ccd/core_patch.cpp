#include "ccd/core_patch.hpp"

#include "ccd/nearest_points.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "core/circular.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;
/// Number of corners that stand for a circle; some of them lie on the axes of its box.
constexpr int around = 16;
/// Heights within so many roundings of the size are level.
constexpr double level = 1024.0 * u;
/// Edges with a smaller sine lie along each other.
constexpr double parallel = 1e-6;

/// Two axes across n.
struct Plane {
  explicit Plane(const Vector3& n) {
    int least = 0;
    n.cwiseAbs().minCoeff(&least);
    s = n.cross(Vector3::Unit(least)).normalized();
    t = n.cross(s);
  }
  [[nodiscard]] double turn(const Vector3& from, const Vector3& to, const Vector3& x) const {
    const Vector3 e = to - from;
    const Vector3 r = x - from;
    return e.dot(s) * r.dot(t) - e.dot(t) * r.dot(s);
  }
  Vector3 s, t;
};

/// Calls visit(point) for what may be highest along m.
template <typename Visit>
void for_each_corner_here(const ConvexCore& core, const Vector3& m, const Visit& visit) {
  const Vector3& size = core.sizes();
  const auto rim = [&](double y) {
    const double first = arc_tangent(m.z(), m.x());
    for (int k = 0; k < around; ++k) {
      const double angle = first + 2.0 * std::numbers::pi * k / around;
      visit(Vector3(size.x() * cosine(angle), y, size.x() * sine(angle)));
    }
  };
  switch (core.kind()) {
    case ConvexCore::Kind::point:
      visit(Vector3(Vector3::Zero()));
      return;
    case ConvexCore::Kind::segment:
      visit(Vector3(0.0, -size.y(), 0.0));
      visit(Vector3(0.0, size.y(), 0.0));
      return;
    case ConvexCore::Kind::box:
      for (int k = 0; k < 8; ++k) {
        visit(box_corner(size, k));
      }
      return;
    case ConvexCore::Kind::cylinder:
      rim(-size.y());
      rim(size.y());
      return;
    case ConvexCore::Kind::cone:
      rim(-size.y());
      visit(Vector3(0.0, size.z(), 0.0));
      return;
    case ConvexCore::Kind::polytope:
      for (const Vector3& x : core.polytope()->vertices) {
        visit(x);
      }
      return;
    case ConvexCore::Kind::triangle:
      for (std::size_t i = 0; i < 3; ++i) {
        visit(core.corner(i));
      }
      return;
    case ConvexCore::Kind::placed:  // a placed part is never placed itself
      return;
  }
}

template <typename Visit>
void for_each_corner(const ConvexCore& core, const Vector3& m, const Visit& visit) {
  const PlacedCore* part = core.part();
  if (part == nullptr) {
    for_each_corner_here(core, m, visit);
    return;
  }
  for_each_corner_here(part->core, part->axes.transpose() * m,
                       [&](const Vector3& x) { visit(Vector3(part->centre + part->axes * x)); });
}

/// The outline of points seen along a direction [Andrew1979].
class Outline {
 public:
  explicit Outline(const Vector3& m) : plane_(m) {}
  void add(const Vector3& x) {
    if (count_ < points_.size()) {
      points_[count_++] = x;
    }
  }
  [[nodiscard]] FacePolygon polygon(double size) {
    const auto end = points_.begin() + static_cast<std::ptrdiff_t>(count_);
    std::sort(points_.begin(), end, [this](const Vector3& x, const Vector3& y) {
      const double a = x.dot(plane_.s);
      const double b = y.dot(plane_.s);
      return a < b || (a == b && x.dot(plane_.t) < y.dot(plane_.t));
    });
    FacePolygon outline;
    half(outline, 0, size, false);
    half(outline, outline.size, size, true);
    if (outline.size == 0 && count_ > 0) {
      outline.add(points_[0]);
    }
    return outline;
  }

 private:
  /// One side, from the first to before the last.
  void half(FacePolygon& outline, int first, double size, bool backwards) const {
    for (std::size_t i = 0; i < count_; ++i) {
      const Vector3& x = points_[backwards ? count_ - 1 - i : i];
      while (outline.size >= first + 2 &&
             plane_.turn(outline[outline.size - 2], outline[outline.size - 1], x) <=
                 level * size * size) {
        --outline.size;
      }
      if (outline.size > first && (outline[outline.size - 1] - x).norm() <= level * size) {
        continue;
      }
      outline.add(x);
    }
    if (outline.size > 0 && outline.size > first) {
      --outline.size;  // it begins the other side
    }
  }

  Plane plane_;
  std::array<Vector3, 64> points_;
  std::size_t count_ = 0;
};

/// The part on the inner side of the edge from p to q.
FacePolygon clipped(const FacePolygon& in, const Plane& plane, const Vector3& p, const Vector3& q,
                    double margin) {
  FacePolygon out;
  for (int i = 0; i < in.size; ++i) {
    const Vector3& x = in[i];
    const Vector3& y = in[(i + 1) % in.size];
    const double hx = plane.turn(p, q, x) + margin;
    const double hy = plane.turn(p, q, y) + margin;
    if (hx >= 0.0) {
      out.add(x);
    }
    if ((hx > 0.0 && hy < 0.0) || (hx < 0.0 && hy > 0.0)) {
      out.add(x + (hx / (hx - hy)) * (y - x));
    }
  }
  return out;
}

FacePolygon clipped(FacePolygon incident, const FacePolygon& reference, const Plane& plane,
                    double size) {
  for (int i = 0; i < reference.size && incident.size > 0; ++i) {
    incident = clipped(incident, plane, reference[i], reference[(i + 1) % reference.size],
                       level * size * size);
  }
  return incident;
}

/// Two edges: where they cross, or the part along which they lie.
FacePolygon common(const FacePolygon& a, const FacePolygon& b, const Plane& plane) {
  const Vector3 along = a[1] - a[0];
  const Vector3 other = b[1] - b[0];
  const double length = along.norm();
  const double turned = plane.turn(Vector3::Zero(), along, other);
  FacePolygon found;
  if (std::abs(turned) > parallel * length * other.norm()) {
    const double t = plane.turn(Vector3::Zero(), along, a[0] - b[0]) / turned;
    found.add(b[0] + std::clamp(t, 0.0, 1.0) * other);
    return found;
  }
  const Vector3 unit = along / length;
  const auto at = [&](const Vector3& x) { return std::clamp(unit.dot(x - a[0]), 0.0, length); };
  const double step = unit.dot(other);
  for (const Vector3& end : {b[0], b[1]}) {
    // The point of b over the end, cut to a.
    found.add(b[0] + other * ((unit.dot(a[0] - b[0]) + at(end)) / step));
  }
  return found;
}

FacePolygon placed(const FacePolygon& face, const Matrix3& R, const Vector3& at) {
  FacePolygon moved;
  for (int i = 0; i < face.size; ++i) {
    moved.add(at + R * face[i]);
  }
  return moved;
}

double highest(const FacePolygon& face, const Vector3& n) {
  double most = -infinity;
  for (int i = 0; i < face.size; ++i) {
    most = std::max(most, n.dot(face[i]));
  }
  return most;
}

}  // namespace

Vector3 FacePolygon::centroid() const {
  assert(size > 0);
  Vector3 area = Vector3::Zero();
  double longest = 0.0;
  Vector3 middle = points[0];
  for (int i = 0; i < size; ++i) {
    for (int k = 0; k < i; ++k) {
      const double length = ((*this)[i] - (*this)[k]).norm();
      if (length > longest) {
        longest = length;
        middle = 0.5 * ((*this)[i] + (*this)[k]);
      }
    }
  }
  for (int i = 2; i < size; ++i) {
    area += ((*this)[i - 1] - points[0]).cross((*this)[i] - points[0]);
  }
  const double doubled = area.norm();
  if (!(doubled > 1e-10 * longest * longest)) {  // an edge, to roundoff
    return middle;
  }
  Vector3 sum = Vector3::Zero();
  for (int i = 2; i < size; ++i) {
    const Vector3 p = (*this)[i - 1] - points[0];
    const Vector3 q = (*this)[i] - points[0];
    sum += (p.cross(q).dot(area) / (doubled * doubled)) * (p + q) / 3.0;
  }
  return points[0] + sum;
}

FacePolygon outline_of(std::span<const Vector3> points, const Vector3& m, double size) {
  Outline outline(m);
  for (const Vector3& x : points) {
    outline.add(x);
  }
  return outline.polygon(size);
}

FacePolygon highest_face(const ConvexCore& core, const Vector3& m, double within) {
  const double size = core.radius();
  const double least = core.support(m) - within - level * size;
  Outline outline(m);
  for_each_corner(core, m, [&](const Vector3& x) {
    if (m.dot(x) >= least) {
      outline.add(x);
    }
  });
  FacePolygon face = outline.polygon(size);
  if (face.size == 0) {
    face.add(core.support_point(m));
  }
  return face;
}

Vector3 lowest_point(const ConvexCore& core, const Vector3& m) {
  return highest_face(core, m, 0.0).centroid();
}

CorePatch core_patch(const CorePair& pair, const Vector3& n, double within) {
  const double size = pair.size();
  const Plane plane(n);
  const FacePolygon a =
      placed(highest_face(pair.a, pair.R_WA.transpose() * n, within), pair.R_WA, Vector3::Zero());
  const FacePolygon b =
      placed(highest_face(pair.b, -(pair.R_WB.transpose() * n), within), pair.R_WB, pair.d);
  CorePatch patch;
  patch.face_of_a = a.size > 2;
  patch.face_of_b = b.size > 2;
  // Points of a or of b, whichever is cut to the other.
  bool of_b = true;
  FacePolygon found = b;
  if (b.size == 1 || a.size == 1) {
    of_b = b.size == 1;
    found = of_b ? b : a;
  } else if (a.size > 2) {
    found = clipped(b, a, plane, size);
  } else if (b.size > 2) {
    of_b = false;
    found = clipped(a, b, Plane(-n), size);  // b is seen from its own side
  } else {
    found = common(a, b, plane);
  }
  if (found.size == 0) {  // the outlines lie beside each other
    found.add(b.centroid());
    of_b = true;
  }
  const double top = highest(a, n);
  const double bottom = -highest(b, -n);
  for (int i = 0; i < found.size; ++i) {
    const double gap = of_b ? n.dot(found[i]) - top : bottom - n.dot(found[i]);
    patch.gaps[static_cast<std::size_t>(i)] = gap;
    patch.points.add(of_b ? Vector3(found[i] - gap * n) : found[i]);
  }
  return patch;
}

}  // namespace kairos::ccd
