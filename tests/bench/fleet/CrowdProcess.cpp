// A process of players (Crowd.h).
#include <algorithm>
#include <cstdio>
#include <deque>
#include <sstream>
#include <stdexcept>
#include <variant>
#include <vector>

#include "Bot.h"
#include "Crowd.h"
#include "shared/net/stream/JoinLink.h"

namespace bench {
namespace {

constexpr std::chrono::milliseconds kTurn{5};

class Players {
 public:
  /// The players' numbers start at `first`.
  Players(const std::string& link, const std::filesystem::path& known_servers, int first, int count)
      : m_first(first), m_count(static_cast<std::size_t>(count)) {
    const auto parsed = naiad::JoinLink::parse(link);
    const auto* const p_link = std::get_if<naiad::JoinLink>(&parsed);
    if (p_link == nullptr) throw std::runtime_error("the directory has no link: " + link);
    m_directory = {p_link->address.host, p_link->address.port};
    m_trust.link_key = p_link->key;
    m_trust.known_servers = known_servers;
  }

  /// Serves the players for some milliseconds.
  void serve() {
    const std::size_t waiting = m_bots.size() - playing();
    for (std::size_t i = waiting; i < m_at_once && m_bots.size() < m_count; ++i)
      m_bots.emplace_back(m_context, m_directory, m_trust, m_first + static_cast<int>(m_bots.size()));
    runFor(kTurn);
    const auto now = Bot::Clock::now();
    for (Bot& bot : m_bots) bot.update(now);
  }

  std::string answer(const std::string& line) {
    std::istringstream words(line);
    std::string command;
    int number = 0;
    words >> command >> number;
    if (command == "join") m_at_once = static_cast<std::size_t>(number);
    if (command == "state") return state();
    if (command == "kill") return noteKill(static_cast<std::uint16_t>(number));
    if (command == "waiting") return std::to_string(std::ranges::count(m_there, false, &Bot::isBack));
    if (command == "result") return result();
    if (command == "redirects") return redirects();
    if (command == "leave") leaveAll();
    return "0";
  }

 private:
  void runFor(std::chrono::milliseconds time) {
    m_context.restart();
    m_context.run_for(time);
  }
  void leaveAll() {
    for (Bot& bot : m_bots) bot.leave();
    runFor(std::chrono::seconds(2));
  }
  std::size_t playing() const {
    return static_cast<std::size_t>(std::ranges::count_if(m_bots, &Bot::isPlaying));
  }
  /// Returns the answer to "state". A player that ends after all have joined is not a problem here, because
  /// it will count as not returned.
  std::string state() {
    m_have_come = m_have_come || playing() == m_count;
    const auto over = std::ranges::find_if(m_bots, &Bot::isOver);
    if (!m_have_come && over != m_bots.end()) return "problem " + over->message();
    int losses = 0;
    for (const Bot& bot : m_bots) losses += bot.losses();
    return std::to_string(playing()) + " " + std::to_string(losses);
  }
  int lossesOfOthers() const {
    int losses = 0;
    for (const Bot* p_bot : m_others) losses += p_bot->losses();
    return losses;
  }
  /// Prepares result(), which counts these bots even if they move to another server for good. Returns their
  /// number.
  std::string noteKill(std::uint16_t port) {
    m_there.clear();
    m_others.clear();
    for (Bot& bot : m_bots) {
      const bool is_there = bot.port() == port && bot.isPlaying();
      (is_there ? m_there : m_others).push_back(&bot);
      if (is_there) bot.noteKill(Bot::Clock::now());
    }
    m_before = lossesOfOthers();
    return std::to_string(m_there.size());
  }
  std::string result() const {
    int returned = 0;
    std::string times;
    for (Bot* p_bot : m_there) {
      if (!p_bot->isBack()) continue;
      returned += p_bot->isSamePlayer() ? 1 : 0;
      times += " " + std::to_string(p_bot->backTime().count());
    }
    return std::to_string(returned) + " " + std::to_string(lossesOfOthers() - m_before) + times;
  }
  std::string redirects() const {
    std::string times;
    for (const Bot& bot : m_bots) {
      if (const auto time = bot.redirectTime()) times += std::to_string(time->count()) + " ";
    }
    return times;
  }

  asio::io_context m_context{1};
  naiad::ServerAddress m_directory;
  naiad::ServerTrust m_trust;
  int m_first;
  std::size_t m_count;
  std::size_t m_at_once = 0;
  std::deque<Bot> m_bots;
  bool m_have_come = false;   ///< true once all players have joined
  std::vector<Bot*> m_there;  ///< players of the last killed server
  std::vector<Bot*> m_others;
  int m_before = 0;  ///< losses of m_others when the server was killed
};

}  // namespace

void serveCrowd(const std::string& link, const std::filesystem::path& known_servers, int first, int count) {
  Players players(link, known_servers, first, count);
  std::string input;
  while (readInput(input)) {
    players.serve();
    while (const auto line = popLine(input)) {
      std::printf("%s\n", players.answer(*line).c_str());
      std::fflush(stdout);
      if (*line == "leave") return;
    }
  }
}

}  // namespace bench
