#include "ccd/contact_patch.hpp"

#include "ccd/nearest_points.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// A convex polygon in space; clipping a rectangle by four planes leaves at most 8 corners.
struct Polygon {
  std::array<Vector3, 12> corners;
  int size = 0;

  [[nodiscard]] const Vector3& operator[](int i) const {
    return corners[static_cast<std::size_t>(i)];
  }
  void add(const Vector3& corner) {
    if (size < static_cast<int>(corners.size())) {
      corners[static_cast<std::size_t>(size++)] = corner;
    }
  }
};

/// The part with sign * x[axis] <= limit [Sutherland1974].
Polygon clipped(const Polygon& in, int axis, double sign, double limit) {
  Polygon out;
  for (int i = 0; i < in.size; ++i) {
    const Vector3& p = in[i];
    const Vector3& q = in[(i + 1) % in.size];
    const double hp = sign * p[axis] - limit;
    const double hq = sign * q[axis] - limit;
    if (hp <= 0.0) {
      out.add(p);
    }
    if ((hp < 0.0 && hq > 0.0) || (hp > 0.0 && hq < 0.0)) {
      out.add(p + (hp / (hp - hq)) * (q - p));
    }
  }
  return out;
}

/// The least sign * x[axis].
double least(const Polygon& polygon, int axis, double sign) {
  double least = infinity;
  for (int i = 0; i < polygon.size; ++i) {
    least = std::min(least, sign * polygon[i][axis]);
  }
  return least;
}

/// Centroid of the area, or of the longest extent where there is none (an edge, a corner).
Vector3 centroid(const Polygon& polygon) {
  Vector3 sum = Vector3::Zero();
  Vector3 area = Vector3::Zero();
  double longest = 0.0;
  Vector3 middle = polygon[0];
  for (int i = 1; i + 1 < polygon.size; ++i) {
    area += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  for (int i = 0; i < polygon.size; ++i) {
    for (int k = 0; k < i; ++k) {
      const double length = (polygon[i] - polygon[k]).norm();
      if (length > longest) {
        longest = length;
        middle = 0.5 * (polygon[i] + polygon[k]);
      }
    }
  }
  // A sliver narrower than 1e-10 of its length is an edge to roundoff: its width is a difference of
  // clipped coordinates.
  const double doubled = area.norm();
  if (doubled <= 1e-10 * longest * longest) {
    return middle;
  }
  const Vector3 n = area / doubled;
  for (int i = 1; i + 1 < polygon.size; ++i) {
    const double part = (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]).dot(n);
    sum += (part / (3.0 * doubled)) * (polygon[i] + polygon[i + 1] - 2.0 * polygon[0]);
  }
  return polygon[0] + sum;
}

/// The face of the other box that looks most against face `axis` (outward sign * unit vector) of
/// the reference box at the origin. `half`, `d`, `R`: the other box seen from the reference box.
struct IncidentFace {
  IncidentFace(int axis, double sign, const Vector3& half, const Vector3& d, const Matrix3& R) {
    int incident = 0;
    for (int j = 1; j < 3; ++j) {
      if (std::abs(R(axis, j)) > std::abs(R(axis, incident))) {
        incident = j;
      }
    }
    const double side = sign * R(axis, incident) > 0.0 ? -1.0 : 1.0;
    const int m = (incident + 1) % 3;
    const int n = (incident + 2) % 3;
    centre = d + R.col(incident) * (side * half[incident]);
    u = R.col(m) * half[m];
    v = R.col(n) * half[n];
  }
  [[nodiscard]] Polygon polygon() const {
    Polygon face;
    face.add(centre + u + v);
    face.add(centre - u + v);
    face.add(centre - u - v);
    face.add(centre + u - v);
    return face;
  }

  Vector3 centre, u, v;
};

/// The part of a polygon inside the borders of face `axis` of a box, each moved out by `slack`.
Polygon within(Polygon face, const Vector3& half, int axis, double slack) {
  for (const int k : {(axis + 1) % 3, (axis + 2) % 3}) {
    for (const double s : {-1.0, 1.0}) {
      face = clipped(face, k, s, half[k] + slack);
    }
  }
  return face;
}

