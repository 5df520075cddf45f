#include "GameProgram.h"

#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <system_error>
#include <thread>

#include "TestClient.h"

namespace naiad::test {

GameProgram::GameProgram(const std::string& name, std::map<std::string, std::string> environment,
                         const std::vector<std::string>& arguments, int errors) {
  std::filesystem::create_directory(playFolder());
  environment.insert({{"NAIAD_ADDRESS", "127.0.0.1"},
                      {"NAIAD_PORT", "0"},
                      {"NAIAD_PORT_FILE", m_directory / "port"},
                      {"NAIAD_IDENTITY", m_directory / "identity"},
                      {"NAIAD_LOG_FILE", m_directory / "log"},
                      {"NAIAD_CONTROL", m_directory / "control.sock"},
                      {"NAIAD_STATE", m_directory / "state"},
                      {"NAIAD_JOURNAL", "off"},
                      {"NAIAD_LOCAL_CLIENT", "false"},
                      {"NAIAD_FRAME_TIME", "5000"},
                      {"DRAGONFLY_CONFIG", m_directory / "df-config.txt"}});
  std::ofstream(m_directory / "df-config.txt") << "logfile:" << (m_directory / "game.log").string() << ",\n";
  for (const char* kept :
       {"PATH", "HOME", "LD_LIBRARY_PATH", "ASAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"}) {
    if (const char* p_value = std::getenv(kept)) environment.emplace(kept, p_value);
  }
  std::vector<std::string> entries;
  for (const auto& [key, value] : environment) entries.push_back(key + "=" + value);
  std::vector<std::string> words{std::string(NAIAD_BINARY_DIR) + "/" + name};
  words.insert(words.end(), arguments.begin(), arguments.end());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const std::string output = m_directory / "output";
  posix_spawn_file_actions_addchdir_np(&actions, playFolder().c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                   0600);
  posix_spawn_file_actions_adddup2(&actions, errors >= 0 ? errors : STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Reset SIGHUP, because children of a parent that ignores it, such as nohup, also ignore it.
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGHUP);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGDEF);
  const int error = posix_spawn(&m_process, words.front().c_str(), &actions, &attributes,
                                pointersTo(words).data(), pointersTo(entries).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::system_error(error, std::generic_category(), words.front());
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (m_port == 0 && !hasEnded() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // pause before the file is read again
    std::ifstream(m_directory / "port") >> m_port;
  }
}

GameProgram::~GameProgram() {
  if (!hasEnded()) {
    signal(SIGTERM);
    wait();
  }
}

bool GameProgram::hasEnded() {
  if (m_process > 0 && waitpid(m_process, &m_status, WNOHANG) == m_process) m_process = -1;
  return m_process < 0;
}

int GameProgram::wait() {
  if (m_process > 0) waitpid(m_process, &m_status, 0);
  m_process = -1;
  return m_status;
}

void GameProgram::signal(int number) const {
  if (m_process > 0) kill(m_process, number);
}

std::string GameProgram::log() const {
  std::string all;
  for (const char* name : {"log", "output"}) {
    std::ifstream file(m_directory / name);
    all.append(std::istreambuf_iterator<char>(file), {});
  }
  return all;
}

}  // namespace naiad::test
