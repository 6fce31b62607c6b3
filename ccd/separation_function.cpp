#include "ccd/separation_function.hpp"

#include "ccd/relative_boxes.hpp"
#include "ccd/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// First positive root of f + b h + c h^2, f > 0; infinity if there is none. Where a bound is
/// infinite or the arithmetic overflows nothing is known: 0.
double first_root(double f, double b, double c) {
  const double discriminant = b * b - 4.0 * f * c;
  if (!std::isfinite(discriminant)) {
    return 0.0;
  }
  if (c < 0.0) {
    const double root = std::sqrt(discriminant);
    return b <= 0.0 ? 2.0 * f / (root - b) : -(b + root) / (2.0 * c);
  }
  if (b >= 0.0 || discriminant < 0.0) {
    return infinity;
  }
  return 2.0 * f / (std::sqrt(discriminant) - b);
}

}  // namespace

SeparationFunction::SeparationFunction(const PairMotion& motion, const Kinematics& k,
                                       const TurnBounds& turn, const Witness& witness)
    : motion_(motion), k_(k), turn_(turn), witness_(witness) {
  value_ = witness.gap * witness.length - k.error;
  switch (witness.frame) {
    case WitnessFrame::spheres:
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
  least_slope_ = tangent() - k.rate_error;
  if (curvature_depends_on_horizon()) {
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
    add_supports(motion_.half_a(), k_.R_WA, g_a);
    bend += motion_.radius_a() * second_of_axis(turn_a, g_a, turn_.w_a, turn_.alpha_a);
  }
  if (motion_.radius_b() > 0.0 && moves_b) {
    add_supports(motion_.half_b(), k_.R_WB, g_b);
    bend += motion_.radius_b() * second_of_axis(turn_b, g_b, turn_.w_b, turn_.alpha_b);
  }
  fixed_bend_ = 0.5 * bend;
}

/// n = a_i x b_j: n . a_i = n . b_j = 0 for all time, so only two edges of each box count.
void SeparationFunction::along_edges() {
  const Vector3& n = witness_.n;
  const Vector3 a = k_.R_WA.col(witness_.edge_a);
  const Vector3 b = k_.R_WB.col(witness_.edge_b);
  const double sign = a.cross(b).dot(n) < 0.0 ? -1.0 : 1.0;
  const Vector3 a_rate = k_.w_a.cross(a);
  const Vector3 b_rate = k_.w_b.cross(b);
  const Vector3 n_rate = sign * (a_rate.cross(b) + a.cross(b_rate));
  slope_ = n.dot(k_.v) + n_rate.dot(k_.d);
  if (constant_rates()) {
    const Vector3 half_n_second =
        0.5 * (k_.w_a.cross(a_rate).cross(b) + a.cross(k_.w_b.cross(b_rate))) +
        a_rate.cross(b_rate);
    second_ = sign * half_n_second.dot(k_.d) + n_rate.dot(k_.v) + n.dot(k_.c);
  }
  // An axis x of a moves at w_a x x, so that n . x changes at (n' + n x w_a) . x.
  const Vector3 g_a = n_rate + n.cross(k_.w_a);
  const Vector3 g_b = n_rate + n.cross(k_.w_b);
  double weights = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (i != witness_.edge_a && motion_.half_a()[i] > 0.0) {
      const auto axis = k_.R_WA.col(i);
      terms_[count_++] = {motion_.half_a()[i], n.dot(axis), g_a.dot(axis)};
      weights += motion_.half_a()[i];
    }
    if (i != witness_.edge_b && motion_.half_b()[i] > 0.0) {
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
  // n is not normalised: the reach counts |n| times, which grows at `relative` at most.
  if (motion_.reach() > 0.0) {  // `relative` may be infinite
    slope_ -= motion_.reach() * relative;
  }
}

double SeparationFunction::tangent() const {
  double slope = slope_;
  for (int i = 0; i < count_; ++i) {
    const Term& term = terms_[i];
    slope -= term.weight * (term.s > 0.0   ? term.rate
                            : term.s < 0.0 ? -term.rate
                                           : std::abs(term.rate));
  }
  return slope;
}

double SeparationFunction::chord(double h) const {
  double growth = 0.0;
  for (int i = 0; i < count_; ++i) {
    const Term& term = terms_[i];
    growth += term.weight * (std::abs(term.s + term.rate * h) - std::abs(term.s));
  }
  return slope_ - growth / h;
}

double SeparationFunction::curvature(double horizon) const {
  const double bend = turn_.bend;
  switch (witness_.frame) {
    case WitnessFrame::spheres:
    case WitnessFrame::world:
      return second_ - bend - fixed_bend_;
    default:
      break;
  }
  const double c = c_ + bend;
  const double speed = speed_ + 2.0 * c * horizon;
  const double distance = distance_ + (speed_ + c * horizon) * horizon;
  const bool edges = witness_.frame == WitnessFrame::edges;
  const bool with_a = witness_.frame == WitnessFrame::a;
  const double w = edges ? turn_.w_a + turn_.w_b : with_a ? turn_.w_a : turn_.w_b;
  if (constant_rates()) {  // the second derivative is exact, and the third bounded
    const double third = w * (6.0 * c + w * (3.0 * speed + w * distance));
    return second_ - third * horizon / 6.0 - fixed_bend_;
  }
  const double alpha = edges    ? turn_.alpha_a + turn_.alpha_b
                       : with_a ? turn_.alpha_a
                                : turn_.alpha_b;
  return -0.5 * ((w * w + alpha) * distance + 2.0 * w * speed + 2.0 * c) - fixed_bend_;
}

double SeparationFunction::rate() const { return (least_slope_ + k_.rate_error) / witness_.length; }

double SeparationFunction::step_within(double reach) const {
  const double second = curvature(reach);
  const double step = std::min(reach, first_root(value_, least_slope_, second));
  // Over [0, step] every kinked term stays below its chord.
  return std::min(step, first_root(value_, chord(step) - k_.rate_error, second));
}

double SeparationFunction::advance(double horizon) const {
  if (!(value_ > 0.0)) {
    return 0.0;
  }
  if (!curvature_depends_on_horizon()) {
    const double second = curvature(horizon);
    double h = std::min(horizon, first_root(value_, least_slope_, second));
    if (count_ > 0) {
      // Where nothing ends h, a radian does.
      h = std::isfinite(h) ? h : 1.0 / (turn_.w_a + turn_.w_b);
      h = std::min(h, first_root(value_, chord(h) - k_.rate_error, second));
    }
    return h * (1.0 - 64.0 * u);
  }
  // The quadratic holds on a horizon of our choice: about twice the step that it allows. Where the
  // gap closes, that is near its tangent's root.
  const double turning = turn_.w_a + turn_.w_b;
  double reach = std::min(horizon, turning > 0.0 ? 1.0 / turning : horizon);
  if (!std::isfinite(reach)) {
    return 0.0;
  }
  if (least_slope_ < 0.0) {
    reach = std::min(reach, -1.25 * value_ / least_slope_);
  }
  double h = step_within(reach);
  if (h < 0.4 * reach) {
    h = std::max(h, step_within(2.0 * h));
  }
  return h * (1.0 - 64.0 * u);
}

double SeparationFunction::advance_from_touch(double horizon) const {
  if (!(least_slope_ > 0.0)) {
    return 0.0;
  }
  // Start 2 errors below the present value and look for the second root.
  const double start = std::min(value_, 0.0) - 2.0 * k_.error;
  double reach = horizon;
  const double turning = turn_.w_a + turn_.w_b;
  if (turning > 0.0) {
    reach = std::min(reach, 1.0 / turning);
  }
  for (int attempt = 0; attempt < 60; ++attempt) {
    if (!std::isfinite(reach)) {
      if (count_ > 0 || curvature_depends_on_horizon()) {
        reach = 1.0;
      } else if (curvature(reach) >= 0.0) {
        return infinity;
      }
    }
    const double second = curvature(reach);
    const double b = (count_ > 0 ? chord(reach) : slope_) - k_.rate_error;
    const double discriminant = b * b - 4.0 * start * second;
    if (b > 0.0 && discriminant > 0.0 && std::isfinite(discriminant)) {
      const double end = second < 0.0 ? -(b + std::sqrt(discriminant)) / (2.0 * second) : reach;
      const double left = -2.0 * start / (b + std::sqrt(discriminant));
      const double h = std::min(end, reach);
      if (h > 2.0 * left) {
        return h * (1.0 - 64.0 * u);
      }
    }
    if (!(reach > 0.0)) {
      break;
    }
    reach = (std::isfinite(reach) ? reach : 1.0) * 0.25;
  }
  return 0.0;
}

// ---- witnesses ----------------------------------------------------------------------------------

namespace {

Witness between_points(const Vector3& d, double reach) {
  Witness witness;
  const double distance = d.norm();
  witness.n = distance > 0.0 ? Vector3(d / distance) : Vector3(Vector3::UnitY());
  witness.gap = distance - reach;
  return witness;
}

/// a is a sphere, b a box: the direction from the nearest point of the box.
Witness from_box(const PairMotion& motion, const Kinematics& k) {
  const Vector3 c = -(k.R_WB.transpose() * k.d);
  const Vector3& half = motion.half_b();
  const Vector3 out = c - c.cwiseMax(-half).cwiseMin(half);
  const double distance = out.norm();
  Witness witness;
  witness.frame = motion.turns_b() ? WitnessFrame::b : WitnessFrame::world;
  if (distance > 0.0) {
    witness.n = k.R_WB * (out / -distance);
    witness.gap = distance - motion.reach();
    return witness;
  }
  int face = 0;
  const double depth = (half - c.cwiseAbs()).minCoeff(&face);
  witness.n = k.R_WB.col(face) * (c[face] < 0.0 ? 1.0 : -1.0);
  witness.gap = -depth - motion.reach();
  return witness;
}

/// b is a half-space.
Witness from_plane(const PairMotion& motion, const Kinematics& k) {
  Witness witness;
  witness.frame = motion.turns_b() ? WitnessFrame::b : WitnessFrame::world;
  witness.n = -k.R_WB.col(1);
  double support = motion.reach();
  if (motion.radius_a() > 0.0) {
    support += motion.half_a().dot((k.R_WA.transpose() * witness.n).cwiseAbs());
  }
  witness.gap = witness.n.dot(k.d) - support;
  return witness;
}

Witness from_boxes(const PairMotion& motion, const Kinematics& k) {
  const AxisSeparation best =
      greatest_separation(motion.half_a(), k.R_WA, motion.half_b(), k.R_WB, k.d);
  Witness witness;
  witness.gap = best.gap() - motion.reach();
  witness.axis = best.axis;
  witness.sign = best.sign;
  if (best.axis < 3) {
    witness.frame = motion.turns_a() ? WitnessFrame::a : WitnessFrame::world;
    witness.n = best.sign * k.R_WA.col(best.axis);
  } else if (best.axis < 6) {
    witness.frame = motion.turns_b() ? WitnessFrame::b : WitnessFrame::world;
    witness.n = best.sign * k.R_WB.col(best.axis - 3);
  } else {
    witness.frame =
        motion.turns_a() || motion.turns_b() ? WitnessFrame::edges : WitnessFrame::world;
    witness.edge_a = (best.axis - 6) / 3;
    witness.edge_b = (best.axis - 6) % 3;
    witness.length = best.length;
    witness.n = best.sign * k.R_WA.col(witness.edge_a).cross(k.R_WB.col(witness.edge_b));
  }
  return witness;
}

}  // namespace

PairKind pair_kind(const Shape& a, const Shape& b) {
  const bool sphere = std::holds_alternative<Sphere>(a);
  if (std::holds_alternative<HalfSpace>(b)) {
    return sphere ? PairKind::sphere_plane : PairKind::box_plane;
  }
  if (std::holds_alternative<Sphere>(b)) {
    return PairKind::sphere_sphere;
  }
  return sphere ? PairKind::sphere_box : PairKind::box_box;
}

Witness between_balls(PairKind kind, const PairMotion& motion, const Kinematics& k) {
  const double reach = motion.reach() + motion.radius_a() + motion.radius_b();
  Witness witness;
  if (kind == PairKind::sphere_plane || kind == PairKind::box_plane) {
    witness.n = -k.R_WB.col(1);
    // A plane that turns has no ball around it.
    witness.gap = motion.turns_b() ? -infinity : witness.n.dot(k.d) - reach;
  } else {
    witness = between_points(k.d, reach);
  }
  witness.frame = WitnessFrame::spheres;
  return witness;
}

Witness unit_in_world(const PairMotion& motion, const Kinematics& k, const Witness& witness) {
  Witness still = witness;
  still.frame = WitnessFrame::world;
  if (witness.frame == WitnessFrame::edges) {
    still.n = witness.n / witness.length;
    still.length = 1.0;
    still.gap = still.n.dot(k.d) - motion.reach() -
                motion.half_a().dot((k.R_WA.transpose() * still.n).cwiseAbs()) -
                motion.half_b().dot((k.R_WB.transpose() * still.n).cwiseAbs());
  }
  return still;
}

double clear_of_balls(PairKind kind, const PairMotion& motion) {
  const bool plane = kind == PairKind::sphere_plane || kind == PairKind::box_plane;
  if (plane && motion.turns_b()) {
    return 0.0;
  }
  const double reach =
      (motion.reach() + motion.radius_a() + motion.radius_b()) * (1.0 + 8.0 * unit_roundoff);
  double t = 0.0;
  Kinematics k;
  // Along the line of the centres the distance is a parabola, or not below one. Three such lines
  // come near enough to where the balls touch: the bodies inside them matter then.
  for (int line = 0; line < (plane ? 1 : 3); ++line) {
    plane ? motion.evaluate(t, k) : motion.evaluate_translation(t, k);
    const double distance = k.d.norm();
    const Vector3 n = plane ? Vector3(-k.R_WB.col(1)) : Vector3(k.d / distance);
    const double value = (plane ? n.dot(k.d) : distance) - reach - k.error;
    if (!(value > 0.05 * reach)) {
      break;
    }
    const double bend = motion.bend(t, motion.duration());
    const double step = first_root(value, n.dot(k.v) - k.rate_error, n.dot(k.c) - bend);
    const double remaining = motion.duration() - t;
    if (step >= remaining) {
      return motion.duration();
    }
    t += step * (1.0 - 64.0 * u);
  }
  return t;
}

Witness find_witness(PairKind kind, const PairMotion& motion, const Kinematics& k) {
  switch (kind) {
    case PairKind::sphere_sphere:
      return between_points(k.d, motion.reach());
    case PairKind::sphere_box:
      return from_box(motion, k);
    case PairKind::sphere_plane:
    case PairKind::box_plane:
      return from_plane(motion, k);
    case PairKind::box_box:
      break;
  }
  return from_boxes(motion, k);
}

bool proven_overlap(PairKind kind, const PairMotion& motion, const Kinematics& k,
                    const Witness& witness) {
  if (kind != PairKind::box_box) {
    return witness.gap < -k.error;
  }
  if (witness.gap >= 0.0) {
    return false;
  }
  if (motion.reach() > 0.0) {
    // Boxes whose greatest separation is s are at most sqrt(3) s apart (see the README).
    const double separation = witness.gap + motion.reach();
    return separation + k.error / witness.length < 0.57 * motion.reach();
  }
  return classify(motion.half_a(), k.R_WA, motion.half_b(), k.R_WB, k.d) == Verdict::overlapping;
}

}  // namespace kairos::ccd
