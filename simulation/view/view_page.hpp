#pragma once

#include "simulation/view/view_run.hpp"

#include <span>
#include <string>
#include <string_view>

namespace kairos {
inline namespace simulation {

/// The page that shows runs beside each other (one or two), as one HTML file without references to
/// anything outside: the template with the data in it. Numbers go in as base64, names and other
/// text of a scene as JSON in which `<` is escaped, so that nothing of it is read as HTML. The
/// format of the data is described in studio/README.md. Throws `std::invalid_argument` where the
/// template has no place for it.
[[nodiscard]] std::string view_page(std::string_view page_template, std::span<const ViewRun> runs);

}  // namespace simulation
}  // namespace kairos
