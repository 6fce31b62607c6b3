#include "ccd/separation_function.hpp"

#include "ccd/relative_boxes.hpp"
#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// Part of a value that is subtracted before a root is sought: if the discriminant cancels, its
/// terms are off by some 8 u of the value.
constexpr double root_rounding = 32.0 * u;
/// A step is shortened by this part: the roundings of a root, and of the sum t + h.
constexpr double step_rounding = 64.0 * u;
/// How far a convex f must reach beyond the root of its tangent to be worth a look.
constexpr double beyond_tangent = 1.25;
/// A step that uses so much of its horizon is good enough: no other can be more than twice as long.
constexpr double well_used = 0.5;
/// A support is off by so much of its core's extent and of the length of its direction.
constexpr double support_rounding = 4.0 * u;
/// How far ahead, rad, the highest point is asked for where several are at first.
constexpr double kink = 1e-9;
/// Horizons tried for one step. Each halves the logarithm of the open range, so that 6 reduce 20
/// orders of magnitude to a factor of 2.
constexpr int most_horizons = 6;

}  // namespace

SeparationFunction::SeparationFunction(const PairMotion& motion, const Kinematics& k,
                                       const TurnBounds& turn, const Witness& witness)
    : motion_(motion), k_(k), turn_(turn), witness_(witness) {
  const bool hulls = witness.frame == WitnessFrame::hulls;
  scale_ = witness.frame == WitnessFrame::edges ? witness.sine : 1.0;
  error_ = k.error * scale_;
  rate_error_ = hulls ? k.still_rate_error : k.rate_error;
  second_error_ = hulls ? k.still_second_error : k.second_error;
  value_ = witness.gap * scale_ - error_;
  switch (witness.frame) {
    case WitnessFrame::hulls:
      slope_ = witness.n.dot(k.v);
      second_ = witness.n.dot(k.c);
      break;
    case WitnessFrame::world:
      along_frame(Vector3::Zero());
      break;
    case WitnessFrame::a:
      along_frame(k.w_a);
      break;
    case WitnessFrame::b:
      along_frame(k.w_b);
      break;
    case WitnessFrame::edges:
      along_edges();
  }
  least_slope_ = tangent() - rate_error_;
  if (direction_turns()) {
    distance_ = k.d.norm();
    speed_ = k.v.norm();
    c_ = k.c.norm();
  }
}

void SeparationFunction::add_supports(const Vector3& half, const Matrix3& axes, const Vector3& g) {
  for (int i = 0; i < 3; ++i) {
    if (half[i] > 0.0) {
      terms_[count_++] = {half[i], witness_.n.dot(axes.col(i)), g.dot(axes.col(i))};
    }
  }
}

void SeparationFunction::add_core(const ConvexCore& core, const Matrix3& R, double side,
                                  const Vector3& g) {
  CoreTerm& term = cores_[core_count_++];
  term.core = &core;
  term.m = R.transpose() * (side * scale_ * witness_.n);
  term.rate = R.transpose() * (side * g);
  term.support = core.support(term.m);
}

