#pragma once

namespace kairos::experiments {

/// The program `kairos`: parses, runs one subcommand, and turns exceptions into messages on stderr
/// and exit codes: 0 done, 1 a run failed, 2 the input is wrong.
int run_command_line(int argc, const char* const* argv);

}  // namespace kairos::experiments
