#include "core/schemes/event/event_accumulation.hpp"

#include "core/archive.hpp"
#include "core/large_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Impacts hang together if the way between them is shorter than this part of the extent.
constexpr double small_way = 1e-3;
/// Hops that die down are taken for rest below this part of the extent.
constexpr double small_rest = 1e-10;
/// Those that do not, below so many eps of coordinates and extent: twice what `certified` takes for
/// touch.
constexpr double unresolved = 64.0;
/// More contacts than these are not followed.
constexpr std::size_t most_contacts = 24;

/// How many impacts are followed to see whether they end. A light body between two heavy ones that
/// close in on it has millions of them. Searches that may be made at every impact are short.
constexpr std::int64_t most_of_a_long_look = 200'000;
constexpr std::int64_t most_of_a_look = 2'000;

/// A search is made at the 3rd, 4th, 6th, 8th, 12th, 16th ... impact, so that searches cost a
/// constant share of the work.
bool worth_a_look(std::int64_t n) {
  const auto power_of_two = [](std::int64_t k) { return k > 0 && (k & (k - 1)) == 0; };
  return n >= 3 && (power_of_two(n) || (n % 3 == 0 && power_of_two(n / 3)));
}

/// Acceleration of the material point `arm` from the origin of a motion, m/s^2; the change of the
/// angular velocity is left out.
Vector3 acceleration_at(const Motion& motion, double s, const Vector3& w, const Vector3& arm) {
  return motion.acceleration(s) + w.cross(w.cross(arm));
}

/// One of two bodies in contact, at an instant.
struct Side {
  Side(const Model& model, BodyIndex i, const BodyState& at, const Motion& motion, double s,
       const Vector3& point)
      : body(i),
        free(model.is_free(i)),
        rotates(free && model.rotates(i)),
        inertia(model.inertia(i)),
        state(at),
        arm(point - at.pose.position),
        acceleration(acceleration_at(motion, s, at.twist.angular, arm)) {}

  [[nodiscard]] Vector3 velocity() const {
    return state.twist.linear + state.twist.angular.cross(arm);
  }
  [[nodiscard]] Vector3 turned_by(const Vector3& torque) const {
    return rotates ? inertia.inverse(state.pose.orientation, torque) : Vector3(Vector3::Zero());
  }

  BodyIndex body;
  bool free;
  bool rotates;
  const BodyInertia& inertia;
  BodyState state;
  Vector3 arm;
  Vector3 acceleration;
};

struct Joined {
  Contact contact;
  Side a;
  Side b;

  /// How much a unit impulse at `other`, along its normal, changes the rate of this contact, 1/kg.
  [[nodiscard]] double coupling(const Joined& other) const {
    double sum = 0.0;
    for (const Side* mine : {&a, &b}) {
      for (const Side* its : {&other.a, &other.b}) {
        if (mine->body != its->body || !mine->free) {
          continue;
        }
        const Vector3 impulse = (its == &other.a ? -1.0 : 1.0) * other.contact.normal;
        const Vector3 dv = impulse / mine->inertia.mass;
        const Vector3 dw = mine->turned_by(its->arm.cross(impulse));
        sum += (mine == &a ? -1.0 : 1.0) * contact.normal.dot(dv + dw.cross(mine->arm));
      }
    }
    return sum;
  }
};

}  // namespace

EventAccumulation::EventAccumulation(EventRun& run, const EventMotions& motions)
    : run_(run), motions_(motions), histories_(scattered<ImpactHistory>(run.model.size())) {}

double EventAccumulation::restitution(BodyIndex a, BodyIndex b) const {
  return run_.model.restitution(a, b);
}

double EventAccumulation::rest_tolerance(BodyIndex a, BodyIndex b, double e) const {
  const double extent =
      std::min(smallest_extent(run_.model.shape(a)), smallest_extent(run_.model.shape(b)));
  const double coordinate = std::max(motions_.now(a).pose.position.cwiseAbs().maxCoeff(),
                                     motions_.now(b).pose.position.cwiseAbs().maxCoeff());
  return rest_tolerance(extent, coordinate,
                        e < 1.0 || motions_.is_damped(a) || motions_.is_damped(b) ||
                            lately_lost(a) || lately_lost(b));
}

