#pragma once

#include "core/broad_phase.hpp"
#include "core/contact_detector.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace kairos::ccd {

/// Who is asked about with whom: two objects if the mask of each has a bit of the other's group.
struct CollisionFilter {
  std::uint32_t group = 1;
  std::uint32_t mask = 0xffffffffU;
};

/// Two objects that touch, a < b; the overlap is from a to b.
struct Touch {
  BodyIndex a = 0;
  BodyIndex b = 0;
  Overlap overlap;
};

/// Many objects at one instant, and what is to happen where two touch: as SOLID has it, a response
/// for a pair, else for one of the two, else for all. Neighbours are found by sweep and prune; of
/// convex pairs that were apart the direction that separated them is asked first the next time,
/// which is safe, whatever it has become (ccd/README.md, any direction is safe).
class CollisionWorld {
 public:
  /// What is called with two that touch.
  using Response = std::function<void(const Touch&)>;
  /// Of the last `touching`, pairs.
  struct Cost {
    std::int64_t near = 0;      ///< whose boxes overlap, and which filters allow
    std::int64_t reminded = 0;  ///< of them told apart by the direction of the last time
    std::int64_t asked = 0;     ///< of them asked about anew
  };

  /// Objects are numbered from 0 to `most` - 1.
  explicit CollisionWorld(std::size_t most);

  /// Puts an object into the world, or another in its place. Throws `std::out_of_range` for a
  /// number that there is not, `std::invalid_argument` for a pose that is none.
  void put(BodyIndex object, Shape shape, const Pose& pose, CollisionFilter filter = {});
  /// Throws `std::out_of_range` where there is no such object, and as `put`.
  void move(BodyIndex object, const Pose& pose);
  /// Takes an object and its own response out of the world; one that is not there is none.
  void remove(BodyIndex object);
  /// Whether it holds this object.
  [[nodiscard]] bool has(BodyIndex object) const;

  /// What happens where two touch of which nothing else is said; an empty one takes it back, in the
  /// functions below as well.
  void respond(Response response) { for_all_ = std::move(response); }
  /// Where this object is one of them; if both have one, that of the smaller number.
  void respond(BodyIndex object, Response response);
  /// Where these two touch each other: goes before what is said of one of them, or of all.
  void respond(BodyIndex a, BodyIndex b, Response response);

  /// All pairs that touch, in ascending order, after their responses were called; valid until the
  /// next call. A response may move objects: that counts from the next call on.
  const std::vector<Touch>& touching();
  /// What the last `touching` cost.
  [[nodiscard]] const Cost& cost() const { return cost_; }

 private:
  struct Object {
    Shape shape;
    Pose pose;
    CollisionFilter filter;
    Response response;
  };

  const Object& at(BodyIndex object) const;
  void update(BodyIndex object);
  [[nodiscard]] bool apart_as_before(std::uint64_t pair, const Object& a, const Object& b);
  void look(BodyIndex a, BodyIndex b);
  void call_response(const Touch& touch) const;

  std::vector<std::optional<Object>> objects_;
  std::unique_ptr<BroadPhase> broad_phase_;
  Response for_all_;
  std::map<std::pair<BodyIndex, BodyIndex>, Response> for_pairs_;
  std::unordered_map<std::uint64_t, Vector3> directions_;  ///< of pairs that were apart
  std::unordered_map<std::uint64_t, Vector3> next_directions_;
  std::vector<BodyIndex> near_;
  std::vector<Touch> touches_;
  Cost cost_;
};

}  // namespace kairos::ccd
