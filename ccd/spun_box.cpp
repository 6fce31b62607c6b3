#include "ccd/spun_box.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

/// Projections onto each: the distance falls with each, the faster the rounder the bodies.
constexpr int most_projections = 128;
constexpr double enough = 1e-9;  ///< of the distance, that one projection changes

}  // namespace

SpunBox SpunBox::spinning(const Vector3& half, const Vector3& centre, const Matrix3& axes,
                          const Vector3& w) {
  SpunBox body(half, centre, axes);
  body.w_ = w.normalized();
  const Vector3 axis = axes.transpose() * body.w_;
  std::array<Corner, 4> rings;
  double widest = 0.0;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const Vector3 x((i & 1U) != 0 ? half.x() : -half.x(), (i & 2U) != 0 ? half.y() : -half.y(),
                    half.z());
    rings[i] = {std::abs(x.dot(axis)), x.cross(axis).norm()};
    widest = std::max(widest, rings[i].away);
  }
  std::sort(rings.begin(), rings.end(),
            [](const Corner& p, const Corner& q) { return p.along < q.along; });
  const auto add = [&body](const Corner& p) {
    // The upper hull, from left to right [Andrew1979].
    while (body.corners_ >= 2) {
      const Corner& last = body.profile_[static_cast<std::size_t>(body.corners_ - 1)];
      const Corner& before = body.profile_[static_cast<std::size_t>(body.corners_ - 2)];
      if ((last.along - before.along) * (p.away - before.away) <
          (last.away - before.away) * (p.along - before.along)) {
        break;
      }
      --body.corners_;
    }
    body.profile_[static_cast<std::size_t>(body.corners_++)] = p;
  };
  add({0.0, widest});
  for (const Corner& ring : rings) {
    add(ring);
  }
  add({rings.back().along, 0.0});
  return body;
}

Vector3 SpunBox::nearest(const Vector3& x) const {
  const Vector3 d = x - centre_;
  if (w_.isZero(0.0)) {
    const Vector3 x_B = axes_.transpose() * d;
    return centre_ + axes_ * x_B.cwiseMax(-half_).cwiseMin(half_);
  }
  const double along = d.dot(w_);
  const Vector3 across = d - along * w_;
  const double away = across.norm();
  const double height = std::abs(along);
  Corner best{height, away};
  double least = 0.0;
  for (int i = 0; i + 1 < corners_; ++i) {
    const Corner& p = profile_[static_cast<std::size_t>(i)];
    const Corner& q = profile_[static_cast<std::size_t>(i + 1)];
    const double l = q.along - p.along, r = q.away - p.away;
    const double outside = (away - p.away) * l - (height - p.along) * r;
    const double length = l * l + r * r;
    if (!(outside > 0.0) || !(length > 0.0)) {
      continue;
    }
    const double s = std::clamp(((height - p.along) * l + (away - p.away) * r) / length, 0.0, 1.0);
    const Corner on{p.along + s * l, p.away + s * r};
    const double square =
        (on.along - height) * (on.along - height) + (on.away - away) * (on.away - away);
    if (least == 0.0 || square < least) {
      least = square;
      best = on;
    }
  }
  const Vector3 out = away > 0.0 ? Vector3(across / away) : Vector3(Vector3::Zero());
  return centre_ + std::copysign(best.along, along) * w_ + best.away * out;
}

Vector3 direction_between(const SpunBox& a, const SpunBox& b, const Vector3& start) {
  Vector3 on_b = b.nearest(start);
  Vector3 direction = Vector3::Zero();
  for (int i = 0; i < most_projections; ++i) {
    const Vector3 on_a = a.nearest(on_b);
    on_b = b.nearest(on_a);
    const Vector3 before = direction;
    direction = on_b - on_a;
    if ((direction - before).norm() <= enough * direction.norm()) {
      break;
    }
  }
  return direction;
}

}  // namespace kairos::ccd