/// Whether a body, no ball, lately met one that does not return all of its speed, or several of
/// which one rubs. Between that and one that does return it its hops die down, too, on one corner
/// or another, where no collapse is seen.
bool EventAccumulation::lately_lost(BodyIndex i) const {
  if (!run_.model.is_free(i) || std::holds_alternative<Sphere>(run_.model.shape(i))) {
    return false;
  }
  const std::vector<BodyIndex> met = histories_[i].partners();
  return std::any_of(met.begin(), met.end(), [&](BodyIndex j) {
    return restitution(i, j) < 1.0 || (met.size() > 1 && run_.model.friction(i, j) > 0.0);
  });
}

double EventAccumulation::rest_tolerance(double extent, double coordinate, bool dies_down) {
  return dies_down ? small_rest * extent + 4.0 * epsilon * coordinate
                   : unresolved * epsilon * (coordinate + extent);
}

EventAccumulation::Scale EventAccumulation::scale_of(const Rebound& of) const {
  const auto extent_of = [](const PlainBall* ball) {
    return ball != nullptr ? 2.0 * ball->radius : std::numeric_limits<double>::infinity();
  };
  const auto pressing_of = [this](const PlainBall* ball, BodyIndex i) {
    return ball != nullptr ? motions_.flight(i).acceleration.norm() : 0.0;
  };
  const double extent_a = extent_of(of.ball_a);
  const double extent_b = extent_of(of.ball_b);
  const double coordinate = std::max(of.event.after_a.pose.position.cwiseAbs().maxCoeff(),
                                     of.event.after_b.pose.position.cwiseAbs().maxCoeff());
  return {
      rest_tolerance(std::min(extent_a, extent_b), coordinate, of.event.contact.restitution < 1.0),
      pressing_of(of.ball_a, of.event.a) + pressing_of(of.ball_b, of.event.b), small_way * extent_a,
      small_way * extent_b};
}

/// Twice the speed that `EventModes` takes for rest.
bool EventAccumulation::part_for_sure(const Rebound& of, const Scale& scale) {
  const double speeds =
      of.event.after_a.twist.linear.lpNorm<1>() + of.event.after_b.twist.linear.lpNorm<1>();
  const double parting = of.parting - 32.0 * epsilon * speeds;
  return parting > 0.0 && parting * parting > 8.0 * scale.pressing * scale.tolerance;
}

bool EventAccumulation::go_on_for_sure(const Rebound& of, const Scale& scale) {
  const auto [a, b] = std::pair{of.event.a, of.event.b};
  const bool rest = of.approach * of.approach <= 2.0 * scale.pressing * scale.tolerance;
  const Instant t = of.event.time;
  if (of.ball_a != nullptr) {
    histories_[a].add({b, of.approach, scale.near_a, scale.tolerance, rest}, t);
  }
  if (of.ball_b != nullptr) {
    histories_[b].add({a, of.approach, scale.near_b, scale.tolerance, rest}, t);
  }
  const auto goes_on = [this](const PlainBall* ball, BodyIndex i) {
    const ImpactHistory& history = histories_[i];
    return ball == nullptr ||
           (!history.rests() && !history.on_no_way() && !worth_a_look(history.chain()));
  };
  return goes_on(of.ball_a, a) && goes_on(of.ball_b, b);
}

EventAccumulation::Finding EventAccumulation::after_impact(const Rebound& of,
                                                           const Scale& scale) const {
  const auto [a, b] = std::pair{of.event.a, of.event.b};
  const bool resting = (of.ball_a == nullptr || histories_[a].rests()) &&
                       (of.ball_b == nullptr || histories_[b].rests());
  return conclude(a, b, scale.tolerance, resting, of.event.time);
}

EventAccumulation::Finding EventAccumulation::after_impact(BodyIndex a, BodyIndex b,
                                                           double approach, Instant t) {
  const double e = restitution(a, b);
  const double tolerance = rest_tolerance(a, b, e);
  const bool rest = rests(a, b, approach, tolerance, t);
  bool resting = true;
  for (const BodyIndex i : {a, b}) {
    if (!run_.model.is_free(i)) {
      continue;
    }
    const double near = small_way * smallest_extent(run_.model.shape(i));
    histories_[i].add({i == a ? b : a, approach, near, tolerance, rest}, t);
    resting = resting && histories_[i].rests();
  }
  return conclude(a, b, tolerance, resting, t);
}

