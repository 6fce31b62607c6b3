#include "core/schemes/shared/support.hpp"

#include "core/archive.hpp"
#include "core/contacts/face_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// First time in [lo, hi] at which the scalar polynomial (the x of `f`) is positive, by subdivision
/// of its Bernstein form; infinite if it is nowhere.
double first_positive(const Polynomial<3>& f, double lo, double hi, int depth) {
  std::array<Polynomial<3>::Value, Polynomial<3>::max_degree + 1> b;
  bernstein<3>(f, lo, hi, b);
  bool any_positive = false;
  bool all_positive = true;
  for (int k = 0; k <= f.degree(); ++k) {
    const double x = b[static_cast<std::size_t>(k)].x();
    any_positive = any_positive || x > 0.0;
    all_positive = all_positive && x > 0.0;
  }
  if (!any_positive) {
    return infinity;
  }
  const double middle = 0.5 * (lo + hi);
  if (all_positive || depth == 0 || !(lo < middle && middle < hi)) {
    return lo;
  }
  const double early = first_positive(f, lo, middle, depth - 1);
  return std::isfinite(early) ? early : first_positive(f, middle, hi, depth - 1);
}

/// (p - q).axis + constant, as the x of a polynomial.
Polynomial<3> along(const Polynomial<3>& p, const Polynomial<3>& q, const Vector3& axis,
                    double constant) {
  Polynomial<3> f;
  f.resize(std::max(p.degree(), q.degree()));
  for (int k = 0; k <= f.degree(); ++k) {
    Vector3 c = Vector3::Zero();
    if (k <= p.degree()) {
      c += p[k];
    }
    if (k <= q.degree()) {
      c -= q[k];
    }
    f[k] = Vector3(c.dot(axis), 0.0, 0.0);
  }
  f[0].x() += constant;
  return f;
}

/// Index of the box axis that the normal is parallel to, to roundoff; -1 if none.
int face_axis(const Quaternion& q_WB, const Vector3& normal) {
  const Vector3 normal_B = q_WB.conjugate() * normal;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(normal_B[k]) >= 1.0 - 1e-12) {
      return k;
    }
  }
  return -1;
}

/// p - q in the frame of a body that does not turn.
Polynomial<3> in_frame(const Quaternion& orientation, const Polynomial<3>& p,
                       const Polynomial<3>& q) {
  Polynomial<3> x;
  x.resize(std::max(p.degree(), q.degree()));
  for (int k = 0; k <= x.degree(); ++k) {
    Vector3 c = k <= p.degree() ? Vector3(p[k]) : Vector3(Vector3::Zero());
    c -= k <= q.degree() ? Vector3(q[k]) : Vector3(Vector3::Zero());
    x[k] = orientation.conjugate() * c;
  }
  return x;
}

/// The rim of a face of several convex pieces, and the way of a point, both in the body's frame.
struct Rim {
  const std::vector<FacePart>& parts;
  double slack;  ///< pieces meet where planes differ by roundoff, m
  Polynomial<3> way;
  double duration;

  [[nodiscard]] bool inside(const FacePart& part, const Vector3& x) const {
    const Vector3 out = x - part.middle;
    return std::all_of(part.sides.begin(), part.sides.end(),
                       [&](const TouchRim::Side& side) {
                         return side.normal.dot(x) - side.offset <= slack;
                       }) &&
           (part.radius == 0.0 ||
            (out - part.axis * part.axis.dot(out)).norm() <= part.radius + slack);
  }

  /// First time in [lo, hi] beyond a piece: the control points of a curve (its Bernstein form) hold
  /// the curve, and what is convex holds it with them.
  [[nodiscard]] double leaves(const FacePart& part, double lo, double hi, int depth) const {
    std::array<Polynomial<3>::Value, Polynomial<3>::max_degree + 1> b;
    bernstein<3>(way, lo, hi, b);
    if (std::all_of(b.begin(), b.begin() + way.degree() + 1,
                    [&](const Vector3& x) { return inside(part, x); })) {
      return infinity;
    }
    const double middle = 0.5 * (lo + hi);
    if (!inside(part, b[0]) || depth == 0 || !(lo < middle && middle < hi)) {
      return lo;
    }
    const double early = leaves(part, lo, middle, depth - 1);
    return std::isfinite(early) ? early : leaves(part, middle, hi, depth - 1);
  }

  /// From piece to piece, always on that which is left last.
  [[nodiscard]] double passed() const {
    constexpr int halvings = 60;
    double t = 0.0;
    for (std::size_t hops = 0; hops <= 2 * parts.size() && t < duration; ++hops) {
      double last = t;
      for (const FacePart& part : parts) {
        if (inside(part, way(t))) {
          last = std::max(last, leaves(part, t, duration, halvings));
        }
      }
      if (last == t) {
        return t;
      }
      t = last;
    }
    return t < duration ? t : infinity;
  }
};

}  // namespace

double first_positive(const Polynomial<3>& f, double duration) {
  constexpr int halvings = 60;  // of the duration: beyond the resolution of its double
  return duration > 0.0 ? first_positive(f, 0.0, duration, halvings) : infinity;
}

void Support::persist(Archive& archive) { archive(surface, normal, height); }

