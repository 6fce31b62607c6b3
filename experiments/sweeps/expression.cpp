#include "experiments/sweeps/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace kairos::experiments {
namespace {

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

/// Recursive descent: one function per level of precedence, lowest first.
class Parser {
 public:
  Parser(std::string_view text, const Values& values) : text_(text), values_(values) {}

  double whole() {
    const double x = sum();
    if (skip_spaces(); at_ != text_.size()) {
      fail("expected an operator");
    }
    return x;
  }

 private:
  static constexpr int max_depth = 100;  // of brackets and signs, so that no text can end the stack

  double sum() {
    double x = product();
    for (;;) {
      if (accept('+')) {
        x += product();
      } else if (accept('-')) {
        x -= product();
      } else {
        return x;
      }
    }
  }

  double product() {
    double x = signed_power();
    for (;;) {
      if (accept('*')) {
        x *= signed_power();
      } else if (accept('/')) {
        x /= signed_power();
      } else {
        return x;
      }
    }
  }

  double signed_power() {
    if (++depth_ > max_depth) {
      fail("is nested too deeply");
    }
    double x = 0.0;
    if (accept('-')) {
      x = -signed_power();
    } else {
      x = atom();
      if (accept('^')) {
        x = std::pow(x, signed_power());
      }
    }
    --depth_;
    return x;
  }

  double atom() {
    if (accept('(')) {
      const double x = sum();
      expect(')');
      return x;
    }
    skip_spaces();
    if (at_ < text_.size() && (std::isdigit(peek()) != 0 || peek() == '.')) {
      return number();
    }
    if (at_ < text_.size() && (std::isalpha(peek()) != 0 || peek() == '_')) {
      return named();
    }
    fail("expected a number, a name or '('");
  }

  double number() {
    double x = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), x);
    if (error != std::errc{}) {
      fail("is not a number in range");
    }
    at_ = static_cast<std::size_t>(end - text_.data());
    return x;
  }

  double named() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_name_character(text_[at_])) {
      ++at_;
    }
    const std::string_view name = text_.substr(begin, at_ - begin);
    if (accept('(')) {
      return call(name);
    }
    if (const auto found = values_.find(name); found != values_.end()) {
      return found->second;
    }
    if (name == "pi") {
      return std::numbers::pi;
    }
    std::vector<std::string> known;
    for (const auto& entry : values_) {
      known.push_back(entry.first);
    }
    fail(fmt::format("there is no '{}'; names here are: {}", name, fmt::join(known, ", ")));
  }

  double call(std::string_view name) {
    std::vector<double> arguments{sum()};
    while (accept(',')) {
      arguments.push_back(sum());
    }
    expect(')');
    if (name == "min") {
      return *std::min_element(arguments.begin(), arguments.end());
    }
    if (name == "max") {
      return *std::max_element(arguments.begin(), arguments.end());
    }
    if (arguments.size() != 1) {
      fail(fmt::format("'{}' takes one argument", name));
    }
    using Function = double (*)(double);
    static constexpr std::pair<std::string_view, Function> functions[] = {
        {"abs", [](double x) { return std::abs(x); }},
        {"sqrt", [](double x) { return std::sqrt(x); }},
        {"floor", [](double x) { return std::floor(x); }},
        {"ceil", [](double x) { return std::ceil(x); }},
        {"log10", [](double x) { return std::log10(x); }},
        {"sin", [](double x) { return std::sin(x); }},
        {"cos", [](double x) { return std::cos(x); }},
    };
    for (const auto& [known, function] : functions) {
      if (known == name) {
        return function(arguments.front());
      }
    }
    fail(
        fmt::format("there is no function '{}'; there are min, max, abs, sqrt, floor, ceil, log10, "
                    "sin, cos",
                    name));
  }

  [[nodiscard]] int peek() const { return static_cast<unsigned char>(text_[at_]); }
  void skip_spaces() {
    while (at_ < text_.size() && std::isspace(peek()) != 0) {
      ++at_;
    }
  }
  bool accept(char c) {
    skip_spaces();
    if (at_ < text_.size() && text_[at_] == c) {
      ++at_;
      return true;
    }
    return false;
  }
  void expect(char c) {
    if (!accept(c)) {
      fail(fmt::format("expected '{}'", c));
    }
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument(
        fmt::format("in the expression '{}' at character {}: {}", text_, at_ + 1, what));
  }

  std::string_view text_;
  const Values& values_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

double evaluate(std::string_view expression, const Values& values) {
  return Parser(expression, values).whole();
}

bool uses_name(std::string_view expression, std::string_view name) {
  for (std::size_t at = expression.find(name); at != std::string_view::npos;
       at = expression.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || !is_name_character(expression[at - 1])) &&
        (end == expression.size() || !is_name_character(expression[end]))) {
      return true;
    }
  }
  return false;
}

}  // namespace kairos::experiments
