#include "ccd/expanding_polytope.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;
constexpr int most_points = 64;
constexpr int most_faces = 128;

struct Face {
  std::array<int, 3> corners{};
  Vector3 n = Vector3::Zero();  ///< unit, outward
  double offset = 0.0;          ///< of its nearest corner from 0 along n
};

struct RimEdge {
  int from = 0, to = 0;
};

class Polyhedron {
 public:
  Polyhedron(const CorePair& pair, const Vector3& shift) : pair_(pair), shift_(shift) {}

  /// A tetrahedron around 0, or with 0 on its surface.
  bool start(const Simplex& inside) {
    for (int i = 0; i < inside.size; ++i) {
      points_[static_cast<std::size_t>(count_++)] = inside[i];
    }
    while (count_ < 4) {
      if (!add_beside()) {
        return false;
      }
    }
    const Vector3 n = (w(1) - w(0)).cross(w(2) - w(0));
    const bool outside = n.dot(w(3) - w(0)) > 0.0;
    const int j = outside ? 2 : 1;
    const int k = outside ? 1 : 2;
    return add_face(0, j, k) && add_face(0, 3, j) && add_face(j, 3, k) && add_face(k, 3, 0);
  }

  void expand(double precision) {
    while (count_ < most_points) {
      const Face& nearest = nearest_face();
      const Vector3 n = nearest.n;
      const double offset = nearest.offset;
      const DifferencePoint p = pair_.support(-n);
      const double outer = n.dot(p.w);
      if (outer < least_outer_) {
        least_outer_ = outer;
        best_ = n;
      }
      if (outer - offset <= precision || !add_point(p)) {
        return;
      }
    }
  }

  [[nodiscard]] Expansion answer(double error) const {
    Expansion e;
    e.found = std::isfinite(least_outer_);
    e.n = -best_;
    add_points(e);
    double depth = infinity;
    for (int i = 0; i < faces_count_; ++i) {
      depth = std::min(depth, proven_depth(faces_[static_cast<std::size_t>(i)], error));
    }
    e.depth = std::max(0.0, depth);
    return e;
  }

 private:
  [[nodiscard]] const Vector3& w(int i) const { return points_[static_cast<std::size_t>(i)].w; }

  /// Adds one more point that is off the span of the others.
  bool add_beside() {
    const double size = pair_.size();
    for (int k = 0; k < 6; ++k) {
      const Vector3 axis = (k < 3 ? 1.0 : -1.0) * Vector3::Unit(k % 3);
      Vector3 direction = axis;
      if (count_ == 2) {
        direction = axis.cross(w(1) - w(0));
      } else if (count_ == 3) {
        direction = (k < 3 ? 1.0 : -1.0) * (w(1) - w(0)).cross(w(2) - w(0));
      }
      const double length = direction.norm();
      if (!(length > 0.0)) {
        continue;
      }
      const DifferencePoint p = pair_.support(-direction / length);
      const Vector3 out = p.w - w(0);
      double off = out.norm();
      if (count_ == 2) {
        off = out.cross((w(1) - w(0)).normalized()).norm();
      } else if (count_ == 3) {
        off = std::abs(out.dot(direction) / length);
      }
      if (off > 1e-9 * size) {
        points_[static_cast<std::size_t>(count_++)] = p;
        return true;
      }
    }
    return false;
  }

  bool make_face(int i, int j, int k, Face& face) const {
    const Vector3 n = (w(j) - w(i)).cross(w(k) - w(i));
    const double length = n.norm();
    if (!(length > 0.0)) {
      return false;
    }
    face.corners = {i, j, k};
    face.n = n / length;
    face.offset = std::min({face.n.dot(w(i)), face.n.dot(w(j)), face.n.dot(w(k))});
    return true;
  }

  bool add_face(int i, int j, int k) {
    Face face;
    if (faces_count_ >= most_faces || !make_face(i, j, k, face)) {
      return false;
    }
    faces_[static_cast<std::size_t>(faces_count_++)] = face;
    return true;
  }

  [[nodiscard]] const Face& nearest_face() const {
    const auto end = faces_.begin() + faces_count_;
    return *std::min_element(faces_.begin(), end,
                             [](const Face& x, const Face& y) { return x.offset < y.offset; });
  }

  void toggle(int from, int to) {
    for (int i = 0; i < rim_count_; ++i) {
      RimEdge& edge = rim_[static_cast<std::size_t>(i)];
      if (edge.from == to && edge.to == from) {
        edge = rim_[static_cast<std::size_t>(--rim_count_)];
        return;
      }
    }
    rim_[static_cast<std::size_t>(rim_count_++)] = {from, to};
  }

