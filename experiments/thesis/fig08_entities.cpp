#include "core/reading/scene_keys.hpp"
#include "experiments/thesis/entity_survey.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

namespace kairos::experiments::thesis {
namespace {

void add_answers(FigureData& data, const std::vector<SurveyedEntity>& survey) {
  Table& answers = data.table("answers", {{"entity", "", "kind, as scene files name it"},
                                          {"method", "", "what it is asked"},
                                          {"original", "", "the thesis' name of the method"},
                                          {"answer", "", "what it answers, SI units"}});
  for (const SurveyedEntity& entity : survey) {
    for (const Answer& a : entity.answers) {
      answers.rows.push_back(
          {entity.kind, std::string(a.method), std::string(a.original), a.answer});
    }
  }
  data.count("entities", static_cast<std::int64_t>(survey.size()), "entities in the catalogue");
}

void add_classes(FigureData& data, const std::vector<SurveyedEntity>& survey) {
  Table& classes = data.table("classes", {{"entity", "", "kind, as scene files name it"},
                                          {"class", "", "in the code"},
                                          {"parent", "", "its base class"},
                                          {"physics_type", "", "5.4.1"},
                                          {"mobility", "", "who moves it"},
                                          {"stationary", "", "a surface that reflects"},
                                          {"field", "", "things pass through it"},
                                          {"rotates", "", "impacts can turn it"},
                                          {"source", "", "section of the thesis, or ours"}});
  std::int64_t depth = 0;
  for (const SurveyedEntity& entity : survey) {
    classes.rows.push_back({entity.kind, entity.class_name, entity.parents.front(),
                            entity.physics_type, entity.mobility, std::int64_t{entity.stationary},
                            std::int64_t{entity.field}, std::int64_t{entity.rotates},
                            entity.source});
    depth = std::max(depth, static_cast<std::int64_t>(entity.parents.size()));
  }
  data.count("depth", depth, "levels of inheritance below the base class");
}

void add_attributes(FigureData& data, const std::vector<SurveyedEntity>& survey) {
  Table& attributes = data.table("attributes", {{"entity", "", "kind; empty: every body"},
                                                {"key", "", "as scene files write it"},
                                                {"unit", "", "of its value"},
                                                {"default", "", "where there is one"}});
  for (const std::string_view key : scene_keys_of("body")) {
    attributes.rows.push_back({std::string(), std::string(key), std::string(), Cell()});
  }
  for (const SurveyedEntity& entity : survey) {
    for (const EntityKey& key : entity.keys) {
      attributes.rows.push_back(
          {entity.kind, std::string(key.key), std::string(key.unit), key.default_value});
    }
  }
}

void measure_get_and_give(FigureData& data) { add_answers(data, survey_entities()); }

void measure_hierarchy(FigureData& data) { add_classes(data, survey_entities()); }

void measure_class_diagram(FigureData& data) {
  const std::vector<SurveyedEntity> survey = survey_entities();
  add_classes(data, survey);
  add_answers(data, survey);
  add_attributes(data, survey);
}

}  // namespace

ThesisFigure get_and_give() {
  return {.name = "fig08",
          .chapter = "5",
          .title = "Figure 8: the design philosophy of VRPhysicsEntities",
          .shows =
              "Attributes that flow into an object are given, those that flow out are got; "
              "force and momentum are fundamental (5.3).",
          .how =
              "Each of the {entities} entities that are registered is asked in the middle of a "
              "collision: it moves at (1, 2, 0) m/s and is met by a ball of 1 kg at (0, -3, 0) "
              "m/s. The answers are the code's, not a list's.",
          .caption =
              "What entities give (get_...) and what they do with what they are given "
              "(give_...), as they answer.",
          .finding =
              "The thesis' design survives contact with more entities: none of them knows "
              "another, and only things that move freely take momentum or force.",
          .script = "thesis.fig08",
          .measure = measure_get_and_give};
}

ThesisFigure hierarchy() {
  return {.name = "fig09",
          .chapter = "5",
          .title = "Figure 9: the object hierarchy",
          .shows =
              "An extract of the CoRgi object hierarchy: what VRPhysicsEntity inherits (Component, "
              "VREntity), and what inherits from it.",
          .how =
              "The classes of the registered entities and their base classes, read from the "
              "program's run-time type information.",
          .caption =
              "Inheritance of the entities, as compiled. Below each class: its kind in scene "
              "files.",
          .finding =
              "{depth} levels below one base class. What CoRgi inherits from above (a component, a "
              "thread "
              "routine, a visual) is no business of an entity here: schemes move it, recorders "
              "see it.",
          .script = "thesis.fig09",
          .measure = measure_hierarchy};
}

ThesisFigure class_diagram() {
  return {
      .name = "fig10",
      .chapter = "5",
      .title = "Figure 10: the VRPhysicsEntity class diagram",
      .shows =
          "The attributes and methods that physics entities have in common, in pairs of Get "
          "and Set (5.4).",
      .how =
          "The keys that the scene reader accepts for any body, those that each entity adds, "
          "and the methods that each answers otherwise than the base class: all from the "
          "catalogue of {entities} entities.",
      .caption =
          "Attributes (as scene files name them) and properties of the entities that are "
          "registered.",
      .finding =
          "Mass, velocity, G, normal, collision type: the thesis' attributes are here "
          "under their names, read from the scene rather than by pairs of Get and Set. Net force "
          "is not: it belongs to a frame, not to a body.",
      .script = "thesis.fig10",
      .measure = measure_class_diagram};
}

}  // namespace kairos::experiments::thesis
