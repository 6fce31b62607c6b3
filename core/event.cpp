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
  }
  return "unknown";
}

}  // namespace core
}  // namespace kairos
