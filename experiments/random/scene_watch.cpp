#include "experiments/random/scene_watch.hpp"

#include "core/impact_check.hpp"
#include "experiments/random/plain_overlap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::experiments {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// In all frames, of which there are 64 and one.
constexpr std::int64_t most_events = 66 * SceneWatch::most_in_frame;
/// Bodies in contact are no farther apart than so much of their size: hops that are taken for rest
/// are below 1e-10 of it.
constexpr double in_touch = 1e-6;

/// Joints are held at the ends of steps; in between they open by what a step is interpolated to.
constexpr double joint_opens = 1e-9;

double radius_of(const Shape& shape) {
  const double radius = bounding_radius(shape);
  return std::isfinite(radius) ? radius : 0.0;
}

/// What a gap is a sum of, m: a box adds up its three half extents.
double coordinates_of(const Shape& shape) {
  const auto* box = std::get_if<Box>(&shape);
  return box != nullptr ? box->half_extents.sum() : radius_of(shape);
}

/// A ball or box that reaches farther by `more`; nothing where it is something else.
bool grow(Shape& shape, double more) {
  if (auto* ball = std::get_if<Sphere>(&shape)) {
    ball->radius += more;
    return true;
  }
  if (auto* box = std::get_if<Box>(&shape)) {
    box->half_extents.array() += more;
    return true;
  }
  return false;
}

}  // namespace

void SceneWatch::frame(const Frame& frame) {
  check_impacts();
  for (auto& [pair, reached] : in_contact_) {
    const auto& [a, b] = pair;
    reached = std::max(reached, coordinates(a, frame.bodies[a], b, frame.bodies[b]));
  }
  check_overlap(frame.bodies, frame.time);
  check_contacts(frame.bodies, frame.time);
  check_energy(frame);
  check_dissipation(frame);
  check_joints(frame.bodies, frame.time);
  if (frame.index > most_events) {
    throw BrokenPromise{Fate::hang, "frames without end", frame.time.seconds};
  }
}

void SceneWatch::event(const Event& event) {
  if (!at_once_.empty() && at_once_.front().time != event.time) {
    check_impacts();
  }
  const std::pair pair{std::min(event.a, event.b), std::max(event.a, event.b)};
  if (event.kind == EventKind::impact) {
    check_pair(event.a, event.before_a, event.b, event.before_b, event.time);
    at_once_.push_back(event);
  } else if (event.kind == EventKind::contact_begins) {
    in_contact_.emplace(pair, 0.0);
  } else if (event.kind == EventKind::contact_ends) {
    in_contact_.erase(pair);
  }
  if (++events_ > most_events) {
    throw BrokenPromise{Fate::hang, fmt::format("{} events", events_), event.time.seconds};
  }
}

void SceneWatch::check_energy(const Frame& frame) const {
  const double allowed = 8.0 * epsilon * frame.ledger.flow();
  if (std::abs(frame.ledger.unexplained()) > allowed) {
    throw BrokenPromise{
        Fate::ledger,
        fmt::format("{} J unexplained, allowed {}", frame.ledger.unexplained(), allowed),
        frame.time.seconds};
  }
}

void SceneWatch::check_dissipation(const Frame& frame) {
  constexpr std::array lines{EnergyLine::friction, EnergyLine::impact_friction,
                             EnergyLine::zeno_completion};
  const double rounding = 8.0 * epsilon * frame.ledger.flow();
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double now = frame.ledger.line(lines[k]);
    if (now > dissipated_[k] + rounding) {
      throw BrokenPromise{
          Fate::friction,
          fmt::format("{} gave {:.3g} J in a frame", to_string(lines[k]), now - dissipated_[k]),
          frame.time.seconds};
    }
    dissipated_[k] = now;
  }
}

