#include "ccd/parts_impact.hpp"

#include "ccd/body_parts.hpp"
#include "ccd/closed_form.hpp"
#include "ccd/descent_answer.hpp"
#include "ccd/gjk.hpp"
#include "ccd/moving_cores.hpp"
#include "ccd/parts_at_rest.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/separation_function.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;
/// Boxes nearer than this part of their size are opened: their parts are apart for longer.
constexpr double near = 0.1;
/// How near below the distance of two boxes a separation is sought, as a part of it.
constexpr double box_precision = 0.1;
/// Looks at two parts before others have their turn.
constexpr int looks_at_parts = 24;
/// Looks that a query may take before it is `undecided`, and for each radian of turning so many
/// more, up to so many radians.
constexpr int most_looks = 1'000'000;
constexpr double looks_per_radian = 1'000.0;
constexpr double most_radians = 1e3;
/// If rounding hides whether two parts touch, other parts are asked for this many times as long.
constexpr double proofs_follow = 64.0;
/// Part of the rest of the window for which motions that are no parabolas are bounded at once.
constexpr double piece = 0.125;

class PartsImpact {
 public:
  PartsImpact(const MovingShape& a, const MovingShape& b, const Window& window,
              const AdvancementOptions& options)
      : a_(a),
        b_(b),
        window_(window),
        options_(options),
        plane_(std::holds_alternative<HalfSpace>(b.shape)),
        parts_a_(a.shape, plane_ ? BodyParts::Against::plane : BodyParts::Against::bodies),
        end_(window.duration) {
    if (!(options_.tolerance > 0.0)) {
      options_.tolerance = default_tolerance(a, b, window);
    }
    if (!plane_) {
      parts_b_.emplace(b.shape);
      const ConvexCore whole_a = parts_a_.whole();
      const ConvexCore whole_b = parts_b_->whole();
      motion_.emplace(MovingCore{whole_a, a.motion}, MovingCore{whole_b, b.motion}, window);
    }
  }

  TimeOfImpact run() {
    if (plane_) {
      parts_a_.each_root([&](ObbChild part) { follow({0.0, part, {}}); });
      return answer();
    }
    if (starts_inside()) {
      return overlapping(Vector3::UnitY());
    }
    const double clear = clear_of_balls(PairKind::cores, *motion_);
    parts_a_.each_root([&](ObbChild a) {
      parts_b_->each_root([&](ObbChild b) { push({clear, a, b}); });
    });
    const double angle = turning() * window_.duration;
    const int most = most_looks + static_cast<int>(looks_per_radian *
                                                   (angle < most_radians ? angle : most_radians));
    while (!keys_.empty() && keys_.front().t < end_ && !found_overlap_) {
      if (looks_ > most) {
        return exhausted(keys_.front().t);
      }
      std::pop_heap(keys_.begin(), keys_.end(), later);
      const Key key = keys_.back();
      keys_.pop_back();
      look(key);
    }
    return answer();
  }

 private:
  /// Two boxes or parts, and the time up to which they are proven apart.
  struct Key {
    double t;
    ObbChild a, b;
  };
  /// Equal keys have an order, too: otherwise the heap of another library could take another.
  static bool later(const Key& x, const Key& y) {
    return std::tuple(x.t, x.a, x.b) > std::tuple(y.t, y.a, y.b);
  }
  void push(const Key& key) {
    if (key.t < end_) {
      keys_.push_back(key);
      std::push_heap(keys_.begin(), keys_.end(), later);
    }
  }

  [[nodiscard]] double turning() const {
    return a_.motion.rotation_rate.norm() + b_.motion.rotation_rate.norm();
  }

