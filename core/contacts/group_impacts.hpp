#pragma once

#include "core/contacts/contact_system.hpp"

#include <Eigen/Core>

#include <vector>

namespace kairos {
inline namespace core {

/// Newton's hypothesis for all rows at once [Moreau1988]: v+ >= -e v- where a row approaches, v+ >=
/// 0 where it rests, impulses >= 0, and none where v+ is greater. One linear complementarity
/// problem; momentum and symmetry are kept, and energy never grows, whatever the restitutions.
[[nodiscard]] Eigen::VectorXd newton_group(const ContactSystem& system,
                                           const Eigen::VectorXd& restitution,
                                           std::vector<Twist>& v);

/// Generalised reflections [Smith2012]: as long as rows approach, v += 2 M^-1 J^T p, p the plastic
/// impulse of those that do. Energy is kept. With restitution below 1 (the least of all rows that
/// take an impulse, e), e times that and 1 - e times the plastic impact of all rows: neither lets
/// rows approach, and neither gains energy.
[[nodiscard]] Eigen::VectorXd reflected_group(const ContactSystem& system,
                                              const Eigen::VectorXd& restitution,
                                              std::vector<Twist>& v);

}  // namespace core
}  // namespace kairos
