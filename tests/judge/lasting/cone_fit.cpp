#include "tests/judge/lasting/cone_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kairos::judge {
namespace {

constexpr Real rounding = std::numeric_limits<Real>::epsilon();
constexpr int most_rays = 400;  ///< of those of round cones; forces that exist are found with a few

struct Ray {
  std::size_t set;
  Vector direction;
  Column gives;
};

/// Least squares by a QR decomposition that columns of length one come to and leave by turns of two
/// rows [Lawson1974, ch. 24].
class LeastSquares {
 public:
  explicit LeastSquares(const Column& asked)
      : q_(Table::Identity(asked.size(), asked.size())),
        r_(asked.size(), asked.size()),
        columns_(asked.size(), asked.size()),
        asked_(asked) {}

  /// As the last; false where the others make it up.
  bool add(const Column& column) {
    const Eigen::Index m = asked_.size();
    if (size_ == m) {
      return false;
    }
    Column r = q_.transpose() * column;
    if (!(r.tail(m - size_).norm() > 64 * rounding)) {
      return false;
    }
    for (Eigen::Index i = m - 1; i > size_; --i) {
      turn(i - 1, r[i - 1], r[i]);
    }
    r_.col(size_) = r;
    columns_.col(size_) = column;
    ++size_;
    return true;
  }
  void remove(Eigen::Index place) {
    --size_;
    for (Eigen::Index j = place; j < size_; ++j) {
      r_.col(j) = r_.col(j + 1);
      columns_.col(j) = columns_.col(j + 1);
    }
    for (Eigen::Index j = place; j < size_; ++j) {
      const auto [c, s] = turn(j, r_(j, j), r_(j + 1, j));
      for (Eigen::Index k = j + 1; k < size_; ++k) {
        const Real upper = r_(j, k);
        r_(j, k) = c * upper + s * r_(j + 1, k);
        r_(j + 1, k) = c * r_(j + 1, k) - s * upper;
      }
    }
  }
  /// Weights of the columns; what many turns have rounded is put right once.
  [[nodiscard]] Column solve() const {
    Column x = solve(asked_);
    x += solve(asked_ - columns_.leftCols(size_) * x);
    return x;
  }

 private:
  using Table = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  [[nodiscard]] Column solve(const Column& b) const {
    Column x = q_.leftCols(size_).transpose() * b;
    r_.topLeftCorner(size_, size_).triangularView<Eigen::Upper>().solveInPlace(x);
    return x;
  }

  /// Turns rows i and i + 1 of R so that of x and y in them x is left: cosine and sine.
  std::pair<Real, Real> turn(Eigen::Index i, Real& x, Real& y) {
    const Real length = std::hypot(x, y);
    const Real c = length > 0 ? x / length : 1;
    const Real s = length > 0 ? y / length : 0;
    x = length;
    y = 0;
    for (Eigen::Index k = 0; k < q_.rows(); ++k) {
      const Real left = q_(k, i);
      q_(k, i) = c * left + s * q_(k, i + 1);
      q_(k, i + 1) = c * q_(k, i + 1) - s * left;
    }
    return {c, s};
  }

  Table q_;
  Table r_;
  Table columns_;
  Eigen::Index size_ = 0;
  const Column& asked_;
};

class Fit {
 public:
  Fit(const std::vector<ForceSet>& sets, const Column& asked, Real enough)
      : sets_(sets), asked_(asked), enough_(enough), left_(asked), carrying_(asked) {}

  ConeFit run() {
    for (std::size_t k = 0; k < sets_.size(); ++k) {
      begin(k);
    }
    solve();
    int stalls = 0;
    while (static_cast<int>(rays_.size()) < most_rays && stalls < 3 &&
           left_.norm() > std::max(64 * rounding * asked_.norm(), enough_) && add_rays()) {
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
      if (best == rays_.size() ||
          left_.norm() <= std::max(16 * rounding * asked_.norm(), enough_)) {
        return;
      }
      refused[best] = take_in(best) ? 0 : 1;
    }
  }

  /// Lets one more carry; false where that changes nothing.
  bool take_in(std::size_t more) {
    if (!carrying_.add(rays_[more].gives)) {
      return false;
    }
    carry_.push_back(more);
    Column x = carrying_.solve();
    if (!(x[x.size() - 1] > 0)) {
      drop(carry_.size() - 1);
      return false;
    }
    while (true) {
      Real step = 1;
      for (std::size_t j = 0; j < carry_.size(); ++j) {
        const Real w = weight_[carry_[j]];
        const Real wanted = x[static_cast<Eigen::Index>(j)];
        if (!(wanted > 0)) {
          step = std::min(step, w / (w - wanted));
        }
      }
      bool all_stay = true;
      for (std::size_t j = carry_.size(); j-- > 0;) {
        Real& w = weight_[carry_[j]];
        const Real wanted = x[static_cast<Eigen::Index>(j)];
        const bool leaves = !(wanted > 0) && w / (w - wanted) <= step;
        w = leaves ? 0 : w + step * (wanted - w);
        if (leaves) {
          drop(j);
          all_stay = false;
        }
      }
      if (all_stay || carry_.empty()) {
        return true;
      }
      x = carrying_.solve();
    }
  }

  void drop(std::size_t place) {
    carrying_.remove(static_cast<Eigen::Index>(place));
    carry_.erase(carry_.begin() + static_cast<std::ptrdiff_t>(place));
  }

  const std::vector<ForceSet>& sets_;
  const Column& asked_;
  Real enough_;
  Column left_;
  std::vector<Ray> rays_;
  std::vector<Real> weight_;
  std::vector<std::size_t> carry_;  ///< rays that do
  LeastSquares carrying_;           ///< of their columns
};

}  // namespace

ConeFit fit(const std::vector<ForceSet>& sets, const Column& asked, Real enough) {
  return Fit(sets, asked, enough).run();
}

}  // namespace kairos::judge
