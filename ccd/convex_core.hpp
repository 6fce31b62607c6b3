#pragma once

#include "core/polytope.hpp"

namespace kairos::ccd {

/// What of a convex body is nearest along a direction: a point, an edge or a face.
struct Feature {
  int dimension = 0;
  Vector3 along = Vector3::Zero();  ///< of an edge, its direction; of a face, its normal; unit
};

/// A convex body by its support: the greatest m . x of its points x. Bodies of this room are such a
/// core and a ball of radius `rounding` about each of its points. Body frame, m. It refers to the
/// polytope that it is made of.
class ConvexCore {
 public:
  enum class Kind { point, segment, box, cylinder, cone, polytope };

  /// Centres of caps at y = -half and half.
  static ConvexCore segment(double half, double rounding);
  static ConvexCore point(double rounding);
  static ConvexCore box(const Vector3& half_extents);
  /// Along y, from -half to half.
  static ConvexCore cylinder(double radius, double half, double rounding);
  /// Along y, its centroid the origin: the apex at 3/4 of its height.
  static ConvexCore cone(double radius, double height, double rounding);
  static ConvexCore of(const Polytope& polytope, double rounding);

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] double rounding() const { return rounding_; }
  /// Radius of the ball about the origin that contains the core.
  [[nodiscard]] double radius() const { return radius_; }
  /// Greatest sum of the magnitudes of a point's coordinates: what its roundings are parts of.
  [[nodiscard]] double extent() const { return extent_; }
  /// Least size across, without the rounding.
  [[nodiscard]] double width() const { return width_; }
  /// Is it more than a point or a segment?
  [[nodiscard]] bool has_volume() const { return kind_ > Kind::segment; }

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

 private:
  [[nodiscard]] std::uint32_t support_vertex(const Vector3& m) const;
  /// Of a cone, from the rim to the apex on the side of m.
  [[nodiscard]] Vector3 side_line(const Vector3& m) const;

  Kind kind_ = Kind::point;
  Vector3 sizes_ = Vector3::Zero();
  const Polytope* polytope_ = nullptr;
  double rounding_ = 0.0;
  double radius_ = 0.0;
  double extent_ = 0.0;
  double width_ = 0.0;
};

template <typename Normal, typename Edge>
void ConvexCore::nearby(const Vector3& m, const Normal& normal, const Edge& edge) const {
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

}  // namespace kairos::ccd
