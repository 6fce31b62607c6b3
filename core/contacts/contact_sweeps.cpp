#include "core/contacts/contact_sweeps.hpp"

#include "core/contacts/cone_newton.hpp"
#include "core/contacts/coulomb_cone.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>

namespace kairos {
inline namespace core {
namespace {

constexpr int most_sweeps = 4000;
/// After so many sweeps impulses change by half of what they would alone: what goes round in a
/// circle comes to rest. They stay within their cones, which are convex.
constexpr int damped_from = 1000;
/// Sweeps that change less than this many times what has settled, and do not come to half of that
/// in so many more, change what rounding does: others would do the same.
constexpr double nearly_settled = 1e4;
constexpr int idle_sweeps = 64;
/// What has not settled after so many sweeps is looked for at all touches at once, and after four
/// and sixteen times as many again, in these ways; steps, which come often, have the first only.
constexpr int at_once_after = 64;
constexpr std::array ways_of_impacts = {AtOnce::newton, AtOnce::proximal, AtOnce::bounded};
constexpr std::array ways_of_steps = {AtOnce::newton, AtOnce::newton, AtOnce::newton};
constexpr std::array last_ways_of_steps = {AtOnce::newton, AtOnce::newton, AtOnce::held_along};

}  // namespace

ContactSweeps::ContactSweeps(std::span<const GroupBody> bodies,
                             std::span<const SweptTouch> touches) {
  for (const SweptTouch& touch : touches) {
    Block out;
    out.a = touch.a;
    out.b = touch.b;
    out.friction = touch.friction;
    const Vector3& n = touch.normal;
    const Vector3 t = n.unitOrthogonal();
    out.axes << n.transpose(), t.transpose(), n.cross(t).transpose();
    const auto side = [&](std::size_t i, const Vector3& point, double sign, Matrix36& of,
                          Matrix63& to) {
      for (int r = 0; r < 3; ++r) {
        const Vector3 d = sign * out.axes.row(r);
        const Vector3 moment = (point - bodies[i].position).cross(d);
        of.row(r) << d.transpose(), moment.transpose();
        to.col(r) << bodies[i].inverse_mass * d, bodies[i].inverse_inertia * moment;
      }
    };
    side(touch.a, touch.point_a, -1.0, out.of_a, out.to_a);
    side(touch.b, touch.point_b, 1.0, out.of_b, out.to_b);
    out.W = out.of_a * out.to_a + out.of_b * out.to_b;
    blocks_.push_back(out);
  }
}

ContactSweeps::Swept ContactSweeps::sweep(std::vector<Vector6> velocities,
                                          std::span<const Vector3> rates,
                                          std::span<const Vector3> begin, double settled, bool rubs,
                                          bool last_resort) const {
  Swept swept{std::vector<Vector3>(blocks_.size(), Vector3::Zero()), velocities};
  std::vector<Vector3> along(blocks_.size(), Vector3::Zero());
  for (std::size_t k = 0; k < blocks_.size() && !begin.empty(); ++k) {
    along[k] = blocks_[k].axes * begin[k];
    push_along(blocks_[k], along[k], swept.velocities);
  }
  double least = nearly_settled * settled;
  int idle = 0;
  const bool in_step = !rates.empty();
  const std::size_t most = in_step && !last_resort ? most_for_newton : most_at_once;
  int at_once = blocks_.size() <= most ? at_once_after : most_sweeps;
  std::span<const AtOnce> ways = !in_step      ? ways_of_impacts
                                 : last_resort ? last_ways_of_steps
                                               : ways_of_steps;
  for (int round = 0; round < most_sweeps; ++round) {
    swept.changed = 0.0;
    swept.solves += static_cast<int>(blocks_.size());
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      const Block& block = blocks_[k];
      const Vector3 u = rate(k, swept.velocities) + (rates.empty() ? Vector3::Zero() : rates[k]);
      const Vector3 alone =
          coulomb_impulse(block.W, u - block.W * along[k], rubs ? block.friction : 0.0);
      const Vector3 more = (round < damped_from ? 1.0 : 0.5) * (alone - along[k]);
      if (more.isZero(0.0)) {
        continue;
      }
      push_along(block, more, swept.velocities);
      swept.changed = std::max(swept.changed, (block.W * more).norm());
      along[k] += more;
    }
    if (swept.changed <= settled) {
      break;
    }
    if (swept.changed <= 0.5 * least) {
      least = swept.changed;
      idle = 0;
    } else if (swept.changed <= nearly_settled * settled && ++idle >= idle_sweeps) {
      break;
    }
    if (round == at_once && !ways.empty()) {
      at_once *= 4;
      const AtOnce way = ways.front();
      ways = ways.subspan(1);
      const double off =
          settle_at_once(velocities, rates, settled, rubs, way, along, swept.velocities);
      // Sweeps would let go again what was held.
      if (off <= (way == AtOnce::held_along ? nearly_settled : 1.0) * settled) {
        swept.changed = off;
        break;
      }
    }
  }
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    swept.impulse[k] = blocks_[k].axes.transpose() * along[k];
  }
  return swept;
}

/// Goes to the nearest that is found at all touches at once from here on, and returns how far it is
/// off, m/s.
double ContactSweeps::settle_at_once(const std::vector<Vector6>& free,
                                     std::span<const Vector3> rates, double settled, bool rubs,
                                     AtOnce way, std::vector<Vector3>& along,
                                     std::vector<Vector6>& velocities) const {
  const std::size_t n = blocks_.size();
  const auto size = static_cast<Eigen::Index>(3 * n);
  ConeProblem problem{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd(size), {}};
  Eigen::VectorXd begin(size);
  for (std::size_t k = 0; k < n; ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    problem.q.segment<3>(at) = rate(k, free) + (rates.empty() ? Vector3::Zero() : rates[k]);
    problem.friction.push_back(rubs ? blocks_[k].friction : 0.0);
    begin.segment<3>(at) = along[k];
    for (std::size_t l = 0; l < n; ++l) {
      auto W = problem.W.block<3, 3>(at, static_cast<Eigen::Index>(3 * l));
      for (const auto& [i, of] :
           {std::pair{blocks_[k].a, &blocks_[k].of_a}, std::pair{blocks_[k].b, &blocks_[k].of_b}}) {
        for (const auto& [j, to] : {std::pair{blocks_[l].a, &blocks_[l].to_a},
                                    std::pair{blocks_[l].b, &blocks_[l].to_b}}) {
          if (i == j) {
            W += *of * *to;
          }
        }
      }
    }
  }
  const ConeImpulses found = cone_at_once(problem, begin, settled, way);
  velocities = free;
  for (std::size_t k = 0; k < n; ++k) {
    along[k] = found.impulse.segment<3>(static_cast<Eigen::Index>(3 * k));
    push_along(blocks_[k], along[k], velocities);
  }
  return found.off;
}

Vector3 ContactSweeps::rate(std::size_t touch, const std::vector<Vector6>& v) const {
  const Block& block = blocks_[touch];
  return block.of_a * v[block.a] + block.of_b * v[block.b];
}

void ContactSweeps::push(std::size_t touch, const Vector3& impulse,
                         std::vector<Vector6>& velocities) const {
  push_along(blocks_[touch], blocks_[touch].axes * impulse, velocities);
}

void ContactSweeps::push_along(const Block& block, const Vector3& impulse,
                               std::vector<Vector6>& v) {
  v[block.a] += block.to_a * impulse;
  v[block.b] += block.to_b * impulse;
}

}  // namespace core
}  // namespace kairos
