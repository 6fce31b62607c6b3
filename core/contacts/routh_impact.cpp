#include "core/contacts/routh_impact.hpp"

#include "core/circular.hpp"
#include "core/contacts/least_norm.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

using Vector2 = Eigen::Vector2d;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A direction that turns by fewer radians than this while the body slides is kept.
constexpr double straight = 1e-13;
/// Part of the first sliding speed below which the rest is a straight line.
constexpr double nearly_stopped = 1e-12;
/// What sticks parts by less than this part of what a normal impulse does: by roundoff of joints.
constexpr double locked = 1e-12;
/// Of W, and of the speeds that a relative velocity is a difference of: roundoff.
constexpr double unknown = 16.0 * std::numeric_limits<double>::epsilon();
constexpr double unfelt = 64.0 * std::numeric_limits<double>::epsilon();
/// What needs no more than this part of friction beyond it is held: it is known no better.
constexpr double barely = 1e-12;
/// What joints block to 1e-12 of what it would be moves by the root of that.
constexpr double hardly_moves = 1e-6;
/// Part of what an impulse does along the surface by which its direction turns in equilibrium.
constexpr double settled = 1e-14;
/// Of the series in which sliding turns, and how much of its radius of convergence is used: what is
/// left out is 0.05^17.
constexpr std::size_t order = 16;
constexpr double part_of_radius = 0.05;
constexpr int looks = 8;  ///< within such a step, whether the approach has ended
constexpr int most_phases = 16;
constexpr int most_steps = 100000;

/// The impact so far.
struct Course {
  Vector3 u;                    ///< m/s
  Vector3 p = Vector3::Zero();  ///< N s
  double rubbed = 0.0;          ///< work of the tangential impulse, J
  double work = 0.0;            ///< of the normal impulse, J; < 0 while pressed together
  double most = 0.0;            ///< |work| when the approach ended
  bool springs_back = false;
};

class Routh {
 public:
  Routh(const Matrix3& W, double mu, double e, double speeds)
      : W_(W), mu_(mu), e_(e), speeds_(speeds), blocked_{W(1, 1) == 0.0, W(2, 2) == 0.0} {}

  RouthImpact run(const Vector3& u) {
    course_.u = u;
    slip_ = u.tail<2>().norm();
    first_ = std::abs(u[0]);
    if (std::isinf(mu_)) {
      stop_at_once();
    }
    for (int phase = 0; phase < most_phases && !over_; ++phase) {
      const Vector2 t = course_.u.tail<2>();
      if (t.norm() <= std::numeric_limits<double>::epsilon() * std::max(slip_, u.norm())) {
        hold_still();
        stopped();
      } else {
        slide(t.normalized());
      }
    }
    return {course_.p, course_.u, course_.work, course_.rubbed, jammed_, over_ && !failed_};
  }

 private:
  /// Rates of u and p with the normal impulse, while the tangential one is f times it.
  [[nodiscard]] Vector3 push(const Vector2& f) const { return Vector3(1.0, f[0], f[1]); }

  /// What holds along the surface against x; nothing where nothing moves.
  [[nodiscard]] Vector2 against(const Vector2& x) const {
    if (!blocked_[0] && !blocked_[1]) {
      return -(W_.block<2, 2>(1, 1).inverse() * x);
    }
    return {blocked_[0] ? 0.0 : -x[0] / W_(1, 1), blocked_[1] ? 0.0 : -x[1] / W_(2, 2)};
  }

  /// Ends the sliding: what is left of it is roundoff, or all of it goes at once.
  void hold_still() {
    const Vector2 left = course_.u.tail<2>();
    const Vector2 f = against(left);
    const Vector3 p(0.0, f[0], f[1]);
    course_.p += p;
    course_.u += W_ * p;
    course_.rubbed += 0.5 * f.dot(left);
    course_.u.tail<2>().setZero();
  }

