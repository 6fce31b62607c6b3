#include "tests/judge/lasting/verdict.hpp"

#include "core/random.hpp"
#include "tests/judge/lasting/cone_fit.hpp"
#include "tests/judge/lasting/touching.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace kairos::judge {
namespace {

/// Surfaces that are so far apart, as a part of the smaller body, may press: rest is at the
/// surface, or at the small gap at which what turns is held, and hops below 1e-10 are taken for
/// rest.
constexpr Real margin = 1e-8L;
/// Points that part or approach faster, as a part of the speed of a fall by the size, do not press.
constexpr Real at_rest = 1e-7L;
/// The same where steps are implicit, and so of first order.
constexpr Real at_rest_in_step = 1e-2L;
/// Velocities are put right at the end of a step by up to so much of that speed.
constexpr Real put_right = 1e-10L;
/// What slides slower than this, in the same units, may be about to stop or begin: where friction
/// is not against the slide, but in its cone, that is counted and no fault.
constexpr Real slow = 1e-4L;
/// And slower than this it sticks.
constexpr Real sticks = 1e-7L;
/// Of what forces may leave: less is not looked for.
constexpr Real far_below = 1e-3L;
/// Rounding that the project allows in a gap: 16 times 12 eps of what it is a sum of.
constexpr Real hidden = 16 * 12 * Real(std::numeric_limits<double>::epsilon());

/// Motions are bent to end where gaps are right, and gaps are known to 12 eps of the coordinates:
/// over a way of length h s that is an acceleration of up to 6 / h^2 times as much.
constexpr Real bent = 6 * 12 * Real(std::numeric_limits<double>::epsilon());

using Pair = std::pair<BodyIndex, BodyIndex>;

Pair ordered(BodyIndex a, BodyIndex b) { return {std::min(a, b), std::max(a, b)}; }

struct Press {
  BodyIndex a;
  BodyIndex b;
  TouchPoint point;
  Vector slip;  ///< of b along a, m/s
};

class Judge {
 public:
  Judge(const Model& model, const Trajectory& run, Instant end, const EnergyLedger& ledger,
        const Look& look)
      : model_(model), run_(run), end_(end), ledger_(ledger), look_(look) {}

  Verdict judge() {
    verdict_.refusal = why_not();
    if (!verdict_.refusal.empty()) {
      return std::move(verdict_);
    }
    for (const SceneForce& force : model_.scene().forces) {
      steady_ = steady_ && force.force->conservative();
    }
    for (BodyIndex i = 0; i < model_.size(); ++i) {
      steady_ = steady_ && model_.mobility(i) != Mobility::driven && !carries(i);
    }
    for (const Instant t : instants()) {
      look_at(t);
    }
    look_at_jumps();
    return std::move(verdict_);
  }

 private:
  // --- What is judged ----------------------------------------------------------------------------

  [[nodiscard]] std::string why_not() const {
    if (!model_.scene().joints.empty()) {
      return "it has joints";
    }
    if (model_.scene().periodic) {
      return "its room is repeated";
    }
    for (BodyIndex i = 0; i < model_.size(); ++i) {
      const std::string_view kind = model_.entity(i).kind();
      if (!known(model_.shape(i)) || model_.is_field(i) || kind == "hand" || kind == "balloon") {
        return fmt::format("'{}' is none of what the judge knows", model_.body(i).name);
      }
    }
    return {};
  }

