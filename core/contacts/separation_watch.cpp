#include "core/contacts/separation_watch.hpp"

#include "core/contacts/shape_pieces.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

using Kind = TouchFeature::Kind;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Times that differ by less than this part of a step count as one.
constexpr double finest = 0x1p-46;
/// Points of the surface are on a rim if they are this near to it, relative to its size.
constexpr double near_rim = 1e-7;
/// A corner belongs to a held feature if it is this near to it, relative to how far out both are.
constexpr double same_corner = 1e-9;

/// Bounds of one motion over a step.
struct Bounds {
  Bounds(const Motion& motion, double h) {
    speed = motion.speed_bound(0.0, h);
    turning = motion.angular_speed_bound(0.0, h);
    for (int k = motion.position.degree(); k >= 2; --k) {
      acceleration = acceleration * h + k * (k - 1) * motion.position[k].norm();
    }
    if (motion.rotation == RotationKind::polynomial) {
      double first = 0.0;
      double second = 0.0;
      double least = motion.quaternion[0].norm();
      double way = 0.0;
      for (int k = motion.quaternion.degree(); k >= 1; --k) {
        const double c = motion.quaternion[k].norm();
        first = first * h + k * c;
        second = k >= 2 ? second * h + k * (k - 1) * c : second;
        way = (way + c) * h;
      }
      least = std::max(least - way, 1e-3);
      // w = 2 u' u*, u = q/|q|: |w'| <= 2 |u''|, |u''| <= |q''|/|q| + 3 (|q'|/|q|)^2, and |w|^2
      // / 2.
      spin = 2.0 * second / least + 8.0 * (first / least) * (first / least);
    }
  }
  /// Bounds the second derivative of a point that is so far from the body's origin, m/s^2.
  [[nodiscard]] double bend(double arm) const {
    return acceleration + arm * (spin + turning * turning);
  }

  double speed = 0.0;         ///< m/s
  double acceleration = 0.0;  ///< m/s^2
  double turning = 0.0;       ///< rad/s
  double spin = 0.0;          ///< rad/s^2
};

/// Where all planes are nearer than this part of the gaps that are held, another one is looked for:
/// a corner that nothing holds, beyond the rim, may go below the plane of a face.
constexpr double scant = 1e-2;

/// One plane, and the corners that are to stay beyond it.
struct Candidate {
  std::vector<std::size_t> corners_a;  ///< of the pair's, those that are to be on one side
  std::vector<std::size_t> corners_b;
  const TouchFeature* plane = nullptr;  ///< of a face
  bool of_a = false;
  const Touch* touch = nullptr;  ///< or through it
  double bend = 0.0;             ///< bound of second derivatives of heights, m/s^2
  double least = 0.0;            ///< what comes nearer strikes, m
};

/// Whether what is held bears an extreme, too: a rim that is held, one of which points that are far
/// apart are, or what is on an axis of which two places are held, no nearer to each other than it
/// is to them. (Two places side by side let it turn about them.)
bool is_borne(const TouchFeature& extreme, const std::vector<TouchFeature>& held) {
  const double size = extreme.at.norm() + extreme.radius;
  double low = infinity;
  double high = -infinity;
  int on_rim = 0;
  double span = 0.0;
  Vector3 first = Vector3::Zero();
  for (const TouchFeature& h : held) {
    if (h.kind == Kind::rim && h.at == extreme.at) {
      return extreme.kind == Kind::rim;
    }
    const double out = Vector3(h.at.x(), 0.0, h.at.z()).norm();
    if (h.kind == Kind::rim || (h.radius > 0.0 && out <= same_corner * size)) {
      low = std::min(low, h.at.y());
      high = std::max(high, h.at.y());
    }
    if (extreme.kind == Kind::rim && h.kind == Kind::ball && h.radius == 0.0 &&
        std::abs(h.at.y() - extreme.at.y()) <= near_rim * size &&
        std::abs(out - extreme.radius) <= near_rim * size) {
      first = on_rim == 0 ? h.at : first;
      span = std::max(span, (h.at - first).norm());
      ++on_rim;
    }
  }
  const double beyond = std::max({low - extreme.at.y(), extreme.at.y() - high, 0.0});
  const bool on_axis = high > low && beyond <= high - low;
  return extreme.radius > 0.0 && (on_axis || (on_rim >= 3 && span >= extreme.radius));
}

