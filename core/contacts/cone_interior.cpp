#include "core/contacts/cone_interior.hpp"

#include "core/contacts/body_system.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int most_steps = 60;
/// Newton's method on the projections is tried once the products of impulses and rates are such a
/// part of the first ones; so many tries that do not halve what is left end it.
constexpr double near = 1e-9;
constexpr int most_idle = 4;
/// Where it goes astray, as touches are redundant, it is helped by a compliance against the
/// impulses so far [Rockafellar1976], as a part of that of a touch; so often, with so many steps
/// each.
constexpr double proximal = 1e-6;
constexpr int most_rounds = 4;
constexpr int most_newton_steps = 3;
/// The least part of what is left that a step aims for.
constexpr double least_centring = 0.1;
/// The corrector is believed as far as the predictor leads, times this.
constexpr double full_second_order = 2.0;
/// Of the way to the edges of the cones.
constexpr double most_of_way = 0.99;
/// A step of less than this part of Newton's is the last.
constexpr double least_step = 1e-3;
/// |u_t| is smoothed by the root of this part of what is left.
constexpr double smoothing = 1e-4;
/// Given to impulses along rough surfaces, which may be redundant, as a part of what a touch by
/// itself feels.
constexpr double compliance_along = 1e-12;

/// Where the impulses of a touch are among all unknowns: one along its normal alone, or three of a
/// cone of second order: along the normal, times its friction, and along two tangents.
struct Cone {
  Index at = 0;
  Index size = 1;
  Index rows = 1;                         ///< with those along rough surfaces, which are in no cone
  Matrix3d scale = Matrix3d::Identity();  ///< of Nesterov and Todd: scale x = unscale u
  Matrix3d unscale = Matrix3d::Identity();  ///< its inverse
  Matrix3d lower = Matrix3d::Identity();    ///< what friction adds to rates along the normal
};

Vector3d part(const VectorXd& of, const Cone& cone) {
  Vector3d v = Vector3d::Zero();
  v.head(cone.size) = of.segment(cone.at, cone.size);
  return v;
}

/// v_0^2 - |v_1|^2 of what is in the cone, without cancellation of squares.
double determinant(const Vector3d& v) {
  const double across = v.tail<2>().norm();
  return (v[0] - across) * (v[0] + across);
}

/// Jordan's.
Vector3d product(const Vector3d& v, const Vector3d& w) {
  return {v.dot(w), v[0] * w[1] + w[0] * v[1], v[0] * w[2] + w[0] * v[2]};
}

/// The w with product(v, w) = of.
Vector3d quotient(const Vector3d& of, const Vector3d& v) {
  Vector3d w;
  w[0] = (v[0] * of[0] - v.tail<2>().dot(of.tail<2>())) / determinant(v);
  w.tail<2>() = (of.tail<2>() - w[0] * v.tail<2>()) / v[0];
  return w;
}

/// The edge of the cone is where v has gone 1 / this of a way; not above 0: nowhere.
double towards_edge(const Vector3d& v, const Vector3d& way) {
  const double size = std::sqrt(determinant(v));
  const Vector3d unit = v / size;
  const double along = (unit[0] * way[0] - unit.tail<2>().dot(way.tail<2>())) / size;
  const Eigen::Vector2d across =
      way.tail<2>() / size - (along + way[0] / size) / (unit[0] + 1.0) * unit.tail<2>();
  return across.norm() - along;
}

/// The way of impulses and rates.
struct Way {
  VectorXd x;
  VectorXd u;
};

/// Unknowns x in units in which each touch by itself feels an impulse of 1 by 1 m/s, and rates u
/// with the term of friction, both in the cones, with x u = 0 in the end.
class Interior {
 public:
  Interior(const ConeProblem& problem, const std::vector<double>& friction) {
    const auto add = [&](Index row, double size) {
      unit_.push_back(size);
      row_.push_back(row);
    };
    for (std::size_t touch = 0; touch < friction.size(); ++touch) {
      const Index row = 3 * static_cast<Index>(touch);
      const double felt = problem.W.diagonal().segment<3>(row).maxCoeff();
      const double unit = felt > 0.0 ? 1.0 / std::sqrt(felt) : 1.0;
      const double mu = friction[touch];
      const bool bounded = mu > 0.0 && !std::isinf(mu);
      cones_.push_back({static_cast<Index>(row_.size()), bounded ? 3 : 1, mu > 0.0 ? 3 : 1});
      add(row, bounded ? unit / mu : unit);
      for (Index axis = 1; axis < 3 && mu > 0.0; ++axis) {
        if (!bounded) {
          free_.push_back(static_cast<Index>(row_.size()));
        }
        add(row + axis, unit);
      }
    }
    const auto size = static_cast<Index>(row_.size());
    const Eigen::Map<const VectorXd> unit(unit_.data(), size);
    H_ = unit.asDiagonal() * problem.W(row_, row_) * unit.asDiagonal();
    g_ = unit.cwiseProduct(problem.q(row_));
    rows_ = problem.q.size();
    if (!problem.roots.empty()) {
      VectorXd of_row = VectorXd::Zero(rows_);
      of_row(row_) = unit;
      bodies_.emplace(problem.roots, of_row);
      if (bodies_->size() >= size) {
        bodies_.reset();
      }
    }
    x_ = u_ = VectorXd::Zero(size);
    for (const Cone& cone : cones_) {
      x_[cone.at] = u_[cone.at] = std::max(g_.lpNorm<Eigen::Infinity>(), least_rate);
    }
  }