/// n turns at w: in its frame d moves at v - w x d, and an axis of X at (w_X - w) x axis. The
/// second derivative of n . axis is at most |n x w'| |w'| while w' = w_X - w stays what it is,
/// which it does in the world for constant rates.
void SeparationFunction::along_frame(const Vector3& w) {
  const Vector3& n = witness_.n;
  const bool in_world = witness_.frame == WitnessFrame::world;
  const Vector3 w_x_d = w.cross(k_.d);
  slope_ = n.dot(k_.v - w_x_d);
  if (in_world) {
    second_ = n.dot(k_.c);
  } else {
    second_ = n.dot(k_.c - w.cross(k_.v) + 0.5 * w.cross(w_x_d));
  }
  const Vector3 turn_a = k_.w_a - w;
  const Vector3 turn_b = k_.w_b - w;
  const Vector3 g_a = n.cross(turn_a);
  const Vector3 g_b = n.cross(turn_b);
  const bool moves_a =
      motion_.turns_a() ? witness_.frame != WitnessFrame::a : witness_.frame == WitnessFrame::b;
  const bool moves_b =
      motion_.turns_b() ? witness_.frame != WitnessFrame::b : witness_.frame == WitnessFrame::a;
  const double alpha_frame = witness_.frame == WitnessFrame::a   ? turn_.alpha_a
                             : witness_.frame == WitnessFrame::b ? turn_.alpha_b
                                                                 : 0.0;
  // Bound of the second derivative of n . axis of a body that turns at `relative` in the frame.
  const auto second_of_axis = [&](const Vector3& relative, const Vector3& g, double speed,
                                  double alpha) {
    if (alpha + alpha_frame > 0.0) {  // rates change: only their bounds are known
      const double w_frame = witness_.frame == WitnessFrame::a   ? turn_.w_a
                             : witness_.frame == WitnessFrame::b ? turn_.w_b
                                                                 : 0.0;
      const double relative_speed = speed + w_frame;
      return relative_speed * relative_speed + w_frame * speed + alpha + alpha_frame;
    }
    const double size_squared = relative.squaredNorm();
    if (!in_world) {
      const double drift_squared = w.cross(relative).squaredNorm();
      if (drift_squared > 0.0) {
        return size_squared + std::sqrt(drift_squared);
      }
    }
    return std::sqrt(size_squared * g.squaredNorm());
  };
  double bend = 0.0;
  if (motion_.radius_a() > 0.0 && moves_a) {
    if (motion_.has_cores()) {
      add_core(motion_.core_a(), k_.R_WA, 1.0, g_a);
    } else {
      add_supports(motion_.half_a(), k_.R_WA, g_a);
    }
    bend += motion_.radius_a() * second_of_axis(turn_a, g_a, turn_.w_a, turn_.alpha_a);
  }
  if (motion_.radius_b() > 0.0 && moves_b) {
    if (motion_.has_cores()) {
      add_core(motion_.core_b(), k_.R_WB, -1.0, g_b);
    } else {
      add_supports(motion_.half_b(), k_.R_WB, g_b);
    }
    bend += motion_.radius_b() * second_of_axis(turn_b, g_b, turn_.w_b, turn_.alpha_b);
  }
  fixed_bend_ = 0.5 * bend;
}

/// n = a_i x b_j, of the length of their sine: n . a_i = n . b_j = 0 for all time, so only two
/// edges of each box count (eq. 4).
void SeparationFunction::along_edges() {
  const Vector3 n = witness_.n * scale_;
  const bool cores = motion_.has_cores();
  const int edge_a = cores ? 0 : witness_.edge_a();
  const int edge_b = cores ? 0 : witness_.edge_b();
  const Vector3 a = cores ? witness_.along_a : Vector3(k_.R_WA.col(edge_a));
  const Vector3 b = cores ? witness_.along_b : Vector3(witness_.sign * k_.R_WB.col(edge_b));
  const Vector3 a_rate = k_.w_a.cross(a);
  const Vector3 b_rate = k_.w_b.cross(b);
  const Vector3 n_rate = a_rate.cross(b) + a.cross(b_rate);
  slope_ = n.dot(k_.v) + n_rate.dot(k_.d);
  if (constant_rates()) {
    const Vector3 half_n_second =
        0.5 * (k_.w_a.cross(a_rate).cross(b) + a.cross(k_.w_b.cross(b_rate))) +
        a_rate.cross(b_rate);
    second_ = half_n_second.dot(k_.d) + n_rate.dot(k_.v) + n.dot(k_.c);
  }
  // An axis x of a moves at w_a x x, so that n . x changes at (n' + n x w_a) . x.
  const Vector3 g_a = n_rate + n.cross(k_.w_a);
  const Vector3 g_b = n_rate + n.cross(k_.w_b);
  double weights = 0.0;
  if (cores) {
    add_core(motion_.core_a(), k_.R_WA, 1.0, g_a);
    add_core(motion_.core_b(), k_.R_WB, -1.0, g_b);
    weights = motion_.radius_a() + motion_.radius_b();
  }
  for (int i = 0; i < 3 && !cores; ++i) {
    if (i != edge_a && motion_.half_a()[i] > 0.0) {
      const auto axis = k_.R_WA.col(i);
      terms_[count_++] = {motion_.half_a()[i], n.dot(axis), g_a.dot(axis)};
      weights += motion_.half_a()[i];
    }
    if (i != edge_b && motion_.half_b()[i] > 0.0) {
      const auto axis = k_.R_WB.col(i);
      terms_[count_++] = {motion_.half_b()[i], n.dot(axis), g_b.dot(axis)};
      weights += motion_.half_b()[i];
    }
  }
  // n . a_k is the product of two axes, one of each body: its second derivative knows only how the
  // bodies turn against each other.
  const double relative =
      turn_.alpha_a + turn_.alpha_b > 0.0 ? turn_.w_a + turn_.w_b : (k_.w_b - k_.w_a).norm();
  const double drift =
      turn_.alpha_a + turn_.alpha_b > 0.0 ? turn_.w_a * turn_.w_b : k_.w_a.cross(k_.w_b).norm();
  fixed_bend_ = 0.5 * weights * (relative * relative + drift + turn_.alpha_a + turn_.alpha_b);
  // n is not normalised: reach and error count |n| times, which grows at `relative` at most
  // (it may be infinite).
  const double around = motion_.reach() + k_.error;
  if (!(motion_.reach() > 0.0)) {
    slope_ -= around * relative;
    return;
  }
  // While |n| is more than half of what it is, |n|'' <= |n''| + |n'|^2 / |n|.
  const double turns = turn_.w_a + turn_.w_b;
  const double second = turns * turns + turn_.alpha_a + turn_.alpha_b;
  length_.crude = around * relative;
  length_.rate = around * witness_.n.dot(n_rate);
  length_.bend = 0.5 * around * (second + 2.0 * turns * turns / scale_);
  length_.limit = 0.5 * scale_ / turns;
}