  /// Adds a point; false, and nothing is changed, if rounding leaves no surface around 0.
  bool add_point(const DifferencePoint& p) {
    const int at = count_;
    points_[static_cast<std::size_t>(at)] = p;
    const double flat = 4.0 * u * pair_.size();
    std::array<Face, most_faces> kept;
    int kept_count = 0;
    rim_count_ = 0;
    for (int i = 0; i < faces_count_; ++i) {
      const Face& face = faces_[static_cast<std::size_t>(i)];
      if (face.n.dot(p.w) > face.offset + flat) {
        for (std::size_t c = 0; c < 3; ++c) {
          toggle(face.corners[c], face.corners[(c + 1) % 3]);
        }
      } else {
        kept[static_cast<std::size_t>(kept_count++)] = face;
      }
    }
    if (rim_count_ < 3 || kept_count + rim_count_ > most_faces) {
      return false;
    }
    for (int i = 0; i < rim_count_; ++i) {
      const RimEdge& edge = rim_[static_cast<std::size_t>(i)];
      Face face;
      if (!make_face(edge.from, edge.to, at, face) || face.offset < -flat) {
        return false;
      }
      kept[static_cast<std::size_t>(kept_count++)] = face;
    }
    std::copy(kept.begin(), kept.begin() + kept_count, faces_.begin());
    faces_count_ = kept_count;
    ++count_;
    return true;
  }

  /// Proven distance of the plane of a face from 0 in exact arithmetic; negative: nothing is
  /// proven.
  [[nodiscard]] double proven_depth(const Face& face, double error) const {
    std::array<Vector3, 3> x;
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = w(face.corners[i]) - shift_;
    }
    // The nearest corner first: rounding grows with its distance.
    if (x[1].squaredNorm() < x[0].squaredNorm()) {
      std::rotate(x.begin(), x.begin() + 1, x.end());
    }
    if (x[2].squaredNorm() < x[0].squaredNorm()) {
      std::rotate(x.begin(), x.begin() + 2, x.end());
    }
    const Vector3 side_1 = x[1] - x[0];
    const Vector3 side_2 = x[2] - x[0];
    const double turning = side_1.cross(side_2).dot(x[0]);
    const double areas =
        x[0].cross(x[1]).norm() + x[1].cross(x[2]).norm() + x[2].cross(x[0]).norm();
    const double reached = x[0].norm() + x[1].norm() + x[2].norm();
    const double doubt = 2.0 * error * areas + 4.0 * error * error * reached +
                         16.0 * u * side_1.norm() * side_2.norm() * x[0].norm();
    if (!(turning > doubt)) {
      return -1.0;
    }
    return std::min({face.n.dot(x[0]), face.n.dot(x[1]), face.n.dot(x[2])}) - 2.0 * error;
  }

  /// The point of the nearest face that 0 is deepest below.
  void add_points(Expansion& e) const {
    const Face& face = nearest_face();
    const auto& [i, j, k] = face.corners;
    const Vector3 foot = face.n * face.offset;
    std::array<double, 3> weights{face.n.dot((w(j) - foot).cross(w(k) - foot)),
                                  face.n.dot((w(k) - foot).cross(w(i) - foot)),
                                  face.n.dot((w(i) - foot).cross(w(j) - foot))};
    double sum = 0.0;
    for (double& weight : weights) {
      weight = std::max(0.0, weight);
      sum += weight;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double weight = sum > 0.0 ? weights[c] / sum : 1.0 / 3.0;
      const DifferencePoint& p = points_[static_cast<std::size_t>(face.corners[c])];
      e.on_a += weight * p.on_a;
      e.on_b += weight * (p.on_b - shift_);
    }
  }

  const CorePair& pair_;
  const Vector3& shift_;
  std::array<DifferencePoint, most_points + 1> points_;
  int count_ = 0;
  std::array<Face, most_faces> faces_;
  int faces_count_ = 0;
  std::array<RimEdge, 3 * most_faces> rim_;
  int rim_count_ = 0;
  double least_outer_ = infinity;
  Vector3 best_ = Vector3::UnitX();
};

}  // namespace

Expansion expand(const CorePair& pair, const Vector3& shift, const Simplex& inside,
                 double precision, double error) {
  Polyhedron polyhedron(pair, shift);
  if (!polyhedron.start(inside)) {
    return {};
  }
  polyhedron.expand(precision);
  return polyhedron.answer(error);
}

}  // namespace kairos::ccd
