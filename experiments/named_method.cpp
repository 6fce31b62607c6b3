#include "experiments/named_method.hpp"

namespace kairos::experiments {

std::vector<NamedMethod> compared_methods() {
  const auto method = [](std::string_view name, const char* scheme, const char* detector) {
    return NamedMethod{name, {.method = {scheme, "auto", detector, "newton"}}};
  };
  std::vector<NamedMethod> all{{"thesis", {.method = MethodChoice::thesis()}},
                               method("geometric", "geometric", "certified"),
                               method("substepped", "substepped", "sat"),
                               method("equal substeps", "substepped", "sat"),
                               method("bisected", "bisected", "certified"),
                               method("event-driven", "event-driven", "certified")};
  all[3].choice.equal_substeps = true;
  return all;
}

}  // namespace kairos::experiments
