#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/option.hpp"
#include "simulation/output/json_writer.hpp"
#include "simulation/output/run_tables.hpp"
#include "simulation/view/packed_run.hpp"
#include "simulation/view/view_recorder.hpp"

#include <fmt/format.h>

#include "studio/engine/engine.hpp"
#include "studio/engine/later_start.hpp"
#include <chrono>
#include <exception>
#include <new>
#include <utility>
#include <vector>

namespace kairos::studio {
namespace {

/// Of bodies that a page draws and a person can tell apart.
constexpr std::size_t most_bodies = 20000;

/// Thrown by the recorder below; nothing else catches it on its way.
struct OutOfTime {
  double at = 0.0;  ///< s of the run
};

/// Ends a run that takes longer to compute than the page waits.
class PatientRecorder final : public ViewRecorder {
 public:
  explicit PatientRecorder(double seconds) : seconds_(seconds) {}

  void frame(const Frame& frame) override {
    ViewRecorder::frame(frame);
    look(frame.time);
  }
  void event(const Event& event) override {
    ViewRecorder::event(event);
    look(event.time);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void look(Instant t) const {
    const std::chrono::duration<double> passed = Clock::now() - began_;
    if (seconds_ > 0.0 && passed.count() > seconds_) {
      throw OutOfTime{t.seconds};
    }
  }

  double seconds_;
  Clock::time_point began_ = Clock::now();
};

RunChoice choice_of(std::string_view settings) {
  std::vector<OptionSetting> all;
  while (!settings.empty()) {
    const std::size_t end = std::min(settings.find('\n'), settings.size());
    const std::string_view line = settings.substr(0, end);
    settings.remove_prefix(std::min(end + 1, settings.size()));
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
      throw InputError("", 0, std::string(line), "is no option=value");
    }
    all.emplace_back(std::string(line.substr(0, equals)), std::string(line.substr(equals + 1)));
  }
  RunChoice choice;
  set_options(choice, all);
  return choice;
}

Scene scene_of(const Request& request) {
  Scene scene = parse_scene(request.scene, std::string(request.path));
  if (scene.bodies.size() > most_bodies) {
    throw InputError(std::string(request.path), 0, "body",
                     fmt::format("are {}; a page takes up to {}: run it with the program, and look "
                                 "at a part of it",
                                 scene.bodies.size(), most_bodies));
  }
  start_later(scene, request.start);
  return scene;
}

void add_bodies(JsonWriter& json, const Scene& scene) {
  json.open("lines");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    json.count(fmt::format("{}", i), scene.bodies[i].line);
  }
  json.close();
}

void add_cost(JsonWriter& json, const Cost& cost) {
  json.open("cost");
  json.count("right_hand_sides", cost.right_hand_sides);
  json.count("overlap_tests", cost.overlap_tests);
  json.count("toi_evaluations", cost.toi_evaluations);
  json.count("impacts", cost.impacts);
  json.close();
}

Answer run_view(const Model& model, const RunChoice& choice, double seconds) {
  Answer answer;
  JsonWriter json;
  PatientRecorder recorder(seconds);
  std::string reason;
  try {
    const RunResult result = simulate(model, choice, recorder);
    reason = result.status == RunStatus::stopped ? result.reason : "";
    add_cost(json, result.cost);
  } catch (const OutOfTime& late) {
    reason = fmt::format("computing took longer than {} s; shown up to t = {} s", seconds, late.at);
  }
  ViewRun view = std::move(recorder).finish();
  const MethodChoice& method = choice.method;
  view.method = fmt::format("{} + {} + {} + {}", method.scheme, method.integrator, method.detector,
                            method.impact);
  view.reason = std::move(reason);
  answer.numbers = packed(view);
  describe(json, view, answer.numbers);
  add_bodies(json, model.scene());
  answer.json = json.finish();
  return answer;
}

Answer run_tables(const Model& model, const RunChoice& choice) {
  Answer answer;
  const auto sink = [&answer](std::size_t i) {
    return [&text = answer.tables[i]](std::string_view line) { text += line; };
  };
  RunTables recorder({sink(0), sink(1), sink(2)});
  const RunResult result = simulate(model, choice, recorder);
  JsonWriter json;
  json.text("reason", result.status == RunStatus::stopped ? result.reason : "");
  add_cost(json, result.cost);
  answer.json = json.finish();
  return answer;
}

Answer complaint(const std::string& file, int line, const std::string& key,
                 const std::string& reason) {
  JsonWriter json;
  json.open("error");
  json.text("file", file);
  json.count("line", line);
  json.text("key", key);
  json.text("reason", reason);
  json.close();
  return {.json = json.finish()};
}

}  // namespace

Answer run(const Request& request) {
  try {
    const RunChoice choice = choice_of(request.settings);
    const Model model(scene_of(request));
    return request.tables ? run_tables(model, choice) : run_view(model, choice, request.seconds);
  } catch (const InputError& error) {
    return complaint(error.file(), error.line(), error.key(), error.reason());
  } catch (const std::bad_alloc&) {
    return complaint("", 0, "", "out of memory: a smaller scene or a shorter duration fits");
  } catch (const std::exception& error) {
    return complaint("", 0, "", error.what());
  }
}

}  // namespace kairos::studio
