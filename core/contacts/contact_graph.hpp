#pragma once

#include "core/contact_manifold.hpp"
#include "core/contacts/flat_modes.hpp"
#include "core/instant.hpp"
#include "core/state.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

class Archive;

/// Two bodies that stay in touch, an edge of the contact graph.
struct Patch {
  BodyIndex a = 0;
  BodyIndex b = 0;
  ContactManifold manifold;           ///< when it was last looked at
  Instant begins = Instant::never();  ///< when its bounces have died down
  bool told = false;                  ///< that contact has begun
  Slip slip = Slip::none;             ///< what both do along each other
  bool turns = false;                 ///< they turn while they touch
  Grade grade = Grade::exact;         ///< how its mode was found
  double step = 0.0;                  ///< s; how long the next step may be; 0: not known
  int short_steps = 0;                ///< in a row, of bodies that turn
  int implicit_steps = 0;             ///< that are made before forces are looked for again
  int stretch = 0;                    ///< how many of them were made last; 0: none since
  std::vector<Vector3> force{};       ///< by point, on b, of the last implicit step, N

  void persist(Archive& archive);
};

/// Who stays in touch with whom. The pairs in it are held by contact forces, and no detector is
/// asked about them. A pair goes as (a, b) with a before b in the order of names.
class ContactGraph {
 public:
  /// @param rank  of each body in the order of names
  explicit ContactGraph(const std::vector<std::uint32_t>& rank) : rank_(rank) {}

  [[nodiscard]] bool holds(BodyIndex i) const {
    return !partners_.empty() && partners_.contains(i);
  }
  [[nodiscard]] bool empty() const { return patches_.empty(); }
  /// nullptr where the two (in any order) are not held together.
  [[nodiscard]] Patch* find(BodyIndex i, BodyIndex j);
  [[nodiscard]] bool joins(BodyIndex i, BodyIndex j) const {
    return patches_.contains({i, j}) || patches_.contains({j, i});
  }
  /// The bodies that body i touches, in the order of names, so that a resumed run goes on alike.
  [[nodiscard]] const std::vector<BodyIndex>& partners(BodyIndex i) const {
    const auto found = partners_.find(i);
    return found == partners_.end() ? nobody_ : found->second;
  }

  Patch& join(BodyIndex a, BodyIndex b);
  void part(BodyIndex i, BodyIndex j);

  void persist(Archive& archive);

 private:
  void touch(BodyIndex i, BodyIndex j);
  void leave(BodyIndex i, BodyIndex j);

  std::vector<std::uint32_t> rank_;
  std::map<std::pair<BodyIndex, BodyIndex>, Patch> patches_;
  std::map<BodyIndex, std::vector<BodyIndex>> partners_;  ///< of bodies that have some
  std::vector<BodyIndex> nobody_;
};

}  // namespace core
}  // namespace kairos