/// What crosses at a smaller sine is taken as round, if it is.
constexpr double nearly_along = 0.1;

bool belongs(const TouchFeature& corner, const TouchFeature& held) {
  const Vector3 from = corner.at - held.at;
  const double size = corner.at.norm() + held.at.norm();
  if (held.kind == Kind::line) {
    return (from - held.direction * held.direction.dot(from)).norm() <= same_corner * size;
  }
  if (held.kind == Kind::rim) {
    return corner.kind == Kind::rim && corner.at == held.at;
  }
  if (held.kind == Kind::cone) {  // apex and rim are on every plane along its side
    return true;
  }
  return held.kind == Kind::ball && from.norm() <= same_corner * size;
}

class Watcher {
 public:
  Watcher(const SeparationWatch& watch, double duration)
      : watch_(watch),
        a_(watch.motion_a, duration),
        b_(watch.motion_b, duration),
        duration_(duration) {
    for (const TouchFeature& plane : watch.pair.planes_b) {
      add_plane(plane, false, true);
    }
    for (const TouchFeature& plane : watch.pair.planes_a) {
      add_plane(plane, true, true);
    }
    for (const Touch& touch : watch.held) {
      if (touch.on_a.kind != Kind::plane && touch.on_b.kind != Kind::plane) {
        add_touch(touch, true);
      }
    }
    for (const Touch& touch : watch.open) {
      add_touch(touch, false);
    }
  }

