// What a `Model` makes of the joints of its scene.
#include "core/joint_system.hpp"
#include "core/model.hpp"
#include "core/model_tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>

namespace kairos {
inline namespace core {

/// Who hangs on joints, and what they make turn.
void Model::choose_joints() {
  Tally tally;
  jointed_.assign(size(), false);
  for (const Joint& joint : scene_.joints) {
    std::string names;
    for (const JointSide* side : {&joint.a, &joint.b}) {
      names += names.empty() ? "" : " and ";
      names += side->body ? body(*side->body).name : "the world";
      if (side->body && is_free(*side->body)) {
        jointed_[*side->body] = true;
        turned_by_force_[*side->body] = turned_by_force_[*side->body] || turns(joint, *side);
      }
    }
    tally.add(to_string(joint.kind), names,
              joint.collide ? "the scene asks for it; the two meet as solids, too"
                            : "the scene asks for it; the two do not meet as solids");
  }
  decide(tally.decisions("joints"));
}

/// Those that a joint holds together and that do not meet as solids, sorted.
std::vector<BodyPair> Model::jointed_pairs() const {
  std::vector<BodyPair> pairs;
  for (const Joint& joint : scene_.joints) {
    if (!joint.collide && joint.a.body && joint.b.body &&
        interaction(roles_[*joint.a.body], roles_[*joint.b.body])) {
      pairs.emplace_back(std::minmax(*joint.a.body, *joint.b.body));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// The joints of every island, whose forces come last. `place`: of each body in its island.
void Model::build_joints(const std::vector<std::size_t>& place) {
  const auto side = [&](const JointSide& written) {
    JointSystem::Side made;
    if (written.body && is_free(*written.body)) {
      made.place = place[*written.body];
    } else if (written.body) {
      made.pose = body(*written.body).initial.pose;
      made.drive = body(*written.body).drive;
    }
    return made;
  };
  std::vector<std::vector<JointSystem::Placed>> of_island(islands_.size());
  for (const Joint& joint : scene_.joints) {
    const bool a_is_free = joint.a.body && is_free(*joint.a.body);
    const BodyIndex one = a_is_free ? *joint.a.body : *joint.b.body;
    of_island[island_of_[one]].push_back({joint, side(joint.a), side(joint.b)});
  }
  const auto key = [this](const Joint& joint) {
    const auto name = [this](const JointSide& at) {
      return at.body ? std::string_view(body(*at.body).name) : std::string_view();
    };
    const Vector3 &a = joint.a.point, &b = joint.b.point;
    return std::tuple(name(joint.a), name(joint.b), joint.kind, a.x(), a.y(), a.z(), b.x(), b.y(),
                      b.z());
  };
  for (std::size_t k = 0; k < islands_.size(); ++k) {
    if (of_island[k].empty()) {
      continue;
    }
    // Joints are sorted, so that their order in the file changes no bit.
    std::stable_sort(of_island[k].begin(), of_island[k].end(),
                     [&](const JointSystem::Placed& a, const JointSystem::Placed& b) {
                       return key(a.joint) < key(b.joint);
                     });
    Island& island = islands_[k];
    auto joints = std::make_shared<const JointSystem>(std::move(of_island[k]), island.inertia);
    island_forces_.push_back(std::make_shared<const JointForce>(joints));
    island.forces.push_back(island_forces_.back().get());
    island.joints = joints.get();
    std::vector<BodyState> start;
    for (const BodyIndex i : island.bodies) {
      start.push_back(body(i).initial);
    }
    const std::size_t rank = joints->rank(Instant{}, start);
    if (rank < joints->rows()) {
      decide({{"joints",
               fmt::format("those of \"{}\" and what hangs on it are over-determined: {} rows, {} "
                           "of them independent",
                           body(island.bodies.front()).name, joints->rows(), rank),
               "a loop: forces are not unique, of those that fit the least are taken (least norm); "
               "motions are, but where the loop gains a freedom, as a flat parallelogram does"}});
    }
  }
}

/// The scene's numbers fit the joints to nine digits. The state is moved until it fits to roundoff.
void Model::put_onto_joints(State& state) const {
  std::vector<BodyState> jointed;
  for (const Island& island : islands_) {
    if (island.joints == nullptr) {
      continue;
    }
    jointed.clear();
    for (const BodyIndex i : island.bodies) {
      jointed.push_back(state[i]);
    }
    (void)island.joints->project_positions(Instant{}, jointed, island.constant_force);
    (void)island.joints->project_velocities(Instant{}, jointed);
    for (std::size_t k = 0; k < jointed.size(); ++k) {
      state[island.bodies[k]] = jointed[k];
    }
  }
}

}  // namespace core
}  // namespace kairos