  /// Friction without a bound stops the sliding before anything is pressed.
  void stop_at_once() {
    for (int k = 0; k < 2; ++k) {
      if (blocked_[static_cast<std::size_t>(k)] &&
          std::abs(course_.u[k + 1]) >
              std::max(hardly_moves * course_.u.norm(), unfelt * speeds_)) {
        return fail();  // nothing can stop it
      }
    }
    const Vector2 hold = against(W_.block<2, 1>(1, 0));
    if (is_locked(hold) && stand_still()) {
      return;
    }
    hold_still();
    over_ = course_.u[0] >= 0.0;
  }

  /// At rest along the surface: either friction holds, or sliding begins.
  void stopped() {
    const Vector2 hold = against(W_.block<2, 1>(1, 0));
    if (is_locked(hold)) {
      return lock(hold);
    }
    if (hold.norm() <= mu_ * (1.0 + barely)) {
      return along(push(hold), infinity, true);
    }
    if (const std::optional<Vector2> d = leaving()) {
      return along(push(-mu_ * *d), infinity, false);
    }
    fail();
  }

  /// Whether what friction holds this way parts by no impulse: joints let it not.
  [[nodiscard]] bool is_locked(const Vector2& hold) const {
    const double parts = W_(0, 0) + hold.dot(W_.block<2, 1>(1, 0));
    const double known = unknown * W_.lpNorm<Eigen::Infinity>() * push(hold).squaredNorm();
    return hold.norm() <= mu_ * (1.0 + barely) && parts <= std::max(locked * W_(0, 0), known);
  }

  /// Joints let nothing part that sticks: whatever presses, friction holds it, and it gives nothing
  /// back.
  void lock(const Vector2& hold) {
    const double none = std::max(nearly_stopped * std::max(slip_, first_), unfelt * speeds_);
    if (course_.u[0] < -none * push(hold).norm()) {
      return fail();  // nor does anything stop it
    }
    over_ = true;
  }

  /// What is rough and locked stops altogether, by the least impulse: what stops sliding first, and
  /// then presses, may be a difference of much larger ones. False if something moves on, as what
  /// drives it cannot be stopped.
  [[nodiscard]] bool stand_still() {
    Vector3 p = -least_norm(W_, course_.u);
    Vector3 left = course_.u + W_ * p;
    if (left.norm() > hardly_moves * std::max(speeds_, course_.u.norm())) {
      return false;
    }
    p[0] -= left[0] / W_(0, 0);
    if (p[0] < 0.0) {
      return false;
    }
    left = course_.u + W_ * p;
    const Vector3 mean = 0.5 * (course_.u + left);
    const double whole = p.dot(mean);
    course_.rubbed = std::min(std::max(p.tail<2>().dot(mean.tail<2>()), whole), 0.0);
    course_.work = whole - course_.rubbed;
    course_.p = p;
    course_.u = left;
    over_ = true;
    return true;
  }

  /// Direction in which sliding begins from rest: along the part of W_tn that friction leaves.
  [[nodiscard]] std::optional<Vector2> leaving() const {
    const auto pull = [&](double angle) -> Vector2 {
      const Vector2 d(cosine(angle), sine(angle));
      return W_.block<2, 1>(1, 0) - mu_ * (W_.block<2, 2>(1, 1) * d);
    };
    const auto across = [&](double angle) {
      const Vector2 g = pull(angle);
      return cosine(angle) * g[1] - sine(angle) * g[0];
    };
    const double first = arc_tangent(W_(2, 0), W_(1, 0));
    const Vector2 d(cosine(first), sine(first));
    if (std::abs(across(first)) <= straight_enough(W_.block<2, 1>(1, 0)) &&
        pull(first).dot(d) > 0.0) {
      return Vector2(W_.block<2, 1>(1, 0).normalized());
    }
    constexpr int parts = 720;
    for (int k = 0; k < parts; ++k) {
      double from = first + 2.0 * M_PI * k / parts;
      double to = first + 2.0 * M_PI * (k + 1) / parts;
      const double low = across(from);
      if (low * across(to) > 0.0) {
        continue;
      }
      for (int halvings = 0; halvings < 60; ++halvings) {
        const double middle = 0.5 * (from + to);
        (low * across(middle) > 0.0 ? from : to) = middle;
      }
      const Vector2 found(cosine(from), sine(from));
      if (pull(from).dot(found) > 0.0) {
        return found;
      }
    }
    return std::nullopt;
  }

