#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// An entry of a BibTeX file.
struct BibliographyEntry {
  std::string kind;  ///< article, book, ...
  std::string key;
  std::map<std::string, std::string> fields;  ///< as plain text: braces and accents resolved
  int line = 0;
};

/// Reads the part of BibTeX that `paper/references.bib` uses. Throws `InputError` with the line.
[[nodiscard]] std::vector<BibliographyEntry> read_bibliography(std::string_view text,
                                                               const std::string& path);

/// One reference as a reader expects it: authors, year, title, where it appeared, DOI.
[[nodiscard]] std::string reference_html(const BibliographyEntry& entry);

}  // namespace kairos::experiments
