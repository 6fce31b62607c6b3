#include "experiments/report/report_site.hpp"

#include "experiments/output/atomic_file.hpp"
#include "experiments/report/report_html.hpp"
#include "experiments/run_error.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>

namespace kairos::experiments {
namespace {

using Places = std::map<std::string, std::string, std::less<>>;

/// The page on which each `id` stands.
Places places_of(const std::vector<SitePage>& pages) {
  constexpr std::string_view mark = " id=\"";
  Places places;
  for (const SitePage& page : pages) {
    for (std::size_t at = page.body.find(mark); at != std::string::npos;
         at = page.body.find(mark, at)) {
      at += mark.size();
      places.emplace(page.body.substr(at, page.body.find('"', at) - at), page.file);
    }
  }
  return places;
}

/// Links to places of other pages name the page.
std::string linked(const std::string& body, const std::string& file, const Places& places) {
  constexpr std::string_view mark = "href=\"#";
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = body.find(mark); at != std::string::npos; at = body.find(mark, from)) {
    const std::size_t name = at + mark.size();
    const std::string id = body.substr(name, body.find('"', name) - name);
    const auto place = places.find(id);
    out += body.substr(from, at - from);
    out += place == places.end() || place->second == file
               ? fmt::format("href=\"#{}", id)
               : fmt::format("href=\"{}#{}", place->second, id);
    from = name + id.size();
  }
  return out + body.substr(from);
}

std::string contents(const std::vector<SitePage>& pages, std::size_t current) {
  std::string out;
  std::string group;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const SitePage& page = pages[i];
    if (page.group != group) {
      group = page.group;
      out += fmt::format("<li class=\"group\">{}</li>", html(group));
    }
    out += fmt::format("<li><a href=\"{}\"{}>{}</a></li>", html(page.file),
                       i == current ? " aria-current=\"page\"" : "", html(page.title));
    if (!page.below.empty()) {
      out += fmt::format("<li class=\"below\">{}</li>", page.below);
    }
  }
  return out;
}

std::string neighbours(const std::vector<SitePage>& pages, std::size_t i) {
  const auto link = [&](std::size_t to, const char* way) {
    return fmt::format("<a rel=\"{}\" href=\"{}\">{}{}{}</a>", way, html(pages[to].file),
                       *way == 'p' ? "← " : "", html(pages[to].title), *way == 'n' ? " →" : "");
  };
  return fmt::format("<p class=\"neighbours\">{}{}</p>\n", i > 0 ? link(i - 1, "prev") : "",
                     i + 1 < pages.size() ? link(i + 1, "next") : "");
}

}  // namespace

void write_site(const std::string& folder, std::vector<SitePage> pages, const SiteFrame& frame) {
  const Places places = places_of(pages);
  std::set<std::string> files;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const SitePage& page = pages[i];
    if (!files.insert(page.file).second) {
      throw RunError(fmt::format("{}: two pages of the report have this name", page.file));
    }
    const bool first = i == 0;
    const std::string text = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>{}kairos: what happens between two frames</title>\n"
        "<link rel=\"icon\" href=\"data:,\">\n<style>\n{}</style></head>\n"
        "<body id=\"top\"{}><div class=\"layout\">\n"
        "<nav aria-label=\"Contents\"><a class=\"name\" href=\"index.html\">kairos</a>"
        "<p>What happens between two frames</p><ol>{}</ol></nav>\n<main>\n{}{}"
        "<footer>{}</footer>\n</main></div></body></html>\n",
        first ? "" : html(page.title) + " – ", frame.style, first ? " class=\"first\"" : "",
        linked(contents(pages, i), page.file, places), linked(page.body, page.file, places),
        neighbours(pages, i), frame.footer);
    write_file((std::filesystem::path(folder) / page.file).string(), text);
  }
}

}  // namespace kairos::experiments
