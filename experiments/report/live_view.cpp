#include "experiments/report/live_view.hpp"

#include "core/model.hpp"
#include "core/reading/document.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/report/report_html.hpp"
#include "experiments/view/simulated_view.hpp"
#include "experiments/view/viewer_template.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "simulation/view/view_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <string_view>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

struct Live {
  std::string_view entry;
  std::string_view scene;
  std::string_view what;
};

constexpr Live lives[] = {
    {"fig12", "bat", "the bat goes through the ball, and does not"},
    {"fig13", "bounce", "a ball sinks into the floor, and does not"},
    {"ch8.1", "physworld", "the story of the three balls"},
    {"ch8.2", "table-tennis", "a rally on the folded table"},
    {"9.1.2", "bounce", "a ball rises higher and higher, and does not"},
    {"energy-drift", "bounce", "a ball rises higher and higher, and does not"},
    {"penetration", "bullet", "a ball flies through a wall, and does not"},
    {"bat", "bat", "the bat goes through the ball, and does not"},
    {"spinning-box", "spinning-box", "a spinning box meets a plate"},
};

const Live* live_of(const std::string& entry) {
  const auto* found = std::find_if(std::begin(lives), std::end(lives),
                                   [&](const Live& live) { return live.entry == entry; });
  return found == std::end(lives) ? nullptr : found;
}

fs::path page_of(const fs::path& folder, const Live& live) {
  return folder / "live" / fmt::format("{}.html", live.scene);
}

std::string live_page(const std::string& scene, const std::string& page) {
  const Model model(read_scene(shipped_scene_path(scene)));
  const std::array runs = {
      simulated_view(model, {}),
      simulated_view(model, RunChoice{.method = MethodChoice::thesis()}),
  };
  return view_page(page, runs);
}

}  // namespace

void write_live_views(const std::string& folder, const std::vector<ReportEntry>& entries) {
  const std::string page = viewer_template();
  if (page.empty()) {
    return;
  }
  const std::string text = read_text_file(page);
  std::vector<fs::path> written;
  for (const ReportEntry& entry : entries) {
    const Live* live = live_of(entry.name);
    if (live == nullptr) {
      continue;
    }
    const fs::path path = page_of(folder, *live);
    if (std::find(written.begin(), written.end(), path) == written.end()) {
      fs::create_directories(path.parent_path());
      write_file(path.string(), live_page(std::string(live->scene), text));
      written.push_back(path);
    }
  }
}

std::string live_html(const ReportEntry& entry) {
  const Live* live = live_of(entry.name);
  std::error_code error;
  if (live == nullptr || !fs::exists(page_of(fs::path(entry.folder).parent_path(), *live), error)) {
    return "";
  }
  const std::string path = fmt::format("live/{}.html", live->scene);
  // The drawing is loaded only when its link is followed.
  return fmt::format(
      "<details class=\"live\"><summary>See it move: {0}</summary>\n"
      "<p class=\"note\"><a href=\"{1}\" target=\"live-{2}\">Show it here</a>, or <a "
      "href=\"{1}\">alone on a page</a> (up to some 3 MB; the only thing here that needs scripts). "
      "Left: from impact to impact. Right: the thesis’ stepping.</p>\n"
      "<iframe name=\"live-{2}\" title=\"{0}\"></iframe></details>\n",
      html(std::string(live->what)), path, html(entry.name));
}

}  // namespace kairos::experiments