double SeparationFunction::tangent() const {
  double slope = slope_ - length_.slope(0.0);
  for (int i = 0; i < count_; ++i) {
    const Term& term = terms_[i];
    slope -= term.weight * (term.s > 0.0   ? term.rate
                            : term.s < 0.0 ? -term.rate
                                           : std::abs(term.rate));
  }
  for (int i = 0; i < core_count_; ++i) {
    const CoreTerm& term = cores_[i];
    // Where several points are highest, one of those that rise most.
    const double size = term.rate.norm();
    const Vector3 ahead = size > 0.0 ? Vector3(term.m + (kink / size) * term.rate) : term.m;
    slope -= term.core->support_point(ahead).dot(term.rate);
  }
  return slope;
}

double SeparationFunction::chord(double h) const {
  double growth = 0.0;
  for (int i = 0; i < count_; ++i) {
    const Term& term = terms_[i];
    growth += term.weight * (std::abs(term.s + term.rate * h) - std::abs(term.s));
  }
  for (int i = 0; i < core_count_; ++i) {
    const CoreTerm& term = cores_[i];
    const Vector3 end = term.m + h * term.rate;
    growth += term.core->support(end) - term.support +
              support_rounding * term.core->extent() * (scale_ + end.lpNorm<1>());
  }
  return slope_ - length_.slope(h) - growth / h;
}

double SeparationFunction::unknown_curvature(double horizon) const {
  const double bend = turn_.bend;
  const double fixed = fixed_bend_ + second_error_;
  if (!direction_turns()) {
    return bend + fixed;
  }
  const double c = c_ + bend;
  const double speed = speed_ + 2.0 * c * horizon;
  const double distance = distance_ + (speed_ + c * horizon) * horizon;
  const bool edges = witness_.frame == WitnessFrame::edges;
  const bool with_a = witness_.frame == WitnessFrame::a;
  const double w = edges ? turn_.w_a + turn_.w_b : with_a ? turn_.w_a : turn_.w_b;
  if (constant_rates()) {  // the second derivative is exact, and the third bounded
    const double third = w * (6.0 * c + w * (3.0 * speed + w * distance));
    return third * horizon / 6.0 + fixed;
  }
  const double alpha = edges    ? turn_.alpha_a + turn_.alpha_b
                       : with_a ? turn_.alpha_a
                                : turn_.alpha_b;
  return 0.5 * ((w * w + alpha) * distance + 2.0 * w * speed + 2.0 * c) + fixed;
}

double SeparationFunction::curvature(double horizon) const {
  return known_curvature() - unknown_curvature(horizon) - length_.second(horizon);
}

double SeparationFunction::rate() const { return (least_slope_ + rate_error_) / scale_; }

double SeparationFunction::step_within(double reach) const {
  // Over [0, reach] every kinked term stays below its chord.
  const double slope = (has_terms() ? chord(reach) : slope_) - rate_error_;
  return std::min(reach, first_root(value_ * (1.0 - root_rounding), slope, curvature(reach)));
}