  /// Whether the present direction of sliding does not turn.
  [[nodiscard]] bool keeps_direction() const {
    const Vector2 d = course_.u.tail<2>().normalized();
    const Vector2 rate = (W_ * push(-mu_ * d)).tail<2>();
    const double turns = std::abs(d[0] * rate[1] - d[1] * rate[0]);
    return turns <= straight_enough(rate);
  }

  /// What changes a direction by less turns nothing. Where friction nearly holds, and along what
  /// nothing moves, it slides on: the direction comes to an equilibrium.
  [[nodiscard]] double straight_enough(const Vector2& rate) const {
    const double scale = W_.block<2, 1>(1, 0).norm() + mu_ * W_.block<2, 2>(1, 1).norm();
    return std::max(straight * rate.norm(), settled * scale);
  }

  void slide(const Vector2& d) {
    const Vector3 p = push(-mu_ * d);
    const Vector3 rate = W_ * p;
    const double braking = -d.dot(rate.tail<2>());
    const double speed = course_.u.tail<2>().norm();
    jammed_ = jammed_ || rate[0] <= 0.0;
    if (mu_ == 0.0) {
      return along(p, infinity, false);
    }
    if (keeps_direction() || speed <= nearly_stopped * slip_) {
      return along(p, braking > 0.0 ? speed / braking : infinity, false);
    }
    turn();
  }

  /// Goes on a straight line in p, at most for `most`.
  void along(const Vector3& p, double most, bool sticks) {
    const Vector3 rate = W_ * p;
    for (int part = 0; part < 2 && !over_; ++part) {
      const double k = rate[0];
      const double u = course_.u[0];
      double until = infinity;
      if (!course_.springs_back) {
        until = k > 0.0 ? std::max(-u, 0.0) / k : infinity;
      } else {
        // Work that is still to be given back: u x + k x^2 / 2.
        const double left = e_ * e_ * course_.most - (course_.work + course_.most);
        const double root = u * u + 2.0 * k * std::max(left, 0.0);
        until = root < 0.0 ? infinity : 2.0 * std::max(left, 0.0) / (u + std::sqrt(root));
        until = left > 0.0 ? until : 0.0;
      }
      const double x = std::min(until, most);
      if (!std::isfinite(x)) {
        return fail();
      }
      course_.work += x * (u + 0.5 * k * x);
      course_.rubbed += x * p.tail<2>().dot(course_.u.tail<2>() + 0.5 * x * rate.tail<2>());
      course_.p += x * p;
      course_.u += x * rate;
      most -= x;
      if (x < until) {  // it stops sliding
        hold_still();
        return;
      }
      reached();
      if (sticks) {
        course_.u.tail<2>().setZero();
      }
    }
  }

  /// Marks the end of the approach, or of the impact.
  void reached() {
    if (course_.springs_back) {
      over_ = true;
      return;
    }
    course_.u[0] = 0.0;
    course_.springs_back = true;
    course_.most = -course_.work;
    over_ = e_ == 0.0;
  }

  void fail() {
    over_ = true;
    failed_ = true;
  }

  /// u, p, and the work of both, as polynomials in x over its unit, see `turn`.
  struct Series {
    std::array<std::array<double, order + 1>, 8> of;
    double radius = infinity;  ///< about that of convergence

    [[nodiscard]] double at(std::size_t i, double x) const {
      double value = of[i][order];
      for (std::size_t k = order; k-- > 0;) {
        value = value * x + of[i][k];
      }
      return value;
    }
  };