  [[nodiscard]] bool starts_inside() const {
    const Pose pose_a = a_.motion.pose(start_of(a_.motion, window_));
    const Pose pose_b = b_.motion.pose(start_of(b_.motion, window_));
    return one_inside(a_.shape, pose_a, b_.shape, pose_b) &&
           measure_overlap_at(pose_a, pose_b) < -options_.tolerance;
  }
  [[nodiscard]] double measure_overlap_at(const Pose& pose_a, const Pose& pose_b) const {
    return measure_parts(a_.shape, pose_a, b_.shape, pose_b).gap;
  }

  /// Keys come in the order of their times, so that one look at the motions serves many of them.
  void go_to(double t) {
    if (looked_ && k_.t == t) {
      return;
    }
    motion_->evaluate(t, k_);
    looked_ = true;
    if (motion_->simple()) {
      if (!bounded_) {
        bounds_ = motion_->bounds(0.0, motion_->duration());
        bounds_.until = motion_->duration();
      }
    } else if (!bounded_ || !(t < bounds_.until)) {
      bounds_ = motion_->bounds(t, piece * (motion_->duration() - t));
      // Reused at later times, at which c is another one.
      bounds_.bend *= 2.0;
      if (!(bounds_.until > t)) {
        bounds_.until = motion_->duration();
      }
    }
    bounded_ = true;
  }

  /// Looks at a pair at the time of its key: gives it more time if it is far apart, or opens it.
  void look(const Key& key) {
    stack_.clear();
    stack_.push_back(key);
    while (!stack_.empty() && !found_overlap_) {
      const Key at = stack_.back();
      stack_.pop_back();
      if (at.a.is_triangle() && at.b.is_triangle()) {
        follow(at);
        continue;
      }
      const double next = clear_until(at);
      if (next > at.t) {
        push({next, at.a, at.b});
        continue;
      }
      const bool first =
          at.b.is_triangle() || (!at.a.is_triangle() && parts_a_.size(at.a) > parts_b_->size(at.b));
      for (const ObbChild child : first ? parts_a_.children(at.a) : parts_b_->children(at.b)) {
        stack_.push_back(first ? Key{at.t, child, at.b} : Key{at.t, at.a, child});
      }
    }
  }

  /// Up to when two boxes, or a box and a part, are proven apart; no later than now if they are to
  /// be opened.
  [[nodiscard]] double clear_until(const Key& at) {
    ++looks_;
    go_to(at.t);
    PlacedCore memory_a, memory_b;
    const ConvexCore core_a = parts_a_.core(at.a, memory_a);
    const ConvexCore core_b = parts_b_->core(at.b, memory_b);
    motion_->take_parts(core_a, core_b);
    const CorePair pair = core_pair(*motion_, k_);
    const Vector3 start = k_.d + k_.R_WB * memory_b.centre - k_.R_WA * memory_a.centre;
    const double apart = start.norm();
    const GjkResult found =
        gjk(pair, apart > 0.0 ? Vector3(start / apart) : Vector3(Vector3::UnitY()), box_precision);
    Witness witness;
    witness.n = found.n;
    witness.gap = found.lower - motion_->reach();
    if (!(witness.gap > k_.error)) {
      return at.t;
    }
    const double horizon = bounds_.until - at.t;
    const double step = SeparationFunction(*motion_, k_, bounds_, witness).advance(horizon);
    const double next = step >= horizon * (1.0 - 128.0 * u) ? bounds_.until : at.t + step;
    const double size = std::max(at.a.is_triangle() ? 0.0 : parts_a_.size(at.a),
                                 at.b.is_triangle() ? 0.0 : parts_b_->size(at.b));
    return next >= end_ || witness.gap > near * size ? next : at.t;
  }