  double strike_time() {
    std::vector<double> start = heights(0.0);
    const auto is_apart = [&](double height) { return height > scant * watch_.pair.nearest; };
    if (std::none_of(start.begin(), start.end(), is_apart)) {
      add_spare();
      start = heights(0.0);
    }
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      // Corners that are nearer already may stay so while they draw away.
      candidates_[c].least = watch_.least * std::min(watch_.pair.nearest, start[c]);
    }
    return safe_until(0.0, start, duration_, heights(duration_));
  }

 private:
  struct Placed;

  [[nodiscard]] const Pose& piece(bool of_a) const {
    return of_a ? watch_.pair.piece_a : watch_.pair.piece_b;
  }
  /// How far from the origin of the body what is followed of it is at most, m: the middle of a
  /// ball, the points of a rim.
  [[nodiscard]] double reach(const TouchFeature& f, bool of_a) const {
    return f.at.norm() + (f.kind == Kind::rim ? f.radius : 0.0) + piece(of_a).position.norm();
  }

  /// `but_held`: what is held on such a face is not asked about.
  void add_plane(const TouchFeature& plane, bool of_a, bool but_held) {
    Candidate c;
    c.plane = &plane;
    c.of_a = of_a;
    const Bounds& carrier = of_a ? a_ : b_;
    const Bounds& other = of_a ? b_ : a_;
    const auto& corners = of_a ? watch_.pair.corners_b : watch_.pair.corners_a;
    auto& mine = of_a ? c.corners_b : c.corners_a;
    double arm = 0.0;
    std::vector<TouchFeature> held;
    for (const Touch& touch : watch_.held) {
      if (but_held && (of_a ? touch.on_a : touch.on_b).kind == Kind::plane) {
        held.push_back(of_a ? touch.on_b : touch.on_a);
      }
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const TouchFeature& corner = corners[k];
      const bool is_held = std::any_of(held.begin(), held.end(),
                                       [&](const TouchFeature& h) { return belongs(corner, h); }) ||
                           is_borne(corner, held);
      if (!is_held) {
        mine.push_back(k);
        arm = std::max(arm, reach(corner, !of_a));
      }
    }
    if (corners.empty()) {
      return;  // a half-space: no corner tells on which side it is
    }
    const Motion& motion = of_a ? watch_.motion_a : watch_.motion_b;
    c.bend = bend(carrier, other,
                  motion.orientation(0.0) * (piece(of_a).orientation * plane.direction), of_a, arm);
    candidates_.push_back(std::move(c));
  }

  /// No plane through what touches has all corners where they are to be: a corner that nothing
  /// holds is over the rim, or behind it. Two polytopes that are apart are so along a face of one
  /// of them, or across an edge of each [Gottschalk1996]: of these the plane along which they are
  /// apart most.
  void add_spare() {
    const TurningPair& pair = watch_.pair;
    if (pair.shape_a == nullptr || pair.shape_b == nullptr || pair.corners_a.empty() ||
        pair.corners_b.empty()) {
      return;
    }
    const Placed at(*this, 0.0);
    double best = 0.0;
    double best_across = 0.0;  // two edges, where these count apart
    const auto is_best = [&](const TouchFeature* face, bool of_a, const Touch* edges) {
      const Candidate c{.corners_a = all_of(pair.corners_a),
                        .corners_b = all_of(pair.corners_b),
                        .plane = face,
                        .of_a = of_a,
                        .touch = edges};
      const double h = height(c, at);
      double& most = pair.of_pieces && edges != nullptr ? best_across : best;
      most = std::max(most, h);
      return h == most && h > 0.0;
    };
    enum class Spare { none, face_of_a, face_of_b, edges } found = Spare::none;
    bool across = false;
    for (const bool of_a : {true, false}) {
      for (const TouchFeature& face : faces_of(of_a ? *pair.shape_a : *pair.shape_b)) {
        if (is_best(&face, of_a, nullptr)) {
          spare_face_ = face;
          found = of_a ? Spare::face_of_a : Spare::face_of_b;
        }
      }
    }
    for (const Touch& edges : crossing_edges(at)) {
      if (is_best(nullptr, false, &edges)) {
        spare_edges_ = edges;
        across = true;
        found = pair.of_pieces ? found : Spare::edges;
      }
    }
    // Of a piece a corner may go below the plane of a face beside which it is.
    if (across && (found == Spare::edges || pair.of_pieces)) {
      add_touch(spare_edges_, false);
    }
    if (found == Spare::face_of_a || found == Spare::face_of_b) {
      add_plane(spare_face_, found == Spare::face_of_a, false);
    }
    if (!pair.apart.isZero(0.0)) {
      // Across edges that are nearly parallel a plane turns fast, or is not known: the one at which
      // a detector found them apart goes with one of them, whose corners are behind it.
      for (const bool of_a : {true, false}) {
        TouchFeature& plane = of_a ? plane_of_a_ : plane_of_b_;
        const Quaternion& q = (of_a ? at.piece_a : at.piece_b).orientation;
        plane = {Kind::plane, Vector3::Zero(),
                 q.conjugate() * (of_a ? pair.apart : Vector3(-pair.apart)), 0.0};
        double highest = -infinity;
        for (const TouchFeature& corner : of_a ? pair.corners_a : pair.corners_b) {
          highest = std::max(highest, -height_over(corner, corner.at, corner.direction,
                                                   -plane.direction, Vector3::Zero()));
        }
        plane.at = highest * plane.direction;
        add_plane(plane, of_a, false);
      }
    }
  }

  /// Edges, or round sides, of both whose common perpendicular leads out of both, so that it may
  /// separate them, and that stay across each other: how fast it turns is bounded by twice what it
  /// is at first.
  [[nodiscard]] std::vector<Touch> crossing_edges(const Placed& at) const {
    const Pose& a = at.piece_a;
    const Pose& b = at.piece_b;
    const Vector3 within_a = watch_.pair.of_pieces ? middle(at.corners_a) : a.position;
    const Vector3 within_b = watch_.pair.of_pieces ? middle(at.corners_b) : b.position;
    constexpr double nearly_parallel = 1e-6;
    const double least_sine =
        std::max(nearly_parallel, 2.0 * (a_.turning + b_.turning) * duration_);
    const auto edges_a = edges_of(*watch_.pair.shape_a);
    const auto edges_b = edges_of(*watch_.pair.shape_b);
    std::vector<Touch> found;
    for (const TouchFeature& edge_a : edges_a) {
      const Vector3 along_a = a.orientation * edge_a.direction;
      const Vector3 at_a = a.to_world(edge_a.at);
      for (const TouchFeature& edge_b : edges_b) {
        const Vector3 across = along_a.cross(b.orientation * edge_b.direction);
        const Vector3 at_b = b.to_world(edge_b.at);
        if (!(across.norm() > least_sine)) {
          continue;
        }
        const Vector3 n = (across.dot(at_b - at_a) > 0.0 ? 1.0 : -1.0) * across.normalized();
        const bool out_of_a = edge_a.radius > 0.0 || n.dot(at_a - within_a) > 0.0;
        const bool out_of_b = edge_b.radius > 0.0 || n.dot(within_b - at_b) > 0.0;
        if (out_of_a && out_of_b) {
          found.push_back({.on_a = edge_a,
                           .on_b = edge_b,
                           .normal = n,
                           .of_pieces = watch_.pair.of_pieces,
                           .piece_a = watch_.pair.piece_a,
                           .piece_b = watch_.pair.piece_b});
        }
      }
    }
    return found;
  }

  /// Bounds the second derivative of n.(x - q), where n and q belong to `carrier`: of n.(x_o -
  /// x_c), and of what turns. What both bodies do together is no part of it.
  [[nodiscard]] double bend(const Bounds& carrier, const Bounds& other, const Vector3& n, bool of_a,
                            double arm) const {
    const Polynomial<3>& x_c = (of_a ? watch_.motion_a : watch_.motion_b).position;
    const Polynomial<3>& x_o = (of_a ? watch_.motion_b : watch_.motion_a).position;
    double along = 0.0;         // of the second derivative, the part along n where it starts
    double acceleration = 0.0;  // all of it
    double speed = 0.0;
    double distance = 0.0;
    for (int k = std::max(x_c.degree(), x_o.degree()); k >= 0; --k) {
      Vector3 c = Vector3::Zero();
      c += k <= x_o.degree() ? Vector3(x_o[k]) : Vector3(Vector3::Zero());
      c -= k <= x_c.degree() ? Vector3(x_c[k]) : Vector3(Vector3::Zero());
      distance = distance * duration_ + c.norm();
      speed = k >= 1 ? speed * duration_ + k * c.norm() : speed;
      acceleration = k >= 2 ? acceleration * duration_ + k * (k - 1) * c.norm() : acceleration;
      along = k >= 2 ? along * duration_ + k * (k - 1) * std::abs(n.dot(c)) : along;
    }
    const double turning = carrier.turning;
    // By so much n may have changed since the start.
    const double turned = std::min(turning * duration_, 2.0);
    const double of_arm = arm * (other.spin + other.turning * other.turning);
    return std::min(along + turned * acceleration, acceleration) + of_arm +
           2.0 * turning * (speed + arm * other.turning) +
           (carrier.spin + turning * turning) * (distance + arm);
  }

  void add_touch(const Touch& touch, bool is_held) {
    Candidate c;
    c.touch = &touch;
    double arm_a = reach(touch.on_a, true);
    double arm_b = reach(touch.on_b, false);
    for (std::size_t k = 0; k < watch_.pair.corners_a.size(); ++k) {
      const TouchFeature& corner = watch_.pair.corners_a[k];
      arm_a = std::max(arm_a, reach(corner, true));
      if (!is_held || !belongs(corner, touch.on_a)) {
        c.corners_a.push_back(k);
      }
    }
    for (std::size_t k = 0; k < watch_.pair.corners_b.size(); ++k) {
      const TouchFeature& corner = watch_.pair.corners_b[k];
      arm_b = std::max(arm_b, reach(corner, false));
      if (!is_held || !belongs(corner, touch.on_b)) {
        c.corners_b.push_back(k);
      }
    }
    const double speeds = a_.speed + b_.speed + arm_a * a_.turning + arm_b * b_.turning;
    const double bends = a_.bend(arm_a) + b_.bend(arm_b);
    const double size = 2.0 * (arm_a + arm_b);
    double turning = 2.0 * (a_.turning + b_.turning);
    double spin = 2.0 * (a_.spin + b_.spin);
    // The normal of lines, rims and cones turns as fast as they do, and where they touch goes round
    // them, divided by the sine of their angle; that of what is round as its middle goes.
    const bool crosses = touch.on_a.crosses() && touch.on_b.crosses();
    const bool of_cone = touch.on_a.kind == Kind::cone || touch.on_b.kind == Kind::cone;
    const BodyState at_a{watch_.motion_a.pose(0.0), {}};
    const BodyState at_b{watch_.motion_b.pose(0.0), {}};
    const double sine = crosses ? crossing_sine(touch, at_a, at_b) : 0.0;
    double around = 0.0;  // 1/m
    double round = 0.0;   // m
    for (const TouchFeature* const f : {&touch.on_a, &touch.on_b}) {
      const double radius = f->kind == Kind::cone ? radius_of_cone(touch, at_a, at_b) : f->radius;
      around += f->kind == Kind::rim || f->kind == Kind::cone ? 1.0 / radius : 0.0;
      round += f->kind == Kind::rim ? 0.0 : 0.5 * radius;
    }
    if (crosses && (of_cone || sine > nearly_along || !(round > 0.0))) {
      const double rate = speeds / (sine * sine);
      turning = (turning + 2.0 * around * rate) / sine;
      spin = (spin + 2.0 * around * (bends + 2.0 * turning * rate) / (sine * sine)) / sine;
    } else {
      turning += speeds / round;
      spin += bends / round + 3.0 * (speeds / round) * (speeds / round);
    }
    c.bend = bends + 2.0 * turning * speeds + size * (spin + 2.0 * turning * turning);
    candidates_.push_back(std::move(c));
  }

  /// Of the cone that touches, where it does, m.
  [[nodiscard]] static double radius_of_cone(const Touch& touch, const BodyState& a,
                                             const BodyState& b) {
    const TouchNow now = look_at(touch, a, b);
    const bool of_a = touch.on_a.kind == Kind::cone;
    const TouchFeature& cone = of_a ? touch.on_a : touch.on_b;
    const Pose& piece = of_a ? touch.piece_a : touch.piece_b;
    const Vector3 x = piece.to_body((of_a ? a : b).pose.to_body(of_a ? now.point_a : now.point_b));
    return (x - cone.at).cross(cone.direction).norm();
  }

  /// The two at s, and where all their corners are: planes ask for the same ones.
  struct Placed {
    BodyState a;
    BodyState b;
    Pose piece_a;  ///< in the world
    Pose piece_b;
    /// Its place and its axis.
    struct Extreme {
      Vector3 at;
      Vector3 axis;
    };
    std::vector<Extreme> corners_a;
    std::vector<Extreme> corners_b;

    Placed(const Watcher& of, double s)
        : a{of.watch_.motion_a.pose(s), {}},
          b{of.watch_.motion_b.pose(s), {}},
          piece_a(of.watch_.pair.of_pieces ? in_world(a.pose, of.watch_.pair.piece_a) : a.pose),
          piece_b(of.watch_.pair.of_pieces ? in_world(b.pose, of.watch_.pair.piece_b) : b.pose) {
      for (const TouchFeature& corner : of.watch_.pair.corners_a) {
        corners_a.push_back(placed(corner, piece_a));
      }
      for (const TouchFeature& corner : of.watch_.pair.corners_b) {
        corners_b.push_back(placed(corner, piece_b));
      }
    }
    static Extreme placed(const TouchFeature& corner, const Pose& pose) {
      return {pose.to_world(corner.at), corner.kind == Kind::rim
                                            ? Vector3(pose.orientation * corner.direction)
                                            : Vector3(Vector3::Zero())};
    }
  };

  /// A triangle of a mesh is not about the origin of its frame.
  [[nodiscard]] static Vector3 middle(const std::vector<Placed::Extreme>& corners) {
    Vector3 sum = Vector3::Zero();
    for (const Placed::Extreme& corner : corners) {
      sum += corner.at;
    }
    return sum / static_cast<double>(corners.size());
  }

  [[nodiscard]] static std::vector<std::size_t> all_of(const std::vector<TouchFeature>& corners) {
    std::vector<std::size_t> all(corners.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }

  /// How far the lowest of these corners is above the plane through q with this normal, m.
  [[nodiscard]] static double lowest(const std::vector<std::size_t>& which,
                                     const std::vector<TouchFeature>& corners,
                                     const std::vector<Placed::Extreme>& placed, const Vector3& n,
                                     const Vector3& q) {
    double least = infinity;
    for (const std::size_t k : which) {
      least = std::min(least, height_over(corners[k], placed[k].at, placed[k].axis, n, q));
    }
    return least;
  }

  [[nodiscard]] double height(const Candidate& c, const Placed& at) const {
    const TurningPair& pair = watch_.pair;
    if (c.plane != nullptr) {
      const Pose& carrier = c.of_a ? at.piece_a : at.piece_b;
      const Vector3 n = carrier.orientation * c.plane->direction;
      const Vector3 q = carrier.to_world(c.plane->at);
      return c.of_a ? lowest(c.corners_b, pair.corners_b, at.corners_b, n, q)
                    : lowest(c.corners_a, pair.corners_a, at.corners_a, n, q);
    }
    // Along the normal of a touch no corner of a is above any of b: what touches has the gap, which
    // is held.
    const TouchNow now = look_at(*c.touch, at.a, at.b);
    const double of_a = lowest(c.corners_a, pair.corners_a, at.corners_a, -now.normal, now.point_a);
    const double of_b = lowest(c.corners_b, pair.corners_b, at.corners_b, now.normal, now.point_b);
    return now.gap + std::min({of_a, of_b, of_a + of_b});
  }

  [[nodiscard]] std::vector<double> heights(double s) const {
    const Placed at(*this, s);
    std::vector<double> out;
    for (const Candidate& c : candidates_) {
      out.push_back(height(c, at));
    }
    return out;
  }

  /// The last time in [s0, s1] up to which some plane is known to separate.
  double safe_until(double s0, const std::vector<double>& h0, double s1,
                    const std::vector<double>& h1) {
    const double ds = s1 - s0;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (std::min(h0[c], h1[c]) - 0.125 * ds * ds * candidates_[c].bend >
          std::max(candidates_[c].least, 0.0)) {
        return s1;
      }
    }
    if (ds <= finest * duration_) {
      return s0;
    }
    const double middle = 0.5 * (s0 + s1);
    const std::vector<double> hm = heights(middle);
    const double until = safe_until(s0, h0, middle, hm);
    return until < middle ? until : safe_until(middle, hm, s1, h1);
  }

  const SeparationWatch& watch_;
  Bounds a_;
  Bounds b_;
  double duration_;
  std::vector<Candidate> candidates_;
  TouchFeature spare_face_;  ///< what one of them may be through
  Touch spare_edges_;
  TouchFeature plane_of_a_;
  TouchFeature plane_of_b_;
};

}  // namespace

double SeparationWatch::strike_time(double duration) const {
  return Watcher(*this, duration).strike_time();
}

}  // namespace core
}  // namespace kairos
