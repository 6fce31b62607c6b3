#include "experiments/cli/cli.hpp"

#include "core/error.hpp"
#include "core/nearest_name.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/run_error.hpp"
#include "simulation/version.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace kairos::experiments {
namespace {

enum ExitCode { done = 0, run_failed = 1, input_wrong = 2 };

/// A message may quote what a person wrote: control characters in it become harmless.
std::string printable(std::string_view message) {
  std::string text;
  for (const char c : message) {
    const auto code = static_cast<unsigned char>(c);
    if ((code < 0x20 && c != '\n' && c != '\t') || code == 0x7f) {
      constexpr std::string_view digits = "0123456789abcdef";
      text += std::string("\\x") + digits[code >> 4U] + digits[code & 15U];
    } else {
      text += c;
    }
  }
  return text;
}

int fail(ExitCode code, const char* message) {
  std::cout.flush();
  std::cerr << printable(message) << '\n';
  return code;
}

/// Flushes the output: a full disk shows here at the latest.
int flush_results() {
  errno = 0;
  std::cout.flush();
  const bool written = std::cout.good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  return written ? done
                 : fail(run_failed,
                        errno == 0 ? "standard output: cannot be written" : std::strerror(errno));
}

void add_commands(CLI::App& app) {
  Command program(app);
  add_run_command(program);
  add_explain_command(program);
  add_list_command(program);
  add_toi_command(program);
  add_vfee_command(program);
  add_mesh_command(program);
  add_collide_command(program);
  add_distance_command(program);
  add_deform_command(program);
  add_sweep_command(program);
  add_experiment_command(program);
  add_reproduce_command(program);
  add_render_command(program);
  add_view_command(program);
  add_plot_command(program);
  add_record_command(program);
  add_physworld_command(program);
  add_bench_command(program);
  add_tradeoff_command(program);
  add_recommend_command(program);
  add_random_scenes_command(program);
}

/// CLI11 only says that a command is missing where a person has mistyped one.
void refuse_unknown_command(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  if (words.empty() || !app.get_subcommands().empty()) {
    return;
  }
  std::vector<std::string_view> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.emplace_back(command->get_name());
  }
  throw InputError("", 0, words.front(),
                   "is neither a command nor an option; " + suggestion(words.front(), names));
}

/// What was not expected, in the order in which it was written, and what may have been meant:
/// CLI11 tells it from behind.
void refuse_extras(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
  }
  const std::vector<std::string> left = app.remaining(true);
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (std::find(left.begin(), left.end(), word) != left.end()) {
      words.push_back(word);
    }
  }
  std::vector<std::string> options;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) {
      options.push_back("--" + name);
    }
  }
  const std::vector<std::string_view> names(options.begin(), options.end());
  std::string text = "is not expected here";
  if (words.size() > 1) {
    text += ", nor are the words after it: ";
    for (std::size_t k = 1; k < words.size(); ++k) {
      text += (k > 1 ? " " : "") + words[k];
    }
  }
  const std::string first = words.empty() ? "" : words.front().substr(0, words.front().find('='));
  throw InputError("", 0, words.empty() ? command->get_name() : words.front(),
                   text + "; " +
                       (first.starts_with("-") ? suggestion(first, names)
                                               : "allowed: kairos " + command->get_name() +
                                                     " --help shows what it takes"));
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app{"What happens between two frames, and what does it cost to know?", "kairos"};
  app.set_version_flag("--version", "kairos " + std::string(version()));
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 1 a run failed, 2 the input is wrong.");
  add_commands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    refuse_unknown_command(app);
    return app.exit(error), input_wrong;
  } catch (const CLI::ExtrasError&) {
    refuse_extras(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? flush_results() : input_wrong;
  }
  return flush_results();
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  // A file beyond its limit is a failed write with a message, not the death of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return parse_and_run(argc, argv);
  } catch (const InputError& error) {
    return fail(input_wrong, error.what());
  } catch (const RunError& error) {
    return fail(run_failed, error.what());
  } catch (const std::system_error& error) {
    // What a formatted print throws if the disk is full.
    const bool print = std::string_view(error.what()).starts_with("cannot write to file");
    const std::string why = "standard output: cannot be written: " + error.code().message();
    return fail(run_failed, print ? why.c_str() : error.what());
  } catch (const std::bad_alloc&) {
    return fail(run_failed, "out of memory");
  } catch (const std::exception& error) {
    return fail(run_failed, error.what());
  }
}

}  // namespace kairos::experiments
