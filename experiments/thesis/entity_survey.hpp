#pragma once

#include "core/entity.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments::thesis {

/// A method of an entity and what it answers to one standard question: a collision with a ball of
/// 1 kg. Asked, not looked up: the answers are the code's.
struct Answer {
  std::string_view method;    ///< "get_momentum"
  std::string_view original;  ///< what the thesis calls it, "GetMomentum"
  std::string answer;         ///< short, for a diagram
};

/// An entity of the catalogue and all that can be asked of it.
struct SurveyedEntity {
  std::string kind;
  std::string class_name;            ///< in the code, "Wall"
  std::vector<std::string> parents;  ///< its base classes, nearest first; ends with "Entity"
  std::string physics_type;
  std::string mobility;
  bool stationary = false;
  bool field = false;
  bool rotates = false;
  std::string source;
  std::vector<EntityKey> keys;
  std::vector<Answer> answers;
};

/// Every entity that is registered.
[[nodiscard]] std::vector<SurveyedEntity> survey_entities();

}  // namespace kairos::experiments::thesis