  /// Follows two parts, as if they were bodies, until the end or the first known contact.
  void follow(const Key& at) {
    PlacedCore memory_a, memory_b;
    const ConvexCore core_a = parts_a_.core(at.a, memory_a);
    const ConvexCore core_b = plane_ ? ConvexCore() : parts_b_->core(at.b, memory_b);
    const Window window{window_.start, end_};
    const TimeOfImpact toi =
        advance_parts(a_, core_a, b_, plane_ ? nullptr : &core_b, window,
                      {.tolerance = options_.tolerance,
                       .prove = options_.prove,
                       .from = at.t,
                       .most_evaluations = plane_ ? most_looks : looks_at_parts});
    looks_ += toi.evaluations;
    switch (toi.status) {
      case ToiStatus::separated:
        return;
      case ToiStatus::overlapping:
        found_overlap_ = true;
        keep(toi, first_);
        return;
      case ToiStatus::impact:
        keep(toi, first_);
        end_ = std::min(end_, toi.t_hi);
        return;
      case ToiStatus::undecided:
        break;
    }
    // The looks of this pair are spent: others have their turn.
    if (toi.t_hi == toi.t_lo && toi.t_lo > at.t && !plane_) {
      push({toi.t_lo, at.a, at.b});
      return;
    }
    // Others may be proven to touch a little later. What comes long after it is not asked for: who
    // goes on begins there.
    const double t_hi = std::max(toi.t_hi, at.t + 64.0 * ulp(at.t));
    end_ = std::min(end_, t_hi + proofs_follow * (t_hi - toi.t_lo));
    if (!hidden_ || toi.t_lo < hidden_->t_lo) {
      hidden_ = toi;
      hidden_->t_hi = t_hi;
    }
    if (!plane_) {
      push({t_hi, at.a, at.b});
    }
  }

  static void keep(const TimeOfImpact& toi, std::optional<TimeOfImpact>& best) {
    if (!best || toi.t_lo < best->t_lo) {
      const double t_hi = best ? std::min(best->t_hi, toi.t_hi) : toi.t_hi;
      best = toi;
      best->t_hi = t_hi;
    } else {
      best->t_hi = std::min(best->t_hi, toi.t_hi);
    }
  }

  /// Makes one contact of the proven one and those before it that rounding leaves open.
  [[nodiscard]] TimeOfImpact answer() {
    std::optional<TimeOfImpact> toi = first_;
    if (hidden_ && (!toi || hidden_->t_lo < toi->t_lo)) {
      const bool one = toi && hidden_->t_hi >= toi->t_lo;
      const double t_hi = one ? toi->t_hi : hidden_->t_hi;
      toi = hidden_;
      toi->t_hi = t_hi;
      toi->status = one ? ToiStatus::impact : ToiStatus::undecided;
    }
    if (!toi) {
      TimeOfImpact none;
      none.t_lo = none.t_hi = window_.duration;
      none.evaluations = looks_;
      return none;
    }
    return finished(*toi);
  }

  [[nodiscard]] TimeOfImpact finished(TimeOfImpact toi) {
    toi.evaluations = looks_;
    const double coordinates = a_.motion.position(local_time(a_.motion, window_, toi.t_lo)).norm() +
                               b_.motion.position(local_time(b_.motion, window_, toi.t_lo)).norm();
    const double size = bounding_radius(a_.shape) + (plane_ ? 0.0 : bounding_radius(b_.shape));
    if (options_.prove && toi.gap <= 256.0 * u * (coordinates + size)) {
      retreat_from_overlap(a_, b_, window_, toi);
    }
    const Pose pose_a = a_.motion.pose(local_time(a_.motion, window_, toi.t_lo));
    const Pose pose_b = b_.motion.pose(local_time(b_.motion, window_, toi.t_lo));
    const double within = 512.0 * u * (coordinates + size) + toi.gap;
    const Vector3 middle =
        touching_point(a_.shape, pose_a, b_.shape, pose_b, toi.normal, toi.gap, within);
    toi.witness_a = middle - 0.5 * toi.gap * toi.normal;
    toi.witness_b = middle + 0.5 * toi.gap * toi.normal;
    return toi;
  }

