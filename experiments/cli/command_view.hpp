#pragma once

namespace CLI {
class App;
}

namespace kairos::experiments {

/// `kairos view`: a run as a page; see `commands.hpp`.
void add_view_command(CLI::App& app);

}  // namespace kairos::experiments
