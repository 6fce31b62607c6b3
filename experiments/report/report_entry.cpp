#include "experiments/report/report_entry.hpp"

#include "experiments/data_folders.hpp"
#include "experiments/output/table.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <algorithm>
#include <filesystem>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

std::string ReportEntry::entry(const std::string& key) const {
  for (const auto& [k, value] : manifest) {
    if (k == key) {
      return value;
    }
  }
  return "";
}

std::vector<std::string> ReportEntry::sweeps() const {
  std::vector<std::string> out;
  for (const auto& [key, value] : manifest) {
    if (key == "sweep") {
      out.push_back(value);
    }
  }
  return out;
}

std::string ReportEntry::quoted(const std::string& value) const {
  const fs::path path = fs::path(folder) / "values.csv";
  std::error_code error;
  if (!fs::exists(path, error)) {
    return "";
  }
  const Table table = read_csv(path.string());
  for (const auto& row : table.rows) {
    if (to_text(row[0]) == value) {
      return to_text(row[table.column("quoted")]);
    }
  }
  return "";
}

std::vector<std::string> ReportEntry::data_files() const {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder, error)) {
    const std::string extension = file.path().extension().string();
    if (extension == ".csv" || extension == ".toml") {
      names.push_back(file.path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> reproducible_names() {
  std::vector<std::string> names;
  for (const ThesisFigure& figure : thesis_figures()) {
    names.emplace_back(figure.name);
  }
  const std::vector<std::string> experiments = shipped_experiments();
  names.insert(names.end(), experiments.begin(), experiments.end());
  return names;
}

std::vector<ReportEntry> read_report_entries(const std::string& folder) {
  std::vector<ReportEntry> entries;
  std::error_code error;
  for (const auto& below : fs::directory_iterator(folder, error)) {
    if (fs::exists(below.path() / "manifest.csv", error)) {
      const std::string name = below.path().filename().string();
      const ThesisFigure* figure = find_thesis_figure(name);
      const bool of_thesis = figure != nullptr && (!figure->chapter.empty() || name == "errata");
      entries.push_back({below.path().string(), name, read_pairs(below.path() / "manifest.csv"),
                         read_pairs(below.path() / "figures.csv"), of_thesis});
    }
  }
  const std::vector<std::string> order = reproducible_names();
  const auto rank = [&order](const ReportEntry& entry) {
    return std::find(order.begin(), order.end(), entry.name) - order.begin();
  };
  std::sort(entries.begin(), entries.end(), [&](const ReportEntry& a, const ReportEntry& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.name < b.name;
  });
  return entries;
}

}  // namespace kairos::experiments