  /// Random times, and some of each leg between events, in order.
  [[nodiscard]] std::vector<Instant> instants() const {
    if (look_.only_at >= 0) {
      return {Instant{} + look_.only_at};
    }
    Random random(look_.seed, 0x6c617374);
    std::vector<Instant> out;
    for (int k = 0; k < look_.times; ++k) {
      out.push_back(Instant{} + random.uniform() * end_.seconds);
    }
    std::vector<Instant> marks{Instant{}};
    for (const Event& event : run_.events()) {
      if (marks.back() < event.time) {
        marks.push_back(event.time);
      }
    }
    marks.push_back(end_);
    const std::size_t legs = marks.size() - 1;
    const std::size_t stride =
        std::max<std::size_t>(1, legs / static_cast<std::size_t>(look_.most_legs));
    for (std::size_t k = 0; k < legs; k += stride) {
      for (int j = 0; j < look_.of_each_leg; ++j) {
        out.push_back(marks[k] + random.uniform() * (marks[k + 1] - marks[k]));
      }
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  [[nodiscard]] std::string names(BodyIndex a, BodyIndex b) const {
    return fmt::format("'{}' and '{}'", model_.body(a).name, model_.body(b).name);
  }

  void find(Fault fault, Instant t, Real size, const std::string& who) {
    verdict_.findings.push_back({fault, t.seconds, size, who});
  }

  // --- Bodies
  // -------------------------------------------------------------------------------------

  [[nodiscard]] Vector belt(BodyIndex i) const {
    return real(
        model_.entity(i).surface_velocity(model_.body(i), model_.scene().bodies[i].initial));
  }
  [[nodiscard]] bool carries(BodyIndex i) const { return !belt(i).isZero(0); }

  /// Whether forces turn it: a `ball` nothing turns.
  [[nodiscard]] bool turns(BodyIndex i) const { return model_.entity(i).kind() == "body"; }

  /// Principal moments, kg m^2: those of the homogeneous solid, where the scene says nothing else.
  [[nodiscard]] Vector moments(BodyIndex i) const { return real(model_.body(i).inertia); }

  [[nodiscard]] Matrix inertia(BodyIndex i, const Moment& at) const {
    return at.turned * moments(i).asDiagonal() * at.turned.transpose();
  }

  /// Of all that is no contact: gravity down, and forces of the scene.
  void loads_at(Instant t) {
    force_.assign(model_.size(), Vector::Zero());
    torque_.assign(model_.size(), Vector::Zero());
    const bool as_force = model_.scene().gravity == GravityMode::force;
    for (BodyIndex i = 0; i < model_.size(); ++i) {
      if (model_.is_free(i)) {
        const Body& body = model_.body(i);
        force_[i].y() = -Real(body.G) * (as_force ? 1 : Real(body.mass));
      }
    }
    for (const SceneForce& force : model_.scene().forces) {
      std::vector<BodyState> states;
      for (const BodyIndex i : force.bodies) {
        states.push_back(run_.at(i, t));
      }
      std::vector<Wrench> wrenches(states.size());
      force.force->add(t, states, wrenches);
      for (std::size_t k = 0; k < states.size(); ++k) {
        force_[force.bodies[k]] += real(wrenches[k].force);
        torque_[force.bodies[k]] += real(wrenches[k].torque);
      }
    }
  }

  [[nodiscard]] Real energy(Instant t) const {
    Real sum = 0;
    for (BodyIndex i = 0; i < model_.size(); ++i) {
      if (!model_.is_free(i)) {
        continue;
      }
      const Moment& at = at_[i];
      sum += Real(model_.body(i).mass) * at.velocity.squaredNorm() / 2;
      const Vector local = at.turned.transpose() * at.spin;
      sum += local.cwiseAbs2().dot(moments(i)) / 2;
      const bool as_force = model_.scene().gravity == GravityMode::force;
      sum += Real(model_.body(i).G) * (as_force ? 1 : Real(model_.body(i).mass)) * at.position.y();
    }
    for (const SceneForce& force : model_.scene().forces) {
      std::vector<BodyState> states;
      for (const BodyIndex i : force.bodies) {
        states.push_back(run_.at(i, t));
      }
      sum += force.force->potential(t, states);
    }
    return sum;
  }

  // --- One instant
  // --------------------------------------------------------------------------------

  void look_at(Instant t) {
    ++verdict_.instants;
    at_.clear();
    for (BodyIndex i = 0; i < model_.size(); ++i) {
      // Of what never moves there may be no motion.
      at_.push_back(run_.motions(i).empty()
                        ? moment_of(Motion::at_rest(Instant{}, model_.body(i).initial.pose), 0)
                        : moment_at(run_, i, t));
      if (at_[i].beyond > 16 * Real(std::numeric_limits<double>::epsilon()) * Real(t.seconds)) {
        find(Fault::gap, t, at_[i].beyond, model_.body(i).name);
      }
    }
    while (next_event_ < run_.events().size() && run_.events()[next_event_].time <= t) {
      const Event& event = run_.events()[next_event_++];
      if (changes_contact(event.kind) && event.grade == Grade::stepped) {
        stepped_over_.insert(ordered(event.a, event.b));
      }
    }
    loads_at(t);
    look_at_pairs(t);
    if (look_.forces) {
      look_at_groups(t);
    }
    look_at_energy(t);
  }

  /// How long the motion of a body lasts, s.
  [[nodiscard]] Real lasts(BodyIndex i, Instant t) const {
    return Real(motion_at(run_, i, t).duration);
  }

  [[nodiscard]] Real smaller(BodyIndex a, BodyIndex b) const {
    const Real ra = reach(model_.shape(a));
    const Real rb = reach(model_.shape(b));
    return ra > 0 && rb > 0 ? std::min(ra, rb) : std::max(ra, rb);
  }

  void look_at_pairs(Instant t) {
    presses_.clear();
    for (BodyIndex b = 0; b < model_.size(); ++b) {
      for (BodyIndex a = 0; a < b; ++a) {
        if (!model_.interacts(a, b) || !(model_.is_free(a) || model_.is_free(b))) {
          continue;
        }
        const Vector between = at_[b].position - at_[a].position;
        const Real ra = reach(model_.shape(a));
        const Real rb = reach(model_.shape(b));
        if (ra > 0 && rb > 0 && between.norm() > 1.001L * (ra + rb)) {
          continue;
        }
        const Nearness found =
            nearness(model_.shape(a), at_[a], model_.shape(b), at_[b], margin * smaller(a, b));
        verdict_.depth = std::max(verdict_.depth, -found.gap);
        const Real scale = at_[a].position.norm() + at_[b].position.norm() + ra + rb;
        if (-found.gap > hidden * scale) {
          find(Fault::overlap, t, -found.gap, names(a, b));
        }
        if (look_.only_at >= 0 && found.gap <= 1e3L * margin * smaller(a, b)) {
          fmt::print("  {}: gap {:.3g} m\n", names(a, b), static_cast<double>(found.gap));
        }
        for (const TouchPoint& point : found.points) {
          Vector v = at_[b].at(point.at) + belt(b) - at_[a].at(point.at) - belt(a);
          presses_.push_back({a, b, point, v});
        }
      }
    }
  }

  void look_at_groups(Instant t) {
    std::vector<BodyIndex> root(model_.size());
    std::iota(root.begin(), root.end(), BodyIndex{0});
    const auto find_root = [&](BodyIndex i) {
      while (root[i] != i) {
        i = root[i];
      }
      return i;
    };
    for (const Press& p : presses_) {
      if (model_.is_free(p.a) && model_.is_free(p.b)) {
        root[find_root(p.a)] = find_root(p.b);
      }
    }
    std::map<BodyIndex, std::vector<BodyIndex>> groups;
    for (BodyIndex i = 0; i < model_.size(); ++i) {
      if (model_.is_free(i)) {
        groups[find_root(i)].push_back(i);
      }
    }
    for (const auto& [first, bodies] : groups) {
      std::vector<Press> presses;
      for (const Press& p : presses_) {
        if (find_root(model_.is_free(p.a) ? p.a : p.b) == first) {
          presses.push_back(p);
        }
      }
      look_at_group(t, bodies, std::move(presses));
    }
  }

  /// The largest acceleration of the group, of a point of it or that a load would give, m/s^2.
  [[nodiscard]] Real load(const std::vector<BodyIndex>& bodies) const {
    Real most = 0;
    for (const BodyIndex i : bodies) {
      const Real r = reach(model_.shape(i));
      const Real m = model_.body(i).mass;
      most = std::max({most, force_[i].norm() / m, at_[i].acceleration.norm(),
                       r * at_[i].spinning_up.norm(), r * at_[i].spin.squaredNorm()});
    }
    return most;
  }

  void look_at_group(Instant t, const std::vector<BodyIndex>& bodies, std::vector<Press> presses) {
    ++verdict_.groups;
    const Real a = load(bodies);
    Real size = 0;
    Real fastest = 0;
    Real farthest = 0;
    for (const BodyIndex i : bodies) {
      farthest = std::max(farthest, at_[i].position.norm() + reach(model_.shape(i)));
      size = std::max(size, reach(model_.shape(i)));
      fastest =
          std::max(fastest, at_[i].velocity.norm() + reach(model_.shape(i)) * at_[i].spin.norm());
    }
    const Real fall = std::sqrt(a * size);
    // Rounding of velocities: what is at rest to each other may be fast.
    const Real unit = std::max(fall, fastest * Real(1e-8));
    const bool stepped = std::any_of(presses.begin(), presses.end(), [&](const Press& p) {
      return stepped_over_.contains(ordered(p.a, p.b));
    });
    Real step = std::numeric_limits<Real>::infinity();  // s, the shortest of the motions
    for (const BodyIndex i : bodies) {
      const Moment& at = at_[i];
      const bool is_box = std::holds_alternative<Box>(model_.shape(i));
      const Real r = reach(model_.shape(i));
      const Real astray = std::max(at.strays.norm(), is_box ? at.turns_astray.norm() * r : 0);
      const Real until = lasts(i, t);
      step = std::min(step, until);
      // What this is off by the end of the motion, or when the body has fallen by its size.
      const Real speed = std::max(fall, fastest);
      note(Fault::strays, t, speed > 0 ? astray * std::min(until, size / speed) : 0, r,
           verdict_.strays, stepped ? look_.allowed.strays_in_step : look_.allowed.strays,
           model_.body(i).name);
    }
    if (look_.only_at >= 0) {
      tell(t, bodies, presses, unit);
    }
    std::erase_if(presses, [&](const Press& p) {
      return std::abs(p.point.normal.dot(p.slip)) > (stepped ? at_rest_in_step : at_rest) * unit;
    });
    std::vector<ForceSet> sets;
    std::map<BodyIndex, Eigen::Index> place;
    Eigen::Index rows = 0;
    for (const BodyIndex i : bodies) {
      place[i] = rows;
      rows += 6;
    }
    for (const Press& p : presses) {
      sets.push_back(force_set(p, unit, place, rows));
    }
    if (stepped) {
      ++verdict_.stepped;
    }
    if (!(a > 0)) {
      return;
    }
    const Column needed = asked(bodies, rows);
    const Real allowed = look_.allowed.forces + put_right * fall / (a * step);
    const Real enough = far_below * allowed * a;
    ConeFit found = fit(sets, needed, enough);
    BodyIndex who = bodies[0];
    Real worst = worst_of(bodies, found, who);
    if (worst > allowed * a) {
      bool any = false;
      for (std::size_t k = 0; k < sets.size(); ++k) {
        if (sets[k].friction > 0 && !sets[k].ray.isZero(0) &&
            (stepped || along_of(presses[k]).norm() <= slow * unit)) {
          sets[k].ray.setZero();
          any = true;
        }
      }
      if (any) {
        ++(stepped ? verdict_.turned : verdict_.slow);
        found = fit(sets, needed, enough);
        worst = worst_of(bodies, found, who);
      }
    }
    const Real most = stepped ? look_.allowed.stepped : allowed;
    if (worst > most * a && worst <= bent * farthest / (step * step)) {
      ++verdict_.brief;  // rounding of where they are hides what forces there were
      return;
    }
    for (std::size_t k = 0; k < sets.size(); ++k) {
      if (!sets[k].ray.isZero(0)) {
        verdict_.friction_power =
            std::max(verdict_.friction_power, tangential(presses[k], found.forces[k]));
      }
    }
    note(Fault::forces, t, worst, a, stepped ? verdict_.in_steps : verdict_.forces, most,
         fmt::format(
             "'{}' of {} with {} points{}", model_.body(who).name, bodies.size(), sets.size(),
             stepped ? fmt::format(" (stepped, {:.2g} s)", static_cast<double>(step)) : ""));
  }

  /// What is seen of a group, for people.
  void tell(Instant t, const std::vector<BodyIndex>& bodies, const std::vector<Press>& presses,
            Real unit) const {
    for (const Press& p : presses) {
      fmt::print("  {}: parts at {:.3g} m/s, slides at {:.3g} m/s; 1 is {:.3g} m/s\n",
                 names(p.a, p.b), static_cast<double>(p.point.normal.dot(p.slip)),
                 static_cast<double>(along_of(p).norm()), static_cast<double>(unit));
    }
    for (const BodyIndex i : bodies) {
      const Vector3 a = at_[i].acceleration.cast<double>();
      const Motion& motion = motion_at(run_, i, t);
      fmt::print(
          "  '{}' accelerates by {:.6g} {:.6g} {:.6g} m/s^2, {:.3g} of {:.3g} s on its way\n",
          model_.body(i).name, a.x(), a.y(), a.z(), static_cast<double>(seconds(motion.start, t)),
          motion.duration);
    }
  }

  /// Of what is left of the accelerations, m/s^2, and whose it is.
  [[nodiscard]] static Real worst_of(const std::vector<BodyIndex>& bodies, const ConeFit& found,
                                     BodyIndex& who) {
    Real worst = 0;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const auto left = found.left.segment<6>(static_cast<Eigen::Index>(6 * k));
      const Real off = std::max(left.head<3>().norm(), left.tail<3>().norm());
      who = off > worst ? bodies[k] : who;
      worst = std::max(worst, off);
    }
    return worst;
  }

  /// Of a slide, along the surfaces, m/s.
  [[nodiscard]] static Vector along_of(const Press& p) {
    return p.slip - p.point.normal * p.point.normal.dot(p.slip);
  }

  [[nodiscard]] static Real tangential(const Press& p, const Vector& force) {
    return force.dot(along_of(p));
  }

  /// What a force at a point may be, and what a unit of it gives, m/s^2: to each body's centre, and
  /// by turning to its farthest point.
  ForceSet force_set(const Press& p, Real unit, const std::map<BodyIndex, Eigen::Index>& place,
                     Eigen::Index rows) {
    ForceSet set;
    set.normal = p.point.normal;
    set.friction = look_.friction * Real(model_.friction(p.a, p.b));
    set.gives.setZero(rows, 3);
    for (const auto& [i, sign] : {std::pair(p.a, Real(-1)), {p.b, Real(1)}}) {
      const auto at = place.find(i);
      if (at == place.end()) {
        continue;
      }
      set.gives.middleRows<3>(at->second) = sign / Real(model_.body(i).mass) * Matrix::Identity();
      if (turns(i)) {
        const Vector arm = p.point.at - at_[i].position;
        Matrix cross;
        cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
        set.gives.middleRows<3>(at->second + 3) =
            sign * reach(model_.shape(i)) * inverse_inertia(i) * cross;
      }
    }
    const Vector along = along_of(p);
    const Real speed = along.norm();
    if (speed > sticks * unit && std::isfinite(set.friction)) {
      ++verdict_.sliding;
      set.ray = p.point.normal - set.friction * along / speed;
    } else if (!(set.friction > 0)) {
      set.ray = p.point.normal;
      ++verdict_.sliding;
    } else {
      ++verdict_.sticking;
      verdict_.creep = std::max(verdict_.creep, unit > 0 ? speed / unit : 0);
    }
    return set;
  }

  [[nodiscard]] Matrix inverse_inertia(BodyIndex i) const {
    const Matrix& r = at_[i].turned;
    return r * moments(i).cwiseInverse().asDiagonal() * r.transpose();
  }

  /// What contact forces have to give, m/s^2: as the motions accelerate, less the loads.
  [[nodiscard]] Column asked(const std::vector<BodyIndex>& bodies, Eigen::Index rows) const {
    Column out = Column::Zero(rows);
    Eigen::Index at = 0;
    for (const BodyIndex i : bodies) {
      const Moment& m = at_[i];
      out.segment<3>(at) = m.acceleration - force_[i] / Real(model_.body(i).mass);
      if (turns(i)) {
        const Vector momentum = inertia(i, m) * m.spin;
        const Vector torque = m.spin.cross(momentum) - torque_[i];
        out.segment<3>(at + 3) =
            reach(model_.shape(i)) * (m.spinning_up + inverse_inertia(i) * torque);
      }
      at += 6;
    }
    return out;
  }

  void note(Fault fault, Instant t, Real size, Real scale, Real& most, Real allowed,
            const std::string& who) {
    if (!(size > 0)) {
      return;
    }
    const Real part = size / scale;
    most = std::max(most, part);
    if (!(part <= allowed)) {
      find(fault, t, part, who);
    }
  }

  // --- Between instants
  // ---------------------------------------------------------------------------

  /// What gravity is given up to t where bodies are put at gaps that can be held: from one motion
  /// to the next, by less than this part of their size.
  Real lifted_until(Instant t) {
    constexpr Real least = 1e-8L;
    if (lifts_.empty()) {
      for (BodyIndex i = 0; i < model_.size(); ++i) {
        const auto& motions = run_.motions(i);
        const bool as_force = model_.scene().gravity == GravityMode::force;
        const Real weight = Real(model_.body(i).G) * (as_force ? 1 : Real(model_.body(i).mass));
        for (std::size_t k = 1; model_.is_free(i) && k < motions.size(); ++k) {
          const Instant start = motions[k].start;
          const Vector up =
              moment_of(motions[k], 0).position -
              moment_of(motions[k - 1], seconds(motions[k - 1].start, start)).position;
          if (up.norm() <= least * reach(model_.shape(i))) {
            lifts_[start] += weight * up.y();
          }
        }
      }
      lifts_[Instant{}] += 0;
      next_lift_ = lifts_.begin();
    }
    for (; next_lift_ != lifts_.end() && !(t < next_lift_->first); ++next_lift_) {
      lifted_ += next_lift_->second;
    }
    return lifted_;
  }

  void look_at_energy(Instant t) {
    if (!steady_) {
      return;
    }
    const Real now = energy(t) - lifted_until(t);
    const Real flow = ledger_.flow();
    if (!std::isnan(before_)) {
      note(Fault::gains, t, now - before_, flow, verdict_.gains, look_.allowed.gains, "all");
    }
    before_ = now;
  }

  /// Where one motion follows another and no event is told, nothing may jump.
  void look_at_jumps() {
    std::map<Instant, std::vector<BodyIndex>> told;
    for (const Event& event : run_.events()) {
      told[event.time];
    }
    for (BodyIndex i = 0; i < model_.size(); ++i) {
      if (!model_.is_free(i)) {
        continue;
      }
      const auto& motions = run_.motions(i);
      const Real r = reach(model_.shape(i));
      for (std::size_t k = 1; k < motions.size(); ++k) {
        const Instant t = motions[k].start;
        if (told.contains(t) || (k + 1 < motions.size() && motions[k + 1].start == t) ||
            motions[k - 1].start == t) {
          continue;
        }
        const Moment was = moment_of(motions[k - 1], seconds(motions[k - 1].start, t));
        const Moment is = moment_of(motions[k], 0);
        const Real jump = std::max((is.velocity - was.velocity).norm(),
                                   turns(i) ? r * (is.spin - was.spin).norm() : 0);
        const Real a = std::max(Real(model_.body(i).G), was.acceleration.norm());
        const Real scale = std::max(std::sqrt(a * r), was.velocity.norm() + r * was.spin.norm());
        note(Fault::jump, t, jump, scale, verdict_.jump, look_.allowed.jump, model_.body(i).name);
      }
    }
  }

  const Model& model_;
  const Trajectory& run_;
  Instant end_;
  const EnergyLedger& ledger_;
  const Look& look_;
  bool steady_ = true;  ///< energy cannot come from anywhere
  Real before_ = std::numeric_limits<Real>::quiet_NaN();
  std::map<Instant, Real> lifts_;
  std::map<Instant, Real>::iterator next_lift_;
  Real lifted_ = 0;
  std::size_t next_event_ = 0;
  std::set<Pair> stepped_over_;  ///< so far: which steps are implicit is not told one by one
  std::vector<Moment> at_;
  std::vector<Vector> force_;
  std::vector<Vector> torque_;
  std::vector<Press> presses_;
  Verdict verdict_;
};

}  // namespace

std::string_view to_string(Fault fault) {
  constexpr std::array<std::string_view, 6> words{"overlap", "forces", "strays",
                                                  "jump",    "gains",  "gap"};
  return words[static_cast<std::size_t>(fault)];
}

Verdict judge(const Model& model, const Trajectory& run, Instant end, const EnergyLedger& ledger,
              const Look& look) {
  return Judge(model, run, end, ledger, look).judge();
}

}  // namespace kairos::judge
