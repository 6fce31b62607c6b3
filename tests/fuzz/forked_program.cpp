// The program of the command line, started once and forked for each request: a program built with
// sanitizers takes longer to start than most mutated cases take to run. See mutate_program.py.
//
// A request on stdin is fields that end with a zero byte: how many follow, seconds of processor
// time, seconds of waiting, bytes of new memory (0: any), the folder to run in, the files for
// stdout and stderr, then the words of the command line without the program's name. The answer on
// stdout is a line: "exit CODE" or "signal NUMBER", with the seconds of processor time that it
// took.
#include "experiments/cli/cli.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

struct Request {
  rlim_t processor_seconds;
  unsigned waiting_seconds;
  rlim_t memory;
  bool ends_whole;
  std::string folder, out, err;
  std::vector<std::string> words;
};

bool read_request(Request& request) {
  std::string field;
  if (!std::getline(std::cin, field, '\0')) {
    return false;
  }
  std::vector<std::string> fields(std::stoul(field));
  for (std::string& each : fields) {
    std::getline(std::cin, each, '\0');
  }
  request = {.processor_seconds = std::stoul(fields.at(0)),
             .waiting_seconds = static_cast<unsigned>(std::stoul(fields.at(1))),
             .memory = std::stoul(fields.at(2)),
             .ends_whole = fields.at(3) == "1",
             .folder = fields.at(4),
             .out = fields.at(5),
             .err = fields.at(6),
             .words = {fields.begin() + 7, fields.end()}};
  return true;
}

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "forked_program: %s: %s\n", what, std::strerror(errno));
  std::_Exit(125);
}

void open_as(int descriptor, const std::string& path, int flags) {
  const int opened = open(path.c_str(), flags, 0600);
  if (opened < 0 || dup2(opened, descriptor) < 0) {
    fail(path.c_str());
  }
  close(opened);
}

void limit(int resource, rlim_t soft, rlim_t hard) {
  const rlimit bounds{soft, hard};
  if (setrlimit(resource, &bounds) != 0) {
    fail("setrlimit");
  }
}

/// Writable memory that this process has mapped. The shadow of a sanitizer is in it, so that a
/// limit is told beyond what is there.
rlim_t mapped_data() {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  for (int column = 0; column < 6; ++column) {
    statm >> pages;
  }
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

int run_program(const std::vector<std::string>& arguments) {
  std::vector<const char*> words{"kairos"};
  for (const std::string& argument : arguments) {
    words.push_back(argument.c_str());
  }
  words.push_back(nullptr);
  return kairos::experiments::run_command_line(static_cast<int>(words.size()) - 1, words.data());
}

[[noreturn]] void run(const Request& request) {
  setpgid(0, 0);  // with whatever it starts, so that nothing of it is left behind
  open_as(STDIN_FILENO, "/dev/null", O_RDONLY);
  open_as(STDERR_FILENO, request.err, O_WRONLY | O_CREAT | O_TRUNC | O_NOCTTY);
  open_as(STDOUT_FILENO, request.out, O_WRONLY | O_CREAT | O_TRUNC | O_NOCTTY);
  if (chdir(request.folder.c_str()) != 0) {
    fail(request.folder.c_str());
  }
  limit(RLIMIT_CORE, 0, 0);
  if (request.memory > 0) {
    const rlim_t bytes = mapped_data() + request.memory;
    limit(RLIMIT_DATA, bytes, bytes);
  }
  limit(RLIMIT_CPU, request.processor_seconds, request.processor_seconds + 2);
  alarm(request.waiting_seconds);
  const int code = run_program(request.words);
  if (request.ends_whole) {
    std::exit(code);
  }
  std::cout.flush();
  std::fflush(nullptr);
  std::_Exit(code);
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Has the program say what it says to a wrong word, and throws that away: what is set up when it
/// is first needed, and the memory that this takes, is there in every child then.
void warm_up() {
  const int out = dup(STDOUT_FILENO);
  const int err = dup(STDERR_FILENO);
  open_as(STDOUT_FILENO, "/dev/null", O_WRONLY);
  open_as(STDERR_FILENO, "/dev/null", O_WRONLY);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"explain", "bounce"}, {"explain", "no scene"}, {"list"}}) {
    run_program(words);
  }
  std::cout.flush();
  std::fflush(nullptr);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  close(out);
  close(err);
}

}  // namespace

int main() {
  warm_up();
  Request request;
  while (read_request(request)) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) {
      fail("fork");
    }
    if (child == 0) {
      run(request);
    }
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0) {
      if (errno != EINTR) {
        fail("wait");
      }
    }
    kill(-child, SIGKILL);
    std::printf("%s %d %.6f\n", WIFEXITED(status) ? "exit" : "signal",
                WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status),
                seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime));
    std::fflush(stdout);
  }
  return 0;
}
