#include "experiments/report/figure_html.hpp"

#include "core/reading/csv.hpp"
#include "experiments/report/markdown.hpp"
#include "experiments/report/report_html.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

namespace kairos::experiments {
namespace {

/// Tables that describe the others.
bool is_description(const std::string& file) {
  return file == "columns.csv" || file == "figures.csv" || file == "manifest.csv";
}

std::string data_links(const ReportEntry& entry) {
  std::string out;
  std::size_t shown = 0;
  for (const std::string& file : entry.data_files()) {
    if (is_description(file) || ++shown > 6) {
      continue;
    }
    out += fmt::format(" <a href=\"{0}/{1}\">{1}</a>", html(entry.name), html(file));
  }
  return out;
}

/// Width and height of a drawing, so that its place is kept before it is loaded; empty if it does
/// not say.
std::string size_of(const std::filesystem::path& drawing) {
  std::ifstream in(drawing);
  std::string text(2000, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  std::string out;
  for (const std::string_view key : {"width", "height"}) {
    const std::string mark = fmt::format(" {}=\"", key);
    const std::size_t at = text.find(mark);
    const std::size_t from = at + mark.size();
    const std::size_t end = text.find_first_not_of("0123456789.", from);
    const auto number =
        at == std::string::npos ? std::nullopt : parse_number(text.substr(from, end - from));
    if (!number) {
      return "";
    }
    out += fmt::format(" {}=\"{:.0f}\"", key, *number);
  }
  return out;
}

}  // namespace

std::string figure_label(const std::vector<ReportEntry>& entries, const ReportEntry& entry,
                         std::size_t drawing) {
  if (entry.of_thesis) {
    const bool numbered = entry.name.starts_with("fig");
    std::string label =
        numbered ? fmt::format("Figure {}", std::stoi(entry.name.substr(3))) : entry.name;
    if (entry.figures.size() > 1) {
      label += fmt::format(" {}", static_cast<char>('a' + static_cast<char>(drawing % 26)));
    }
    return label;
  }
  std::size_t before = 0;
  for (const ReportEntry& other : entries) {
    if (&other == &entry) {
      break;
    }
    before += other.of_thesis ? 0 : other.figures.size();
  }
  return fmt::format("Figure E{}", before + drawing + 1);
}

std::string figure_html(const ReportEntry& entry, std::size_t drawing, const std::string& label) {
  namespace fs = std::filesystem;
  const auto& [name, caption] = entry.figures[drawing];
  const std::string base = html(entry.name + "/" + name);
  // A ray-traced picture has no vector form: only a PNG.
  std::error_code error;
  const bool vector = fs::exists(fs::path(entry.folder) / (name + ".svg"), error);
  const std::string shown = base + (vector ? ".svg" : ".png");
  return fmt::format(
      "<figure><a class=\"picture\" href=\"{0}\"><img loading=\"lazy\" src=\"{0}\" "
      "alt=\"{1}\"{7}></a>"
      "<figcaption><b>{2}.</b> {3} <span class=\"made\"><code>{4}</code>{5}{6}</span>"
      "</figcaption></figure>\n",
      shown, html(caption), html(label), inline_html(caption), html(entry.entry("command")),
      data_links(entry), vector ? fmt::format(" <a href=\"{}.png\">PNG</a>", base) : "",
      vector ? size_of(fs::path(entry.folder) / (name + ".svg")) : "");
}

std::string figure_reference(const ReportEntry& entry, std::size_t drawing,
                             const std::string& label) {
  return fmt::format("<p class=\"note\"><a href=\"#{}\">{}</a>: {}</p>\n", html(entry.name),
                     html(label), inline_html(entry.figures[drawing].second));
}

}  // namespace kairos::experiments