/// By what each kind of joint means, not by the rows that hold it.
void SceneWatch::check_joints(std::span<const BodyState> bodies, Instant t) const {
  for (const Joint& joint : model_->scene().joints) {
    const auto pose = [&](const JointSide& side) {
      return side.body ? bodies[*side.body].pose : Pose{};
    };
    const Pose a = pose(joint.a);
    const Pose b = pose(joint.b);
    const Vector3 arm_a = a.orientation * joint.a.point;
    const Vector3 arm_b = b.orientation * joint.b.point;
    const Vector3 apart = (b.position - a.position) + (arm_b - arm_a);
    const Quaternion frame_a = a.orientation * joint.a.frame;
    const Quaternion frame_b = b.orientation * joint.b.frame;
    const Vector3 axis_a = frame_a * Vector3::UnitX();
    double open = apart.norm();
    double turned = 0.0;
    switch (joint.kind) {
      case JointKind::ball:
        break;
      case JointKind::rod:
        open = std::abs(apart.norm() - joint.length);
        break;
      case JointKind::hinge:
        turned = axis_a.cross(frame_b * Vector3::UnitX()).norm();
        break;
      case JointKind::slider:
        open = axis_a.cross(apart).norm();
        turned = 2.0 * (frame_a.conjugate() * frame_b).vec().norm();
        break;
      case JointKind::weld:
        turned = 2.0 * (frame_a.conjugate() * frame_b).vec().norm();
        break;
    }
    const auto radius = [&](const JointSide& side) {
      return side.body ? radius_of(model_->shape(*side.body)) : 0.0;
    };
    const double size =
        arm_a.norm() + arm_b.norm() + joint.length + radius(joint.a) + radius(joint.b);
    const double scale = a.position.norm() + b.position.norm() + size;
    if (open > joint_opens * size + 64.0 * epsilon * scale || turned > joint_opens) {
      throw BrokenPromise{Fate::joint,
                          fmt::format("a {} joint is {:.3g} m and {:.3g} rad open",
                                      to_string(joint.kind), open, turned),
                          t.seconds};
    }
  }
}

void SceneWatch::check_impacts() {
  for (const Event& event : at_once_) {
    // With friction restitution is one of work, not of velocities; what jams sticks, and what ends
    // an impact that is handed on returns nothing.
    if (event.contact.friction > 0.0 || event.flag == EventFlag::painleve ||
        event.flag == EventFlag::plastic) {
      continue;
    }
    const double e = model_->restitution(event.a, event.b);
    if (const std::string broken = broken_restitution(event, e, handed_on(event));
        !broken.empty()) {
      throw BrokenPromise{Fate::law, names(event.a, event.b) + ": " + broken, event.time.seconds};
    }
  }
  at_once_.clear();
}

/// Of what an impact gave to each of the two, N s.
double SceneWatch::momentum(const Event& event) const {
  double most = 0.0;
  for (const auto& [i, before, after] : {std::tuple{event.a, &event.before_a, &event.after_a},
                                         std::tuple{event.b, &event.before_b, &event.after_b}}) {
    if (model_->is_free(i)) {
      most = std::max(
          most, model_->inertia(i).mass * (after->twist.linear - before->twist.linear).norm());
    }
  }
  return most;
}

/// What a rebound among several at once may be off by, m/s. Impulses from two sides nearly cancel,
/// and each is known to some epsilon of the greatest; what one does to the velocity of the contact
/// is 1/m + r^2/I of it. And faces in touch are apart by what their gaps are, thus tilted against
/// each other: no velocity returns all their points as restitution has it, by tilt times speed.
/// What is struck at once is solved for at once, to some epsilon of the fastest, which may be one
/// that slides past.
double SceneWatch::handed_on(const Event& event) const {
  if (at_once_.size() < 2) {
    return 0.0;
  }
  double greatest = 0.0;
  double tilt = 0.0;
  double speed = 0.0;
  double fastest = 0.0;
  for (const Event& other : at_once_) {
    fastest = std::max({fastest, other.before_a.twist.linear.norm(),  //
                        other.before_b.twist.linear.norm()});
    greatest = std::max(greatest, momentum(other));
    const double extent = std::min(smallest_extent(model_->shape(other.a)),  //
                                   smallest_extent(model_->shape(other.b)));
    tilt = std::max(tilt, std::abs(other.contact.gap) / extent);
    speed = std::max(speed, std::abs(normal_velocity(other.contact, other.before_a,  //
                                                     other.before_b)));
  }
  double response = 0.0;
  for (const auto& [i, state] : {std::pair{event.a, &event.after_a}, {event.b, &event.after_b}}) {
    if (!model_->is_free(i)) {
      continue;
    }
    const BodyInertia& inertia = model_->inertia(i);
    const double arm = (event.contact.point - state->pose.position).norm();
    response += 1.0 / inertia.mass;
    response += inertia.rotates ? arm * arm / inertia.principal.minCoeff() : 0.0;
  }
  return 64.0 * epsilon * (greatest * response + fastest) + tilt * speed;
}

