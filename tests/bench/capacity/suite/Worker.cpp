#include "Worker.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

#include "../../path/Argv.h"
#include "../Core.h"

extern char** environ;

namespace bench::capacity {

Worker::Worker(const std::vector<std::string>& command) {
  std::array<int, 2> in{};
  std::array<int, 2> out{};
  if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("a pipe cannot be made");
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  std::vector<char*> argv = path::argvOf(command);
  const int error = posix_spawnp(&m_pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(in[0]);
  close(out[1]);
  m_in = in[1];
  m_out = out[0];
  if (error != 0) throw std::runtime_error(command[0] + " cannot be run");
  clock_getcpuclockid(m_pid, &m_clock);
}

Worker::~Worker() {
  close(m_in);
  close(m_out);
  for (int i = 0; i < 300; ++i) {
    if (waitpid(m_pid, nullptr, WNOHANG) != 0) return;
    usleep(10'000);
  }
  kill(m_pid, SIGKILL);
  waitpid(m_pid, nullptr, 0);
}

void Worker::tell(const std::string& line) {
  const std::string text = line + "\n";
  if (write(m_in, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw std::runtime_error("a program of the measurement has ended");
  }
}

std::string Worker::hear(std::chrono::seconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;;) {
    const std::size_t newline = m_heard.find('\n');
    if (newline != std::string::npos) {
      std::string line = m_heard.substr(0, newline);
      m_heard.erase(0, newline + 1);
      return line;
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd wait{m_out, POLLIN, 0};
    if (left.count() <= 0 || poll(&wait, 1, static_cast<int>(left.count())) <= 0) {
      throw std::runtime_error("a program of the measurement says nothing");
    }
    std::array<char, 65536> bytes;
    const ssize_t size = read(m_out, bytes.data(), bytes.size());
    if (size <= 0) throw std::runtime_error("a program of the measurement has ended");
    m_heard.append(bytes.data(), static_cast<std::size_t>(size));
  }
}

std::string Worker::ask(const std::string& line, const std::string& word, std::chrono::seconds patience) {
  tell(line);
  for (;;) {
    std::string heard = hear(patience);
    if (heard.starts_with(word)) return heard;
    if (heard == "failed") throw std::runtime_error("a program of the measurement failed");
  }
}

double Worker::cpu() const {
  return cpuMicros(m_clock);
}

}  // namespace bench::capacity
