#include "core/entity.hpp"
#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/metrics/metrics.hpp"
#include "experiments/sweeps/sweep_spec.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/output/csv_row.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {
namespace {

/// All choices of one kind: a table whose first column is the name.
struct Listing {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

std::string yes_or_no(bool value) { return value ? "yes" : "no"; }
/// "exact" or the order.
std::string order(int order) { return order == 0 ? "exact" : fmt::format("{}", order); }

Listing list_schemes() {
  Listing listing{{"name", "summary", "source"}, {}};
  for (const auto& scheme : schemes()) {
    const SchemeInfo info = scheme->info();
    listing.rows.push_back(
        {std::string(info.name), std::string(info.summary), std::string(info.source)});
  }
  return listing;
}

Listing list_integrators() {
  Listing listing{{"name", "order", "position_order", "velocity_order", "chooses_order",
                   "symplectic", "step", "library", "source", "summary"},
                  {}};
  listing.rows.push_back({"auto", "", "", "", "", "", "", "", "",
                          "closed-form where the model allows it, a Runge-Kutta method otherwise"});
  for (const IntegratorEntry& entry : integrator_entries()) {
    const StepperInfo& info = entry.info;
    listing.rows.push_back({std::string(info.name), order(info.order), order(info.position_order),
                            order(info.velocity_order), yes_or_no(info.variable_order),
                            yes_or_no(info.symplectic),
                            info.controlled   ? "controlled"
                            : info.order == 0 ? "any"
                                              : "fixed",
                            std::string(info.library), std::string(info.source), std::string()});
  }
  return listing;
}

Listing list_detectors() {
  Listing listing{{"name", "summary", "locates", "proves"}, {}};
  for (const auto& detector : detectors()) {
    const DetectorInfo info = detector->info();
    listing.rows.push_back({std::string(info.name), std::string(info.summary),
                            yes_or_no(info.locates), yes_or_no(info.proves)});
  }
  return listing;
}

Listing list_impact_laws() {
  Listing listing{{"name", "summary"}, {}};
  for (const auto& law : impact_laws()) {
    listing.rows.push_back({std::string(law->info().name), std::string(law->info().summary)});
  }
  return listing;
}

Listing list_broad_phases() {
  Listing listing{{"name"}, {}};
  for (const std::string_view name : broad_phases()) {
    listing.rows.push_back({std::string(name)});
  }
  return listing;
}

Listing list_entities() {
  Listing listing{{"name", "summary", "source"}, {}};
  for (const EntityType& type : entity_catalogue()) {
    listing.rows.push_back(
        {std::string(type.kind), std::string(type.summary), std::string(type.source)});
  }
  return listing;
}

Listing list_scenes() {
  Listing listing{{"name", "summary"}, {}};
  for (const std::string& name : shipped_scenes()) {
    std::string summary;
    try {
      summary = read_scene(find_scene(name)).summary;
    } catch (const InputError& error) {
      summary = fmt::format("cannot be read: {}", error.what());
    }
    listing.rows.push_back({name, summary});
  }
  return listing;
}

Listing list_experiments() {
  Listing listing{{"name", "summary"}, {}};
  for (const std::string& name : shipped_experiments()) {
    listing.rows.push_back({name, read_experiment(find_experiment(name), Size::quick).title});
  }
  return listing;
}

Listing list_figures() {
  Listing listing{{"name", "summary"}, {}};
  for (const ThesisFigure& figure : thesis_figures()) {
    listing.rows.push_back({std::string(figure.name), std::string(figure.title)});
  }
  return listing;
}

Listing list_metrics() {
  Listing listing{{"name", "unit", "summary"}, {}};
  for (const MetricInfo& metric : metric_catalogue()) {
    listing.rows.push_back(
        {std::string(metric.name), std::string(metric.unit), std::string(metric.meaning)});
  }
  return listing;
}

struct Section {
  const char* name;
  Listing (*list)();
};
constexpr std::array<Section, 10> sections{{{"schemes", list_schemes},
                                            {"integrators", list_integrators},
                                            {"detectors", list_detectors},
                                            {"impact-laws", list_impact_laws},
                                            {"broad-phases", list_broad_phases},
                                            {"entities", list_entities},
                                            {"scenes", list_scenes},
                                            {"experiments", list_experiments},
                                            {"figures", list_figures},
                                            {"metrics", list_metrics}}};

/// Columns of the terminal that takes the output, or COLUMNS; 0: it goes to a file or a pipe.
std::size_t terminal_width() {
  struct winsize size {};
  if (::isatty(STDOUT_FILENO) == 1 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) {
    return size.ws_col;
  }
  const char* const columns = std::getenv("COLUMNS");
  std::size_t width = 0;
  const std::string_view text = columns == nullptr ? "" : columns;
  std::from_chars(text.data(), text.data() + text.size(), width);
  return width;
}

/// Breaks a line between words into lines of at most `width` characters; the others are indented.
std::string wrapped(const std::string& line, std::size_t width) {
  constexpr std::size_t least = 40;
  constexpr std::size_t indent = 6;
  if (width < least || line.size() <= width) {
    return line;
  }
  std::string out;
  std::string_view rest = line;
  while (rest.size() + (out.empty() ? 0 : indent) > width) {
    const std::size_t room = width - (out.empty() ? 0 : indent);
    const std::size_t space = rest.rfind(' ', room);
    const std::size_t end = space == std::string_view::npos || space < indent ? room : space;
    const std::string_view head = rest.substr(0, end);
    out += out.empty() ? "" : "\n" + std::string(indent, ' ');
    out += head.substr(0, head.find_last_not_of(' ') + 1);
    rest.remove_prefix(std::min(rest.find_first_not_of(' ', end), rest.size()));
  }
  return rest.empty() ? out : out + "\n" + std::string(indent, ' ') + std::string(rest);
}

/// Prints for people: columns as wide as their content, and a header if names do not say enough.
void print_table(const Section& section, const Listing& listing) {
  std::vector<std::vector<std::string>> lines = listing.rows;
  if (listing.columns.size() > 3) {
    lines.insert(lines.begin(), listing.columns);
    lines.front().front().clear();
  }
  std::vector<std::size_t> widths(listing.columns.size(), 0);
  widths.front() = 22;
  for (const auto& line : lines) {
    for (std::size_t k = 0; k < line.size(); ++k) {
      widths[k] = std::max(widths[k], line[k].size());
    }
  }
  fmt::print("{}\n", section.name);
  const std::size_t terminal = terminal_width();
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t k = 0; k < line.size(); ++k) {
      text += fmt::format("  {:<{}}", line[k], widths[k]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    fmt::print("{}\n", wrapped(text, terminal));
  }
}

/// Prints for programs: all columns of one kind, or kind, name and summary of all kinds.
void print_csv(const std::string& wanted) {
  CsvRow row;
  const auto print = [&row](const std::vector<std::string>& fields) {
    for (const std::string& field : fields) {
      row.text(field);
    }
    fmt::print("{}", row.finish());
  };
  if (wanted.empty()) {
    print({"kind", "name", "summary"});
  }
  for (const Section& section : sections) {
    const Listing listing = wanted.empty() || wanted == section.name ? section.list() : Listing{};
    if (wanted == section.name) {
      print(listing.columns);
    }
    const auto summary = std::find(listing.columns.begin(), listing.columns.end(), "summary");
    for (const auto& fields : listing.rows) {
      if (!wanted.empty()) {
        print(fields);
      } else {
        const auto k = static_cast<std::size_t>(summary - listing.columns.begin());
        print({section.name, fields.front(), k < fields.size() ? fields[k] : ""});
      }
    }
  }
}

}  // namespace

void add_list_command(Command& app) {
  const auto words = std::make_shared<std::vector<std::string>>();
  const auto csv = std::make_shared<bool>(false);
  Command command = app.add_subcommand("list", "What there is to choose from");
  std::vector<std::string_view> names;
  for (const Section& section : sections) {
    names.emplace_back(section.name);
  }
  command.add_option("what", *words, fmt::format("one of them only: {}", fmt::join(names, ", ")));
  command.add_flag("--csv", *csv, "as CSV, for programs; of one of them, with all columns");
  command.callback([words, csv, names] {
    std::string wanted = fmt::format("{}", fmt::join(*words, "-"));
    std::replace(wanted.begin(), wanted.end(), ' ', '-');  // impact laws, "impact laws"
    if (!wanted.empty() && std::find(names.begin(), names.end(), wanted) == names.end()) {
      refuse("list", fmt::format("'{}' is none of {}", wanted, fmt::join(names, ", ")));
    }
    if (*csv) {
      return print_csv(wanted);
    }
    for (const Section& section : sections) {
      if (wanted.empty() || wanted == section.name) {
        print_table(section, section.list());
      }
    }
  });
}

}  // namespace kairos::experiments
