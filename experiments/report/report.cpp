#include "experiments/report/report.hpp"

#include "core/error.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/report/report_html.hpp"
#include "experiments/sweeps/experiment_library.hpp"
#include "experiments/sweeps/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t inline_rows = 40;  // longer tables are linked

/// An experiment as its folder tells it.
struct Chapter {
  std::string folder;  ///< path
  std::string name;    ///< of the folder: prefix of links
  std::vector<std::pair<std::string, std::string>> manifest;
  std::vector<std::pair<std::string, std::string>> figures;  ///< name, caption

  [[nodiscard]] std::string entry(const std::string& key) const {
    for (const auto& [k, value] : manifest) {
      if (k == key) {
        return value;
      }
    }
    return "";
  }
  [[nodiscard]] std::vector<std::string> sweeps() const {
    std::vector<std::string> out;
    for (const auto& [key, value] : manifest) {
      if (key == "sweep") {
        out.push_back(value);
      }
    }
    return out;
  }
};

std::vector<std::pair<std::string, std::string>> read_pairs(const fs::path& path) {
  std::vector<std::pair<std::string, std::string>> out;
  std::error_code error;
  if (fs::exists(path, error)) {
    for (const auto& row : read_csv(path.string()).rows) {
      out.emplace_back(to_text(row.at(0)), to_text(row.at(1)));
    }
  }
  return out;
}

/// Experiments in the order of the library, a person's own after them.
std::vector<Chapter> read_chapters(const std::string& folder) {
  std::vector<Chapter> chapters;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (fs::exists(entry.path() / "manifest.csv", error)) {
      chapters.push_back({entry.path().string(), entry.path().filename().string(),
                          read_pairs(entry.path() / "manifest.csv"),
                          read_pairs(entry.path() / "figures.csv")});
    }
  }
  const std::vector<std::string> order = shipped_experiments();
  const auto rank = [&order](const Chapter& chapter) {
    return std::find(order.begin(), order.end(), chapter.name) - order.begin();
  };
  std::sort(chapters.begin(), chapters.end(), [&](const Chapter& a, const Chapter& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.name < b.name;
  });
  return chapters;
}