  /// Of a touch, on average, (m/s)^2.
  [[nodiscard]] double left() const { return x_.dot(u_) / static_cast<double>(cones_.size()); }

  /// N s
  [[nodiscard]] VectorXd impulse() const {
    VectorXd p = VectorXd::Zero(rows_);
    for (std::size_t i = 0; i < row_.size(); ++i) {
      p[row_[i]] = unit_[i] * x_[static_cast<Index>(i)];
    }
    return p;
  }

  /// Goes a step; false: it gets no further.
  bool advance() {
    const double now = left();
    VectorXd off = H_ * x_ + g_;
    MatrixXd K = H_;
    for (Cone& cone : cones_) {
      cone.lower = Matrix3d::Identity();
      if (cone.size == 3) {
        const Eigen::Vector2d slip = off.segment<2>(cone.at + 1);
        const double length = std::sqrt(slip.squaredNorm() + smoothing * now);
        off[cone.at] += length;
        cone.lower.block<1, 2>(0, 1) = slip.transpose() / length;
        K.row(cone.at) += slip.transpose() / length * H_.middleRows<2>(cone.at + 1);
      }
    }
    off -= u_;
    MatrixXd scaled = K;
    for (Cone& cone : cones_) {
      if (!find_scale(cone)) {
        return false;
      }
      scaled.block(cone.at, cone.at, cone.size, cone.size) +=
          (cone.scale * cone.scale).topLeftCorner(cone.size, cone.size);
    }
    for (const Index i : free_) {
      scaled(i, i) += compliance_along;
    }
    const Decomposed system(*this, scaled);
    const auto way = [&](const VectorXd& pulls) {
      Way found{system.solve(pulls - off), VectorXd()};
      found.u = K * found.x + off;
      for (const Index i : free_) {
        found.u[i] = 0.0;
      }
      return found;
    };
    const Way straight = way(-u_);
    const double most = std::min(1.0, 1.0 / towards_edges(straight));
    const double then =
        (x_ + most * straight.x).dot(u_ + most * straight.u) / static_cast<double>(cones_.size());
    const double goes_to = then / now;
    const double centring = std::clamp(goes_to * goes_to * goes_to, least_centring, 1.0);
    const double second = std::min(1.0, full_second_order * most);
    VectorXd pulls = VectorXd::Zero(x_.size());
    for (const Cone& cone : cones_) {
      const Vector3d at = cone.scale * part(x_, cone);
      Vector3d pull = -product(at, at) - second * product(cone.scale * part(straight.x, cone),
                                                          cone.unscale * part(straight.u, cone));
      pull[0] += centring * now;
      pulls.segment(cone.at, cone.size) = (cone.scale * quotient(pull, at)).head(cone.size);
    }
    const Way bent = way(pulls);
    const double step = std::min(1.0, most_of_way / towards_edges(bent));
    if (!(step >= least_step && bent.x.allFinite() && bent.u.allFinite())) {
      return false;
    }
    x_ += step * bent.x;
    u_ += step * bent.u;
    return true;
  }

 private:
  static constexpr double least_rate = std::numeric_limits<double>::min();

  /// What a step solves: by bodies if it can be, and else as it is.
  class Decomposed {
   public:
    Decomposed(Interior& of, const MatrixXd& matrix) : of_(of), matrix_(matrix) {
      if (!of.bodies_) {
        return;
      }
      std::vector<Matrix3d> inverse;
      std::vector<Matrix3d> lower;
      for (const Cone& cone : of.cones_) {
        inverse.push_back(Matrix3d::Zero());
        inverse.back().topLeftCorner(cone.size, cone.size) =
            (cone.unscale * cone.unscale).topLeftCorner(cone.size, cone.size);
        for (Index i = cone.size; i < cone.rows; ++i) {
          inverse.back()(i, i) = 1.0 / compliance_along;
        }
        lower.push_back(cone.lower);
      }
      of.bodies_->decompose(std::move(inverse), lower);
    }

    [[nodiscard]] VectorXd solve(const VectorXd& b) const {
      if (of_.bodies_) {
        if (auto x =
                refined(matrix_, b, exactly, [&](const VectorXd& c) { return by_bodies(c); })) {
          return *std::move(x);
        }
      }
      if (whole_.rows() == 0) {
        whole_.compute(matrix_);
      }
      return whole_.solve(b);
    }

   private:
    /// What is left of a step, the next one takes.
    static constexpr double exactly = 1e-5;

