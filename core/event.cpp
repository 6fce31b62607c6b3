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

bool changes_contact(EventKind kind) {
  switch (kind) {
    case EventKind::contact_begins:
    case EventKind::contact_ends:
    case EventKind::slip_begins:
    case EventKind::stick_begins:
    case EventKind::roll_begins:
      return true;
    case EventKind::impact:
    case EventKind::field_entered:
    case EventKind::field_left:
    case EventKind::grasped:
    case EventKind::released:
      return false;
  }
  return false;
}

std::string_view to_string(EventFlag flag) {
  switch (flag) {
    case EventFlag::none:
      return "";
    case EventFlag::set_valued:
      return "set-valued";
    case EventFlag::plastic:
      return "plastic";
    case EventFlag::painleve:
      return "painleve";
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
    case Grade::stepped:
      return "stepped";
  }
  return "unknown";
}

}  // namespace core
}  // namespace kairos
