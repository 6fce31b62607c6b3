#include "experiments/report/report_html.hpp"

#include "core/reading/csv.hpp"
#include "experiments/output/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

std::string path_of(const std::string& folder, const std::string& sweep, const char* kind) {
  return (fs::path(folder) / (sweep + kind)).string();
}

/// A column's name as a reader sees it.
std::string words(const std::string& column) {
  std::string out = html(column);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

/// `label`: what a narrow page writes before it, where there is no room for columns.
std::string data_cell(const std::string& cell, const std::string& label, const char* more = "") {
  const std::string name = fmt::format(" data-label=\"{}\"", words(label));
  if (cell.empty()) {
    return fmt::format("<td class=\"zero{}\"{}>–</td>", more, name);
  }
  constexpr std::size_t long_text = 32;  // characters; more than that is set in several lines
  const char* text = cell.size() > long_text ? "text long" : "text";
  const char* look = !parse_number(cell) ? text : cell == "0" ? "zero" : "";
  return fmt::format("<td class=\"{}{}\"{}>{}</td>", look, more, name, readable(cell));
}

std::string header_cell(const std::string& text, bool left = false) {
  return fmt::format("<th{}>{}</th>", left ? " class=\"text\"" : "", words(text));
}

/// Columns of a summary table: those before `runs` describe the point; the others come in groups
/// of statistics, `METRIC.mean` first.
struct Layout {
  std::size_t point = 0;
  std::vector<std::size_t> metrics;  ///< first column of each group
  bool repeated = false;
};

Layout layout_of(const Table& table) {
  Layout layout;
  layout.point = table.column("runs");
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].ends_with(".mean")) {
      layout.metrics.push_back(i);
    }
  }
  for (const auto& row : table.rows) {
    layout.repeated = layout.repeated || to_text(row[layout.point]) != "1";
  }
  return layout;
}

/// Median with quartiles; a metric that is 0 or 1 in a run, as the fraction of runs.
std::string statistic_cell(const std::vector<Cell>& row, std::size_t group, bool repeated,
                           const std::string& name) {
  const auto text = [&](std::size_t i) { return to_text(row[group + i]); };
  if (!repeated || text(0).empty()) {
    return data_cell(text(0), name);
  }
  if (name == "tunnelled" || name == "passed" || name == "turned") {
    return data_cell(text(0), name);
  }
  if (text(2) == text(4)) {
    return data_cell(text(3), name);
  }
  return fmt::format("<td data-label=\"{}\">{} <span class=\"range\">{} – {}</span></td>",
                     words(name), readable(text(3)), readable(text(2)), readable(text(4)));
}

}  // namespace

std::string readable(const std::string& cell) {
  const auto number = parse_number(cell);
  if (!number) {
    return html(cell);
  }
  return *number == std::trunc(*number) && std::abs(*number) < 1e6 ? fmt::format("{:.0f}", *number)
                                                                   : fmt::format("{:.4g}", *number);
}

std::string csv_table_html(const std::string& path) {
  const Table table = read_csv(path);
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"Table\"><table><thead><tr>";
  for (const std::string& column : table.columns) {
    out += header_cell(column);
  }
  out += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      out += data_cell(to_text(row[i]), table.columns[i]);
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string errata_html(const ReportEntry& entry) {
  const Table table = read_csv(path_of(entry.folder, "errata", ".csv"));
  const auto text = [&](std::size_t row, const char* column) {
    return to_text(table.rows[row][table.column(column)]);
  };
  const auto agreement = [&](std::size_t row) {
    const std::string tolerance = text(row, "tolerance");
    const std::string kind = html(text(row, "kind"));
    return tolerance == "0" ? kind : readable(tolerance) + " (" + kind + ")";
  };
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table\"><table "
      "class=\"errata\"><thead><tr><td></td><th "
      "class=\"text\">measured by a "
      "run</th><td></td><th>predicted</th><th>measured</th><th>unit</th>"
      "<th>agree to</th><th>verdict</th></tr></thead>\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::string id = text(i, "id");
    if (i == 0 || text(i - 1, "id") != id) {
      out += i == 0 ? "<tbody>\n" : "</tbody><tbody>\n";
      const std::string section = text(i, "section");
      out += fmt::format(
          "<tr class=\"statement\"><th>{}</th><td class=\"text\" colspan=\"7\"><b>Thesis{}:</b> "
          "{}. "
          "<b>Reading:</b> {}. <span class=\"test\">Test: {}</span></td></tr>\n",
          html(id), section == "—" ? "" : " " + html(section),
          text(i, "thesis") == "—" ? "silent" : html(text(i, "thesis")), html(text(i, "reading")),
          html(text(i, "test")));
    }
    out += fmt::format(
        "<tr><td></td><td class=\"text\">{}</td><td>{}</td><td data-label=\"predicted\">{}</td>"
        "<td data-label=\"measured\">{}</td><td class=\"unit\" data-label=\"unit\">{}</td>"
        "<td class=\"unit\" data-label=\"agree to\">{}</td><td class=\"{}\" "
        "data-label=\"verdict\">{}</td></tr>\n",
        html(text(i, "quantity")), html(text(i, "relation")), readable(text(i, "predicted")),
        readable(text(i, "measured")), html(text(i, "unit")), agreement(i),
        html(text(i, "verdict")), html(text(i, "verdict")));
  }
  return out + "</tbody></table></div>\n";
}

