#pragma once

#include "core/reading/document.hpp"
#include "core/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// A value of a scene file replaced before it is read: `body.ball.radius` and a TOML value.
struct Override {
  std::string key;
  std::string value;
};

/// Reads a scene file; paths inside it are relative to it. Throws `InputError`.
[[nodiscard]] Scene read_scene(const std::string& path,
                               const std::vector<Override>& overrides = {});
/// The same from text; `path` is used in messages and to find tracks.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& path,
                                const std::vector<Override>& overrides = {});

/// The same from a document: a file that was parsed, or a scene written in code. Paths inside it
/// are relative to the folder of `path`.
[[nodiscard]] Scene read_scene_document(Value root, const std::string& path,
                                        const std::vector<Override>& overrides = {});

}  // namespace core
}  // namespace kairos
