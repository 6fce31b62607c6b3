#include "experiments/report/markdown.hpp"

#include "experiments/report/report_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace kairos::experiments {
namespace {

/// The text between `open` at `at` and the next `close`; moves `at` past it. Empty if it is not
/// closed: then nothing is moved.
std::string_view enclosed(std::string_view text, std::size_t& at, std::string_view open,
                          std::string_view close) {
  if (text.substr(at, open.size()) != open) {
    return {};
  }
  const std::size_t begin = at + open.size();
  const std::size_t end = text.find(close, begin);
  if (end == std::string_view::npos || end == begin) {
    return {};
  }
  at = end + close.size();
  return text.substr(begin, end - begin);
}

std::string resolved(std::string_view inside, const Substitution& substitution) {
  const std::size_t colon = inside.find(':');
  return substitution(inside.substr(0, colon),
                      colon == std::string_view::npos ? "" : inside.substr(colon + 1));
}

std::string citations(std::string_view keys, const Substitution& substitution) {
  std::string out = "[";
  for (std::size_t at = 0; at < keys.size();) {
    const std::size_t end = std::min(keys.find(';', at), keys.size());
    std::string_view key = keys.substr(at, end - at);
    key.remove_prefix(std::min(key.find_first_not_of(" @"), key.size()));
    out += (at == 0 ? "" : ", ") + substitution("cite", key);
    at = end + 1;
  }
  return out + "]";
}

/// [text](#place) of the same page; empty, and nothing moved, where there is none.
std::string local_link(std::string_view text, std::size_t& at) {
  std::size_t end = at;
  const std::string_view words = enclosed(text, end, "[", "]");
  const std::string_view place = words.empty() ? words : enclosed(text, end, "(#", ")");
  if (place.empty()) {
    return "";
  }
  at = end;
  return fmt::format("<a href=\"#{}\">{}</a>", html(place), html(words));
}

/// Words of a heading as an identifier.
std::string slug(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!out.empty() && out.back() != '-') {
      out += '-';
    }
  }
  return out;
}

std::string_view next_line(std::string_view text, std::size_t& at) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  const std::string_view line = text.substr(at, end - at);
  at = end + 1;
  return line;
}

/// Where the text of a list item begins; 0: the line is none.
std::size_t item_text(std::string_view line) {
  if (line.starts_with("- ")) {
    return 2;
  }
  const std::size_t dot = line.find(". ");
  const bool numbered = dot != std::string_view::npos && dot > 0 && dot < 3 &&
                        std::all_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(dot),
                                    [](unsigned char c) { return std::isdigit(c) != 0; });
  return numbered ? dot + 2 : 0;
}

/// Collects lines into blocks and writes each when it is complete.
class BlockWriter {
 public:
  BlockWriter(std::string prefix, const Substitution& substitution)
      : prefix_(std::move(prefix)), substitution_(substitution) {}

  void line(std::string_view line) {
    if (line.starts_with("```")) {
      flush();
      page_.html += in_code_ ? "</code></pre>\n" : "<pre><code>";
      in_code_ = !in_code_;
    } else if (in_code_) {
      page_.html += html(line) + "\n";
    } else if (line.empty()) {
      flush();
      close_list();
    } else if (line.starts_with("#")) {
      flush();
      close_list();
      heading(line);
    } else if (const std::size_t begin = item_text(line); begin > 0) {
      flush();
      open_list(line.starts_with("-") ? "ul" : "ol");
      block_ = line.substr(begin);
    } else {
      block_ += (block_.empty() ? "" : " ");
      block_ += line.substr(std::min(line.find_first_not_of(' '), line.size()));
    }
  }

  MarkdownPage finish() && {
    flush();
    close_list();
    return std::move(page_);
  }

 private:
  void heading(std::string_view line) {
    const std::size_t level = line.find_first_not_of('#');
    const std::string text(line.substr(std::min(level + 1, line.size())));
    page_.headings.push_back({static_cast<int>(level), text, prefix_ + slug(text)});
    if (level > 1) {
      page_.html += fmt::format("<h{0} id=\"{1}\">{2}</h{0}>\n", level + 1,
                                page_.headings.back().id, inline_html(text, substitution_));
    }
  }

  void open_list(const char* kind) {
    if (list_ != kind) {
      close_list();
      list_ = kind;
      page_.html += fmt::format("<{}>\n", kind);
    }
  }

  void close_list() {
    if (!list_.empty()) {
      page_.html += fmt::format("</{}>\n", list_);
      list_.clear();
    }
  }

  void flush() {
    if (block_.empty()) {
      return;
    }
    std::size_t at = 0;
    const std::string_view inside = enclosed(block_, at, "{{", "}}");
    if (!inside.empty() && at == block_.size() && list_.empty()) {
      page_.html += resolved(inside, substitution_);
    } else {
      const char* tag = list_.empty() ? "p" : "li";
      page_.html += fmt::format("<{0}>{1}</{0}>\n", tag, inline_html(block_, substitution_));
    }
    block_.clear();
  }

  std::string prefix_;
  const Substitution& substitution_;
  MarkdownPage page_;
  std::string block_;  ///< lines so far of a paragraph or an item
  std::string list_;   ///< the kind that is open; empty: none
  bool in_code_ = false;
};

}  // namespace

std::string inline_html(std::string_view text, const Substitution& substitution) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    if (const auto code = enclosed(text, at, "`", "`"); !code.empty()) {
      out += fmt::format("<code>{}</code>", html(code));
    } else if (const auto strong = enclosed(text, at, "**", "**"); !strong.empty()) {
      out += fmt::format("<strong>{}</strong>", inline_html(strong, substitution));
    } else if (const auto soft = enclosed(text, at, "*", "*"); !soft.empty()) {
      out += fmt::format("<em>{}</em>", inline_html(soft, substitution));
    } else if (!substitution) {
      out += html(text.substr(at++, 1));
    } else if (const auto inside = enclosed(text, at, "{{", "}}"); !inside.empty()) {
      out += resolved(inside, substitution);
    } else if (const auto keys = enclosed(text, at, "[@", "]"); !keys.empty()) {
      out += citations(keys, substitution);
    } else if (const std::string link = local_link(text, at); !link.empty()) {
      out += link;
    } else {
      out += html(text.substr(at++, 1));
    }
  }
  return out;
}

MarkdownPage markdown_html(std::string_view text, const std::string& id_prefix,
                           const Substitution& substitution) {
  BlockWriter writer(id_prefix, substitution);
  for (std::size_t at = 0; at < text.size();) {
    writer.line(next_line(text, at));
  }
  return std::move(writer).finish();
}

}  // namespace kairos::experiments
