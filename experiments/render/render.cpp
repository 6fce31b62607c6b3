#include "experiments/render/render.hpp"

#include "core/error.hpp"
#include "experiments/child_process.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/run_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
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

  /// POV-Ray draws one of its scenes into one of its files, and may write nowhere else.
  void draw(const std::string& scene, const std::string& png, int width, int height, bool smooth) {
    const fs::path home = fs::absolute(path_) / "home";
    if (!configured_) {
      fs::create_directories(home / ".povray" / "3.7");
      write_file((home / ".povray" / "3.7" / "povray.conf").string(),
                 "[File I/O Security]\nrestricted\n[Shellout Security]\nforbidden\n"
                 "[Permitted Paths]\nread+write = .\n");
      configured_ = true;
    }
    // Names of folders stay out of its commands: it works in the folder itself.
    const std::vector<std::string> command{"povray",
                                           "+I" + scene,
                                           "+O" + png,
                                           fmt::format("+W{}", width),
                                           fmt::format("+H{}", height),
                                           "+FN",
                                           "-D",
                                           "-J",
                                           "-P",
                                           smooth ? "+A0.3" : "-A"};
    std::error_code error;
    if (run_child(command, ChildOutput::hidden, {path_.string(), home.string()}) != 0 ||
        !fs::is_regular_file(file(png), error)) {
      throw RunError(fmt::format("{}: povray could not draw it", file(png).string()));
    }
  }

 private:
  fs::path path_;
  bool configured_ = false;
};

PictureOptions picture_options(const RenderOptions& options, const Camera& camera,
                               const std::string& label) {
  return {.camera = camera,
          .width = options.width,
          .height = options.height,
          .label = label,
          .boxes = options.boxes};
}

/// A picture of pictures: seen from straight before, with a gap between them.
std::string side_by_side(const std::string& left, const std::string& right, double aspect) {
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
        *file, aspect, x);
  }
  return text;
}

/// Into the file `NAME.png` of the workshop.
std::string draw_one(const Moment& moment, const RenderOptions& options, const Camera& camera,
                     const std::string& label, const std::string& name, Workshop& workshop) {
  write_file(workshop.file(name + ".pov").string(),
             pov_scene(*moment.footage, moment.footage->at(moment.time),
                       picture_options(options, camera, label)));
  workshop.draw(name + ".pov", name + ".png", options.width, options.height, options.smooth);
  return name + ".png";
}

double aspect_of(const RenderOptions& options) {
  return static_cast<double>(options.width) / options.height;
}

/// Pictures and a film of an earlier run of this, which may have been longer.
void remove_pictures(const fs::path& folder) {
  std::error_code none;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    const std::string_view digits =
        name.starts_with("frame-") && name.ends_with(".png") && name.size() >= 15
            ? std::string_view(name).substr(6, name.size() - 10)
            : std::string_view();
    if (name == "film.mp4" ||
        (!digits.empty() && digits.find_first_not_of("0123456789") == std::string_view::npos)) {
      old.push_back(entry.path());
    }
  }
  for (const fs::path& path : old) {
    fs::remove(path, none);
  }
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
  const auto whole_run = [](const Footage& footage) {
    return Shot{&footage, 0, footage.pictures.size() - 1};
  };
  Camera camera;
  if (options.camera) {
    camera = *options.camera;
  } else {
    std::vector<Shot> shots{whole_run(*moment.footage)};
    if (beside.footage != nullptr) {
      shots.push_back(whole_run(*beside.footage));
    }
    camera = camera_for(shots, aspect_of(options));
  }
  Workshop workshop(png);
  std::string drawn = draw_one(moment, options, camera, options.label, "a", workshop);
  if (beside.footage != nullptr) {
    const std::string right =
        draw_one(beside, options, camera, options.beside_label, "b", workshop);
    write_file(workshop.file("both.pov").string(), side_by_side(drawn, right, aspect_of(options)));
    const int gap = static_cast<int>(std::lround(0.02 * options.width));
    drawn = "both.png";
    workshop.draw("both.pov", drawn, 2 * options.width + gap, options.height, false);
  }
  fs::rename(workshop.file(drawn), png);
}

std::size_t render_run(const Footage& footage, const Footage* beside, const RenderOptions& options,
                       const fs::path& folder) {
  RenderOptions fixed = options;
  const std::vector<double> times = picture_times(footage, options);
  if (!fixed.camera) {  // the same for all pictures
    std::vector<Shot> shots;
    for (const Footage* run : {&footage, beside}) {
      if (run != nullptr) {
        shots.push_back({run, run->at(times.front()), run->at(times.back())});
      }
    }
    fixed.camera = camera_for(shots, aspect_of(options));
  }
  OutputFolder taken(folder);
  taken.publish();  // pictures follow, each whole or not at all
  remove_pictures(folder);
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
  // In the folder itself: its name may hold what ffmpeg takes for a pattern.
  const int code = run_child(
      {"ffmpeg", "-y", "-framerate", fmt::format("{}", frames_per_second), "-i", "frame-%05d.png",
       "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", part.filename().string()},
      ChildOutput::hidden, {folder.string(), {}});
  std::error_code error;
  if (code != 0) {
    fs::remove(part, error);
    return false;
  }
  fs::rename(part, film);
  return true;
}

}  // namespace kairos::experiments
