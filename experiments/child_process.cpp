#include "experiments/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

namespace kairos::experiments {

namespace {

/// Our environment, with another HOME.
std::vector<std::string> environment_of(const ChildPlace& place) {
  std::vector<std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (place.home.empty() || !std::string_view(*entry).starts_with("HOME=")) {
      variables.emplace_back(*entry);
    }
  }
  if (!place.home.empty()) {
    variables.push_back("HOME=" + place.home);
  }
  return variables;
}

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (const std::string& text : texts) {
    result.push_back(const_cast<char*>(text.c_str()));  // posix_spawn does not write to it
  }
  result.push_back(nullptr);
  return result;
}

}  // namespace

int run_child(const std::vector<std::string>& command, ChildOutput output,
              const ChildPlace& place) {
  const std::vector<char*> arguments = pointers(command);
  const std::vector<std::string> variables = environment_of(place);
  const std::vector<char*> environment = pointers(variables);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (output == ChildOutput::hidden) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  } else {
    // Results go to stdout, messages to stderr: what a child says is a message.
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  }
  if (!place.folder.empty()) {
    posix_spawn_file_actions_addchdir_np(&actions, place.folder.c_str());
  }
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(),
                                 environment.data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return -1;
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      return -1;
    }
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace kairos::experiments
