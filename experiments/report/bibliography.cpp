#include "experiments/report/bibliography.hpp"

#include "core/error.hpp"
#include "experiments/report/report_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace kairos::experiments {
namespace {

/// LaTeX that occurs in names and titles, as text.
std::string plain(std::string text) {
  static constexpr std::array<std::pair<const char*, const char*>, 16> spellings{{{"{\\o}", "ø"},
                                                                                  {"{\\\"o}", "ö"},
                                                                                  {"{\\\"u}", "ü"},
                                                                                  {"{\\\"a}", "ä"},
                                                                                  {"{\\'e}", "é"},
                                                                                  {"{\\'a}", "á"},
                                                                                  {"{\\'c}", "ć"},
                                                                                  {"{\\`e}", "è"},
                                                                                  {"\\\"o", "ö"},
                                                                                  {"\\\"u", "ü"},
                                                                                  {"\\'e", "é"},
                                                                                  {"\\&", "&"},
                                                                                  {"---", "—"},
                                                                                  {"--", "–"},
                                                                                  {"{", ""},
                                                                                  {"}", ""}}};
  for (const auto& [latex, letter] : spellings) {
    const std::string from(latex);
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
      text.replace(at, from.size(), letter);
    }
  }
  return text;
}

/// "A and B" as "A; B". What stands in braces is one name: an institution may have an "and".
std::string listed(const std::string& authors) {
  std::string out;
  int depth = 0;
  for (std::size_t at = 0; at < authors.size();) {
    depth += authors[at] == '{' ? 1 : authors[at] == '}' ? -1 : 0;
    if (depth == 0 && authors.compare(at, 5, " and ") == 0) {
      out += "; ";
      at += 5;
    } else {
      out += authors[at++];
    }
  }
  return out;
}

class BibReader {
 public:
  BibReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  std::vector<BibliographyEntry> all() {
    std::vector<BibliographyEntry> entries;
    while ((at_ = text_.find('@', at_)) != std::string_view::npos) {
      ++at_;
      entries.push_back(entry());
    }
    return entries;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(path_, line(), "", what);
  }
  [[nodiscard]] int line() const {
    const std::size_t end = std::min(at_, text_.size());
    return 1 + static_cast<int>(std::count(text_.begin(),
                                           text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
  }
  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
      ++at_;
    }
  }
  std::string word(std::string_view ends) {
    skip_space();
    const std::size_t begin = at_;
    at_ = std::min(text_.find_first_of(ends, at_), text_.size());
    std::string out(text_.substr(begin, at_ - begin));
    out.erase(out.find_last_not_of(" \t\n") + 1);
    return out;
  }
  void expect(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) {
      fail(fmt::format("expected '{}'", c));
    }
    ++at_;
  }
  /// {…} with braces nested, or bare.
  std::string field_value() {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != '{') {
      return word(",}\n");
    }
    const std::size_t begin = ++at_;
    for (int depth = 1; at_ < text_.size(); ++at_) {
      depth += text_[at_] == '{' ? 1 : text_[at_] == '}' ? -1 : 0;
      if (depth == 0) {
        return std::string(text_.substr(begin, at_++ - begin));
      }
    }
    fail("a value is not closed");
  }
  BibliographyEntry entry() {
    BibliographyEntry entry;
    entry.line = line();
    entry.kind = word("{");
    expect('{');
    entry.key = word(",}");
    while (true) {
      skip_space();
      if (at_ < text_.size() && text_[at_] == ',') {
        ++at_;
        skip_space();
      }
      if (at_ >= text_.size()) {
        fail(fmt::format("the entry '{}' is not closed", entry.key));
      }
      if (text_[at_] == '}') {
        ++at_;
        return entry;
      }
      const std::string name = word("=}\n");
      expect('=');
      const std::string value = field_value();
      entry.fields[name] = plain(name == "author" ? listed(value) : value);
    }
  }

  std::string_view text_;
  const std::string& path_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<BibliographyEntry> read_bibliography(std::string_view text, const std::string& path) {
  return BibReader(text, path).all();
}

std::string reference_html(const BibliographyEntry& entry) {
  const auto field = [&entry](const char* name) {
    const auto found = entry.fields.find(name);
    return found == entry.fields.end() ? std::string() : html(found->second);
  };
  const std::string authors = field("author").empty() ? field("organization") : field("author");
  std::string where;
  for (const char* name : {"journal", "booktitle", "howpublished", "school", "institution"}) {
    where = where.empty() ? field(name) : where;
  }
  std::string out =
      fmt::format("{} ({}). ", authors, field("year").empty() ? "n.d." : field("year"));
  out += where.empty() ? fmt::format("<em>{}</em>.", field("title"))
                       : fmt::format("{}. <em>{}</em>", field("title"), where);
  if (!where.empty()) {
    out += field("volume").empty() ? "" : " " + field("volume");
    out += field("number").empty() ? "" : fmt::format("({})", field("number"));
    out += field("pages").empty() ? "" : ", " + field("pages");
    out += ".";
  }
  for (const char* name : {"type", "edition", "publisher", "note"}) {
    if (!field(name).empty()) {
      out += fmt::format(" {}{}.", field(name), std::string_view(name) == "edition" ? " ed" : "");
    }
  }
  if (!field("doi").empty()) {
    out += fmt::format(" <span class=\"doi\">doi:{}</span>", field("doi"));
  } else if (!field("url").empty()) {
    // As text: an address on the page would look as if something were fetched from it.
    std::string url = field("url");
    url = url.substr(url.find("//") == std::string::npos ? 0 : url.find("//") + 2);
    out += fmt::format(" <span class=\"doi\">{}</span>", url);
  }
  return out;
}

}  // namespace kairos::experiments
