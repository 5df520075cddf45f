#include "CrowdProcess.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <vector>

#include "Bots.h"

namespace bench {

namespace {

class CrowdCommands {
 public:
  explicit CrowdCommands(Bots& bots) : m_bots(bots) {}

  std::string answer(const std::string& line) {
    std::istringstream words(line);
    std::string command;
    int number = 0;
    words >> command >> number;
    if (command == "join") return join(number);
    if (command == "state") return state();
    if (command == "kill") return noteKill(static_cast<std::uint16_t>(number));
    if (command == "waiting") return std::to_string(waiting());
    if (command == "result") return result();
    if (command == "redirects") return redirects();
    return "0";
  }

 private:
  std::string join(int at_once) {
    m_bots.bringIn(at_once);
    return "0";
  }
  /// One who ends later is one who does not come back.
  std::string state() {
    if (!m_have_come) m_have_come = m_bots.havePlayed();
    const std::string problem = m_have_come ? "" : m_bots.problem();
    if (!problem.empty()) return "problem " + problem;
    return std::to_string(m_bots.playing()) + " " + std::to_string(losses(m_bots.all()));
  }
  template <class Some>
  static int losses(const Some& bots) {
    int count = 0;
    for (const auto& bot : bots) count += bot->losses();
    return count;
  }
  /// One may go to another server for good: it is still one of those who lost theirs.
  std::string noteKill(std::uint16_t port) {
    m_there.clear();
    m_others.clear();
    for (const auto& bot : m_bots.all()) {
      const bool is_there = bot->port() == port && bot->isPlaying();
      (is_there ? m_there : m_others).push_back(bot.get());
      if (is_there) bot->noteKill(Bot::Clock::now());
    }
    m_before = losses(m_others);
    return std::to_string(m_there.size());
  }
  std::ptrdiff_t waiting() const {
    return std::count_if(m_there.begin(), m_there.end(), [](const Bot* p_bot) { return !p_bot->isBack(); });
  }
  std::string result() const {
    int returned = 0;
    std::string times;
    for (Bot* p_bot : m_there) {
      if (!p_bot->isBack()) continue;
      returned += p_bot->isSamePlayer() ? 1 : 0;
      times += " " + std::to_string(p_bot->backTime().count());
    }
    return std::to_string(returned) + " " + std::to_string(losses(m_others) - m_before) + times;
  }
  std::string redirects() const {
    std::string times;
    for (const auto& bot : m_bots.all()) {
      if (const auto time = bot->redirectTime()) times += std::to_string(time->count()) + " ";
    }
    return times;
  }

  Bots& m_bots;
  bool m_have_come = false;   ///< all of them
  std::vector<Bot*> m_there;  ///< on the server that was killed last
  std::vector<Bot*> m_others;
  int m_before = 0;  ///< losses of the others then
};

/// What has come of the input, if anything; false: it has ended.
bool readInput(std::string& text) {
  pollfd ready{STDIN_FILENO, POLLIN, 0};
  if (::poll(&ready, 1, 0) != 1) return true;
  char part[256];
  const ssize_t count = ::read(STDIN_FILENO, part, sizeof part);
  if (count <= 0) return false;
  text.append(part, static_cast<std::size_t>(count));
  return true;
}

}  // namespace

void serveCrowd(const std::string& link, const std::filesystem::path& known_servers, int first, int count) {
  Bots bots(link, known_servers, first, count);
  CrowdCommands commands(bots);
  std::string input;
  while (readInput(input)) {
    bots.serve();
    for (std::size_t end = input.find('\n'); end != std::string::npos; end = input.find('\n')) {
      const std::string line = input.substr(0, end);
      input.erase(0, end + 1);
      if (line == "leave") bots.leaveAll();
      std::printf("%s\n", commands.answer(line).c_str());
      std::fflush(stdout);
      if (line == "leave") return;
    }
  }
}

}  // namespace bench
