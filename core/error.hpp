#pragma once

#include <stdexcept>
#include <string>

namespace kairos {
inline namespace core {

/// What a person wrote is wrong: the one exception that building a `Scene`, a `Model` or a method
/// throws. `what()` reads `file:line: key: what is wrong and what is allowed`.
class InputError : public std::runtime_error {
 public:
  /// `line` 0 means the whole file; an empty `file` or `key` is left out of the message.
  InputError(std::string file, int line, std::string key, std::string reason);

  /// Where it was written; empty: in no file.
  [[nodiscard]] const std::string& file() const { return file_; }
  /// The line of the file, from 1; 0: the whole file.
  [[nodiscard]] int line() const { return line_; }
  /// What is wrong: a key, an option; may be empty.
  [[nodiscard]] const std::string& key() const { return key_; }
  /// What is wrong with it, and what is allowed.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string file_;
  int line_;
  std::string key_;
  std::string reason_;
};

}  // namespace core
}  // namespace kairos
