#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// What `{{kind:what}}` and `[@Key]` (kind "cite") stand for, as HTML.
using Substitution = std::function<std::string(std::string_view kind, std::string_view what)>;

struct MarkdownHeading {
  int level = 1;
  std::string text;
  std::string id;  ///< of the element: the prefix and the words of the text
};

struct MarkdownPage {
  std::string html;
  std::vector<MarkdownHeading> headings;
};

/// The Markdown that the paper uses, and no more: headings (# to ###; the first is left to the
/// caller), paragraphs, lists of one level (-, 1.), blocks of code (```), inline marks as below. A
/// paragraph that is one substitution becomes what it stands for, without a paragraph around it.
[[nodiscard]] MarkdownPage markdown_html(std::string_view text, const std::string& id_prefix,
                                         const Substitution& substitution);

/// One line of it: `code`, **strong**, *emphasis*, and with a substitution {{kind:what}}, [@Key]
/// and [text](#place); everything else escaped.
[[nodiscard]] std::string inline_html(std::string_view text, const Substitution& substitution = {});

}  // namespace kairos::experiments
