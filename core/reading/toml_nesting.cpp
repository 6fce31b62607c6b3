#include "core/reading/toml_nesting.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace kairos {
inline namespace core {
namespace {

constexpr int most_parts = 32;     // of a key
constexpr int most_brackets = 32;  // open at once

/// Walks through a text and counts, without understanding more than strings and comments.
class Scanner {
 public:
  Scanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (c == '"' || c == '\'') {
        skip_string(c);
      } else {
        count(c);
        ++at_;
      }
    }
  }

 private:
  void count(char c) {
    const bool of_a_key = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '_' || c == '-' || c == ' ' || c == '\t';
    if (c == '.') {
      limit(++dots_ < most_parts, "a key of more", most_parts, "parts");
    } else if (!of_a_key) {
      dots_ = 0;
    }
    if (c == '[' || c == '{') {
      limit(++open_ <= most_brackets, "more", most_brackets, "arrays and tables in each other");
    } else if (c == ']' || c == '}') {
      open_ = std::max(0, open_ - 1);
    } else if (c == '\n') {
      ++line_;
    }
  }

  void limit(bool within, std::string_view what, int most, std::string_view of) const {
    if (!within) {
      throw InputError(file_, line_, "",
                       fmt::format("is nested too deeply: {} than {} {}", what, most, of));
    }
  }

  /// To behind its end; a string of one line that does not end, ends with the line.
  void skip_string(char quote) {
    const std::string_view three = quote == '"' ? R"(""")" : "'''";
    const bool long_one = text_.substr(at_).starts_with(three);
    at_ += long_one ? 3 : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (long_one ? text_.substr(at_).starts_with(three) : c == quote) {
        at_ += long_one ? 3 : 1;
        return;
      }
      if (c == '\n') {
        if (!long_one) {
          return;
        }
        ++line_;
      }
      at_ += c == '\\' && quote == '"' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n' ? 2 : 1;
    }
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
  int dots_ = 0;  ///< of the key that may be here
  int open_ = 0;  ///< brackets
};

}  // namespace

void refuse_deep_nesting(std::string_view text, const std::string& file) {
  Scanner(text, file).run();
}

}  // namespace core
}  // namespace kairos
