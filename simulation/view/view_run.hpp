#pragma once

#include "core/entity.hpp"
#include "core/event.hpp"
#include "core/joint.hpp"
#include "simulation/view/actor.hpp"
#include "simulation/view/body_track.hpp"

#include <string>
#include <utility>
#include <vector>

namespace kairos {
inline namespace simulation {

/// An event as a page shows it.
struct ViewEvent {
  double time = 0.0;  ///< s
  EventKind kind = EventKind::impact;
  BodyIndex a = 0;
  BodyIndex b = 0;
  Contact contact{};                  ///< zeros where the law needs none
  Vector3 impulse = Vector3::Zero();  ///< on b, N s; zeros where no mass is known
  double approach = 0.0;              ///< relative normal velocity before, m/s; negative: closing
};

/// A body as a page shows it.
struct ViewBody {
  Actor actor;
  Mobility moves = Mobility::fixed;
};

/// All that a page needs to show a run at any time. World frame, SI units.
struct ViewRun {
  std::string title;    ///< of the scene
  std::string summary;  ///< what the scene says of itself
  std::string method;
  std::string note;    ///< what a person has to know of the data; "" if nothing
  std::string reason;  ///< why the run stopped; "" if it completed
  std::vector<ViewBody> bodies;
  std::vector<Joint> joints;
  std::vector<BodyTrack> tracks;  ///< by body
  std::vector<double> frame_times;
  /// Name and value per frame, J: kinetic, potential, the lines of the ledger, unexplained.
  std::vector<std::pair<std::string, std::vector<double>>> energy;
  std::vector<ViewEvent> events;
};

}  // namespace simulation
}  // namespace kairos