std::string style_sheet() {
  std::ifstream in(fs::path(report_folder()) / "report.css");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string paragraph(const char* look, const std::string& text) {
  return text.empty() ? "" : fmt::format("<p class=\"{}\">{}</p>\n", look, html(text));
}

std::string figure_html(const Chapter& chapter, std::size_t number, const std::string& name,
                        const std::string& caption) {
  const std::string base = html(chapter.name + "/" + name);
  return fmt::format(
      "<figure><a class=\"picture\" href=\"{0}.svg\"><img src=\"{0}.svg\" alt=\"{1}\"></a>"
      "<figcaption><b>Figure {2}.</b> {3} <a href=\"{0}.png\">PNG</a></figcaption></figure>\n",
      base, html(caption), number, html(caption));
}

/// Links to every table of a chapter that exists.
std::string files_html(const Chapter& chapter) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(chapter.folder, error)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".csv" || extension == ".toml") {
      names.push_back(entry.path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  std::string out = "<ul class=\"files\">";
  for (const std::string& name : names) {
    out += fmt::format("<li><a href=\"{0}/{1}\">{1}</a></li>", html(chapter.name), html(name));
  }
  return out + "</ul>\n";
}

std::string facts_html(const Chapter& chapter) {
  std::string out = fmt::format("<h3>To repeat it</h3>\n<pre><code>{}</code></pre>\n",
                                html(chapter.entry("command")));
  out += "<dl class=\"facts\">";
  for (const std::string& sweep : chapter.sweeps()) {
    out += fmt::format("<dt>{}</dt><dd>scene {}, seed {}, {} repeat{} a point</dd>", html(sweep),
                       html(chapter.entry("scene:" + sweep)), html(chapter.entry("seed:" + sweep)),
                       html(chapter.entry("repeats:" + sweep)),
                       chapter.entry("repeats:" + sweep) == "1" ? "" : "s");
  }
  return out + "</dl>\n" + files_html(chapter);
}

std::string tables_html(const Chapter& chapter) {
  std::string out = "<h3>The numbers</h3>\n";
  if (chapter.name == "overview") {
    return out + overview_html(chapter.folder, chapter.sweeps());
  }
  for (const std::string& sweep : chapter.sweeps()) {
    const std::string table = summary_html(chapter.folder, sweep, inline_rows);
    const std::string link = fmt::format("<a href=\"{0}/{1}_summary.csv\">{1}_summary.csv</a>",
                                         html(chapter.name), html(sweep));
    out += table.empty()
               ? fmt::format("<p class=\"note\">{}: too long to be shown here, see {}.</p>\n",
                             html(sweep), link)
               : fmt::format("<p class=\"note\">{}, all digits in {}</p>\n{}", html(sweep), link,
                             table);
  }
  return out;
}

std::string chapter_html(const Chapter& chapter, std::size_t& figure_number) {
  std::string out = fmt::format("<section id=\"{}\"><h2>{}</h2>\n", html(chapter.name),
                                html(chapter.entry("title")));
  out += paragraph("asks", chapter.entry("asks"));
  out += paragraph("how", chapter.entry("how"));
  for (const auto& [name, caption] : chapter.figures) {
    out += figure_html(chapter, ++figure_number, name, caption);
  }
  if (chapter.figures.empty()) {
    out +=
        "<p class=\"note\">No figures were drawn: no Python with matplotlib was found when this "
        "ran.</p>\n";
  }
  out += paragraph("finding", chapter.entry("finding"));
  return out + tables_html(chapter) + facts_html(chapter) + "</section>\n";
}

std::string versions_html(const Chapter& chapter) {
  std::string out;
  for (const auto& [key, value] : chapter.manifest) {
    if (key.starts_with("version:")) {
      out += fmt::format("{}{} {}", out.empty() ? "" : " · ", html(key.substr(8)), html(value));
    }
  }
  return out;
}

std::string navigation_html(const std::vector<Chapter>& chapters) {
  std::string out =
      "<nav><a class=\"name\" href=\"#top\">kairos</a><p>What happens between two frames</p><ol>";
  for (const Chapter& chapter : chapters) {
    out += fmt::format("<li><a href=\"#{}\">{}</a></li>", html(chapter.name),
                       html(chapter.entry("title")));
  }
  return out + "</ol></nav>\n";
}

std::string page_html(const std::vector<Chapter>& chapters) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>kairos: what happens between two frames</title>\n<style>\n{}</style></head>\n"
      "<body id=\"top\"><div class=\"layout\">\n{}<main>\n",
      style_sheet(), navigation_html(chapters));
  out +=
      "<h1>What happens between two frames, and what does it cost to know?</h1>\n"
      "<p class=\"lead\">A world that is stepped once a rendered frame misses what happens in "
      "between: balls sink into walls, go through them, and gain energy. Here is that stepping, "
      "as Dembovsky’s thesis of 1999 describes it, measured beside its cures.</p>\n";
  std::size_t figure_number = 0;
  for (const Chapter& chapter : chapters) {
    out += chapter_html(chapter, figure_number);
  }
  out += fmt::format(
      "<footer>{} size. {}. Every number on this page comes from the linked tables; "
      "the same commands on the same machine and toolchain give the same bytes "
      "(timings apart).</footer>\n",
      chapters.front().entry("size") == "full" ? "Full" : "Quick", versions_html(chapters.front()));
  return out + "</main></div></body></html>\n";
}

}  // namespace

std::string write_report(const std::string& folder) {
  const std::vector<Chapter> chapters = read_chapters(folder);
  if (chapters.empty()) {
    throw InputError(folder, 0, "", "holds no experiment; run one with --out inside it first");
  }
  const std::string path = (fs::path(folder) / "index.html").string();
  write_file(path, page_html(chapters));
  return path;
}

}  // namespace kairos::experiments