/// How far the two points are from being one above the other over face `axis`.
double beyond(const ContactPatch& patch, int axis) {
  Vector3 offset = patch.on_b - patch.on_a;
  offset[axis] = 0.0;
  return offset.lpNorm<Eigen::Infinity>();
}

/// Borders give way by up to 2^8 margins of rounding.
constexpr int most_widenings = 9;

/// The patch on face `axis` of the reference box.
ContactPatch on_face(const Vector3& reference, int axis, double sign, const Vector3& half,
                     const Vector3& d, const Matrix3& R) {
  const IncidentFace incident(axis, sign, half, d, R);
  const Vector3& centre = incident.centre;
  const Vector3& u = incident.u;
  const Vector3& v = incident.v;
  // Roundoff of coordinates that went through a rotation and a clip: 1024 u of the sizes.
  const double margin = 1024.0 * unit_roundoff * (reference.sum() + half.sum());
  // A corner that is lowest alone needs no clipping.
  const double rise_u = std::abs(u[axis]);
  const double rise_v = std::abs(v[axis]);
  if (std::min(rise_u, rise_v) > 2.0 * margin) {
    const Vector3 corner =
        centre - (sign * u[axis] > 0.0 ? 1.0 : -1.0) * u - (sign * v[axis] > 0.0 ? 1.0 : -1.0) * v;
    const int k = (axis + 1) % 3;
    const int l = (axis + 2) % 3;
    if (std::abs(corner[k]) < reference[k] && std::abs(corner[l]) < reference[l]) {
      Vector3 on_a = corner;
      on_a[axis] = sign * reference[axis];
      return {on_a, corner};
    }
  }
  const auto deepest = [&](const Polygon& face) -> ContactPatch {
    const double level = least(face, axis, sign) + margin;
    const Vector3 on_b = centroid(clipped(face, axis, sign, level));
    Vector3 on_a = on_b.cwiseMax(-reference).cwiseMin(reference);
    on_a[axis] = sign * reference[axis];
    return {on_a, on_b};
  };
  Polygon face = incident.polygon();
  // Where rounding leaves nothing, two edges meet: the nearest part, of what the other planes
  // leave.
  for (const bool nearest_part : {false, true}) {
    for (const int k : {(axis + 1) % 3, (axis + 2) % 3}) {
      for (const double s : {-1.0, 1.0}) {
        const double nearest = least(face, k, s);
        if (nearest <= reference[k] - margin) {
          face = clipped(face, k, s, reference[k]);
        } else if (nearest_part) {
          face = clipped(face, k, s, nearest + margin);
        }
      }
    }
  }
  const ContactPatch patch = deepest(face);
  if (beyond(patch, axis) <= 2.0 * margin) {
    return patch;
  }
  // An edge that lies along the border of the face: one plane may have left nothing of it but what
  // is beyond the next. Both give way a little.
  for (int i = 0; i < most_widenings; ++i) {
    const Polygon wide = within(incident.polygon(), reference, axis, std::ldexp(margin, i));
    if (wide.size > 0) {
      return deepest(wide);
    }
  }
  return patch;
}

/// The corners of the incident face clipped to the reference face, with their feet on it.
PatchCorners corners_on_face(const Vector3& reference, int axis, double sign, const Vector3& half,
                             const Vector3& d, const Matrix3& R) {
  const Polygon face = within(IncidentFace(axis, sign, half, d, R).polygon(), reference, axis, 0.0);
  PatchCorners corners;
  for (int i = 0; i < face.size; ++i) {
    Vector3 foot = face[i];
    foot[axis] = sign * reference[axis];
    corners.points[static_cast<std::size_t>(corners.size++)] = {foot, face[i]};
  }
  return corners;
}

/// Along n, in the frame of a.
ContactPatch on_edges(const RelativeBoxes& s, int axis, const Vector3& n) {
  const int i = (axis - 6) / 3;
  const int j = (axis - 6) % 3;
  Vector3 p = Vector3::Zero();
  Vector3 q = s.d_A;
  for (int k = 0; k < 3; ++k) {
    if (k != i) {
      p[k] = n[k] > 0.0 ? s.half_a[k] : -s.half_a[k];
    }
    if (k != j) {
      q += s.axes_A.col(k) * (s.axes_A.col(k).dot(n) > 0.0 ? -s.half_b[k] : s.half_b[k]);
    }
  }
  const NearestPoints nearest =
      nearest_of_segments(p, Vector3::Unit(i), s.half_a[i], q, s.axes_A.col(j), s.half_b[j]);
  return {nearest.on_a, nearest.on_b};
}