/// What the impacts of the two come to, the last of which is counted.
EventAccumulation::Finding EventAccumulation::conclude(BodyIndex a, BodyIndex b, double tolerance,
                                                       bool resting, Instant t) const {
  const auto creeps_on = [&](BodyIndex i) {
    return run_.model.is_free(i) && histories_[i].creeps_on();
  };
  if (resting) {
    return {.kind = Finding::Kind::rests,
            .reason = fmt::format("accumulation: {} come to rest on each other: the hops "
                                  "that are left are below {:.2g} m",
                                  run_.names(a, b), tolerance),
            .bodies = {a, b},
            .endless = creeps_on(a) || creeps_on(b)};
  }
  for (const BodyIndex i : {a, b}) {
    if (!run_.model.is_free(i)) {
      continue;
    }
    const ImpactHistory& history = histories_[i];
    if (worth_a_look(history.chain())) {
      const std::vector<BodyIndex> met = history.partners();
      std::string reason = met.size() == 2 ? squeeze(i, met[0], met[1], t) : std::string();
      if (!reason.empty()) {
        return {.kind = Finding::Kind::squeezed, .reason = std::move(reason), .bodies = {a, b}};
      }
    }
    // The last impacts of a collapse follow each other on no way at all: each may end it.
    const bool long_look = worth_a_look(history.chain());
    if (long_look || history.on_no_way()) {
      Finding finding = collapse(a, b, t, long_look ? most_of_a_long_look : most_of_a_look);
      if (finding.kind != Finding::Kind::none) {
        if (history.creeps()) {
          finding.kind = Finding::Kind::creeps;
        }
        finding.goes_on = !history.creeps_on();
        return finding;
      }
    }
    if (history.creeps()) {
      std::vector<BodyIndex> bodies{a, b};
      const std::vector<BodyIndex> partners = history.partners();
      bodies.insert(bodies.end(), partners.begin(), partners.end());
      return {.kind = Finding::Kind::creeps,
              .reason = fmt::format("accumulation: impacts of {} follow each other without end, on "
                                    "ways below {:.2g} m",
                                    run_.names(a, b), tolerance),
              .bodies = std::move(bodies),
              .goes_on = !history.creeps_on()};
    }
  }
  return {};
}

bool EventAccumulation::creep(BodyIndex a, BodyIndex b) const {
  const auto of = [&](BodyIndex i) { return run_.model.is_free(i) && histories_[i].creeps(); };
  return of(a) || of(b);
}

bool EventAccumulation::stalls(BodyIndex a, BodyIndex b, Instant t, double resolution) {
  return histories_[run_.model.is_free(a) ? a : b].stalls(t, resolution);
}

/// Whether the two are pressed together so strongly that their hop stays below the tolerance h: u^2
/// <= 2 a h, where a is the greatest acceleration at any of their points.
bool EventAccumulation::rests(BodyIndex a, BodyIndex b, double approach, double tolerance,
                              Instant t) const {
  double pressing = 0.0;
  for (const BodyIndex i : {a, b}) {
    if (motions_.is_flight(i)) {
      pressing += motions_.flight(i).acceleration.norm();
      continue;
    }
    const auto moving = motions_.moving(i);
    const Motion& motion = moving.motion();
    const double s = std::min(t - motion.start, motion.duration);
    const double w = motion.twist(s).angular.norm();
    pressing += motion.acceleration(s).norm();
    // Corners go round; the surface of a ball does not come nearer by turning.
    if (w > 0.0 && !std::holds_alternative<Sphere>(run_.model.shape(i))) {
      pressing += w * w * bounding_radius(run_.model.shape(i));
    }
  }
  return approach * approach <= 2.0 * pressing * tolerance;
}

/// The pairs that met lately, from body to body, starting with this pair.
std::vector<BodyPair> EventAccumulation::cluster_pairs(BodyIndex a, BodyIndex b) const {
  std::vector<BodyPair> pairs{{a, b}};
  std::vector<BodyIndex> bodies{a, b};
  for (std::size_t k = 0; k < bodies.size() && pairs.size() < most_contacts; ++k) {
    const BodyIndex i = bodies[k];
    if (!run_.model.is_free(i)) {
      continue;
    }
    for (const BodyIndex j : histories_[i].partners()) {
      const BodyPair pair = run_.agenda.before(i, j) ? BodyPair{i, j} : BodyPair{j, i};
      if (std::find(pairs.begin(), pairs.end(), pair) == pairs.end()) {
        pairs.push_back(pair);
      }
      if (std::find(bodies.begin(), bodies.end(), j) == bodies.end()) {
        bodies.push_back(j);
      }
    }
  }
  return pairs;
}

