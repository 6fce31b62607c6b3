#include "tests/judge/query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace kairos::judge {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string body_header(char name) {
  std::string header;
  for (const char* column : {"shape", "hx", "hy", "hz", "px", "py", "pz", "qw", "qx", "qy",
                             "qz",    "vx", "vy", "vz", "ax", "ay", "az", "wx", "wy", "wz"}) {
    header += fmt::format(",{}_{}", name, column);
  }
  return header;
}

void append(std::string& row, const Vector3& v) {
  row += fmt::format(",{:.17g},{:.17g},{:.17g}", v.x(), v.y(), v.z());
}

std::string body_row(const Body& body) {
  std::string row = body.kind == Kind::box      ? ",box"
                    : body.kind == Kind::sphere ? ",sphere"
                                                : ",half-space";
  append(row, body.half_extents);
  append(row, body.position);
  const Quaternion& q = body.orientation;
  row += fmt::format(",{:.17g},{:.17g},{:.17g},{:.17g}", q.w(), q.x(), q.y(), q.z());
  append(row, body.velocity);
  append(row, body.acceleration);
  append(row, body.spin);
  return row;
}

}  // namespace

Shape Body::shape() const {
  switch (kind) {
    case Kind::sphere:
      return Sphere{half_extents.x()};
    case Kind::half_space:
      return HalfSpace{normal};
    case Kind::box:
      break;
  }
  return Box{half_extents};
}

Motion Body::motion(Instant window_start, double duration) const {
  Motion motion = Motion::ballistic(window_start - age, duration + age, {position, orientation},
                                    {velocity, spin}, acceleration);
  motion.error_radius = error_radius;
  if (polynomial) {
    motion.position = course;
    motion.velocity = course.differentiated();
    motion.rotation = RotationKind::polynomial;
    motion.quaternion = turn;
  }
  return motion;
}

double Body::smallest_extent() const {
  switch (kind) {
    case Kind::sphere:
      return 2.0 * half_extents.x();
    case Kind::half_space:
      return infinity;
    case Kind::box:
      break;
  }
  return 2.0 * half_extents.minCoeff();
}

double Body::reach() const {
  switch (kind) {
    case Kind::sphere:
      return half_extents.x();
    case Kind::half_space:
      return 0.0;
    case Kind::box:
      break;
  }
  return half_extents.stableNorm();
}

TimeOfImpact Query::ask(const ContactDetector& detector) const {
  const Shape shape_a = a.shape();
  const Shape shape_b = b.shape();
  const Motion motion_a = a.motion(start, duration);
  const Motion motion_b = b.motion(start, duration);
  return detector.time_of_impact({shape_a, motion_a}, {shape_b, motion_b}, {start, duration},
                                 tolerance);
}

Query Query::exchanged() const {
  Query other = *this;
  std::swap(other.a, other.b);
  return other;
}

std::string csv_header() {
  return "id,class" + body_header('a') + body_header('b') +
         ",duration,tolerance,start,a_error,b_error,a_age,b_age,a_nx,a_ny,a_nz,b_nx,b_ny,b_nz";
}

std::string csv_row(const Query& q) {
  std::string row = q.id + "," + q.family + body_row(q.a) + body_row(q.b) +
                    fmt::format(",{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}",
                                q.duration, q.tolerance, q.start.seconds, q.a.error_radius,
                                q.b.error_radius, q.a.age, q.b.age);
  append(row, q.a.normal);
  append(row, q.b.normal);
  return row;
}

}  // namespace kairos::judge
