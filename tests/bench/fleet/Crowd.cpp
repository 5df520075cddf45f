#include "Crowd.h"

#include <algorithm>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace bench {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{20};
constexpr std::chrono::seconds kPatience{60};  // timeout for an answer

bool waitFor(const std::function<bool()>& holds, std::chrono::milliseconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kBetweenLooks);
  }
  return true;
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
    m_workers.emplace_back(std::vector<std::string>{
        "/proc/self/exe", "--players", link, folder / ("known_servers" + std::to_string(i + 1)),
        std::to_string(first + 1), std::to_string(behind - first)});
  }
}

std::vector<std::vector<long>> Crowd::ask(const std::string& command) {
  for (Worker& worker : m_workers) worker.tell(command);
  std::vector<std::vector<long>> answers;
  for (Worker& worker : m_workers) answers.push_back(numbersOf(worker.hear(kPatience)));
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