void SceneWatch::check_overlap(std::span<const BodyState> bodies, Instant t) const {
  for (const auto& [a, b] : model_->pairs()) {
    if (model_->is_field(a) || model_->is_field(b) || !(model_->is_free(a) || model_->is_free(b))) {
      continue;
    }
    check_pair(a, bodies[a], b, bodies[b], t);
  }
}

/// Body b as the image that is nearest to a.
Pose SceneWatch::seen(BodyIndex b, Pose pose_b, BodyIndex a, const Pose& pose_a) const {
  const double radii = bounding_radius(model_->shape(a)) + bounding_radius(model_->shape(b));
  if (const auto& box = model_->scene().periodic; box && std::isfinite(radii)) {
    pose_b.position += box->shift(box->nearest(pose_b.position - pose_a.position));
  }
  return pose_b;
}

/// What a gap of the two is a sum of, m.
double SceneWatch::coordinates(BodyIndex a, const BodyState& at_a, BodyIndex b,
                               const BodyState& at_b) const {
  return at_a.pose.position.lpNorm<1>() + at_b.pose.position.lpNorm<1>() +
         coordinates_of(model_->shape(a)) + coordinates_of(model_->shape(b));
}

/// By geometry of its own, which no detector shares.
void SceneWatch::check_pair(BodyIndex a, const BodyState& state_a, BodyIndex b,
                            const BodyState& state_b, Instant t) const {
  const Pose pose_b = seen(b, state_b.pose, a, state_a.pose);
  const double depth = plain_depth(model_->shape(a), state_a.pose, model_->shape(b), pose_b);
  double scale = coordinates(a, state_a, b, state_b);
  // A contact that lasts keeps what its gap was rounded to where it has been.
  if (const auto held = in_contact_.find(std::minmax(a, b)); held != in_contact_.end()) {
    scale = std::max(scale, held->second);
  }
  // Bodies in touch may stay so to 16 times the bound of a gap's rounding, 12 eps of what it is a
  // sum of (ccd/README.md, eq. 11); less is no overlap that could be told from none.
  constexpr double hidden = 16.0 * 12.0 * epsilon;
  if (depth > hidden * scale) {
    throw BrokenPromise{Fate::overlap,
                        fmt::format("'{}' is {:.3g} m inside '{}'", model_->body(b).name, depth,
                                    model_->body(a).name),
                        t.seconds};
  }
}

/// Bodies that are told to be in contact are: one that reaches a little farther overlaps the other.
void SceneWatch::check_contacts(std::span<const BodyState> bodies, Instant t) const {
  for (const auto& [pair, reached] : in_contact_) {
    const auto& [a, b] = pair;
    Shape shape_a = model_->shape(a);
    Shape shape_b = model_->shape(b);
    const double more = in_touch * (radius_of(shape_a) + radius_of(shape_b));
    if (!grow(shape_a, more) && !grow(shape_b, more)) {
      continue;
    }
    const Pose pose_b = seen(b, bodies[b].pose, a, bodies[a].pose);
    if (!(plain_depth(shape_a, bodies[a].pose, shape_b, pose_b) > 0.0)) {
      throw BrokenPromise{
          Fate::apart,
          fmt::format("{} are in contact, and more than {:.3g} m apart", names(a, b), more),
          t.seconds};
    }
  }
}

std::string SceneWatch::names(BodyIndex a, BodyIndex b) const {
  return fmt::format("'{}' and '{}'", model_->body(a).name, model_->body(b).name);
}

}  // namespace kairos::experiments
