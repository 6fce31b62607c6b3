#pragma once

#include "core/state.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

using BodyPair = std::pair<BodyIndex, BodyIndex>;  ///< first < second

/// What decides whether a body can do anything to another.
struct PairRole {
  bool free = false;   ///< moves as impacts and forces tell it
  bool field = false;  ///< acts on what overlaps it
};

/// Whether two bodies can do anything to each other: at least one moves freely; if one is a field,
/// the other moves freely and is no field.
[[nodiscard]] constexpr bool interaction(PairRole a, PairRole b) {
  if (a.field || b.field) {
    return a.field ? b.free && !b.field : a.free;
  }
  return a.free || b.free;
}

/// The pairs of bodies that can interact, or all pairs, in the order of creation. Made one by one
/// as they are asked for: a list of them would grow with the square of the bodies.
class BodyPairs {
 public:
  BodyPairs() = default;
  /// `all`: also those that cannot do anything to each other. `apart`: pairs (first < second,
  /// sorted) that do nothing to each other though their roles would let them.
  BodyPairs(std::vector<PairRole> roles, bool all, std::vector<BodyPair> apart = {})
      : roles_(std::move(roles)), apart_(std::move(apart)), all_(all) {}

  /// Goes through the pairs in order.
  class Iterator {
   public:
    /// A pair is made when it is asked for: all are values.
    using value_type = BodyPair;
    /// Of standard iterators.
    using difference_type = std::ptrdiff_t;
    /// Of standard iterators: a value.
    using reference = BodyPair;
    /// Of standard iterators.
    using iterator_category = std::input_iterator_tag;

    Iterator() = default;
    /// At the first pair whose first body is `a` or a later one.
    Iterator(const BodyPairs& pairs, BodyIndex a) : pairs_(&pairs), a_(a), b_(a) { ++*this; }

    /// The pair.
    BodyPair operator*() const { return {a_, b_}; }
    /// The next pair.
    Iterator& operator++() {
      do {
        step();
      } while (a_ < pairs_->roles_.size() && !pairs_->contains(a_, b_));
      return *this;
    }
    /// The next pair; returns the one before.
    Iterator operator++(int) {
      const Iterator before = *this;
      ++*this;
      return before;
    }
    /// Whether both are at the same pair.
    friend bool operator==(const Iterator& x, const Iterator& y) {
      return x.a_ == y.a_ && x.b_ == y.b_;
    }

   private:
    void step() {
      const std::size_t n = pairs_->roles_.size();
      if (++b_ >= n) {
        b_ = ++a_ + 1;
      }
      if (b_ >= n) {
        a_ = b_ = n;  // the end
      }
    }

    const BodyPairs* pairs_ = nullptr;
    BodyIndex a_ = 0;
    BodyIndex b_ = 0;
  };

  /// The first pair.
  [[nodiscard]] Iterator begin() const { return roles_.empty() ? end() : Iterator(*this, 0); }
  /// Beyond the last pair.
  [[nodiscard]] Iterator end() const {
    return roles_.empty() ? Iterator() : Iterator(*this, roles_.size());
  }
  /// Whether there is no pair.
  [[nodiscard]] bool empty() const { return begin() == end(); }
  /// Counted by role: what is the same for all bodies of two roles is asked once.
  [[nodiscard]] std::size_t size() const {
    constexpr PairRole roles[] = {{false, false}, {false, true}, {true, false}, {true, true}};
    std::size_t count[4] = {};
    for (const PairRole& role : roles_) {
      ++count[(role.free ? 2 : 0) + (role.field ? 1 : 0)];
    }
    std::size_t pairs = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a; b < 4; ++b) {
        if (all_ || interaction(roles[a], roles[b])) {
          pairs +=
              a == b ? count[a] * (count[a] - (count[a] > 0 ? 1 : 0)) / 2 : count[a] * count[b];
        }
      }
    }
    return all_ ? pairs : pairs - apart_.size();
  }
  /// Whether a and b, two different bodies, are a pair of these.
  [[nodiscard]] bool contains(BodyIndex a, BodyIndex b) const {
    return all_ || (interaction(roles_[a], roles_[b]) && !kept_apart(a, b));
  }
  /// Whether a and b do nothing to each other though their roles would let them.
  [[nodiscard]] bool kept_apart(BodyIndex a, BodyIndex b) const {
    return !apart_.empty() &&
           std::binary_search(apart_.begin(), apart_.end(), BodyPair(std::minmax(a, b)));
  }

 private:
  std::vector<PairRole> roles_;
  std::vector<BodyPair> apart_;
  bool all_ = false;
};

}  // namespace core
}  // namespace kairos
