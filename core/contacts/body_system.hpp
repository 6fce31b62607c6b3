#pragma once

#include "core/contacts/cone_problem.hpp"

#include <Eigen/QR>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

/// Solves (D + L W) x = b for what acts at touches, three numbers each, where D and L are of each
/// touch alone, and W is a product of roots: by the system of the bodies, six numbers for each that
/// moves [Woodbury1950]. It is smaller than that of touches where there are many.
class BodySystem {
 public:
  /// @param unit  of each number of a touch: W is that of these; 0: it moves nothing
  BodySystem(const std::vector<ConeRoot>& roots, const Eigen::VectorXd& unit);

  /// How many numbers of bodies there are.
  [[nodiscard]] Eigen::Index size() const { return 6 * static_cast<Eigen::Index>(bodies_.size()); }

  /// @param inverse  of D, by touch
  /// @param lower    L, by touch
  void decompose(std::vector<Eigen::Matrix3d> inverse, const std::vector<Eigen::Matrix3d>& lower);

  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  using Block36 = Eigen::Matrix<double, 3, 6>;
  struct Side {
    std::size_t touch = 0;
    Eigen::Index at = 0;  ///< of the body's numbers
    Block36 root;
  };
  Eigen::Index place(std::size_t body);

  std::vector<std::size_t> bodies_;
  std::vector<Side> sides_;  ///< those of a touch beside each other
  std::vector<Eigen::Matrix3d> inverse_;
  std::vector<Eigen::Matrix3d> given_;  ///< inverse times lower
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition_;
};

/// Solves A x = b by something that is nearly an inverse of A, again for what is left, as long as
/// that helps; nullopt: more than this part of b is left.
template <typename NearlySolve>
std::optional<Eigen::VectorXd> refined(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                       double enough, const NearlySolve& nearly_solve) {
  constexpr int most_rounds = 4;
  constexpr double solved = 1e-14;  // of b
  const double asked = b.lpNorm<Eigen::Infinity>();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  Eigen::VectorXd rest = b;
  double off = asked;
  for (int round = 0; round < most_rounds && off > solved * asked; ++round) {
    const Eigen::VectorXd more = nearly_solve(rest);
    rest = b - A * (x + more);
    const double before = std::exchange(off, rest.lpNorm<Eigen::Infinity>());
    if (!(off < before)) {
      off = before;
      break;
    }
    x += more;
  }
  return off <= enough * asked ? std::optional(std::move(x)) : std::nullopt;
}

}  // namespace core
}  // namespace kairos