double SeparationFunction::first_reach(double horizon) const {
  if (!direction_turns()) {
    const double root = first_root(value_, least_slope_, curvature(horizon));
    const double reach = std::min(horizon, root);
    // If nothing else ends the horizon, a radian does.
    return std::isfinite(reach) ? reach : 1.0 / (turn_.w_a + turn_.w_b);
  }
  double reach = std::min(horizon, 1.0 / (turn_.w_a + turn_.w_b));
  if (least_slope_ < 0.0) {
    reach = std::min(reach, -beyond_tangent * value_ / least_slope_);
  }
  if (length_.crude > 0.0) {
    reach = std::min(reach, std::max(length_.limit, value_ / length_.crude));
  }
  return reach;
}

/// The horizon that its own quadratic allows, nearly, at most `high`; what is allowed on any is a
/// step. A long one makes the quadratic low (chords of kinked terms, the bound of the third
/// derivative), a short one ends the step.
template <typename Allowed>
double longest_step(double high, const Allowed& allowed_within) {
  if (!(high > 0.0) || !std::isfinite(high)) {
    return 0.0;
  }
  double step = allowed_within(high);
  // Where bounds on the longest overflow, shorter ones may not.
  double low = step > 0.0 ? step : high * 1e-18;
  for (int attempt = 0; attempt < most_horizons && low < well_used * high; ++attempt) {
    // The geometric mean, from a ratio: the same bits in every unit of time.
    const double reach = high * std::sqrt(low / high);
    const double allowed = allowed_within(reach);
    step = std::max(step, allowed);
    (allowed < reach ? high : low) = reach;
    low = std::max(low, allowed);
  }
  return step * (1.0 - step_rounding);
}

double SeparationFunction::advance(double horizon) const {
  if (!(value_ > 0.0)) {
    return 0.0;
  }
  if (!has_terms() && !direction_turns()) {  // a quadratic, whatever the horizon
    const double slope = slope_ - rate_error_;
    const double root = first_root(value_ * (1.0 - root_rounding), slope, curvature(horizon));
    return std::min(horizon, root) * (1.0 - step_rounding);
  }
  return longest_step(first_reach(horizon), [this](double reach) { return step_within(reach); });
}

double SeparationFunction::advance_inside(double horizon) const {
  const double depth = -(value_ + 2.0 * error_);
  if (!(depth > 0.0)) {
    return 0.0;
  }
  const double turning = turn_.w_a + turn_.w_b;
  const double reach = turning > 0.0 ? std::min(horizon, 1.0 / turning) : horizon;
  // The kinked terms are below their tangents.
  const double slope = -(tangent() + rate_error_);
  return longest_step(reach, [&](double h) {
    const double second = -(known_curvature() + unknown_curvature(h));
    return std::min(h, first_root(depth * (1.0 - root_rounding), slope, second));
  });
}

double SeparationFunction::advance_from_touch(double horizon) const {
  // Start 2 errors below the present value and look for the second root.
  const double start = std::min(value_, 0.0) - 2.0 * error_;
  const double turning = turn_.w_a + turn_.w_b;
  double reach = turning > 0.0 ? std::min(horizon, 1.0 / turning) : horizon;
  for (int attempt = 0; attempt < 60; ++attempt) {  // a quarter each time: to 1e-36 of it
    if (!std::isfinite(reach)) {
      if (has_terms() || direction_turns()) {
        reach = 1.0;
      } else if (curvature(reach) >= 0.0 && slope_ > rate_error_) {
        return infinity;
      }
    }
    const double second = curvature(reach);
    const double slope = (has_terms() ? chord(reach) : slope_) - rate_error_;
    const double discriminant = slope * slope - 4.0 * start * second;
    const double root = std::sqrt(discriminant);
    // It may descend at first by less than roundoff.
    const bool leaves = slope > 0.0 || (second > 0.0 && slope * slope < 16.0 * error_ * second);
    if (leaves && std::isfinite(root) && slope + root > 0.0) {
      const double end = second < 0.0 ? -(slope + root) / (2.0 * second) : reach;
      const double left = -2.0 * start / (slope + root);
      const double h = std::min(end, reach);
      if (h > 2.0 * left) {
        return h * (1.0 - step_rounding);
      }
    }
    if (!(reach > 0.0)) {
      break;
    }
    reach = (std::isfinite(reach) ? reach : 1.0) * 0.25;
  }
  return 0.0;
}

double SeparationFunction::least_within(double reach) const {
  if (!std::isfinite(reach)) {
    return -infinity;
  }
  const double second = std::min(0.0, curvature(reach));
  const double slope = std::min(0.0, (has_terms() ? chord(reach) : slope_) - rate_error_);
  return (value_ + (slope + second * reach) * reach) / scale_;
}

}  // namespace kairos::ccd
