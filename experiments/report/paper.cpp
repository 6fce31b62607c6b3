#include "experiments/report/paper.hpp"

#include "core/reading/csv.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/output/table.hpp"
#include "experiments/report/bibliography.hpp"
#include "experiments/report/figure_html.hpp"
#include "experiments/report/report_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

std::string file_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

class PaperFiller {
 public:
  explicit PaperFiller(const std::vector<ReportEntry>& entries) : entries_(entries) {
    const fs::path path = fs::path(paper_folder()) / "references.bib";
    bibliography_ = read_bibliography(file_text(path), path.string());
  }

  std::string resolve(std::string_view kind, std::string_view what) {
    if (kind == "cite") {
      return cite(std::string(what));
    }
    std::string found;
    if (kind == "value") {
      found = value(what);
    } else if (kind == "cell") {
      found = cell(what);
    } else if (kind == "figure") {
      found = figure(what);
    } else if (kind == "table") {
      found = table(what);
    }
    if (found.empty()) {
      const std::string hole = fmt::format("{}:{}", kind, what);
      holes_.push_back(hole);
      return fmt::format("<span class=\"hole\">not made: {}</span>", html(hole));
    }
    return found;
  }

  /// The works that were cited, by key.
  [[nodiscard]] std::string references() const {
    std::vector<const BibliographyEntry*> cited;
    for (const BibliographyEntry& entry : bibliography_) {
      if (cited_.contains(entry.key)) {
        cited.push_back(&entry);
      }
    }
    std::sort(cited.begin(), cited.end(),
              [](const auto* a, const auto* b) { return a->key < b->key; });
    std::string out = "<dl class=\"references\">\n";
    for (const BibliographyEntry* entry : cited) {
      out += fmt::format("<dt id=\"ref-{0}\">{0}</dt><dd>{1}</dd>\n", html(entry->key),
                         reference_html(*entry));
    }
    return out + "</dl>\n";
  }
  [[nodiscard]] const std::vector<std::string>& holes() const { return holes_; }

 private:
  [[nodiscard]] const ReportEntry* find(const std::string& name) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const ReportEntry& entry) { return entry.name == name; });
    return found == entries_.end() ? nullptr : &*found;
  }

  std::string cite(const std::string& key) {
    const bool known = std::any_of(bibliography_.begin(), bibliography_.end(),
                                   [&](const auto& entry) { return entry.key == key; });
    if (!known) {
      holes_.push_back("cite:" + key);
    }
    cited_.insert(key);
    return fmt::format("<a href=\"#ref-{0}\">{0}</a>", html(key));
  }

  [[nodiscard]] std::string value(std::string_view what) const {
    const std::size_t dot = what.rfind('.');
    const ReportEntry* entry = find(std::string(what.substr(0, dot)));
    return entry == nullptr || dot == std::string_view::npos
               ? ""
               : html(entry->quoted(std::string(what.substr(dot + 1))));
  }

  /// ENTRY/TABLE
  [[nodiscard]] fs::path table_path(const std::string& what) const {
    const std::size_t slash = what.find('/');
    const ReportEntry* entry = find(what.substr(0, slash));
    return entry == nullptr || slash == std::string::npos
               ? fs::path()
               : fs::path(entry->folder) / (what.substr(slash + 1) + ".csv");
  }

  [[nodiscard]] std::string cell(std::string_view what) const {
    const std::vector<std::string> parts = split(what, '|');
    std::error_code error;
    const fs::path path = table_path(parts[0]);
    if (parts.size() < 2 || !fs::exists(path, error)) {
      return "";
    }
    const Table table = read_csv(path.string());
    for (const auto& row : table.rows) {
      const bool wanted =
          std::all_of(parts.begin() + 2, parts.end(), [&](const std::string& condition) {
            const std::size_t equal = condition.find('=');
            return to_text(row[table.column(condition.substr(0, equal))]) ==
                   condition.substr(equal + 1);
          });
      if (wanted) {
        return readable(to_text(row[table.column(parts[1])]));
      }
    }
    return "";
  }

  [[nodiscard]] std::string figure(std::string_view what) const {
    const std::vector<std::string> parts = split(what, '/');
    const ReportEntry* entry = find(parts[0]);
    std::string out;
    for (std::size_t i = 0; entry != nullptr && i < entry->figures.size(); ++i) {
      if (parts.size() == 1 || entry->figures[i].first == parts[1]) {
        out += figure_reference(*entry, i, figure_label(entries_, *entry, i));
      }
    }
    return out;
  }

  [[nodiscard]] std::string table(std::string_view what) const {
    if (what == "errata") {
      const ReportEntry* entry = find("errata");
      return entry == nullptr ? "" : errata_html(*entry);
    }
    std::error_code error;
    const fs::path path = table_path(std::string(what));
    return path.empty() || !fs::exists(path, error) ? "" : csv_table_html(path.string());
  }

  const std::vector<ReportEntry>& entries_;
  std::vector<BibliographyEntry> bibliography_;
  std::set<std::string> cited_;
  std::vector<std::string> holes_;
};

}  // namespace

Paper fill_paper(const std::vector<ReportEntry>& entries) {
  Paper paper;
  const std::string folder = paper_folder();
  const std::string text = folder.empty() ? "" : file_text(fs::path(folder) / "replication.md");
  if (text.empty()) {
    return paper;
  }
  PaperFiller filler(entries);
  paper.page =
      markdown_html(text, "paper-", [&filler](std::string_view kind, std::string_view what) {
        return filler.resolve(kind, what);
      });
  paper.title = paper.page.headings.empty() ? "Replication" : paper.page.headings.front().text;
  paper.references = filler.references();
  paper.holes = filler.holes();
  return paper;
}

}  // namespace kairos::experiments
