#pragma once

#include "core/polytope.hpp"

namespace kairos::ccd {

/// What of a convex body is nearest along a direction: a point, an edge or a face.
struct Feature {
  int dimension = 0;
  Vector3 along = Vector3::Zero();  ///< of an edge, its direction; of a face, its normal; unit
};

struct PlacedCore;

/// A convex body by its support: the greatest m . x of its points x. Bodies of this room are such a
/// core and a ball of radius `rounding` about each of its points. Body frame, m. It refers to the
/// polytope, the vertices or the core that it is made of.
class ConvexCore {
 public:
  enum class Kind { point, segment, box, cylinder, cone, polytope, triangle, placed };

  /// Centres of caps at y = -half and half.
  static ConvexCore segment(double half, double rounding);
  static ConvexCore point(double rounding);
  static ConvexCore box(const Vector3& half_extents);
  /// Along y, from -half to half.
  static ConvexCore cylinder(double radius, double half, double rounding);
  /// Along y, its centroid the origin: the apex at 3/4 of its height.
  static ConvexCore cone(double radius, double height, double rounding);
  static ConvexCore of(const Polytope& polytope, double rounding);
  /// Three vertices; a segment or a point where they are one.
  static ConvexCore triangle(const Vector3* vertices, const std::array<std::uint32_t, 3>& corners);
  /// Another core somewhere else in the body.
  static ConvexCore placed(const PlacedCore& part);

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] double rounding() const { return rounding_; }
  /// Radius of the ball about the origin that contains the core.
  [[nodiscard]] double radius() const { return radius_; }
  /// Greatest sum of the magnitudes of a point's coordinates: what its roundings are parts of.
  [[nodiscard]] double extent() const { return extent_; }
  /// Least size across, without the rounding.
  [[nodiscard]] double width() const { return width_; }
  /// Is it more than a point or a segment?
  [[nodiscard]] bool has_volume() const;
  /// Of a point or a segment: its middle, and half of it.
  struct Line {
    Vector3 middle, direction;  ///< unit
    double half;                ///< m
  };
  [[nodiscard]] Line line() const;
  /// Are there rims or sides that bend?
  [[nodiscard]] bool is_round() const;
  /// The second derivative of the support at the unit direction m is radius tangent tangent'.
  struct Bend {
    double radius = 0.0;                ///< m
    Vector3 tangent = Vector3::Zero();  ///< unit
  };
  [[nodiscard]] Bend bend(const Vector3& m) const;

  /// The circle around a flat end.
  struct Rim {
    Vector3 middle = Vector3::Zero();
    Vector3 axis = Vector3::Zero();  ///< unit
    double radius = 0.0;             ///< m; 0: there is none
  };
  /// That of the end that looks along m, if one does.
  [[nodiscard]] Rim rim(const Vector3& m) const;

  [[nodiscard]] double support(const Vector3& m) const;
  [[nodiscard]] Vector3 support_point(const Vector3& m) const;
  /// The feature along the unit direction m, of those that m is off by at most `noise` (rad) from.
  [[nodiscard]] Feature feature(const Vector3& m, double noise) const;
  /// Support along the unit direction n of all that the core passes while it spins about the unit
  /// axis w through its origin (eq. 8), or a bound of it.
  [[nodiscard]] double spun_support(const Vector3& n, const Vector3& w) const;
  /// Calls normal(unit outward normal of a face) and edge(unit direction of one) for all that are
  /// next to the support along m: what a separation may be exactly along or across.
  template <typename Normal, typename Edge>
  void nearby(const Vector3& m, const Normal& normal, const Edge& edge) const;

  /// Half-length of a segment, half extents of a box, or (radius, low end, high end) along y.
  [[nodiscard]] const Vector3& sizes() const { return sizes_; }
  [[nodiscard]] const Polytope* polytope() const { return polytope_; }
  [[nodiscard]] const PlacedCore* part() const { return part_; }
  /// Of a triangle.
  [[nodiscard]] const Vector3& corner(std::size_t i) const { return triangle_[corners_[i]]; }

 private:
  template <typename Normal, typename Edge>
  void nearby_here(const Vector3& m, const Normal& normal, const Edge& edge) const;
  /// Calls visit(point) for points whose hull contains the core.
  template <typename Visit>
  void each_hull_point(const Visit& visit) const;
  [[nodiscard]] std::uint32_t support_vertex(const Vector3& m) const;
  /// Of a cone, from the rim to the apex on the side of m.
  [[nodiscard]] Vector3 side_line(const Vector3& m) const;

  Kind kind_ = Kind::point;
  Vector3 sizes_ = Vector3::Zero();
  const Polytope* polytope_ = nullptr;
  const PlacedCore* part_ = nullptr;
  const Vector3* triangle_ = nullptr;
  std::array<std::uint32_t, 3> corners_{};
  double rounding_ = 0.0;
  double radius_ = 0.0;
  double extent_ = 0.0;
  double width_ = 0.0;
};

/// A core where it is in its body: the points centre + axes x of its points x.
struct PlacedCore {
  ConvexCore core;
  Matrix3 axes = Matrix3::Identity();
  Vector3 centre = Vector3::Zero();
};

template <typename Normal, typename Edge>
void ConvexCore::nearby_here(const Vector3& m, const Normal& normal, const Edge& edge) const {
  const auto towards = [&m](int k) -> Vector3 {
    return (m[k] < 0.0 ? -1.0 : 1.0) * Vector3::Unit(k);
  };
  switch (kind_) {
    case Kind::point:
      return;
    case Kind::segment:
      edge(Vector3(Vector3::UnitY()));
      return;
    case Kind::box:
      for (int k = 0; k < 3; ++k) {
        normal(towards(k));
        edge(Vector3(Vector3::Unit(k)));
      }
      return;
    case Kind::cylinder:
      normal(towards(1));
      edge(Vector3(Vector3::UnitY()));
      return;
    case Kind::cone:
      normal(Vector3(-Vector3::UnitY()));
      edge(side_line(m));
      return;
    case Kind::triangle:
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector3 along = corner((i + 1) % 3) - corner(i);
        if (!along.isZero(0.0)) {
          edge(Vector3(along.normalized()));
        }
      }
      if (const Vector3 n = (corner(1) - corner(0)).cross(corner(2) - corner(0)); !n.isZero(0.0)) {
        normal(Vector3(n.normalized()));
        normal(Vector3(-n.normalized()));
      }
      return;
    case Kind::placed:  // a part is none that is placed itself
      return;
    case Kind::polytope:
      break;
  }
  const std::uint32_t v = support_vertex(m);
  for (const std::uint32_t f : polytope_->faces_at[v]) {
    normal(polytope_->normals[f]);
  }
  for (const std::uint32_t e : polytope_->edges_at[v]) {
    edge(polytope_->directions[e]);
  }
}

template <typename Normal, typename Edge>
void ConvexCore::nearby(const Vector3& m, const Normal& normal, const Edge& edge) const {
  if (kind_ != Kind::placed) {
    nearby_here(m, normal, edge);
    return;
  }
  const Matrix3& axes = part_->axes;
  part_->core.nearby_here(
      axes.transpose() * m, [&](const Vector3& n) { normal(Vector3(axes * n)); },
      [&](const Vector3& e) { edge(Vector3(axes * e)); });
}

}  // namespace kairos::ccd
