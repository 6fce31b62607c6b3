#include "ccd/swept_windows.hpp"

#include "ccd/rounding/roundoff.hpp"
#include "ccd/swept_box.hpp"
#include "core/archive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kairos::ccd {

SweptWindows::SweptWindows(const Model& model, std::unique_ptr<BroadPhase> boxes, double tolerance)
    : model_(model),
      boxes_(model, std::move(boxes)),
      tolerance_(tolerance),
      longest_reach_(infinity),
      watched_(model.size()) {
  if (const auto& periodic = model.scene().periodic) {
    for (int k = 0; k < 3; ++k) {
      const double period = periodic->period()[k];
      longest_reach_ = period > 0.0 ? std::min(longest_reach_, 0.5 * period) : longest_reach_;
    }
  }
}

SweptWindows::Watched& SweptWindows::watch(BodyIndex i) {
  if (watched_[i] == nullptr) {
    watched_[i] = std::make_unique<Watched>();
  }
  return *watched_[i];
}

Instant SweptWindows::enter(BodyIndex i, const MovingShape& moving, Instant t, Instant until) {
  Instant end = until;
  Instant crosses = Instant::never();
  if (model_.is_free(i)) {
    const Instant window_end = t + window_length(i, moving, t);
    if (window_end < until) {
      end = crosses = window_end;
    }
  }
  const double s = t - moving.motion.start;
  Aabb swept = swept_aabb(moving.shape, moving.motion, s, s + (std::max(end, t) - t));
  // A detector may report contact anywhere within its tolerance, bodies are held in touch within
  // twice that, and no such pair may be left out: by each of the two, for the other may be a plane.
  const double radius = bounding_radius(moving.shape);
  if (std::isfinite(radius)) {
    const double size =
        std::max(swept.lower.lpNorm<Eigen::Infinity>(), swept.upper.lpNorm<Eigen::Infinity>());
    const double near = (tolerance_ > 0.0 ? 2.0 * tolerance_ : 4e-9 * radius) +
                        moving.motion.error_radius + 2048.0 * unit_roundoff * (size + radius);
    swept.lower.array() -= near;
    swept.upper.array() += near;
  }
  Watched& watched = watch(i);
  watched.swept = swept;
  watched.known = true;
  boxes_.update(i, swept);
  return crosses;
}

/// How long it takes i to go as far as its reach, s.
double SweptWindows::window_length(BodyIndex i, const MovingShape& moving, Instant t) {
  double& reach = watch(i).reach;
  if (reach == 0.0) {
    reach = 4.0 * bounding_radius(moving.shape);
    watch(i).least_reach = reach / 64.0;
  }
  reach = std::min(reach, longest_reach_);
  const double s = t - moving.motion.start;
  const double speed = moving.motion.velocity(s).norm();
  const double acceleration = moving.motion.acceleration(s).norm();
  // At least as far as its reach at constant acceleration: |v| t + |a| t^2 / 2 = reach.
  return 2.0 * reach / (speed + std::sqrt(speed * speed + 2.0 * acceleration * reach));
}

void SweptWindows::near(BodyIndex i, std::vector<Neighbour>& out) {
  Watched& watched = watch(i);
  const std::size_t before = out.size();
  boxes_.near(i, watched.swept, out);
  // About ten neighbours cost least.
  constexpr std::size_t few = 8;
  constexpr std::size_t many = 16;
  const std::size_t found = out.size() - before;
  if (found > many) {
    // Of what touches it, it has all as neighbours however short its way is.
    watched.reach = std::max(0.5 * watched.reach, watched.least_reach);
  } else if (found < few) {
    watched.reach *= 1.5;
  }
}

Instant SweptWindows::cross(BodyIndex i, const MovingShape& moving, Instant t, Instant until,
                            std::vector<Neighbour>& out) {
  const Instant crosses = enter(i, moving, t, until);
  near(i, out);
  return crosses;
}

void SweptWindows::go_on_as(BodyIndex i, const Image& n) {
  if (is_known(i)) {
    const Vector3 shift = model_.scene().periodic->shift(n);
    Aabb& swept = watched_[i]->swept;
    swept = {swept.lower + shift, swept.upper + shift};
    boxes_.update(i, swept);
  }
}

void SweptWindows::leave(BodyIndex i) {
  watch(i).known = false;
  boxes_.remove(i);
}

void SweptWindows::Watched::persist(Archive& archive) {
  archive(reach, least_reach, swept.lower, swept.upper, known);
}

void SweptWindows::persist(Archive& archive) {
  for (BodyIndex i = 0; i < watched_.size(); ++i) {
    bool here = watched_[i] != nullptr;
    archive(here);
    if (here) {
      archive(watch(i));
    }
    if (archive.reading() && is_known(i)) {
      boxes_.update(i, watched_[i]->swept);
    }
  }
}

}  // namespace kairos::ccd
