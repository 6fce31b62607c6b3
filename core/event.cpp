#include "core/event.hpp"

namespace kairos {
inline namespace core {

std::string_view to_string(EventKind kind) {
  switch (kind) {
    case EventKind::impact:
      return "impact";
    case EventKind::contact_begins:
      return "contact-begins";
    case EventKind::contact_ends:
      return "contact-ends";
    case EventKind::field_entered:
      return "field-entered";
    case EventKind::field_left:
      return "field-left";
    case EventKind::grasped:
      return "grasped";
    case EventKind::released:
      return "released";
    case EventKind::slip_begins:
      return "slip-begins";
    case EventKind::stick_begins:
      return "stick-begins";
    case EventKind::roll_begins:
      return "roll-begins";
  }
  return "unknown";
}

std::string_view to_string(Grade grade) {
  switch (grade) {
    case Grade::exact:
      return "exact";
    case Grade::enclosed:
      return "enclosed";
    case Grade::sampled:
      return "sampled";
  }
  return "unknown";
}

}  // namespace core
}  // namespace kairos
