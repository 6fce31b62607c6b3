#include "core/error.hpp"
#include "core/frame_times.hpp"
#include "core/reading/frame_reader.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/render/render.hpp"
#include "experiments/run_error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace kairos::experiments {
namespace {

struct RenderCommand {
  std::string trajectory;
  std::string beside;
  std::string out;
  std::optional<std::string> from, to, every, size, camera;
  bool no_boxes = false;
  double film_rate = 30.0;
  RenderOptions options;

  void run();

 private:
  void read_options();
};

double seconds(const std::string& text, const char* option) {
  // 0 is a time, though no duration.
  return text == "0" ? 0.0 : parse_duration(text, {"", 0, option});
}

/// `480x360`.
void read_size(const std::string& text, RenderOptions& options) {
  const std::size_t x = text.find('x');
  const auto whole = [&text](std::size_t begin, std::size_t end, int& value) {
    const char* last = text.data() + std::min(end, text.size());
    const auto [stop, error] = std::from_chars(text.data() + begin, last, value);
    return error == std::errc() && stop == last && value >= 16 && value <= 8192;
  };
  if (x == std::string::npos || !whole(0, x, options.width) ||
      !whole(x + 1, text.size(), options.height)) {
    throw InputError("", 0, "--size",
                     fmt::format("'{}' is no size; allowed: WIDTHxHEIGHT, each 16 to 8192", text));
  }
}

void RenderCommand::read_options() {
  if (from) {
    options.from = seconds(*from, "--from");
  }
  if (to) {
    options.to = seconds(*to, "--to");
  }
  if (every) {
    options.every = parse_duration(*every, {"", 0, "--every"});
  }
  if (size) {
    read_size(*size, options);
  }
  if (camera) {
    options.camera = parse_camera(*camera);
  }
  options.boxes = !no_boxes;
}

void RenderCommand::run() {
  read_options();
  const Footage footage = read_footage(trajectory);
  std::optional<Footage> other;
  if (!beside.empty()) {
    other = read_footage(beside);
    options.label = footage.title;
    options.beside_label = other->title;
  }
  (void)picture_times(footage, options);  // what is wrong shows before anything is made
  if (const std::string reason = why_no_povray(); !reason.empty()) {
    throw RunError(reason);
  }
  const std::size_t count = render_run(footage, other ? &*other : nullptr, options, out);
  fmt::print("{} pictures of {} x {} -> {}\n", count, options.width, options.height, out);
  if (count > 1 && make_film(out, film_rate)) {
    fmt::print("film -> {}\n", (std::filesystem::path(out) / "film.mp4").string());
  } else if (count > 1) {
    fmt::print(
        stderr,
        "no film: ffmpeg is not found; install it (Debian, Ubuntu: apt-get install ffmpeg)\n");
  }
}

}  // namespace

void add_render_command(Command& app) {
  const auto command = std::make_shared<RenderCommand>();
  Command render = app.add_subcommand("render", "Draw a run as PNG frames, by POV-Ray");
  const auto option = [&render](const char* name, std::optional<std::string>& value,
                                const char* meaning, const char* type) {
    render.add_option(name, value, meaning).type_name(type);
  };
  render
      .add_option("trajectory", command->trajectory,
                  "the folder that `kairos run --out` wrote, or its trajectory.csv")
      .required()
      .type_name("TRAJECTORY");
  render.add_option("--out", command->out, "folder for frame-00000.png and so on")
      .required()
      .type_name("DIR")
      .check(some_path());
  render.add_option("--beside", command->beside, "another run, drawn to the right of this one")
      .type_name("TRAJECTORY")
      .check(some_path());
  option("--from", command->from, "time of the first picture (default: the first frame)", "T");
  option("--to", command->to, "time of the last picture (default: the last frame)", "T");
  option("--every", command->every, "time between pictures (default: each drawn frame)", "T");
  option("--size", command->size, "pixels of a picture (default 480x360)", "WxH");
  option("--camera", command->camera,
         "px,py,pz,tx,ty,tz[,angle]: where it is, where it looks, degrees (default: sees all)",
         "C");
  render.add_flag("--no-boxes", command->no_boxes,
                  "without the boxes that round bodies collide as");
  render.add_option("--film-rate", command->film_rate, "pictures per second of the film")
      .check(finite_number(1.0, 240.0))
      .capture_default_str();
  render.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