/// Follows the bodies that met lately in relative coordinates, where positions do not round.
EventAccumulation::Finding EventAccumulation::collapse(BodyIndex a, BodyIndex b, Instant t,
                                                       std::int64_t most_impacts) const {
  std::vector<Joined> joined;
  ImpactCluster cluster;
  double horizon = std::numeric_limits<double>::infinity();
  bool dissipates = false;
  for (const auto& [p, q] : cluster_pairs(a, b)) {
    const Shape& shape_p = run_.model.shape(p);
    const Shape& shape_q = run_.model.shape(q);
    const Overlap o =
        run_.detector.overlap(shape_p, motions_.at(p, t).pose, shape_q, motions_.at(q, t).pose);
    const auto side = [&](BodyIndex i) {
      const bool struck = (i == a || i == b) && run_.model.is_free(i);
      const auto moving = motions_.moving(i);
      const Motion& motion = moving.motion();
      return Side(run_.model, i, struck ? motions_.now(i) : motions_.at(i, t), motion,
                  std::min(t - motion.start, motion.duration), o.point);
    };
    joined.push_back({{o.point, o.normal, o.gap}, side(p), side(q)});
    const Side& of_p = joined.back().a;
    const Side& of_q = joined.back().b;
    const Vector3 v = of_q.velocity() - of_p.velocity();
    const double e = restitution(p, q);
    cluster.contacts.push_back({std::max(o.gap, 0.0), o.normal.dot(v),
                                o.normal.dot(of_q.acceleration - of_p.acceleration), e});
    dissipates = dissipates || e < 1.0;
    // Normals are constant until one body has moved past the other by a small part of its extent.
    const double way = small_way * std::min(smallest_extent(shape_p), smallest_extent(shape_q));
    horizon = std::min(horizon, way / v.norm());
  }
  if (!dissipates || joined.size() < 2) {
    return {};
  }
  for (const Joined& row : joined) {
    for (const Joined& column : joined) {
      cluster.coupling.push_back(row.coupling(column));
    }
  }
  const ClusterFate fate = follow(std::move(cluster), horizon, most_impacts);
  if (fate.kind != ClusterFate::Kind::accumulates) {
    return {};
  }
  Finding finding;
  finding.kind = Finding::Kind::collapse;
  finding.remaining = fate.duration;
  finding.pairs = joined.size();
  std::string names;
  for (const Joined& j : joined) {
    names += (names.empty() ? "" : ", ") + run_.names(j.a.body, j.b.body);
    finding.bodies.push_back(j.a.body);
    finding.bodies.push_back(j.b.body);
  }
  finding.reason = fmt::format(
      "accumulation: infinitely many impacts before t = {} s, between {} (inelastic collapse): "
      "they end in touch",
      (t + fate.duration).seconds, names);
  return finding;
}

std::string EventAccumulation::squeeze(const BodyPair& one, const BodyPair& other,
                                       Instant t) const {
  std::string reason;
  for (const auto& [i, beside] : {one, BodyPair{one.second, one.first}}) {
    for (const auto& [k, opposite] : {other, BodyPair{other.second, other.first}}) {
      if (i == k && reason.empty()) {
        reason = squeeze(i, beside, opposite, t);
      }
    }
  }
  return reason;
}

std::string EventAccumulation::squeeze(BodyIndex i, BodyIndex one, BodyIndex other,
                                       Instant t) const {
  if (!run_.model.is_free(i) || run_.model.is_free(one) || run_.model.is_free(other)) {
    return {};
  }
  Vector3 normal = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
  double gap = 0.0;
  double left = std::numeric_limits<double>::infinity();
  bool opposite = true;
  for (const BodyIndex j : {one, other}) {
    const Overlap o = run_.detector.overlap(run_.model.shape(j), motions_.at(j, t).pose,
                                            run_.model.shape(i), motions_.at(i, t).pose);
    opposite = normal.isZero(0.0) || normal.dot(o.normal) < -1.0 + 1e-12;
    velocity = motions_.at(j, t).twist.linear - velocity;
    normal = o.normal;
    gap += std::max(o.gap, 0.0);
    left = std::min(left, motions_.end_of(j) - t);
  }
  // Velocity of the second body relative to the first, along the second's normal, which points to
  // body i.
  const double closing = normal.dot(velocity);
  if (!opposite || !(closing > 0.0) || !(gap < closing * left)) {
    return {};
  }
  return fmt::format(
      "accumulation: {} and '{}' close on '{}': no room is left at t = {} s, and "
      "impacts follow each other ever faster until then; allowed: a run that ends "
      "before (--duration)",
      "'" + run_.model.body(one).name + "'", run_.model.body(other).name, run_.model.body(i).name,
      (t + gap / closing).seconds);
}

void EventAccumulation::persist(Archive& archive) { archive(histories_); }

}  // namespace core
}  // namespace kairos
