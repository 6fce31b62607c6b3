#include "tests/judge/lasting/cone_fit.hpp"

#include <Eigen/QR>

#include <cmath>
#include <limits>

namespace kairos::judge {
namespace {

constexpr Real rounding = std::numeric_limits<Real>::epsilon();
constexpr int most_rays = 400;  ///< of those of round cones; forces that exist are found with a few

struct Ray {
  std::size_t set;
  Vector direction;
  Column gives;
};

class Fit {
 public:
  Fit(const std::vector<ForceSet>& sets, const Column& asked)
      : sets_(sets), asked_(asked), left_(asked) {}

  ConeFit run() {
    for (std::size_t k = 0; k < sets_.size(); ++k) {
      begin(k);
    }
    solve();
    int stalls = 0;
    while (static_cast<int>(rays_.size()) < most_rays && stalls < 3 &&
           left_.norm() > 64 * rounding * asked_.norm() && add_rays()) {
      const Real before = left_.norm();
      solve();
      stalls = left_.norm() > (1 - 1e-6L) * before ? stalls + 1 : 0;
    }
    ConeFit found{std::vector<Vector>(sets_.size(), Vector::Zero()), left_,
                  static_cast<int>(rays_.size())};
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      found.forces[rays_[i].set] += weight_[i] * rays_[i].direction;
    }
    return found;
  }

 private:
  void add(std::size_t set, const Vector& direction) {
    Column gives = sets_[set].gives * direction;
    const Real length = gives.norm();
    if (length > 0) {
      rays_.push_back({set, direction / length, gives / length});
      weight_.push_back(0);
    }
  }

  void begin(std::size_t k) {
    const ForceSet& set = sets_[k];
    if (!set.ray.isZero(0)) {
      add(k, set.ray);
      return;
    }
    add(k, set.normal);
    if (std::isinf(set.friction)) {
      const Vector u = set.normal.unitOrthogonal();
      for (const Vector& t : {u, Vector(set.normal.cross(u))}) {
        add(k, t);
        add(k, -t);
      }
    }
  }

  /// Of each round cone the ray that the rest pulls most; whether any does.
  bool add_rays() {
    bool any = false;
    for (std::size_t k = 0; k < sets_.size(); ++k) {
      const ForceSet& set = sets_[k];
      if (!set.ray.isZero(0) || std::isinf(set.friction) || !(set.friction > 0)) {
        continue;
      }
      const Vector pull = set.gives.transpose() * left_;
      const Vector along = pull - set.normal * set.normal.dot(pull);
      if (along.isZero(0)) {
        continue;
      }
      const Vector direction = set.normal + set.friction * along.normalized();
      const Column gives = set.gives * direction;
      if (gives.dot(left_) > 1e-12L * gives.norm() * left_.norm()) {
        add(k, direction);
        any = true;
      }
    }
    return any;
  }

  /// Weights of those that carry, by QR; puts the rest into `left_`.
  [[nodiscard]] std::vector<Real> weights(const std::vector<std::size_t>& carry) const {
    Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> columns(
        asked_.size(), static_cast<Eigen::Index>(carry.size()));
    for (std::size_t j = 0; j < carry.size(); ++j) {
      columns.col(static_cast<Eigen::Index>(j)) = rays_[carry[j]].gives;
    }
    const Column x = columns.householderQr().solve(asked_);
    return {x.data(), x.data() + x.size()};
  }

  void update_left() {
    left_ = asked_;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (weight_[i] > 0) {
        left_ -= weight_[i] * rays_[i].gives;
      }
    }
  }

  /// Lawson and Hanson, from the weights that there are.
  void solve() {
    std::vector<char> refused(rays_.size(), 0);
    for (std::size_t round = 0; round < 20 * rays_.size() + 20; ++round) {
      update_left();
      std::size_t best = rays_.size();
      Real most = 1e-15L * left_.norm();
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        const Real pull = rays_[i].gives.dot(left_);
        if (!(weight_[i] > 0) && refused[i] == 0 && pull > most) {
          best = i;
          most = pull;
        }
      }
      if (best == rays_.size() || left_.norm() <= 16 * rounding * asked_.norm()) {
        return;
      }
      refused[best] = take_in(best) ? 0 : 1;
    }
  }

  /// Lets one more carry; false where that changes nothing.
  bool take_in(std::size_t more) {
    std::vector<std::size_t> carry{more};
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (weight_[i] > 0) {
        carry.push_back(i);
      }
    }
    while (!carry.empty()) {
      const std::vector<Real> x = weights(carry);
      if (!std::isfinite(x[0]) || (carry[0] == more && !(x[0] > 0))) {
        weight_[more] = 0;
        return false;
      }
      Real step = 1;
      for (std::size_t j = 0; j < carry.size(); ++j) {
        const Real w = weight_[carry[j]];
        if (!(x[j] > 0)) {
          step = std::min(step, w / (w - x[j]));
        }
      }
      std::vector<std::size_t> stay;
      for (std::size_t j = 0; j < carry.size(); ++j) {
        Real& w = weight_[carry[j]];
        const bool leaves = !(x[j] > 0) && w / (w - x[j]) <= step;
        w = leaves ? 0 : w + step * (x[j] - w);
        if (!leaves) {
          stay.push_back(carry[j]);
        }
      }
      if (stay.size() == carry.size()) {
        return true;
      }
      carry = std::move(stay);
    }
    return true;
  }

  const std::vector<ForceSet>& sets_;
  const Column& asked_;
  Column left_;
  std::vector<Ray> rays_;
  std::vector<Real> weight_;
};

}  // namespace

ConeFit fit(const std::vector<ForceSet>& sets, const Column& asked) {
  return Fit(sets, asked).run();
}

}  // namespace kairos::judge
