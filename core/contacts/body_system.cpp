#include "core/contacts/body_system.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index row(std::size_t touch) { return 3 * static_cast<Index>(touch); }

}  // namespace

BodySystem::BodySystem(const std::vector<ConeRoot>& roots, const VectorXd& unit) {
  for (std::size_t k = 0; k < roots.size(); ++k) {
    const Eigen::Vector3d size = unit.segment<3>(row(k));
    for (const auto& [body, of] :
         {std::pair{roots[k].a, &roots[k].of_a}, {roots[k].b, &roots[k].of_b}}) {
      if (!of->isZero(0.0)) {
        sides_.push_back({k, place(body), size.asDiagonal() * *of});
      }
    }
  }
}

Index BodySystem::place(std::size_t body) {
  const auto found = std::find(bodies_.begin(), bodies_.end(), body);
  const auto at = 6 * static_cast<Index>(found - bodies_.begin());
  if (found == bodies_.end()) {
    bodies_.push_back(body);
  }
  return at;
}

void BodySystem::decompose(std::vector<Matrix3d> inverse, const std::vector<Matrix3d>& lower) {
  inverse_ = std::move(inverse);
  given_.clear();
  for (std::size_t k = 0; k < inverse_.size(); ++k) {
    given_.push_back(inverse_[k] * lower[k]);
  }
  MatrixXd S = MatrixXd::Identity(size(), size());
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const std::size_t k = sides_[s].touch;
    const Block36 to = given_[k] * sides_[s].root;
    for (std::size_t r = s > 0 && sides_[s - 1].touch == k ? s - 1 : s;
         r < sides_.size() && sides_[r].touch == k; ++r) {
      S.block<6, 6>(sides_[r].at, sides_[s].at) += sides_[r].root.transpose().lazyProduct(to);
    }
  }
  decomposition_.compute(S);
}

VectorXd BodySystem::solve(const VectorXd& b) const {
  VectorXd x(b.size());
  for (std::size_t k = 0; k < inverse_.size(); ++k) {
    x.segment<3>(row(k)) = inverse_[k] * b.segment<3>(row(k));
  }
  VectorXd moved = VectorXd::Zero(size());
  for (const Side& side : sides_) {
    moved.segment<6>(side.at) += side.root.transpose() * x.segment<3>(row(side.touch));
  }
  const VectorXd y = decomposition_.solve(moved);
  for (const Side& side : sides_) {
    const Eigen::Vector3d felt = side.root * y.segment<6>(side.at);
    x.segment<3>(row(side.touch)) -= given_[side.touch] * felt;
  }
  return x;
}

}  // namespace core
}  // namespace kairos
