#include "core/time_of_impact.hpp"

namespace kairos {
inline namespace core {

std::string_view to_string(ToiStatus status) {
  switch (status) {
    case ToiStatus::separated:
      return "separated";
    case ToiStatus::impact:
      return "impact";
    case ToiStatus::overlapping:
      return "overlapping";
    case ToiStatus::undecided:
      break;
  }
  return "undecided";
}

}  // namespace core
}  // namespace kairos
