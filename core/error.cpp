#include "core/error.hpp"

#include <utility>

namespace kairos {
inline namespace core {
namespace {

std::string compose(const std::string& file, int line, const std::string& key,
                    const std::string& reason) {
  std::string message = file;
  if (line > 0) {
    message += (message.empty() ? "line " : ":") + std::to_string(line);
  }
  if (!key.empty()) {
    message += (message.empty() ? "" : ": ") + key;
  }
  return message + (message.empty() ? "" : ": ") + reason;
}

}  // namespace

InputError::InputError(std::string file, int line, std::string key, std::string reason)
    : std::runtime_error(compose(file, line, key, reason)),
      file_(std::move(file)),
      line_(line),
      key_(std::move(key)),
      reason_(std::move(reason)) {}

}  // namespace core
}  // namespace kairos
