#include "Crowd.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace bench {

namespace {

constexpr std::chrono::milliseconds kBetweenLooks{20};

bool waitFor(const std::function<bool()>& holds, std::chrono::milliseconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kBetweenLooks);
  }
  return true;
}

std::string readLine(std::FILE* p_from) {
  std::string line;
  for (int c = std::fgetc(p_from); c != '\n'; c = std::fgetc(p_from)) {
    if (c == EOF) throw std::runtime_error("a process of players has ended");
    line.push_back(static_cast<char>(c));
  }
  return line;
}

std::vector<long> numbersOf(const std::string& line) {
  if (line.rfind("problem ", 0) == 0) throw std::runtime_error("a player cannot join: " + line.substr(8));
  std::istringstream words(line);
  std::vector<long> numbers;
  for (long number = 0; words >> number;) numbers.push_back(number);
  return numbers;
}

}  // namespace

Crowd::Crowd(const std::string& link, const std::filesystem::path& folder, int players, int processes)
    : m_players(players) {
  for (int i = 0; i < processes; ++i) {
    const int first = players * i / processes;
    const int behind = players * (i + 1) / processes;
    m_workers.push_back(
        start({"/proc/self/exe", "--players", link, folder / ("known_servers" + std::to_string(i + 1)),
               std::to_string(first + 1), std::to_string(behind - first)}));
  }
}

Crowd::~Crowd() {
  for (const Worker& worker : m_workers) {
    std::fclose(worker.p_to);
    std::fclose(worker.p_from);
    ::kill(worker.process, SIGKILL);
    ::waitpid(worker.process, nullptr, 0);
  }
}

Crowd::Worker Crowd::start(const std::vector<std::string>& words) {
  int to[2];
  int from[2];
  if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "a process of players");
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::dup2(to[0], STDIN_FILENO);
    ::dup2(from[1], STDOUT_FILENO);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
  ::close(to[0]);
  ::close(from[1]);
  return {child, ::fdopen(to[1], "w"), ::fdopen(from[0], "r")};
}

std::vector<std::vector<long>> Crowd::ask(const std::string& command) {
  for (const Worker& worker : m_workers) {
    std::fprintf(worker.p_to, "%s\n", command.c_str());
    std::fflush(worker.p_to);
  }
  std::vector<std::vector<long>> answers;
  for (const Worker& worker : m_workers) answers.push_back(numbersOf(readLine(worker.p_from)));
  return answers;
}

long Crowd::sumOf(const std::string& command) {
  long sum = 0;
  for (const auto& numbers : ask(command)) sum += numbers.at(0);
  return sum;
}

bool Crowd::joinAll(int at_once, std::chrono::seconds most) {
  const int each = std::max(1, at_once / static_cast<int>(m_workers.size()));
  ask("join " + std::to_string(each));
  return waitFor([this] { return state().playing == m_players; }, most);
}

Crowd::State Crowd::state() {
  State sum;
  for (const auto& numbers : ask("state")) {
    sum.playing += static_cast<int>(numbers.at(0));
    sum.losses += static_cast<int>(numbers.at(1));
  }
  return sum;
}

std::vector<long> Crowd::redirects() {
  std::vector<long> all;
  for (const auto& numbers : ask("redirects")) all.insert(all.end(), numbers.begin(), numbers.end());
  return all;
}

int Crowd::noteKill(std::uint16_t port) {
  return static_cast<int>(sumOf("kill " + std::to_string(port)));
}

void Crowd::waitUntilBack(std::chrono::milliseconds most) {
  waitFor([this] { return sumOf("waiting") == 0; }, most);
}

Crowd::Return Crowd::result() {
  Return sum;
  for (const auto& numbers : ask("result")) {
    sum.returned += static_cast<int>(numbers.at(0));
    sum.disturbed += static_cast<int>(numbers.at(1));
    sum.back.insert(sum.back.end(), numbers.begin() + 2, numbers.end());
  }
  return sum;
}

void Crowd::leaveAll() {
  ask("leave");
}

}  // namespace bench
