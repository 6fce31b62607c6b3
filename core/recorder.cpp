#include "core/recorder.hpp"

namespace kairos {
inline namespace core {

std::string_view to_string(Stage stage) {
  switch (stage) {
    case Stage::draw:
      return "draw";
    case Stage::calculate_positions:
      return "calculate-positions";
    case Stage::restrict_movement:
      return "restrict-movement";
    case Stage::detect:
      return "detect";
    case Stage::handle:
      return "handle";
    case Stage::advance:
      return "advance";
    case Stage::locate:
      return "locate";
  }
  return "unknown";
}

}  // namespace core
}  // namespace kairos
