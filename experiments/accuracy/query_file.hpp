#pragma once

#include "experiments/accuracy/query.hpp"

#include <cstddef>
#include <string>

namespace kairos::experiments {

/// The header of a file of queries, as `kairos toi` reads it.
[[nodiscard]] std::string query_file_header();
/// A query as a row of it. Motions are ballistic.
[[nodiscard]] std::string query_file_row(std::size_t id, const reference::Query& query);

}  // namespace kairos::experiments