std::optional<Support> find_support(const Model& model, BodyIndex ball, const Vector3& centre,
                                    BodyIndex surface, const Motion& surface_motion, double s,
                                    const Vector3& normal) {
  if (!std::holds_alternative<Sphere>(model.shape(ball)) || model.is_free(surface) ||
      model.is_field(surface) || surface_motion.rotation != RotationKind::fixed ||
      model.islands()[model.island_of(ball)].bodies.size() != 1 || model.jointed(ball)) {
    return std::nullopt;
  }
  const Pose pose = surface_motion.pose(s);
  if (const auto* half_space = std::get_if<HalfSpace>(&model.shape(surface))) {
    const Vector3 n = half_space_normal(*half_space, pose);
    return Support{surface, n, n.dot(centre - pose.position)};
  }
  const auto* box = std::get_if<Box>(&model.shape(surface));
  const int axis = box != nullptr ? face_axis(pose.orientation, normal) : -1;
  if (axis < 0) {
    return std::nullopt;
  }
  // This is the arithmetic of `face_exit_time`, so that a ball which has just left at an edge is
  // not found on the face again by a different rounding.
  const Vector3 from_middle = centre - pose.position;
  for (int k = 0; k < 3; ++k) {
    const Vector3 along_k = pose.orientation * Vector3(Vector3::Unit(k));
    if (k != axis && std::abs(from_middle.dot(along_k)) - box->half_extents[k] >= 0.0) {
      return std::nullopt;
    }
  }
  const Vector3 face = pose.orientation * Vector3(Vector3::Unit(axis));
  const double height = from_middle.dot(face);
  return Support{surface, height > 0.0 ? face : Vector3(-face), std::abs(height)};
}

double face_exit_time(const Shape& surface, const Motion& surface_motion, const Motion& point,
                      const Vector3& normal, const Vector3& at, double duration) {
  const Quaternion q = surface_motion.orientation(0.0);
  if (const auto* box = std::get_if<Box>(&surface)) {
    const int skipped = face_axis(q, normal);
    double earliest = infinity;
    for (int k = 0; k < 3; ++k) {
      if (k == skipped) {
        continue;
      }
      for (const double side : {-1.0, 1.0}) {
        const Vector3 axis = q * Vector3(side * Vector3::Unit(k));
        const Polynomial<3> beyond =
            along(point.position, surface_motion.position, axis, -box->half_extents[k]);
        earliest = std::min(earliest, first_positive(beyond, duration));
      }
    }
    return earliest;
  }
  if (!std::isfinite(bounding_radius(surface))) {
    return infinity;
  }
  const Pose pose{surface_motion.position[0], q};
  for (const Vector3& outward : {normal, Vector3(-normal)}) {
    const auto parts = parts_of_face(surface, q.conjugate() * outward, pose.to_body(at));
    if (!parts.empty()) {
      return Rim{parts, 1e-12 * bounding_radius(surface),
                 in_frame(q, point.position, surface_motion.position), duration}
          .passed();
    }
  }
  return 0.0;
}

double outline_exit_time(std::span<const Vector3> outline, const Vector3& normal,
                         const Motion& motion, const Motion& point, double duration) {
  const Pose pose{motion.position[0], motion.orientation(0.0)};
  double size = 0.0;
  for (const Vector3& x : outline) {
    size = std::max(size, (x - outline[0]).norm());
  }
  const double slack = 1e-12 * size;
  FacePart inside;
  for (const Vector3& from : outline) {
    for (const Vector3& to : outline) {
      Vector3 out = (to - from).cross(normal);
      if (!(out.norm() > slack)) {
        continue;  // one place, as roundoff goes
      }
      out.normalize();
      const auto behind = [&](const Vector3& x) { return out.dot(x - from) <= slack; };
      if (std::all_of(outline.begin(), outline.end(), behind)) {
        const Vector3 side = pose.orientation.conjugate() * out;
        inside.sides.push_back({side, side.dot(pose.to_body(from))});
      }
    }
  }
  if (inside.sides.empty()) {
    return 0.0;
  }
  const std::vector<FacePart> parts{inside};
  return Rim{parts, slack, in_frame(pose.orientation, point.position, motion.position), duration}
      .passed();
}

double lift_off_time(const Motion& surface_motion, const Vector3& normal, double mass,
                     const Vector3& force) {
  const Polynomial<3> acceleration = surface_motion.velocity.differentiated();
  const Polynomial<3> missing = along(Polynomial<3>(Vector3(Vector3::Zero())), acceleration, normal,
                                      force.dot(normal) / mass);
  return first_positive(missing, surface_motion.duration);
}

double release_time(const std::function<double(double)>& contact_force, double duration) {
  constexpr int samples = 32;
  constexpr int halvings = 60;  // beyond the resolution of a double
  double pressing = 0.0;
  for (int k = 0; k <= samples; ++k) {
    double free = duration * k / samples;
    if (contact_force(free) >= 0.0) {
      pressing = free;
      continue;
    }
    for (int i = 0; i < halvings && k > 0; ++i) {
      const double middle = 0.5 * (pressing + free);
      (contact_force(middle) < 0.0 ? free : pressing) = middle;
    }
    return free;
  }
  return infinity;
}

Motion ride(const Motion& along_surface, const Motion& surface_motion, const Vector3& normal) {
  Motion motion = along_surface;
  motion.duration = std::min(motion.duration, surface_motion.duration);
  const auto follow = [&](Polynomial<3>& to, const Polynomial<3>& from, int first) {
    to.resize(std::max(to.degree(), from.degree()));
    for (int k = first; k <= to.degree(); ++k) {
      const double carried = k <= from.degree() ? normal.dot(Vector3(from[k])) : 0.0;
      to[k] += normal * (carried - normal.dot(Vector3(to[k])));
    }
  };
  follow(motion.position, surface_motion.position, 1);  // starts where the ball is, bit for bit
  follow(motion.velocity, surface_motion.velocity, 0);
  motion.error_radius = std::max(motion.error_radius, surface_motion.error_radius);
  return motion;
}

void SupportForce::add(Instant, std::span<const BodyState> bodies,
                       std::span<Wrench> wrenches) const {
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    wrenches[k].force -= normal_ * normal_.dot(wrenches[k].force);
  }
}

}  // namespace core
}  // namespace kairos
