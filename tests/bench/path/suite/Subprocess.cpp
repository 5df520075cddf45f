#include "Subprocess.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <sstream>
#include <stdexcept>

#include "../Argv.h"

extern char** environ;

namespace bench::path {

Finished runProgram(const std::vector<std::string>& command) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("a pipe cannot be made");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  std::vector<char*> argv = argvOf(command);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  Finished finished;
  std::array<char, 4096> bytes{};
  for (ssize_t size = 1; error == 0 && size > 0;) {
    size = read(ends[0], bytes.data(), bytes.size());
    if (size > 0) finished.output.append(bytes.data(), static_cast<std::size_t>(size));
  }
  close(ends[0]);
  if (error != 0) throw std::runtime_error(command[0] + " cannot be run");
  int status = 0;
  waitpid(pid, &status, 0);
  finished.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return finished;
}

std::map<std::string, double> figuresOf(const std::string& line) {
  std::map<std::string, double> figures;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) figures[word.substr(0, equals)] = std::stod(word.substr(equals + 1));
  }
  return figures;
}

}  // namespace bench::path
