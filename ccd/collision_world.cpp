#include "ccd/collision_world.hpp"

#include "ccd/core_of_shape.hpp"
#include "ccd/core_pair.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/sweep_and_prune.hpp"
#include "ccd/swept_box.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kairos::ccd {
namespace {

bool is_convex(const Shape& shape) {
  return !std::holds_alternative<HalfSpace>(shape) && !std::holds_alternative<Mesh>(shape) &&
         !std::holds_alternative<Compound>(shape);
}

void check(const Pose& pose) {
  constexpr double unit_to = 1e-9;
  if (!pose.position.allFinite() || !(std::abs(pose.orientation.norm() - 1.0) <= unit_to)) {
    throw std::invalid_argument(
        "CollisionWorld: a pose has a finite position and a unit orientation");
  }
}

std::uint64_t key_of(BodyIndex a, BodyIndex b) {
  return (static_cast<std::uint64_t>(a) << 32U) | static_cast<std::uint64_t>(b);
}

/// Are they proven apart along n, of any length? Roundings as in (eq. 11) of the README, at rest.
bool apart_along(const Vector3& n, const Shape& a, const Pose& pose_a, const Shape& b,
                 const Pose& pose_b) {
  const ConvexCore core_a = core_of(a);
  const ConvexCore core_b = core_of(b);
  const Matrix3 R_a = pose_a.orientation.toRotationMatrix();
  const Matrix3 R_b = pose_b.orientation.toRotationMatrix();
  const CorePair pair{core_a, core_b, R_a, R_b, pose_b.position - pose_a.position};
  const double reach = core_a.rounding() + core_b.rounding();
  const double error =
      64.0 * unit_roundoff * (pair.d.lpNorm<1>() + core_a.extent() + core_b.extent() + reach);
  return pair.separation(n) > (reach + error) * n.norm();
}

}  // namespace

CollisionWorld::CollisionWorld(std::size_t most)
    : objects_(most), broad_phase_(make_sweep_and_prune(most)) {}

void CollisionWorld::put(BodyIndex object, Shape shape, const Pose& pose, CollisionFilter filter) {
  check(pose);
  remove(object);
  objects_.at(object) = Object{std::move(shape), pose, filter, {}};
  update(object);
}

void CollisionWorld::move(BodyIndex object, const Pose& pose) {
  (void)at(object);
  check(pose);
  objects_[object]->pose = pose;
  update(object);
}

void CollisionWorld::remove(BodyIndex object) {
  if (has(object)) {
    broad_phase_->remove(object);
    objects_[object].reset();
    std::erase_if(directions_, [object](const auto& kept) {
      return kept.first >> 32U == object || (kept.first & 0xffffffffU) == object;
    });
  }
}

bool CollisionWorld::has(BodyIndex object) const {
  return object < objects_.size() && objects_[object].has_value();
}

void CollisionWorld::respond(BodyIndex object, Response response) {
  (void)at(object);
  objects_[object]->response = std::move(response);
}

void CollisionWorld::respond(BodyIndex a, BodyIndex b, Response response) {
  (void)at(a);
  (void)at(b);
  for_pairs_[std::minmax(a, b)] = std::move(response);
}

const CollisionWorld::Object& CollisionWorld::at(BodyIndex object) const {
  if (!has(object)) {
    throw std::out_of_range("CollisionWorld: there is no such object");
  }
  return *objects_[object];
}

void CollisionWorld::update(BodyIndex object) {
  const Object& o = *objects_[object];
  broad_phase_->update(object, swept_aabb(o.shape, Motion::at_rest(Instant{}, o.pose), 0.0, 0.0));
}

const std::vector<Touch>& CollisionWorld::touching() {
  touches_.clear();
  next_directions_.clear();
  cost_ = {};
  for (BodyIndex a = 0; a < objects_.size(); ++a) {
    if (!objects_[a]) {
      continue;
    }
    near_.clear();
    broad_phase_->candidates(a, near_);
    for (const BodyIndex b : near_) {
      if (b > a) {
        look(a, b);
      }
    }
  }
  directions_.swap(next_directions_);
  const std::vector<Touch> told = touches_;
  for (const Touch& touch : told) {
    call_response(touch);
  }
  return touches_;
}

bool CollisionWorld::apart_as_before(std::uint64_t pair, const Object& a, const Object& b) {
  const auto before = directions_.find(pair);
  if (before == directions_.end() ||
      !apart_along(before->second, a.shape, a.pose, b.shape, b.pose)) {
    return false;
  }
  next_directions_.insert(*before);
  return true;
}

void CollisionWorld::look(BodyIndex a, BodyIndex b) {
  const Object& first = *objects_[a];
  const Object& second = *objects_[b];
  if ((first.filter.mask & second.filter.group) == 0 ||
      (second.filter.mask & first.filter.group) == 0) {
    return;
  }
  ++cost_.near;
  const std::uint64_t pair = key_of(a, b);
  const bool convex = is_convex(first.shape) && is_convex(second.shape);
  if (convex && apart_as_before(pair, first, second)) {
    ++cost_.reminded;
    return;
  }
  ++cost_.asked;
  const Overlap overlap = measure_overlap(first.shape, first.pose, second.shape, second.pose);
  if (overlap.overlapping) {
    touches_.push_back({a, b, overlap});
  } else if (convex) {
    next_directions_.emplace(pair, overlap.normal);
  }
}

void CollisionWorld::call_response(const Touch& touch) const {
  const auto pair = for_pairs_.find({touch.a, touch.b});
  const auto of = [this](BodyIndex i) { return has(i) ? objects_[i]->response : Response{}; };
  const Response response = pair != for_pairs_.end() && pair->second ? pair->second
                            : of(touch.a)                            ? of(touch.a)
                            : of(touch.b)                            ? of(touch.b)
                                                                     : for_all_;
  if (response) {
    response(touch);
  }
}

}  // namespace kairos::ccd