    [[nodiscard]] VectorXd by_bodies(const VectorXd& b) const {
      VectorXd rows = VectorXd::Zero(of_.rows_);
      rows(of_.row_) = b;
      return of_.bodies_->solve(rows)(of_.row_);
    }

    const Interior& of_;
    const MatrixXd& matrix_;
    mutable Eigen::ColPivHouseholderQR<MatrixXd> whole_;
  };

  /// False: rounding has taken impulses or rates to an edge.
  bool find_scale(Cone& cone) const {
    const Vector3d x = part(x_, cone);
    const Vector3d u = part(u_, cone);
    const double of_x = std::sqrt(determinant(x));
    const double of_u = std::sqrt(determinant(u));
    if (!(of_x > 0.0 && of_u > 0.0)) {
      return false;
    }
    const Vector3d a = x / of_x;
    const Vector3d b = u / of_u;
    Vector3d w = b + Vector3d(a[0], -a[1], -a[2]);
    w /= std::sqrt(2.0 * (1.0 + a.dot(b)));
    const double size = std::sqrt(of_u / of_x);
    const auto matrix = [&](const Eigen::Vector2d& across) {
      Matrix3d M = Matrix3d::Identity();
      M(0, 0) = w[0];
      M.block<1, 2>(0, 1) = across.transpose();
      M.block<2, 1>(1, 0) = across;
      M.block<2, 2>(1, 1) += across * across.transpose() / (1.0 + w[0]);
      return M;
    };
    cone.scale = size * matrix(w.tail<2>());
    cone.unscale = matrix(-w.tail<2>()) / size;
    return cone.scale.allFinite() && cone.unscale.allFinite();
  }

  /// As `towards_edge`, the nearest.
  [[nodiscard]] double towards_edges(const Way& way) const {
    double most = 0.0;
    for (const Cone& cone : cones_) {
      const Vector3d at = cone.scale * part(x_, cone);
      most = std::max({most, towards_edge(at, cone.scale * part(way.x, cone)),
                       towards_edge(at, cone.unscale * part(way.u, cone))});
    }
    return most;
  }

  std::vector<Cone> cones_;
  std::vector<Index> row_;    ///< of the problem, by unknown
  std::vector<double> unit_;  ///< likewise
  std::vector<Index> free_;   ///< unknowns along rough surfaces
  MatrixXd H_;
  VectorXd g_;
  VectorXd x_;
  VectorXd u_;
  Index rows_ = 0;  ///< of the problem
  std::optional<BodySystem> bodies_;
};

/// To roundoff from impulses that are near.
ConeImpulses polished(const ConeProblem& problem, const ConeProjections& projections, VectorXd p,
                      double settled) {
  const auto off = [&](const VectorXd& q) { return projections.off(q).lpNorm<Eigen::Infinity>(); };
  ConeImpulses nearest{std::move(p), 0.0};
  nearest.off = off(nearest.impulse);
  const auto take = [&](const VectorXd& found) {
    const double now = off(found);
    const bool nearer = now < nearest.off;
    if (nearer) {
      nearest = {found, now};
    }
    return nearer;
  };
  const VectorXd compliance =
      VectorXd::Constant(problem.q.size(), proximal * problem.W.diagonal().mean());
  for (int round = 0; round < most_rounds && nearest.off > settled; ++round) {
    if (round > 0 || problem.roots.empty()) {
      take(nearest.impulse - projections.newton_step(nearest.impulse));
    }
    if (nearest.off <= settled) {
      break;
    }
    const ConeProblem held = held_near(problem, nearest.impulse, compliance);
    const ConeProjections projections_of_held(held);
    VectorXd at = nearest.impulse;
    for (int step = 0; step < most_newton_steps; ++step) {
      at -= projections_of_held.newton_step(at);
    }
    if (!take(at)) {
      break;
    }
  }
  return nearest;
}

}  // namespace

ConeImpulses cone_interior(const ConeProblem& problem, const VectorXd& begin, double settled) {
  const ConeProjections projections(problem);
  ConeImpulses nearest{begin, projections.off(begin).lpNorm<Eigen::Infinity>()};
  std::vector<double> friction = problem.friction;
  bool again = true;
  while (again && nearest.off > settled) {
    Interior interior(problem, friction);
    const double first = interior.left();
    double least = std::numeric_limits<double>::infinity();
    VectorXd p = begin;
    bool goes_on = true;
    for (int step = 0, idle = 0;
         goes_on && step < most_steps && idle < most_idle && nearest.off > settled; ++step) {
      goes_on = interior.advance();
      if (goes_on && !(interior.left() <= near * first)) {
        continue;
      }
      const ConeImpulses found = polished(problem, projections, interior.impulse(), settled);
      p = found.impulse;
      idle = found.off < 0.5 * least ? 0 : idle + 1;
      least = std::min(least, found.off);
      if (found.off < nearest.off) {
        nearest = found;
      }
    }
    again = nearest.off > settled && projections.let_part(p, friction);
  }
  projections.make_exact(nearest);
  return nearest;
}

}  // namespace core
}  // namespace kairos