std::string html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string summary_html(const std::string& folder, const std::string& sweep, std::size_t most) {
  const Table table = read_csv(path_of(folder, sweep, "_summary.csv"));
  if (table.rows.size() > most || table.rows.empty()) {
    return "";
  }
  const Layout layout = layout_of(table);
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"Table\"><table><thead><tr>";
  for (std::size_t i = 0; i < layout.point; ++i) {
    out += header_cell(table.columns[i], i == 0);
  }
  out += header_cell("completed");
  for (const std::size_t group : layout.metrics) {
    out += header_cell(table.columns[group].substr(0, table.columns[group].size() - 5));
  }
  out += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < layout.point; ++i) {
      out += data_cell(to_text(row[i]), table.columns[i]);
    }
    out += fmt::format("<td data-label=\"completed\">{} of {}</td>", to_text(row[layout.point + 1]),
                       to_text(row[layout.point]));
    for (const std::size_t group : layout.metrics) {
      const std::string& column = table.columns[group];
      out += statistic_cell(row, group, layout.repeated, column.substr(0, column.size() - 5));
    }
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n";
  if (layout.repeated) {
    out +=
        "<p class=\"note\">Medians over the repeats, lower and upper quartile beside them; "
        "what is 0 or 1 in a run (<em>tunnelled</em>, <em>passed</em>, <em>turned</em>) is the "
        "fraction of runs.</p>\n";
  }
  return out;
}

std::string overview_html(const std::string& folder, const std::vector<std::string>& sweeps) {
  static const std::vector<std::pair<std::string, std::string>> shown = {
      {"max_penetration.max", "depth / m"},
      {"passed.mean", "through"},
      {"energy_error.max", "energy"}};
  std::vector<std::string> methods;
  std::map<std::string, std::string> cells;  // by method, sweep and metric
  for (const std::string& sweep : sweeps) {
    const Table table = read_csv(path_of(folder, sweep, "_summary.csv"));
    for (const auto& row : table.rows) {
      const std::string method = to_text(row[table.column("method")]);
      if (std::find(methods.begin(), methods.end(), method) == methods.end()) {
        methods.push_back(method);
      }
      for (const auto& metric : shown) {
        cells[method + '\n' + sweep + '\n' + metric.first] =
            to_text(row[table.column(metric.first)]);
      }
    }
  }
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table\"><table "
      "class=\"wide\"><thead><tr><td></td>";
  for (const std::string& sweep : sweeps) {
    out += fmt::format("<th class=\"group\" colspan=\"{}\">{}</th>", shown.size(), html(sweep));
  }
  out += "</tr><tr>" + header_cell("method", true);
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    for (const auto& metric : shown) {
      out += header_cell(metric.second);
    }
  }
  out += "</tr></thead><tbody>\n";
  for (const std::string& method : methods) {
    out += "<tr>" + data_cell(method, "method");
    for (const std::string& sweep : sweeps) {
      for (const auto& metric : shown) {
        out += data_cell(cells[method + '\n' + sweep + '\n' + metric.first],
                         sweep + ": " + metric.second,
                         metric.first == shown.front().first ? " first" : "");
      }
    }
    out += "</tr>\n";
  }
  return out +
         "</tbody></table></div>\n<p class=\"note\">Depth: the deepest penetration in a drawn "
         "frame; "
         "through: the fraction of runs in which the ball and the solid changed sides; energy: the "
         "largest relative error, that is, energy that no physics accounts for.</p>\n";
}

}  // namespace kairos::experiments
