#pragma once

#include "experiments/random/random_scene.hpp"

#include <array>
#include <string>

namespace kairos {
inline namespace core {
class Archive;
}
}  // namespace kairos

namespace kairos::experiments {

/// What became of a scene under `event-driven` with `certified`.
enum class Fate {
  right,       ///< ran to its end: finite, no overlap, its energy accounted for
  no_room,     ///< stopped within a frame of where nothing rigid goes on (`leaves_no_room`)
  stopped,     ///< said why it cannot go on, elsewhere
  not_finite,  ///< NaN or infinity
  overlap,     ///< solids inside each other in a drawn frame
  ledger,      ///< energy that no line explains, beyond roundoff
  hang,        ///< more events than can be
  invalid,     ///< refused: the scene is wrong, which is the generator's mistake
  law,         ///< an impact of two that part, or a rebound that breaks restitution
  apart,       ///< told to be in contact, and not near each other in a drawn frame
  differs,     ///< other bits when neighbours are found another way
  joint,       ///< the two sides of a joint are not where it lets them be
  friction,    ///< friction, or hops that die down, gave energy
};
constexpr Fate last_of(Fate) { return Fate::friction; }
inline constexpr std::array all_fates{Fate::right,   Fate::no_room, Fate::not_finite, Fate::overlap,
                                      Fate::ledger,  Fate::hang,    Fate::law,        Fate::apart,
                                      Fate::differs, Fate::joint,   Fate::friction,   Fate::invalid,
                                      Fate::stopped};
[[nodiscard]] std::string_view to_string(Fate fate);

struct Trial {
  Fate fate = Fate::right;
  std::string reason;  ///< of a stop; what failed
  double time = 0.0;   ///< when, s
  std::int64_t impacts = 0;

  /// A promise that was broken: not a stop that says why.
  [[nodiscard]] bool failed() const {
    return fate != Fate::right && fate != Fate::no_room && fate != Fate::stopped;
  }
  void persist(Archive& archive);
};

/// Runs the scene and watches.
[[nodiscard]] Trial try_scene(const RandomScene& scene);
/// The same with neighbours from cells, and once more with every pair asked: the same bits.
[[nodiscard]] Trial try_by_two_searches(const RandomScene& scene);

/// A smaller scene that fails in the same way: fewer bodies, shorter, simpler numbers.
[[nodiscard]] RandomScene shrink(const RandomScene& scene, Fate fate);

}  // namespace kairos::experiments
