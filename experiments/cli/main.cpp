#include "experiments/cli/cli.hpp"

int main(int argc, char** argv) { return kairos::experiments::run_command_line(argc, argv); }