ContactPatch on_face_of_a(const RelativeBoxes& s, int axis, double sign) {
  return on_face(s.half_a, axis, sign, s.half_b, s.d_A, s.axes_A);
}

ContactPatch on_face_of_b(const RelativeBoxes& s, int axis, double sign) {
  const Matrix3 R = s.axes_A.transpose();
  const ContactPatch patch = on_face(s.half_b, axis, -sign, s.half_a, -(R * s.d_A), R);
  return {s.d_A + s.axes_A * patch.on_b, s.d_A + s.axes_A * patch.on_a};
}

double length_of(const ContactPatch& patch) { return (patch.on_b - patch.on_a).norm(); }

/// 1 - cos of the angle, 1e-3, up to which a direction may be a face's, but for rounding.
constexpr double nearly_aligned = 5e-7;

/// Two edges across each other; or the faces that they border, where their direction is that of a
/// face within rounding: then any two edges of these give it, also such as do not meet.
ContactPatch on_edges_or_faces(const RelativeBoxes& s, int axis, const Vector3& n) {
  const ContactPatch edges = on_edges(s, axis, n);
  const double margin = 1024.0 * unit_roundoff * (s.half_a.sum() + s.half_b.sum());
  const Vector3 n_B = s.axes_A.transpose() * n;
  for (int k = 0; k < 3; ++k) {
    for (const bool a : {true, false}) {
      const double along = a ? n[k] : n_B[k];
      if (1.0 - std::abs(along) > nearly_aligned) {
        continue;
      }
      const double sign = along > 0.0 ? 1.0 : -1.0;
      const ContactPatch face = a ? on_face_of_a(s, k, sign) : on_face_of_b(s, k, sign);
      if (length_of(face) <= length_of(edges) + margin) {
        return face;
      }
    }
  }
  return edges;
}

}  // namespace

ContactPatch contact_patch(const RelativeBoxes& s, const AxisSeparation& axis) {
  return contact_patch(s, axis.axis, axis.sign,
                       axis.axis < 6 ? Vector3(Vector3::Zero()) : axis_normal(s, axis));
}

ContactPatch contact_patch(const RelativeBoxes& s, int axis, double sign, const Vector3& n_A) {
  if (axis < 3) {
    return on_face_of_a(s, axis, sign);
  }
  if (axis < 6) {
    return on_face_of_b(s, axis - 3, sign);
  }
  return on_edges_or_faces(s, axis, n_A);
}

PatchCorners patch_corners(const RelativeBoxes& s, const AxisSeparation& axis) {
  if (axis.axis < 3) {
    return corners_on_face(s.half_a, axis.axis, axis.sign, s.half_b, s.d_A, s.axes_A);
  }
  if (axis.axis < 6) {
    const Matrix3 R = s.axes_A.transpose();
    const Vector3 d = -(R * s.d_A);
    PatchCorners corners = corners_on_face(s.half_b, axis.axis - 3, -axis.sign, s.half_a, d, R);
    for (int k = 0; k < corners.size; ++k) {
      ContactPatch& p = corners.points[static_cast<std::size_t>(k)];
      p = {s.d_A + s.axes_A * p.on_b, s.d_A + s.axes_A * p.on_a};
    }
    return corners;
  }
  return {1, {on_edges(s, axis.axis, axis_normal(s, axis))}};
}

Vector3 lowest_centroid(const Vector3& half, const Vector3& down, double roundoff) {
  Vector3 point = Vector3::Zero();
  for (int k = 0; k < 3; ++k) {
    // An axis that is level within roundoff contributes both its ends: their mean is 0.
    if (half[k] * std::abs(down[k]) > roundoff) {
      point[k] = down[k] > 0.0 ? half[k] : -half[k];
    }
  }
  return point;
}

}  // namespace kairos::ccd