  /// The Taylor series of the course from where it is: its products and the root of one are
  /// multiplied out, coefficient by coefficient.
  [[nodiscard]] Series series(double unit) const {
    Series y;
    const auto put = [&](std::size_t k, const Vector3& u, const Vector3& p, double work,
                         double rubbed) {
      for (std::size_t i = 0; i < 3; ++i) {
        y.of[i][k] = u[static_cast<Eigen::Index>(i)];
        y.of[3 + i][k] = p[static_cast<Eigen::Index>(i)];
      }
      y.of[6][k] = work;
      y.of[7][k] = rubbed;
    };
    put(0, course_.u, course_.p, course_.work, course_.rubbed);
    const auto& [u, t1, t2, p0, p1, p2, work, rubbed] = y.of;
    std::array<double, order + 1> speed{};
    for (std::size_t k = 0; k < order; ++k) {
      double square = 0.0;  // of the speed along the surface
      double given = 0.0;   // u times that speed
      double known = 0.0;   // of the square, what earlier coefficients of the speed make
      for (std::size_t i = 0; i <= k; ++i) {
        square += t1[i] * t1[k - i] + t2[i] * t2[k - i];
        known += i > 0 && i < k ? speed[i] * speed[k - i] : 0.0;
      }
      speed[k] = k == 0 ? std::sqrt(square) : (square - known) / (2.0 * speed[0]);
      for (std::size_t i = 0; i <= k; ++i) {
        given += u[i] * speed[k - i];
      }
      const Vector3 p(speed[k], -mu_ * t1[k], -mu_ * t2[k]);
      const double part = unit / static_cast<double>(k + 1);
      put(k + 1, part * (W_ * p), part * p, part * given, -part * mu_ * square);
    }
    for (const std::size_t k : {order - 1, order}) {
      const double last = Vector2(t1[k], t2[k]).norm() / speed[0];
      y.radius = std::min(y.radius, 1.0 / std::sqrt(std::sqrt(std::sqrt(std::sqrt(last)))));
    }
    return y;
  }

  /// Follows sliding that turns, by a variable x with dp = |u_t| dx: in x, u_t decays without being
  /// singular anywhere, at a rate of at most |W_tn| + mu |W_tt|. Its Taylor series
  /// [Jorba2005] is summed up to a twentieth of its radius. Its unit of x, a power of two, is about
  /// the inverse of that rate: coefficients neither overflow nor vanish, however rough or light the
  /// bodies are.
  void turn() {
    const double left = e_ * e_ * course_.most;
    const double slowest = 1.0 / (W_.block<2, 1>(1, 0).norm() + mu_ * W_.block<2, 2>(1, 1).norm());
    const double unit = std::ldexp(1.0, std::ilogb(slowest));
    for (int step = 0; step < most_steps; ++step) {
      const Series y = series(unit);
      const auto ends = [&](double x) {
        return course_.springs_back ? y.at(6, x) + course_.most >= left : y.at(0, x) >= 0.0;
      };
      double x = std::min(part_of_radius * y.radius, slowest / unit);
      bool end = false;
      for (int k = 1; k <= looks && !end; ++k) {
        double low = x * (k - 1) / looks;
        double high = x * k / looks;
        end = ends(high);
        for (int halvings = 0; end && halvings < 60; ++halvings) {
          const double middle = 0.5 * (low + high);
          (ends(middle) ? high : low) = middle;
        }
        x = end ? high : x;
      }
      course_.u = {y.at(0, x), y.at(1, x), y.at(2, x)};
      course_.p = {y.at(3, x), y.at(4, x), y.at(5, x)};
      course_.work = y.at(6, x);
      course_.rubbed = y.at(7, x);
      if (end) {
        return reached();
      }
      if (course_.u.tail<2>().norm() <= nearly_stopped * slip_ || keeps_direction()) {
        return;
      }
    }
    fail();
  }

  const Matrix3& W_;
  double mu_;
  double e_;
  double speeds_;                ///< of which u is a difference, m/s
  std::array<bool, 2> blocked_;  ///< by tangent: no impulse moves anything along it
  Course course_{};
  double slip_ = 0.0;   ///< at first, m/s
  double first_ = 0.0;  ///< how fast it approached, m/s
  bool over_ = false;
  bool failed_ = false;
  bool jammed_ = false;
};

}  // namespace

RouthImpact routh_impact(const Matrix3& W, const Vector3& u, double mu, double e, double speeds) {
  return Routh(W, mu, e, speeds).run(u);
}

bool painleve(const Matrix3& W, double mu, const Eigen::Vector2d& d) {
  return W(0, 0) - mu * (W(0, 1) * d[0] + W(0, 2) * d[1]) <= 0.0;
}

}  // namespace core
}  // namespace kairos
