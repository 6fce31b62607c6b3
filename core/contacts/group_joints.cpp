#include "core/contacts/group_joints.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {
namespace {

/// A push of which joints leave less than this part is blocked: the rest is roundoff.
constexpr double blocked = 1e-12;

std::vector<BodyState> states_of(const GroupMechanism& mechanism,
                                 std::span<const BodyState> states) {
  std::vector<BodyState> own;
  for (const std::size_t i : mechanism.places) {
    own.push_back(states[i]);
  }
  return own;
}

void put_back(const GroupMechanism& mechanism, std::span<const BodyState> own,
              std::span<BodyState> states) {
  for (std::size_t k = 0; k < own.size(); ++k) {
    states[mechanism.places[k]] = own[k];
  }
}

}  // namespace

GroupJoints::GroupJoints(std::span<const GroupMechanism> mechanisms, Instant t,
                         std::span<const BodyState> states) {
  for (const GroupMechanism& mechanism : mechanisms) {
    if (mechanism.joints != nullptr) {
      mechanisms_.push_back(
          {mechanism.places, mechanism.joints->passing(t, states_of(mechanism, states))});
    }
  }
}

void GroupJoints::pass_on(Eigen::VectorXd& changes) const {
  for (const Mechanism& mechanism : mechanisms_) {
    const std::size_t n = mechanism.places.size();
    Eigen::VectorXd own(static_cast<Eigen::Index>(6 * n));
    const auto at = [](std::size_t k) { return static_cast<Eigen::Index>(6 * k); };
    for (std::size_t k = 0; k < n; ++k) {
      own.segment<6>(at(k)) = changes.segment<6>(at(mechanism.places[k]));
    }
    if (own.isZero(0.0)) {
      continue;
    }
    const Eigen::VectorXd left = mechanism.passing.leaves * own;
    for (std::size_t k = 0; k < n; ++k) {
      changes.segment<6>(at(mechanism.places[k])) = left.segment<6>(at(k));
    }
  }
}

void GroupJoints::pass_on(const Eigen::VectorXd& asks, Eigen::VectorXd& gives) const {
  const double before = asks.dot(gives);
  pass_on(gives);
  if (asks.dot(gives) <= blocked * before) {
    gives.setZero();
  }
}

Eigen::VectorXd GroupJoints::driven_work(const Eigen::VectorXd& changes) const {
  Eigen::VectorXd work = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mechanisms_.size()));
  for (std::size_t m = 0; m < mechanisms_.size(); ++m) {
    const Mechanism& mechanism = mechanisms_[m];
    for (std::size_t k = 0; k < mechanism.places.size() && mechanism.passing.driven.size() > 0;
         ++k) {
      const auto at = [](std::size_t i) { return static_cast<Eigen::Index>(6 * i); };
      work[static_cast<Eigen::Index>(m)] += mechanism.passing.driven.segment<6>(at(k)).dot(
          changes.segment<6>(at(mechanism.places[k])));
    }
  }
  return work;
}

bool GroupJoints::driven() const {
  return std::any_of(mechanisms_.begin(), mechanisms_.end(), [](const Mechanism& mechanism) {
    return mechanism.passing.driven.size() > 0;
  });
}

std::shared_ptr<const GroupJoints> group_joints(std::span<const GroupMechanism> mechanisms,
                                                Instant t, std::span<const BodyState> states) {
  const bool some =
      std::any_of(mechanisms.begin(), mechanisms.end(),
                  [](const GroupMechanism& mechanism) { return mechanism.joints != nullptr; });
  return some ? std::make_shared<const GroupJoints>(mechanisms, t, states) : nullptr;
}

bool put_positions_onto_joints(std::span<const GroupMechanism> mechanisms, Instant t,
                               std::span<BodyState> states) {
  bool converged = true;
  for (const GroupMechanism& mechanism : mechanisms) {
    if (mechanism.joints == nullptr) {
      continue;
    }
    std::vector<BodyState> own = states_of(mechanism, states);
    const std::vector<Vector3> no_forces(own.size(), Vector3::Zero());
    converged = mechanism.joints->project_positions(t, own, no_forces).converged && converged;
    put_back(mechanism, own, states);
  }
  return converged;
}

double put_velocities_onto_joints(std::span<const GroupMechanism> mechanisms, Instant t,
                                  std::span<BodyState> states) {
  double driven = 0.0;
  for (const GroupMechanism& mechanism : mechanisms) {
    if (mechanism.joints == nullptr) {
      continue;
    }
    std::vector<BodyState> own = states_of(mechanism, states);
    driven += mechanism.joints->project_velocities(t, own).driven;
    put_back(mechanism, own, states);
  }
  return driven;
}

void add_mechanism_forces(const GroupMechanism& mechanism, std::span<const std::size_t> place,
                          bool joints_too, Instant t, std::span<const BodyState> states,
                          std::span<Wrench> wrenches) {
  if (joints_too && mechanism.joints == nullptr) {
    return;
  }
  std::vector<BodyState> own;
  std::vector<Wrench> acting;
  for (const std::size_t i : mechanism.places) {
    own.push_back(states[place[i]]);
    acting.push_back(wrenches[place[i]]);
  }
  if (joints_too) {
    mechanism.joints->add_forces(t, own, acting);
  } else {
    for (const Force* const force : mechanism.forces) {
      force->add(t, own, acting);
    }
  }
  for (std::size_t k = 0; k < own.size(); ++k) {
    wrenches[place[mechanism.places[k]]] = acting[k];
  }
}

}  // namespace core
}  // namespace kairos
