#pragma once

#include "core/reading/document.hpp"

#include <string>
#include <string_view>

namespace kairos {
inline namespace core {

/// Whether a file is a scene in the thesis' own format, by its ending `.def`.
[[nodiscard]] bool is_def_file(std::string_view path);

/// Reads a scene as the thesis wrote it (9.2.2): a line per attribute, `Object1-Pos:12.0 -25.0
/// 20.0`, objects numbered from 1 in the order of creation. Of the format five keys survive (Name,
/// Pos, Normal, Type, COLLType); the others, and `World-`, are ours (scenes/README.md).
///
/// The answer is the tree that a scene in TOML would give, every value with its line of the .def
/// file, so that all checks and overrides are the same: gravity is the thesis' force, and all
/// collide as the boxes fitted to their .off models (3.3, 3.5.2). Throws `InputError`.
[[nodiscard]] Value parse_def(std::string_view text, const std::string& path);

}  // namespace core
}  // namespace kairos
