#include "tests/experiments/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>

namespace kairos::tests {
namespace {

void connect(int stream, const std::string& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags, 0600);
  if (descriptor < 0 || ::dup2(descriptor, stream) < 0) {
    ::_exit(126);
  }
  ::close(descriptor);
}

[[noreturn]] void become(const std::vector<std::string>& arguments,
                         const Surroundings& surroundings, const std::string& in,
                         const std::string& out, const std::string& err) {
  connect(STDIN_FILENO, in, O_RDONLY);
  connect(STDOUT_FILENO, out, O_WRONLY | O_CREAT | O_TRUNC);
  connect(STDERR_FILENO, err, O_WRONLY | O_CREAT | O_TRUNC);
  if (surroundings.largest_file > 0) {
    const ::rlimit limit{surroundings.largest_file, surroundings.largest_file};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (surroundings.memory > 0) {
    const ::rlimit limit{surroundings.memory, surroundings.memory};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  const ::rlimit seconds{surroundings.processor_seconds, surroundings.processor_seconds};
  ::setrlimit(RLIMIT_CPU, &seconds);
  std::vector<char*> argv{const_cast<char*>(KAIROS_PROGRAM)};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  ::execv(KAIROS_PROGRAM, argv.data());
  ::_exit(127);
}

}  // namespace

int in_a_shell(const std::string& command) {
  const std::string rest = command.substr(std::string_view("kairos").size());
  const std::string line = "'" KAIROS_PROGRAM "'" + rest + " > /dev/null 2>&1";
  const int status = std::system(line.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Outcome kairos_program(const std::vector<std::string>& arguments,
                       const Surroundings& surroundings) {
  const TemporaryFolder folder;
  const std::string in = folder.file("in", surroundings.input);
  const std::string out = surroundings.output.empty() ? folder.path("out") : surroundings.output;
  const std::string err = surroundings.error.empty() ? folder.path("err") : surroundings.error;
  const ::pid_t child = ::fork();
  if (child == 0) {
    become(arguments, surroundings, in, out, err);
  }
  if (child > 0 && surroundings.kill_after > 0.0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(surroundings.kill_after));
    ::kill(child, SIGKILL);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) {
    throw std::system_error(errno, std::generic_category(), "running kairos");
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
          surroundings.output.empty() ? read_all(out) : "",
          surroundings.error.empty() ? read_all(err) : ""};
}

}  // namespace kairos::tests
