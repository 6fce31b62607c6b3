#include "experiments/render/render.hpp"

#include "core/error.hpp"
#include "experiments/child_process.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/run_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <system_error>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

/// Pictures on the way; removed with what is left in it.
class Workshop {
 public:
  explicit Workshop(const fs::path& beside) : path_(beside.string() + ".part") {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) {
      throw InputError(path_.parent_path().string(), 0, "--out",
                       fmt::format("cannot be written into: {}", error.message()));
    }
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  ~Workshop() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  [[nodiscard]] fs::path file(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

void run_povray(const fs::path& scene, const fs::path& png, int width, int height, bool smooth) {
  std::vector<std::string> command{"povray",
                                   fmt::format("+I{}", scene.string()),
                                   fmt::format("+O{}", png.string()),
                                   fmt::format("+W{}", width),
                                   fmt::format("+H{}", height),
                                   "+FN",
                                   "-D",
                                   "-J",
                                   "-P"};
  command.push_back(smooth ? "+A0.3" : "-A");
  std::error_code error;
  if (run_child(command, ChildOutput::hidden) != 0 || !fs::is_regular_file(png, error)) {
    throw RunError(fmt::format("{}: povray could not draw it", png.string()));
  }
}

PictureOptions picture_options(const RenderOptions& options, const Camera& camera,
                               const std::string& label) {
  return {.camera = camera,
          .width = options.width,
          .height = options.height,
          .label = label,
          .boxes = options.boxes};
}

/// A picture of pictures: seen from straight before, with a gap between them.
std::string side_by_side(const fs::path& left, const fs::path& right, double aspect) {
  const double gap = 0.02 * aspect;
  std::string text = fmt::format(
      "#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\nbackground {{ color rgb 1 }}\n"
      "camera {{ orthographic location <0,0,-1> look_at 0 right <{:.9g},0,0> up <0,1,0> }}\n",
      2.0 * aspect + gap);
  for (const auto& [file, x] : {std::pair{&left, -0.5 * gap - aspect}, {&right, 0.5 * gap}}) {
    text += fmt::format(
        "polygon {{ 5, <0,0>,<1,0>,<1,1>,<0,1>,<0,0> pigment {{ image_map {{ png \"{}\" once }} }} "
        "finish {{ ambient 0 diffuse 0 emission 1 }} scale <{:.9g},1,1> translate "
        "<{:.9g},-0.5,0> }}\n",
        file->string(), aspect, x);
  }
  return text;
}

void draw_one(const Footage& footage, double time, const RenderOptions& options,
              const Camera& camera, const std::string& label, const fs::path& scene,
              const fs::path& png) {
  write_file(scene.string(),
             pov_scene(footage, footage.at(time), picture_options(options, camera, label)));
  run_povray(scene, png, options.width, options.height, options.smooth);
}

}  // namespace

std::string why_no_povray() {
  if (run_child({"povray", "--version"}, ChildOutput::hidden) == 0) {
    return {};
  }
  return "povray is not found; install it (Debian, Ubuntu: apt-get install povray)";
}

std::vector<double> picture_times(const Footage& footage, const RenderOptions& options) {
  const double begin = footage.pictures.front().time;
  const double end = footage.pictures.back().time;
  const double from = options.from.value_or(begin);
  const double to = options.to.value_or(end);
  if (!(from <= to) || from > end || to < begin) {
    throw InputError("", 0, "--from, --to",
                     fmt::format("{} s to {} s is nothing of this run; it shows {} s to {} s", from,
                                 to, begin, end));
  }
  std::vector<double> times;
  if (options.every) {
    if (!(*options.every > 0.0)) {
      throw InputError("", 0, "--every", fmt::format("is {} s; allowed: > 0", *options.every));
    }
    // The end is wanted too where rounding puts it a hair before a step.
    const double count = std::floor((to - from) / *options.every + 1e-9);
    if (count > 1e6) {
      throw InputError("", 0, "--every",
                       fmt::format("asks for {:.3g} pictures; allowed: 1e6", count));
    }
    for (int k = 0; k <= static_cast<int>(count); ++k) {
      times.push_back(from + k * *options.every);
    }
    return times;
  }
  for (std::size_t k = footage.at(from); k < footage.pictures.size(); ++k) {
    const double t = footage.pictures[k].time;
    if (t >= from - 1e-9 && t <= to + 1e-9) {
      times.push_back(t);
    }
  }
  if (times.empty()) {
    times.push_back(from);
  }
  return times;
}

void render_picture(const Moment& moment, const Moment& beside, const RenderOptions& options,
                    const fs::path& png) {
  const Footage& footage = *moment.footage;
  const Camera camera =
      options.camera ? *options.camera : camera_for(footage, 0, footage.pictures.size() - 1);
  const Workshop workshop(png);
  const fs::path whole = workshop.file("whole.png");
  if (beside.footage == nullptr) {
    draw_one(footage, moment.time, options, camera, options.label, workshop.file("a.pov"), whole);
  } else {
    const fs::path left = workshop.file("a.png");
    const fs::path right = workshop.file("b.png");
    draw_one(footage, moment.time, options, camera, options.label, workshop.file("a.pov"), left);
    draw_one(*beside.footage, beside.time, options, camera, options.beside_label,
             workshop.file("b.pov"), right);
    const double aspect = static_cast<double>(options.width) / options.height;
    write_file(workshop.file("both.pov").string(), side_by_side(left, right, aspect));
    const int gap = static_cast<int>(std::lround(0.02 * options.width));
    run_povray(workshop.file("both.pov"), whole, 2 * options.width + gap, options.height, false);
  }
  fs::rename(whole, png);
}

std::size_t render_run(const Footage& footage, const Footage* beside, const RenderOptions& options,
                       const fs::path& folder) {
  RenderOptions fixed = options;
  const std::vector<double> times = picture_times(footage, options);
  if (!fixed.camera) {  // the same for all pictures
    fixed.camera = camera_for(footage, footage.at(times.front()), footage.at(times.back()));
  }
  OutputFolder(folder).publish();  // pictures follow, each whole or not at all
  ProgressBar bar("render", times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    render_picture({&footage, times[k]}, {beside, times[k]}, fixed,
                   folder / fmt::format("frame-{:05}.png", k));
    bar.advance();
  }
  return times.size();
}

bool make_film(const fs::path& folder, double frames_per_second) {
  const fs::path film = folder / "film.mp4";
  const fs::path part = folder / "film.part.mp4";
  const int code =
      run_child({"ffmpeg", "-y", "-framerate", fmt::format("{}", frames_per_second), "-i",
                 (folder / "frame-%05d.png").string(), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                 "-pix_fmt", "yuv420p", part.string()},
                ChildOutput::hidden);
  std::error_code error;
  if (code != 0) {
    fs::remove(part, error);
    return false;
  }
  fs::rename(part, film);
  return true;
}

}  // namespace kairos::experiments
