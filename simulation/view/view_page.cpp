#include "simulation/view/view_page.hpp"

#include "simulation/output/json_writer.hpp"
#include "simulation/version.hpp"
#include "simulation/view/packed_run.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace kairos {
inline namespace simulation {
namespace {

constexpr std::string_view place_of_data = "<!--kairos-data-->";

/// JSON as it may stand in a script element: nothing in it can end the element or open a comment.
std::string without_markup(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string view_page(std::string_view page_template, std::span<const ViewRun> runs) {
  const std::size_t place = page_template.find(place_of_data);
  if (place == std::string_view::npos) {
    throw std::invalid_argument(
        fmt::format("the page's template has no {}; build it again", place_of_data));
  }
  JsonWriter json;
  json.text("program", "kairos " + std::string(version()));
  std::string blocks;
  json.open("runs");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const PackedArrays arrays = packed(runs[i]);
    json.open(fmt::format("{}", i));
    describe(json, runs[i], arrays);
    json.close();
    blocks += fmt::format("<script type=\"text/plain\" id=\"kairos-numbers-{}\">", i);
    blocks += base64(arrays.bytes()) + "</script>\n";
  }
  std::string page(page_template.substr(0, place));
  page += "<script type=\"application/json\" id=\"kairos-run\">" + without_markup(json.finish());
  page += "</script>\n" + blocks;
  return page += page_template.substr(place + place_of_data.size());
}

}  // namespace simulation
}  // namespace kairos
