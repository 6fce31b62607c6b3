#pragma once

#include "core/impact_law.hpp"
#include "core/instant.hpp"
#include "core/state.hpp"

#include <limits>
#include <string_view>

namespace kairos {
inline namespace core {

/// What happened between two bodies.
enum class EventKind {
  impact,          ///< two solids met and the impact law was applied
  contact_begins,  ///< a body comes to rest on a surface
  contact_ends,    ///< it leaves the surface
  field_entered,
  field_left,
  grasped,       ///< a fist closes: `a` is the hand, `b` what it holds from now on
  released,      ///< it opens
  slip_begins,   ///< two in touch begin to slide along each other, or slide otherwise
  stick_begins,  ///< they stop sliding: friction holds them
  roll_begins,   ///< a ball stops sliding: it rolls
};
/// The word for it in `events.csv`.
[[nodiscard]] std::string_view to_string(EventKind kind);

/// How the time was located at which a contact mode begins or ends.
enum class Grade {
  exact,     ///< a root of a polynomial, to roundoff
  enclosed,  ///< proven by intervals
  sampled,   ///< looked for at so many points, then bisected
  stepped,   ///< at the start of an implicit step: see `implicit_mode`
};
/// The word for it in `events.csv`.
[[nodiscard]] std::string_view to_string(Grade grade);
/// The weakest grade.
constexpr Grade last_of(Grade) { return Grade::stepped; }

/// What a reader has to know of an impact before he relies on what came of it.
enum class EventFlag {
  none,
  /// The impact was handed on between bodies in touch, pair by pair, where they approached fastest:
  /// of such impacts several outcomes are possible [Halm2021], and the law's order chose this one.
  set_valued,
  /// What such an impact came to in the end: impulses at all touches at once, after which nothing
  /// approaches, and no restitution [Moreau1988]. What was left was slow, or nobody returns it.
  plastic,
  /// Painleve's case: no forces go with the slide, which an impulse at no speed stops [Genot1999].
  painleve,
};
/// The word for it in `events.csv`; empty: none.
[[nodiscard]] std::string_view to_string(EventFlag flag);

/// Whether an event of this kind tells how a body touches another from now on: it has a grade.
[[nodiscard]] bool changes_contact(EventKind kind);

/// Something that happened between two bodies.
struct Event {
  Instant time;
  EventKind kind = EventKind::impact;
  Grade grade = Grade::exact;  ///< where `changes_contact(kind)`
  EventFlag flag = EventFlag::none;
  /// s: it happens in [time, time + bracket]. Of an impact: what the detector tells, proven where
  /// it proves. Of a contact that begins: until the last of the hops that are left, as the motion
  /// tells when it is linearised. NaN: not known.
  double bracket = std::numeric_limits<double>::quiet_NaN();
  BodyIndex a = 0;
  BodyIndex b = 0;
  Contact contact{};                ///< of an impact whose law needs it; otherwise zeros
  BodyState before_a{}, after_a{};  ///< alike unless the event is an impact
  BodyState before_b{}, after_b{};
};

}  // namespace core
}  // namespace kairos
