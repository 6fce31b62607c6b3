#pragma once

#include "core/state.hpp"

namespace kairos {
inline namespace core {

/// A `Neighbourhood` that says so by being one: it can be told who will be asked about soon, where
/// there are so many bodies that what it knows of them is not in the cache.
class LooksAhead {
 public:
  virtual ~LooksAhead() = default;
  /// Where body i is will be asked for.
  virtual void look_up(BodyIndex i) const = 0;
  /// Who is near it will be, too; where it is has been looked up.
  virtual void look_around(BodyIndex i) const = 0;
};

}  // namespace core
}  // namespace kairos
