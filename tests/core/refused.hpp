#pragma once

#include "core/error.hpp"
#include "tests/catch.hpp"

#include <string>

namespace kairos::tests {

/// A scene that is refused: where, and a part of the reason.
struct BadScene {
  std::string text;
  int line;
  std::string key;
  std::string part;
};

/// `read` is called with the text and the name of its file.
template <typename Read>
void check_refused(const BadScene& bad, const Read& read) {
  INFO(bad.text);
  try {
    read(bad.text, "bad.toml");
  } catch (const InputError& error) {
    INFO(error.what());
    CHECK(error.file() == "bad.toml");
    CHECK(error.line() == bad.line);
    CHECK(error.key() == bad.key);
    CHECK(error.reason().find(bad.part) != std::string::npos);
    return;
  }
  FAIL("was not refused");
}

}  // namespace kairos::tests
