#pragma once

#include "core/model.hpp"
#include "core/trajectory.hpp"
#include "tests/judge/lasting/real.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace kairos::judge {

/// What is wrong.
enum class Fault {
  overlap,  ///< two bodies in one another by more than rounding
  forces,   ///< no contact forces within their cones give the bodies their accelerations
  strays,  ///< a velocity is not the derivative of the position, nor a spin that of the orientation
  jump,    ///< a velocity jumps, and no impact is told
  gains,   ///< bodies have more energy than before
  gap,     ///< a motion ends before the next begins
};
constexpr Fault last_of(Fault) { return Fault::gap; }
[[nodiscard]] std::string_view to_string(Fault fault);

struct Finding {
  Fault fault;
  Real time;  ///< s
  Real size;  ///< in the units of the column of the table
  std::string who;
};

/// What is allowed. All are parts of scales of the instant: see tests/judge/README.md.
struct Allowed {
  Real forces = 1e-8L;          ///< of the largest acceleration of the group
  Real stepped = 1e-2L;         ///< the same where some two of the group were stepped over
  Real strays = 1e-9L;          ///< of the size of the body, by the end of a motion
  Real strays_in_step = 1e-6L;  ///< the same where some two of the group were stepped over
  Real jump = 1e-8L;            ///< of the same
  Real gains = 1e-12L;          ///< of all energy that flowed
};

/// How a run is looked at.
struct Look {
  int times = 1000;      ///< at random over the whole run
  int of_each_leg = 1;   ///< and as many between every two events
  int most_legs = 2000;  ///< of which so many are looked at, evenly
  std::uint64_t seed = 1;
  Real friction = 1;    ///< factor of all coefficients: another than 1 must be found out
  bool forces = true;   ///< of groups, too: of all it looks at, what takes longest
  double only_at = -1;  ///< s; not negative: look at this instant alone, and tell of it
  Allowed allowed;
};

/// What was seen, the greatest of each.
struct Verdict {
  std::string refusal;  ///< why the judge cannot tell; empty: it can
  std::int64_t instants = 0;
  std::int64_t groups = 0;    ///< of bodies that touch, by instant
  std::int64_t sticking = 0;  ///< points, by instant
  std::int64_t sliding = 0;
  std::int64_t slow = 0;     ///< groups where friction of a slow slide is not against it
  std::int64_t brief = 0;    ///< groups not judged: in a step so short that rounding hides forces
  std::int64_t stepped = 0;  ///< groups in an implicit step
  std::int64_t turned = 0;   ///< of these, where friction is not against the slide
  Real depth = 0;            ///< m
  Real forces = 0;
  Real in_steps = 0;  ///< `forces` of implicit steps
  Real creep = 0;     ///< fastest of what sticks, in units of the speed of a fall by the size
  Real strays = 0;
  Real jump = 0;
  Real gains = 0;
  Real friction_power = 0;  ///< the greatest of a point that slides, W; <= 0
  std::vector<Finding> findings;

  [[nodiscard]] bool right() const { return refusal.empty() && findings.empty(); }
};

/// Judges a whole run, from what its motions and events say.
[[nodiscard]] Verdict judge(const Model& model, const Trajectory& run, Instant end,
                            const EnergyLedger& ledger, const Look& look);

}  // namespace kairos::judge
