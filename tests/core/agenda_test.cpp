#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "core/schemes/event/event_agenda.hpp"
#include "tests/catch.hpp"

#include <string>

using namespace kairos;

namespace {

/// Two balls, listed against the alphabet.
Model two_balls() {
  std::string text = "duration = 1\n";
  for (const char* name : {"b", "a"}) {
    text += std::string("[[body]]\nname = \"") + name +
            "\"\nentity = \"ball\"\nradius = 0.1\nmass = 1\nposition = [0, " +
            (name[0] == 'a' ? "0" : "5") + ", 0]\n";
  }
  return Model(parse_scene(text, "test.toml"));
}

}  // namespace

TEST_CASE("agenda: earliest first; at one instant by what is due, then by name", "[agenda]") {
  const Model model = two_balls();
  Agenda agenda(model);
  CHECK(agenda.by_name() == std::vector<BodyIndex>{1, 0});
  CHECK(agenda.before(1, 0));
  const Instant early{1.0, -1e-20};  // the corrections tell the two apart
  const Instant late{1.0, 0.0};
  agenda.push(late, DueKind::impact, 0, 0);
  agenda.push(late, DueKind::impact, 1, 1);
  agenda.push(late, DueKind::segment_end, 0, 0);
  agenda.push(early, DueKind::impact, 0, 0);
  CHECK_FALSE(agenda.due_before(early));
  CHECK(agenda.due_before(late));
  CHECK(agenda.pop().time == early);
  CHECK(agenda.pop().kind == DueKind::segment_end);
  CHECK(agenda.pop().a == 1);
  CHECK(agenda.pop().a == 0);
  CHECK_FALSE(agenda.due_before(Instant::never()));
}

TEST_CASE("agenda: a new motion makes stale what was predicted of the old one", "[agenda]") {
  const Model model = two_balls();
  Agenda agenda(model);
  agenda.push(Instant{1.0}, DueKind::impact, 1, 0, 0.5, false);
  agenda.renew(0);
  agenda.push(Instant{2.0}, DueKind::impact, 1, 0);
  const DueEvent first = agenda.pop();
  CHECK(first.stale);
  CHECK(first.bracket == 0.5);
  CHECK_FALSE(first.decided);
  CHECK_FALSE(agenda.pop().stale);
}
