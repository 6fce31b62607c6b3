#pragma once

#include "core/contacts/cone_problem.hpp"

#include <Eigen/Core>

#include <cstddef>

namespace kairos {
inline namespace core {

/// Newton's method on the projections onto the cones, which are differentiable in pieces
/// [AlartCurnier1991]; of the steps that are as good the shortest, as touches may be redundant. It
/// comes to the end in few steps where sweeps touch by touch hardly move: light bodies between
/// heavy ones, wedges. It may go round in a circle; then it starts once more without impulses, and
/// with those that stop all.
/// @param begin    impulses to begin with, N s, finite
/// @param settled  what is near enough, m/s
/// @returns the impulses that came nearest: maybe those to begin with
[[nodiscard]] ConeImpulses cone_newton(const ConeProblem& problem, const Eigen::VectorXd& begin,
                                       double settled);

/// The same where Newton's method goes round in a circle, as among many redundant touches: the
/// proximal point algorithm [Rockafellar1976, Acary2018]. Each touch is given a compliance against
/// the impulses so far, which makes it a problem that Newton's method solves; the compliance
/// shrinks.
[[nodiscard]] ConeImpulses cone_proximal(const ConeProblem& problem, const Eigen::VectorXd& begin,
                                         double settled);

/// The same with one small compliance from the start, 1e-7 of what each touch feels by itself, and
/// as against no impulses: redundant touches share alike, and what they contradict each other by,
/// as roundoff of where they are does, asks for no more than the compliance bounds, and is left in
/// `off`. Where Newton's method goes round in a circle, larger compliances lead there. What the
/// compliance itself leaves, problems near the impulses so far take away, three at most, and
/// Newton's method without it, as long as it comes nearer.
/// @returns those to begin with, and infinity for what they are off, where that is not solved
[[nodiscard]] ConeImpulses cone_compliant(const ConeProblem& problem, const Eigen::VectorXd& begin,
                                          double settled);

/// Newton's method alone pays with so many touches at most, proximal points with so many, and any
/// of this with so many.
constexpr std::size_t most_for_newton = 32;
constexpr std::size_t most_for_proximal = 64;
constexpr std::size_t most_at_once = 160;
/// Ways to look for impulses at all touches at once.
enum class AtOnce {
  newton,      ///< Newton's method, where touches are few
  interior,    ///< `cone_interior`
  compliant,   ///< Newton's method from where it begins, where touches are few, and then
               ///< `cone_compliant`: where it goes astray, other starts seldom help
  proximal,    ///< the proximal points
  bounded,     ///< these with friction of 100 where touches are rough, as what is hardly pressed
               ///< and has no bound may be held by nothing at all
  held_along,  ///< where touches are rough, `holds_along`; what parts is the caller's to let go
};
/// In this way; what it is not meant for gives the impulses to begin with.
[[nodiscard]] ConeImpulses cone_at_once(const ConeProblem& problem, const Eigen::VectorXd& begin,
                                        double settled, AtOnce way);

}  // namespace core
}  // namespace kairos
