#include "experiments/report/report.hpp"

#include "core/error.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/report/figure_html.hpp"
#include "experiments/report/markdown.hpp"
#include "experiments/report/paper.hpp"
#include "experiments/report/report_entry.hpp"
#include "experiments/report/report_html.hpp"
#include "experiments/thesis/thesis_figure.hpp"

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

using Entries = std::vector<ReportEntry>;

std::string style_sheet() {
  std::ifstream in(fs::path(report_folder()) / "report.css");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string paragraph(const char* look, const std::string& text) {
  return text.empty() ? "" : fmt::format("<p class=\"{}\">{}</p>\n", look, inline_html(text));
}

std::string files_html(const ReportEntry& entry) {
  std::string out = "<ul class=\"files\">";
  for (const std::string& name : entry.data_files()) {
    out += fmt::format("<li><a href=\"{0}/{1}\">{1}</a></li>", html(entry.name), html(name));
  }
  return out + "</ul>\n";
}

std::string facts_html(const ReportEntry& entry) {
  std::string out = fmt::format("<h3>To repeat it</h3>\n<pre><code>{}</code></pre>\n",
                                html(entry.entry("command")));
  out += "<dl class=\"facts\">";
  for (const std::string& sweep : entry.sweeps()) {
    out += fmt::format("<dt>{}</dt><dd>scene {}, seed {}, {} repeat{} a point</dd>", html(sweep),
                       html(entry.entry("scene:" + sweep)), html(entry.entry("seed:" + sweep)),
                       html(entry.entry("repeats:" + sweep)),
                       entry.entry("repeats:" + sweep) == "1" ? "" : "s");
  }
  return out + "</dl>\n" + files_html(entry);
}

/// The tables that an experiment which is no sweep wants to be seen.
std::string shown_tables_html(const ReportEntry& entry) {
  std::string out;
  for (const auto& [key, name] : entry.manifest) {
    if (key == "table") {
      out += fmt::format("<p class=\"note\"><a href=\"{0}/{1}.csv\">{1}.csv</a></p>\n{2}",
                         html(entry.name), html(name),
                         csv_table_html(entry.folder + "/" + name + ".csv"));
    }
  }
  return out.empty() ? "" : "<h3>The numbers</h3>\n" + out;
}

std::string tables_html(const ReportEntry& entry) {
  if (entry.sweeps().empty()) {
    return shown_tables_html(entry);
  }
  std::string out = "<h3>The numbers</h3>\n";
  if (entry.name == "overview") {
    return out + overview_html(entry.folder, entry.sweeps());
  }
  for (const std::string& sweep : entry.sweeps()) {
    const std::string table = summary_html(entry.folder, sweep, inline_rows);
    const std::string link = fmt::format("<a href=\"{0}/{1}_summary.csv\">{1}_summary.csv</a>",
                                         html(entry.name), html(sweep));
    out += table.empty()
               ? fmt::format("<p class=\"note\">{}: too long to be shown here, see {}.</p>\n",
                             html(sweep), link)
               : fmt::format("<p class=\"note\">{}, all digits in {}</p>\n{}", html(sweep), link,
                             table);
  }
  return out;
}

std::string figures_html(const Entries& entries, const ReportEntry& entry) {
  if (entry.figures.empty()) {
    return "<p class=\"note\">No figures were drawn: what draws them was not found when this "
           "ran.</p>\n";
  }
  std::string out;
  for (std::size_t i = 0; i < entry.figures.size(); ++i) {
    out += figure_html(entry, i, figure_label(entries, entry, i));
  }
  return out;
}

/// A figure of the thesis: what it shows there, how it is made here, what it shows now.
std::string thesis_figure_html(const Entries& entries, const ReportEntry& entry) {
  std::string out = fmt::format("<article id=\"{}\"><h3 class=\"title\">{}</h3>\n",
                                html(entry.name), html(entry.entry("title")));
  out += paragraph("asks", entry.entry("asks"));
  out += paragraph("how", entry.entry("how"));
  out += figures_html(entries, entry);
  return out + paragraph("finding", entry.entry("finding")) + "</article>\n";
}

std::string experiment_html(const Entries& entries, const ReportEntry& entry) {
  std::string out =
      fmt::format("<section id=\"{}\"><h2>{}</h2>\n", html(entry.name), html(entry.entry("title")));
  out += paragraph("asks", entry.entry("asks"));
  out += paragraph("how", entry.entry("how"));
  out += figures_html(entries, entry);
  out += paragraph("finding", entry.entry("finding"));
  return out + tables_html(entry) + facts_html(entry) + "</section>\n";
}

std::string errata_section_html(const ReportEntry& entry) {
  std::string out = fmt::format("<section id=\"errata\"><h2>{}</h2>\n", html(entry.entry("title")));
  out += paragraph("asks", entry.entry("asks"));
  out += paragraph("how", entry.entry("how"));
  out += paragraph("finding", entry.entry("finding"));
  out += errata_html(entry);
  for (const auto& [table, heading] : {std::pair{"corrected", "First readings that runs refuted"},
                                       {"contradictions", "Contradictions within the thesis"},
                                       {"undecided", "Claims that no run here decides"}}) {
    out += fmt::format("<h3>{}</h3>\n{}", heading,
                       csv_table_html(fmt::format("{}/{}.csv", entry.folder, table)));
  }
  return out + facts_html(entry) + "</section>\n";
}

std::string versions_html(const ReportEntry& entry) {
  std::string out;
  for (const auto& [key, value] : entry.manifest) {
    if (key.starts_with("version:")) {
      out += fmt::format("{}{} {}", out.empty() ? "" : " · ", html(key.substr(8)), html(value));
    }
  }
  return out;
}

/// The page in the order of reading: its text and its contents grow together.
class Page {
 public:
  explicit Page(const Entries& entries) : entries_(entries), paper_(fill_paper(entries)) {}

  std::string write() {
    add_thesis();
    add_experiments();
    add_paper();
    std::string out = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>kairos: what happens between two frames</title>\n"
        "<link rel=\"icon\" href=\"data:,\">\n<style>\n{}</style></head>\n"
        "<body id=\"top\"><div class=\"layout\">\n"
        "<nav><a class=\"name\" href=\"#top\">kairos</a><p>What happens between two frames</p>"
        "<ol>{}</ol></nav>\n<main>\n",
        style_sheet(), contents_);
    out +=
        "<h1>What happens between two frames, and what does it cost to know?</h1>\n"
        "<p class=\"lead\">A world that is stepped once a rendered frame misses what happens in "
        "between: balls sink into walls, go through them, and gain energy. Here is that stepping, "
        "as Dembovsky’s thesis of 1999 describes it, chapter by chapter, measured beside its "
        "cures.</p>\n";
    out += body_;
    out += fmt::format(
        "<footer>{} size. {}. Every number on this page comes from the linked tables; "
        "the same commands on the same machine and toolchain give the same bytes "
        "(timings apart).</footer>\n",
        entries_.front().entry("size") == "full" ? "Full" : "Quick",
        versions_html(entries_.front()));
    return out + "</main></div></body></html>\n";
  }
  [[nodiscard]] const std::vector<std::string>& holes() const { return paper_.holes; }

 private:
  void add_group(const char* title) {
    contents_ += fmt::format("<li class=\"group\">{}</li>", title);
  }
  void add_contents(const std::string& id, const std::string& title, const char* look = "") {
    contents_ += fmt::format("<li{}><a href=\"#{}\">{}</a></li>", look, html(id), html(title));
  }

  void add_thesis() {
    const bool any = std::any_of(entries_.begin(), entries_.end(),
                                 [](const ReportEntry& entry) { return entry.of_thesis; });
    if (!any) {
      return;
    }
    add_group("The thesis, again");
    for (const ThesisChapter& chapter : thesis_chapters()) {
      std::string inside;
      std::string below;
      for (const ReportEntry& entry : entries_) {
        if (entry.of_thesis && entry.entry("chapter") == chapter.number) {
          inside += thesis_figure_html(entries_, entry);
          below += fmt::format("<a href=\"#{}\">{}</a>", html(entry.name), short_name(entry));
        }
      }
      if (!inside.empty()) {
        const std::string id = fmt::format("chapter-{}", chapter.number);
        const std::string title = fmt::format("{} {}", chapter.number, chapter.title);
        add_contents(id, title);
        contents_ += fmt::format("<li class=\"below\">{}</li>", below);
        body_ += fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, title, inside);
      }
    }
    for (const ReportEntry& entry : entries_) {
      if (entry.name == "errata") {
        add_contents(entry.name, "Errata");
        body_ += errata_section_html(entry);
      }
    }
  }

  static std::string short_name(const ReportEntry& entry) {
    return entry.name.starts_with("fig") ? std::to_string(std::stoi(entry.name.substr(3)))
                                         : html(entry.name);
  }

  void add_experiments() {
    bool first = true;
    for (const ReportEntry& entry : entries_) {
      if (!entry.of_thesis) {
        if (first) {
          add_group("Experiments");
          first = false;
        }
        add_contents(entry.name, entry.entry("title"));
        body_ += experiment_html(entries_, entry);
      }
    }
  }

  void add_paper() {
    if (paper_.page.html.empty()) {
      return;
    }
    add_group("The paper");
    add_contents("paper", paper_.title);
    for (const MarkdownHeading& heading : paper_.page.headings) {
      if (heading.level == 2) {
        add_contents(heading.id, heading.text, " class=\"deeper\"");
      }
    }
    add_contents("references", "References", " class=\"deeper\"");
    body_ += fmt::format(
        "<section id=\"paper\" class=\"paper\"><h2>{}</h2>\n{}<h3 "
        "id=\"references\">References</h3>\n"
        "{}</section>\n",
        html(paper_.title), paper_.page.html, paper_.references);
  }

  const Entries& entries_;
  Paper paper_;
  std::string contents_;
  std::string body_;
};

}  // namespace

Report write_report(const std::string& folder) {
  const Entries entries = read_report_entries(folder);
  if (entries.empty()) {
    throw InputError(folder, 0, "", "holds no experiment; run one with --out inside it first");
  }
  const std::string path = (fs::path(folder) / "index.html").string();
  Page page(entries);
  write_file(path, page.write());
  return {path, page.holes()};
}

}  // namespace kairos::experiments
