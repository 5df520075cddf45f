#include "Child.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <exception>

#include "../Argv.h"

namespace bench::path {

namespace {

constexpr int kCannotRun = 127;

void redirect(const std::string& log) {
  const int in = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (in < 0 || out < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(out, 2) < 0) _exit(kCannotRun);
}

[[noreturn]] void becomeCommand(const NetworkNamespace& network, const std::vector<std::string>& command,
                                const std::string& log) {
  try {
    network.enter();
  } catch (const std::exception&) {
    _exit(kCannotRun);
  }
  setsid();
  if (!log.empty()) redirect(log);
  std::vector<char*> argv = argvOf(command);
  execvp(argv[0], argv.data());
  std::fprintf(stderr, "naiad_link: %s cannot be run\n", argv[0]);
  _exit(kCannotRun);
}

}  // namespace

pid_t startIn(const NetworkNamespace& network, const std::vector<std::string>& command,
              const std::string& log) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("a process cannot be forked");
  if (child == 0) becomeCommand(network, command, log);
  return child;
}

}  // namespace bench::path
