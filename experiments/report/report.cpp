#include "experiments/report/report.hpp"

#include "core/error.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/report/figure_html.hpp"
#include "experiments/report/live_view.hpp"
#include "experiments/report/markdown.hpp"
#include "experiments/report/paper.hpp"
#include "experiments/report/report_entry.hpp"
#include "experiments/report/report_html.hpp"
#include "experiments/report/report_site.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>
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

/// Details that a reader opens.
std::string folded(const char* title, const std::string& inside) {
  return inside.empty()
             ? ""
             : fmt::format("<details><summary>{}</summary>\n{}</details>\n", title, inside);
}

std::string facts_html(const ReportEntry& entry) {
  std::string out = fmt::format("<pre><code>{}</code></pre>\n", html(entry.entry("command")));
  out += "<dl class=\"facts\">";
  for (const std::string& sweep : entry.sweeps()) {
    out += fmt::format("<dt>{}</dt><dd>scene {}, seed {}, {} repeat{} a point</dd>", html(sweep),
                       html(entry.entry("scene:" + sweep)), html(entry.entry("seed:" + sweep)),
                       html(entry.entry("repeats:" + sweep)),
                       entry.entry("repeats:" + sweep) == "1" ? "" : "s");
  }
  return folded("To repeat it", out + "</dl>\n" + files_html(entry));
}

/// The tables that an experiment other than a sweep shows.
std::string shown_tables_html(const ReportEntry& entry) {
  std::string out;
  for (const auto& [key, name] : entry.manifest) {
    if (key == "table") {
      out += fmt::format("<p class=\"note\"><a href=\"{0}/{1}.csv\">{1}.csv</a></p>\n{2}",
                         html(entry.name), html(name),
                         csv_table_html(entry.folder + "/" + name + ".csv"));
    }
  }
  return folded("The numbers", out);
}

