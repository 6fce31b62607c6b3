// The engine as a page calls it. Texts are UTF-8 and end with a zero byte; an answer is kept until
// it is freed.
#include "studio/engine/engine.hpp"
#include <cstddef>
#include <memory>

using kairos::studio::Answer;

extern "C" {

Answer* kairos_about() { return std::make_unique<Answer>(kairos::studio::about()).release(); }

Answer* kairos_run(const char* scene, const char* path, const char* settings, const char* start,
                   double seconds, int tables) {
  return std::make_unique<Answer>(kairos::studio::run({.scene = scene,
                                                       .path = path,
                                                       .settings = settings,
                                                       .start = start,
                                                       .seconds = seconds,
                                                       .tables = tables != 0}))
      .release();
}

const char* kairos_json(const Answer* answer) { return answer->json.c_str(); }

const std::byte* kairos_numbers(const Answer* answer) { return answer->numbers.bytes().data(); }

std::size_t kairos_size(const Answer* answer) { return answer->numbers.bytes().size(); }

/// 0: trajectory, 1: events, 2: energy.
const char* kairos_table(const Answer* answer, int which) {
  return answer->tables.at(static_cast<std::size_t>(which)).c_str();
}

void kairos_free(Answer* answer) { delete answer; }

}  // extern "C"