  [[nodiscard]] TimeOfImpact overlapping(const Vector3& normal) const {
    TimeOfImpact toi;
    toi.status = ToiStatus::overlapping;
    toi.normal = normal;
    toi.witness_a = toi.witness_b = a_.motion.position(start_of(a_.motion, window_));
    toi.evaluations = looks_;
    return toi;
  }

  /// The answer when the work is spent: proven apart up to t.
  [[nodiscard]] TimeOfImpact exhausted(double t) {
    const Pose pose_a = a_.motion.pose(local_time(a_.motion, window_, t));
    const Pose pose_b = b_.motion.pose(local_time(b_.motion, window_, t));
    const Overlap o = measure_parts(a_.shape, pose_a, b_.shape, pose_b);
    TimeOfImpact toi;
    toi.status = ToiStatus::undecided;
    toi.t_lo = toi.t_hi = t;
    toi.gap = std::max(0.0, o.gap);
    toi.normal = o.normal;
    toi.witness_a = toi.witness_b = o.point;
    toi.evaluations = looks_;
    return toi;
  }

  MovingShape a_, b_;
  Window window_;
  AdvancementOptions options_;
  bool plane_;
  BodyParts parts_a_;
  std::optional<BodyParts> parts_b_;
  std::optional<PairMotion> motion_;
  Kinematics k_;
  TurnBounds bounds_;
  bool looked_ = false;
  bool bounded_ = false;
  double end_;  ///< contacts after it are not asked for: the window's, or a contact that is known
  std::vector<Key> keys_;
  std::vector<Key> stack_;
  std::optional<TimeOfImpact> first_;   ///< contact
  std::optional<TimeOfImpact> hidden_;  ///< rounding hides whether there is one
  bool found_overlap_ = false;
  int looks_ = 0;
};

}  // namespace

TimeOfImpact parts_impact(const MovingShape& a, const MovingShape& b, const Window& window,
                          const AdvancementOptions& options) {
  return PartsImpact(a, b, window, options).run();
}

TimeOfImpact parts_separation(const MovingShape& a, const MovingShape& b, const Window& window,
                              double tolerance) {
  constexpr int most_steps = 200'000;
  const double enough = tolerance > 0.0 ? tolerance : default_tolerance(a, b, window);
  const PairMotion motion(a, b, window);
  TimeOfImpact toi;
  Kinematics k;
  double t = 0.0;      // overlapping, or within tolerance, up to here
  double ahead = 0.0;  // looked at beyond it
  for (; toi.evaluations < most_steps; ++toi.evaluations) {
    const double at = t + ahead;
    const Overlap o = measure_parts(a.shape, a.motion.pose(local_time(a.motion, window, at)),
                                    b.shape, b.motion.pose(local_time(b.motion, window, at)));
    toi.normal = o.normal;
    if (o.gap > 0.0 && (at > 0.0 || o.gap > enough)) {
      toi.status = at > 0.0 ? ToiStatus::impact : ToiStatus::separated;
      toi.t_lo = t;
      toi.t_hi = at;
      return toi;
    }
    if (!(at < motion.duration())) {
      break;
    }
    motion.evaluate(at, k);
    const double rest = motion.duration() - at;
    const double horizon = std::isfinite(rest) ? rest : 1.0;
    const double speed = motion.speed_bound(k, motion.bounds(at, horizon), horizon);
    if (-o.gap > enough) {
      t = at;
      ahead = 0.0;
      const double safe = speed > 0.0 ? std::min(horizon, -o.gap / speed) : horizon;
      if (!(t + safe > t)) {
        break;
      }
      t += safe;
    } else {
      const double least = speed > 0.0 ? 0.25 * enough / speed : horizon;
      ahead = std::min(rest, std::max({2.0 * ahead, 8.0 * ulp(t), least}));
      if (!(t + ahead > t)) {
        break;
      }
    }
  }
  toi.status = ToiStatus::overlapping;
  toi.t_lo = toi.t_hi = motion.duration();
  return toi;
}

}  // namespace kairos::ccd
