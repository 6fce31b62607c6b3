#include "core/drives/track.hpp"

#include "core/circular.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A remainder of a segment shorter than this part of it is skipped: it is only the rounding of the
/// end of the motion before, at most an ulp of the duration.
constexpr double skipped_part = 16.0 * eps;

/// The rotation vector that turns q_0 into q_1 the shorter way, world frame, rad.
Vector3 rotation_between(const Quaternion& q0, const Quaternion& q1) {
  Quaternion turn = q1 * q0.conjugate();
  if (turn.w() < 0.0) {
    turn.coeffs() = -turn.coeffs();
  }
  const double sine = turn.vec().norm();
  if (!(sine > 0.0)) {
    return Vector3::Zero();
  }
  return 2.0 * arc_tangent(sine, turn.w()) / sine * turn.vec();
}

/// Derivative at sample i of the parabola through it and its neighbours; at the ends, of the chord.
Vector3 tangent(const std::vector<TrackSample>& samples, std::size_t i) {
  const auto chord = [&samples](std::size_t j) {
    const TrackSample& a = samples[j];
    const TrackSample& b = samples[j + 1];
    return Vector3((b.pose.position - a.pose.position) / (b.time - a.time));
  };
  if (i == 0) {
    return chord(0);
  }
  if (i + 1 == samples.size()) {
    return chord(i - 1);
  }
  const double before = samples[i].time - samples[i - 1].time;
  const double after = samples[i + 1].time - samples[i].time;
  return (after * chord(i - 1) + before * chord(i)) / (before + after);
}

/// Rounding of the coefficients: a few ulp of the coordinates, and of the turn at the body's reach.
double rounding(const TrackSample& a, const TrackSample& b, const Vector3& turn, double reach) {
  const double coordinates = std::max(a.pose.position.lpNorm<Eigen::Infinity>(),
                                      b.pose.position.lpNorm<Eigen::Infinity>());
  const double angle = turn.norm();
  return 16.0 * eps * coordinates + (angle > 0.0 ? 8.0 * eps * (1.0 + angle) * reach : 0.0);
}

Motion held(Instant t, double duration, const Pose& pose) {
  Motion motion = Motion::at_rest(t, pose);
  motion.duration = duration;
  return motion;
}

}  // namespace

Track::Track(std::vector<TrackSample> samples, Options options)
    : samples_(std::move(samples)), options_(std::move(options)) {
  assert(!samples_.empty());
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
    assert(samples_[i].time < samples_[i + 1].time);
    segments_.push_back(segment(i));
  }
}

Motion Track::segment(std::size_t i) const {
  const TrackSample& a = samples_[i];
  const TrackSample& b = samples_[i + 1];
  const double h = b.time - a.time;
  const Vector3 turn = rotation_between(a.pose.orientation, b.pose.orientation);
  const Vector3 chord = (b.pose.position - a.pose.position) / h;
  Motion motion =
      Motion::ballistic(Instant{a.time}, h, a.pose, {chord, Vector3(turn / h)}, Vector3::Zero());
  if (options_.smooth) {
    const Vector3 m0 = tangent(samples_, i);
    const Vector3 m1 = tangent(samples_, i + 1);
    motion.position = Polynomial<3>(a.pose.position, m0, Vector3((3.0 * chord - 2.0 * m0 - m1) / h),
                                    Vector3((m0 + m1 - 2.0 * chord) / (h * h)));
    motion.velocity = motion.position.differentiated();
  }
  motion.error_radius = rounding(a, b, turn, options_.reach);
  return motion;
}

std::size_t Track::index_at(Instant t) const {
  const auto next = std::upper_bound(
      samples_.begin(), samples_.end(), t,
      [](Instant time, const TrackSample& sample) { return time < Instant{sample.time}; });
  auto i = static_cast<std::size_t>(next - samples_.begin()) - 1;
  while (i < segments_.size() && !(segments_[i].end() - t > skipped_part * segments_[i].duration)) {
    ++i;
  }
  return i;
}

Motion Track::motion(Instant t, double at_most) const {
  const Instant first{samples_.front().time};
  if (t < first) {
    return held(t, std::min(at_most, first - t), samples_.front().pose);
  }
  const std::size_t i = index_at(t);
  if (i == segments_.size()) {
    return held(t, at_most, samples_.back().pose);
  }
  const Motion& whole = segments_[i];
  const double s = std::max(0.0, t - whole.start);
  Motion rest = s > 0.0 ? whole.shifted(s) : whole;
  rest.start = t;
  rest.duration = std::min(at_most, whole.end() - t);
  return rest;
}

bool Track::closed(Instant t) const {
  return t < Instant{samples_.front().time} ? samples_.front().closed
                                            : samples_[index_at(t)].closed;
}

bool Track::turns() const {
  return std::any_of(segments_.begin(), segments_.end(),
                     [](const Motion& m) { return m.rotation != RotationKind::fixed; });
}

}  // namespace core
}  // namespace kairos
