#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `original`: the thesis' own stepping, literally (fig. 7): draw, detect and handle, move, once
/// per rendered frame. All its defects are its own.
[[nodiscard]] std::unique_ptr<Scheme> make_original();

}  // namespace core
}  // namespace kairos