std::string tables_html(const ReportEntry& entry) {
  if (entry.sweeps().empty()) {
    return shown_tables_html(entry);
  }
  if (entry.name == "overview") {
    return folded("The numbers", overview_html(entry.folder, entry.sweeps()));
  }
  std::string out;
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
  return folded("The numbers", out);
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

/// A figure of the thesis: its caption there, how it is made here, and the result.
std::string thesis_figure_html(const Entries& entries, const ReportEntry& entry) {
  std::string out = fmt::format("<article id=\"{}\"><h2 class=\"title\">{}</h2>\n",
                                html(entry.name), html(entry.entry("title")));
  out += paragraph("asks", entry.entry("asks"));
  out += paragraph("how", entry.entry("how"));
  out += paragraph("finding", entry.entry("finding"));
  return out + figures_html(entries, entry) + live_html(entry) + "</article>\n";
}

std::string experiment_html(const Entries& entries, const ReportEntry& entry) {
  std::string out =
      fmt::format("<section id=\"{}\"><h1>{}</h1>\n", html(entry.name), html(entry.entry("title")));
  out += paragraph("asks", entry.entry("asks"));
  out += paragraph("finding", entry.entry("finding"));
  out += figures_html(entries, entry) + live_html(entry);
  out += folded("How it is done", paragraph("how", entry.entry("how")));
  return out + tables_html(entry) + facts_html(entry) + "</section>\n";
}

std::string errata_section_html(const ReportEntry& entry) {
  std::string out = fmt::format("<section id=\"errata\"><h1>{}</h1>\n", html(entry.entry("title")));
  out += paragraph("asks", entry.entry("asks"));
  out += paragraph("how", entry.entry("how"));
  out += paragraph("finding", entry.entry("finding"));
  out += errata_html(entry);
  for (const auto& [table, heading] : {std::pair{"corrected", "First readings that runs refuted"},
                                       {"contradictions", "Contradictions within the thesis"},
                                       {"undecided", "Claims that no run here decides"}}) {
    out += folded(heading, csv_table_html(fmt::format("{}/{}.csv", entry.folder, table)));
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

/// An answer that a reader wants first, and the entry that shows it.
struct Headline {
  std::string_view entry;
  std::string_view says;
};
constexpr Headline headlines[] = {
    {"energy-drift",
     "Balls gain energy because each step moves them with the velocity from before it: G²h²/(2m) "
     "more in every frame, whatever the bounces. Floating point has a share of some 1e-14."},
    {"penetration",
     "Looked at once a frame, a ball goes through a wall with probability 1 − (w + 2r)/(v h), once "
     "it moves farther in a frame than wall and ball are thick."},
    {"bat",
     "Looked at once a frame, a bat passes through a ball as its swing gets faster, although the "
     "ball hardly moves."},
    {"substeps",
     "Cutting a frame where something moves too far (fig. 15) catches fast balls and lets slow "
     "ones through: at some speeds it is worse than what it cures."},
    {"order",
     "Where impacts are not located every integrator is of order 1; on the dense output each keeps "
     "the order it was built with."},
    {"tradeoff",
     "Where impacts are handled at the end of a frame, sixteen times the frames bring a ball six "
     "times nearer, however good the integrator; from impact to impact the same work brings it a "
     "thousand times nearer."},
    {"contact-truths",
     "Blocks, balls, stacks and joints in contact that lasts: from event to event a run gives the "
     "numbers that are known to nine digits and more; schemes that step learn at the end of a "
     "frame what began inside it."},
    {"real-time", "Frames that come late do not concern event-driven: it draws what it knows."},
    {"extremes",
     "From impact to impact, by certified or by conservative advancement, nothing is wrong in "
     "silence: what cannot be done is said."},
};

class Pages {
 public:
  explicit Pages(const Entries& entries) : entries_(entries), paper_(fill_paper(entries)) {}

  std::vector<SitePage> all() {
    pages_.push_back({"index.html", "Findings", "", "", first_page()});
    add_thesis();
    for (const ReportEntry& entry : entries_) {
      if (!entry.of_thesis) {
        pages_.push_back({entry.name + ".html", entry.entry("title"), "Experiments", "",
                          experiment_html(entries_, entry)});
      }
    }
    add_paper();
    return std::move(pages_);
  }
  [[nodiscard]] const std::vector<std::string>& holes() const { return paper_.holes; }

 private:
  [[nodiscard]] std::string first_page() const {
    std::string out =
        "<h1>What happens between two frames, and what does it cost to know?</h1>\n"
        "<p class=\"lead\">A world that is stepped once a rendered frame misses what happens in "
        "between: balls sink into walls, go through them, and gain energy. Here is that stepping, "
        "as Dembovsky’s thesis of 1999 describes it, measured beside its cures.</p>\n"
        "<ol class=\"findings\">\n";
    for (const Headline& headline : headlines) {
      for (const ReportEntry& entry : entries_) {
        if (entry.name == headline.entry) {
          out += fmt::format("<li><a href=\"#{}\">{}</a> {}</li>\n", html(entry.name),
                             html(entry.entry("title")), html(std::string(headline.says)));
        }
      }
    }
    return out + "</ol>\n";
  }

  void add_thesis() {
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
        pages_.push_back(
            {id + ".html", title, "The thesis, again", below,
             fmt::format("<section id=\"{}\"><h1>{}</h1>\n{}</section>\n", id, title, inside)});
      }
    }
    for (const ReportEntry& entry : entries_) {
      if (entry.name == "errata") {
        pages_.push_back(
            {"errata.html", "Errata", "The thesis, again", "", errata_section_html(entry)});
      }
    }
  }

  static std::string short_name(const ReportEntry& entry) {
    return entry.name.starts_with("fig") ? std::to_string(std::stoi(entry.name.substr(3)))
                                         : html(entry.name);
  }

  /// A part of the paper as a page of its own: its headings begin at the first level.
  static std::string raised(std::string text) {
    for (const auto& [from, to] : {std::pair{"h3", "h1"}, {"h4", "h2"}}) {
      for (const char* const mark : {"<", "</"}) {
        const std::string tag = std::string(mark) + from;
        for (std::size_t at = text.find(tag); at != std::string::npos; at = text.find(tag, at)) {
          text.replace(at, tag.size(), std::string(mark) + to);
        }
      }
    }
    return text;
  }

  /// A page for each part of the paper, and one for what it cites.
  void add_paper() {
    const std::string& text = paper_.page.html;
    if (text.empty()) {
      return;
    }
    const auto add = [this](const std::string& file, const std::string& title,
                            const std::string& inside) {
      pages_.push_back({file, title, "The paper", "",
                        fmt::format("<section class=\"paper\">{}</section>\n", raised(inside))});
    };
    std::size_t from = 0;
    std::string file = "paper.html";
    std::string title = paper_.title;
    std::string heading = fmt::format("<h1 id=\"paper\">{}</h1>\n", html(paper_.title));
    for (const MarkdownHeading& part : paper_.page.headings) {
      const std::size_t at = text.find(fmt::format("<h3 id=\"{}\"", part.id), from);
      if (part.level != 2 || at == std::string::npos) {
        continue;
      }
      if (at > from || !heading.empty()) {
        add(file, title, heading + text.substr(from, at - from));
      }
      heading.clear();
      from = at;
      file = part.id + ".html";
      title = part.text;
    }
    add(file, title, heading + text.substr(from));
    add("references.html", "References",
        "<h1 id=\"references\">References</h1>\n" + paper_.references);
  }

  const Entries& entries_;
  Paper paper_;
  std::vector<SitePage> pages_;
};

}  // namespace

Report write_report(const std::string& folder) {
  const Entries entries = read_report_entries(folder);
  if (entries.empty()) {
    throw InputError(folder, 0, "", "holds no experiment; run one with --out inside it first");
  }
  write_live_views(folder, entries);
  Pages pages(entries);
  const std::string size = entries.front().entry("size") == "full" ? "Full" : "Quick";
  const std::string footer = fmt::format(
      "{} size. {}. The numbers of the thesis' figures and of the paper are filled in from the "
      "linked tables, those of the experiments' findings were read from them; the same commands "
      "on the same machine and toolchain give the same bytes (timings, and the date in rendered "
      "pictures, apart).",
      size, versions_html(entries.front()));
  write_site(folder, pages.all(), {style_sheet(), footer});
  return {(fs::path(folder) / "index.html").string(), pages.holes()};
}

}  // namespace kairos::experiments
