#include "core/error.hpp"
#include "core/reading/document.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"
#include "experiments/named_method.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/run_error.hpp"
#include "experiments/view/simulated_view.hpp"
#include "experiments/view/view_files.hpp"
#include "experiments/view/viewer_template.hpp"
#include "simulation/option.hpp"
#include "simulation/registry.hpp"
#include "simulation/view/view_page.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words{""};
  for (const char c : text) {
    if (c == ',') {
      words.emplace_back();
    } else if (c != ' ') {
      words.back() += c;
    }
  }
  return words;
}

/// `thesis`, a scheme, or OPTION=VALUE, with commas between several; the rest is as in `choice`.
RunChoice other_choice(RunChoice choice, const std::string& text) {
  std::vector<OptionSetting> settings;
  for (const std::string& word : words_of(text)) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) {
      settings.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    } else if (word == "thesis") {
      choice.method = MethodChoice::thesis();
    } else {
      (void)find_scheme(word);  // throws with the names that exist
      settings.emplace_back("scheme", word);
    }
  }
  set_options(choice, settings);
  return choice;
}

struct ViewCommand {
  SceneOptions scene;
  RunOptions method;
  std::string beside;
  std::string out;

  void run() const;

 private:
  [[nodiscard]] std::vector<ViewRun> runs() const;
  void refuse_options() const;
};

ViewRun simulated(const Model& model, const RunChoice& choice) {
  ViewRun run = simulated_view(model, choice);
  if (!run.reason.empty()) {
    fmt::print(stderr, "{}: {}: stopped at t = {} s: {}; the page shows it up to there\n",
               model.scene().path, run.method,
               run.frame_times.empty() ? 0.0 : run.frame_times.back(), run.reason);
  }
  return run;
}

/// Refuses options of a run: a recorded run was made with its own.
void ViewCommand::refuse_options() const {
  if (!scene.overrides().empty() || identity_of(method.choice()) != identity_of(RunChoice{})) {
    throw InputError(scene.name(), 0, "",
                     "is a run that was made already; --set and the options of a method need a "
                     "SCENE");
  }
}

std::vector<ViewRun> ViewCommand::runs() const {
  std::vector<ViewRun> runs;
  const bool from_files = is_run(scene.name());
  if (from_files) {
    refuse_options();
    runs.push_back(read_run(scene.name()));
    if (!beside.empty() && !is_run(beside)) {
      throw InputError("", 0, "--beside",
                       fmt::format("'{}' is no run; beside a run goes another run's folder, a "
                                   "method beside a SCENE",
                                   beside));
    }
  } else {
    const RunChoice choice = method.choice();
    const Model model(scene.scene());
    runs.push_back(simulated(model, choice));
    if (!beside.empty() && !is_run(beside)) {
      try {
        runs.push_back(simulated(model, other_choice(choice, beside)));
      } catch (const InputError& error) {
        throw InputError(error.file(), error.line(), "--beside " + beside, error.reason());
      }
    }
  }
  if (!beside.empty() && is_run(beside)) {
    runs.push_back(read_run(beside));
  }
  return runs;
}

void ViewCommand::run() const {
  const std::string page = viewer_template();
  if (page.empty()) {
    throw RunError(
        "the viewer's page is not built: that takes Node 20 or later and npm; with both on the "
        "path, `cmake --build build/release --target studio` makes it");
  }
  const std::vector<ViewRun> shown = runs();
  const std::string file =
      out.empty() ? std::filesystem::path(shown.front().title).filename().string() + ".html" : out;
  write_file(file, view_page(read_text_file(page), shown));
  std::size_t motions = 0;
  for (const ViewRun& each : shown) {
    for (const BodyTrack& track : each.tracks) {
      motions += track.start.size();
    }
  }
  fmt::print("{} motions, {} frames -> {}\n", motions, shown.front().frame_times.size(), file);
}

}  // namespace

void add_view_command(Command& app) {
  const auto command = std::make_shared<ViewCommand>();
  Command view = app.add_subcommand(
      "view", "Make a page that shows a run: one HTML file, for any browser, without a network");
  command->scene.add_to(view);
  view.get_option("scene").description(
      "a scene (file or shipped name) to run, or the folder of a run");
  command->method.add_to(view);
  view.add_option("--beside", command->beside,
                  "shown in step beside it: `thesis`, a scheme, OPTION=VALUE (several with "
                  "commas), or the folder of another run")
      .type_name("METHOD");
  view.add_option("--out", command->out, "the page (default: the scene's name, .html)")
      .type_name("FILE.html");
  view.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
