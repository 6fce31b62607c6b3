#include "core/reading/scene_name.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kairos {
inline namespace core {
namespace {

constexpr std::size_t longest_name = 64;

bool is_name(const std::string& text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == ' ';
  };
  return !text.empty() && text.size() <= longest_name && text.front() != ' ' &&
         text.back() != ' ' && std::all_of(text.begin(), text.end(), allowed);
}

/// The text as a message can show it: a zero byte would end the message.
std::string shown(std::string text) {
  std::replace(text.begin(), text.end(), '\0', '?');
  return text;
}

}  // namespace

const std::string& read_name(const Item& item) {
  if (!is_name(item.text())) {
    item.fail(
        fmt::format("\"{}\" is no name; allowed: 1 to {} letters (a-z, A-Z), digits, _, - "
                    "and inner spaces",
                    shown(item.text()), longest_name));
  }
  return item.text();
}

std::string element_path(std::string_view array, const Value& element, std::size_t index) {
  const Table* table = element.table();
  const Value* name = table == nullptr ? nullptr : table->find("name");
  const auto* text = name == nullptr ? nullptr : std::get_if<std::string>(&name->data);
  return text != nullptr && is_name(*text) ? fmt::format("{}.{}", array, *text)
                                           : fmt::format("{}[{}]", array, index);
}

void UniqueNames::add(const Item& item, std::string_view what, int line) {
  const auto [first, is_new] = lines_.emplace(item.text(), line);
  if (!is_new) {
    item.fail(
        fmt::format("\"{}\" is the name of the {} of line {} already; allowed: a name of its "
                    "own",
                    item.text(), what, first->second));
  }
}

}  // namespace core
}  // namespace kairos
