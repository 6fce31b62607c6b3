#pragma once

#include "core/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// The same decision for many bodies is told once.
class Tally {
 public:
  void add(std::string_view what, const std::string& name, const std::string& reason) {
    const auto same = [&](const Entry& e) { return e.what == what && e.reason == reason; };
    auto found = std::find_if(entries_.begin(), entries_.end(), same);
    if (found == entries_.end()) {
      found = entries_.insert(entries_.end(), {std::string(what), reason, "", 0});
    }
    if (found->count < most_names) {
      found->names += fmt::format("{}\"{}\"", found->count > 0 ? ", " : "", name);
    }
    ++found->count;
  }
  [[nodiscard]] std::vector<Decision> decisions(const std::string& topic) const {
    std::vector<Decision> result;
    for (const Entry& e : entries_) {
      const std::string others =
          e.count > most_names ? fmt::format(" and {} more", e.count - most_names) : "";
      result.push_back({topic, fmt::format("{}: {}{}", e.what, e.names, others), e.reason});
    }
    return result;
  }

 private:
  static constexpr std::size_t most_names = 4;
  struct Entry {
    std::string what;
    std::string reason;
    std::string names;
    std::size_t count = 0;
  };
  std::vector<Entry> entries_;
};

}  // namespace core
}  // namespace kairos
