// The players of a fleet. They run in several threads, because one cannot serve a thousand of them as fast as
// each player's own machine would.
#pragma once

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <variant>
#include <vector>

#include "client/bot/BotScript.h"
#include "client/session/Connection.h"
#include "shared/net/stream/JoinLink.h"

namespace bench {

/// A player of a fleet: asks the directory, is redirected to a server, and plays there.
class Bot {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  Bot(asio::io_context& context, const naiad::ServerAddress& directory, const naiad::ServerTrust& trust,
      int number)
      : m_connection(context, directory, optionsOf(number), true, trust),
        m_keys(static_cast<std::uint64_t>(number), 80, 24) {
    m_connection.start();
  }

  void update(Time now) {
    m_connection.update(now);
    if (m_redirected_at == Time() && m_connection.isRedirected()) m_redirected_at = now;
    const bool playing = isPlaying();
    if (m_was_playing && !playing) {
      ++m_losses;
      m_lost = true;
    }
    if (!m_was_playing && playing) {
      if (!m_redirect && m_redirected_at != Time())
        m_redirect = std::chrono::duration_cast<std::chrono::milliseconds>(now - m_redirected_at);
      if (m_killed_at != Time() && m_lost) m_back_at = now;
    }
    m_was_playing = playing;
    if (!playing || now < m_next_key) return;
    m_next_key = now + kBetweenKeys;
    for (const naiad::BotAction& action : m_keys.tick()) {
      if (const auto* const p_key = std::get_if<naiad::KeyAction>(&action))
        m_connection.session()->sendKey(p_key->key, p_key->action, now);
    }
  }
  bool isPlaying() const { return m_connection.state() == naiad::Connection::State::kJoined; }
  bool isOver() const { return m_connection.isOver(); }
  const std::string& message() const { return m_connection.message(); }
  std::uint16_t port() const { return m_connection.address().port; }
  std::uint32_t player() { return m_connection.session()->welcome().player; }
  void leave() { m_connection.leave(); }

  /// Returns the time from the first redirect to the first picture; nullopt if there was no redirect.
  std::optional<std::chrono::milliseconds> redirectTime() const { return m_redirect; }

  /// Records that the bot's server is killed now. isBack() is true when the bot has lost its server and plays
  /// again.
  void noteKill(Time now) {
    m_killed_at = now;
    m_back_at = {};
    m_lost = false;
    m_before = player();
    m_port_before = port();
  }
  bool isBack() const { return m_back_at != Time(); }
  bool isSamePlayer() { return player() == m_before && port() == m_port_before; }
  std::chrono::milliseconds backTime() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(m_back_at - m_killed_at);
  }
  /// Returns how often the bot has lost its server.
  int losses() const { return m_losses; }

 private:
  static constexpr std::chrono::milliseconds kBetweenKeys{200};

  static naiad::SessionOptions optionsOf(int number) {
    naiad::SessionOptions options;
    options.name = "bot" + std::to_string(number);
    options.program = "naiad_fleet";
    options.columns = 80;
    options.rows = 24;
    return options;
  }

  naiad::Connection m_connection;
  naiad::RandomPlayer m_keys;
  Time m_next_key{};
  Time m_redirected_at{};
  std::optional<std::chrono::milliseconds> m_redirect;
  bool m_was_playing = false;
  int m_losses = 0;
  Time m_killed_at{};
  Time m_back_at{};
  bool m_lost = false;
  std::uint32_t m_before = 0;
  std::uint16_t m_port_before = 0;
};

class Crowd {
 public:
  struct Report {
    std::string problem;  ///< why a player cannot join
    int playing = 0;
    int losses = 0;  ///< total number of times that players have lost their servers
    /// Times from the directory's answer to the first picture, in milliseconds, of each redirected player.
    std::vector<long> redirects;
    // Results since the last noteKill():
    int waiting = 0;         ///< players of the killed server that are not back yet
    int returned = 0;        ///< those that play again as the same players
    int disturbed = 0;       ///< how often players of other servers lost their servers
    std::vector<long> back;  ///< milliseconds until the player was back, for each that plays again
  };

  /// Each thread has a file in `folder` for the keys that its players pin. Throws std::runtime_error for an
  /// invalid link.
  Crowd(const std::string& link, const std::filesystem::path& folder, int players, int threads)
      : m_players(players) {
    const auto parsed = naiad::JoinLink::parse(link);
    const auto* const p_link = std::get_if<naiad::JoinLink>(&parsed);
    if (p_link == nullptr) throw std::runtime_error("the directory has no link: " + link);
    for (int i = 0; i < threads; ++i) {
      naiad::ServerTrust trust;
      trust.link_key = p_link->key;
      trust.known_servers = folder / ("known_servers" + std::to_string(i + 1));
      const int first = players * i / threads;
      m_groups.emplace_back(naiad::ServerAddress{p_link->address.host, p_link->address.port}, trust,
                            first + 1, players * (i + 1) / threads - first);
    }
  }

  /// Lets the players join, at most `at_once` at a time. False if they have not all joined in time. Throws
  /// std::runtime_error if one cannot.
  bool joinAll(int at_once, std::chrono::seconds most) {
    const int each = std::max(1, at_once / static_cast<int>(m_groups.size()));
    ask([each](Group& group) { return group.join(each); });
    return waitFor(most, [this](const Report& report) {
      if (!report.problem.empty()) throw std::runtime_error("a player cannot join: " + report.problem);
      return report.playing == m_players;
    });
  }
  Report report() {
    Report sum;
    for (const Report& part : ask(&Group::report)) {
      if (!part.problem.empty()) sum.problem = part.problem;
      sum.playing += part.playing;
      sum.losses += part.losses;
      sum.redirects.insert(sum.redirects.end(), part.redirects.begin(), part.redirects.end());
      sum.waiting += part.waiting;
      sum.returned += part.returned;
      sum.disturbed += part.disturbed;
      sum.back.insert(sum.back.end(), part.back.begin(), part.back.end());
    }
    return sum;
  }
  /// Call before the server at this port is killed. Returns how many players it has.
  int noteKill(std::uint16_t port) {
    int there = 0;
    for (const int count : ask([port](Group& group) { return group.noteKill(port); })) there += count;
    return there;
  }
  /// Waits until all players of the killed server play again, but at most for this time.
  void waitUntilBack(std::chrono::milliseconds most) {
    waitFor(most, [](const Report& report) { return report.waiting == 0; });
  }
  void leaveAll() {
    ask(&Group::leave);
    std::this_thread::sleep_for(std::chrono::seconds(2));  // time for the goodbyes to arrive
  }

 private:
  /// The players of one thread, numbered from `first`. Other functions than post() run in that thread.
  class Group {
   public:
    Group(const naiad::ServerAddress& directory, const naiad::ServerTrust& trust, int first, int count)
        : m_directory(directory), m_trust(trust), m_first(first), m_count(count), m_thread([this] {
            while (!m_over) serve();
          }) {}
    ~Group() {
      m_over = true;
      m_thread.join();
    }

    template <class Result>
    std::future<Result> post(const std::function<Result(Group&)>& action) {
      const auto task =
          std::make_shared<std::packaged_task<Result()>>([this, action] { return action(*this); });
      asio::post(m_context, [task] { (*task)(); });
      return task->get_future();
    }
    int join(int at_once) { return m_at_once = at_once; }
    int leave() {
      for (Bot& bot : m_bots) bot.leave();
      return 0;
    }
    /// Prepares the report of these bots even if they move to another server for good.
    int noteKill(std::uint16_t port) {
      m_there.clear();
      m_others.clear();
      for (Bot& bot : m_bots) {
        const bool is_there = bot.port() == port && bot.isPlaying();
        (is_there ? m_there : m_others).push_back(&bot);
        if (is_there) bot.noteKill(Bot::Clock::now());
      }
      m_before = lossesOfOthers();
      return static_cast<int>(m_there.size());
    }
    /// A player that ends after all have joined is not a problem here, because it will count as not returned.
    Report report() {
      Report report;
      report.playing = playing();
      m_have_come = m_have_come || report.playing == m_count;
      const auto over = std::ranges::find_if(m_bots, &Bot::isOver);
      if (!m_have_come && over != m_bots.end()) report.problem = over->message();
      for (const Bot& bot : m_bots) {
        report.losses += bot.losses();
        if (const auto time = bot.redirectTime()) report.redirects.push_back(time->count());
      }
      report.disturbed = lossesOfOthers() - m_before;
      for (Bot* p_bot : m_there) {
        report.waiting += p_bot->isBack() ? 0 : 1;
        if (!p_bot->isBack()) continue;
        report.returned += p_bot->isSamePlayer() ? 1 : 0;
        report.back.push_back(p_bot->backTime().count());
      }
      return report;
    }

   private:
    void serve() {
      for (int i = static_cast<int>(m_bots.size()) - playing(); i < m_at_once && !isFull(); ++i)
        m_bots.emplace_back(m_context, m_directory, m_trust, m_first + static_cast<int>(m_bots.size()));
      m_context.run_for(std::chrono::milliseconds(5));
      const auto now = Bot::Clock::now();
      for (Bot& bot : m_bots) bot.update(now);
    }
    bool isFull() const { return static_cast<int>(m_bots.size()) == m_count; }
    int playing() const { return static_cast<int>(std::ranges::count_if(m_bots, &Bot::isPlaying)); }
    int lossesOfOthers() const {
      int losses = 0;
      for (const Bot* p_bot : m_others) losses += p_bot->losses();
      return losses;
    }

    asio::io_context m_context{1};
    const asio::executor_work_guard<asio::io_context::executor_type> m_work{m_context.get_executor()};
    naiad::ServerAddress m_directory;
    naiad::ServerTrust m_trust;
    int m_first;
    int m_count;
    int m_at_once = 0;
    std::deque<Bot> m_bots;
    bool m_have_come = false;   ///< true once all players have joined
    std::vector<Bot*> m_there;  ///< players of the last killed server
    std::vector<Bot*> m_others;
    int m_before = 0;  ///< losses of m_others when the server was killed
    std::atomic<bool> m_over{false};
    std::thread m_thread;  // last member, because it uses the others
  };

  /// Calls `action` for all groups at once. Returns the results.
  template <class Action, class Result = std::invoke_result_t<Action, Group&>>
  std::vector<Result> ask(Action action) {
    std::vector<std::future<Result>> answers;
    for (Group& group : m_groups) answers.push_back(group.post(std::function<Result(Group&)>(action)));
    std::vector<Result> results;
    for (auto& answer : answers) results.push_back(answer.get());
    return results;
  }
  bool waitFor(std::chrono::milliseconds most, const std::function<bool(const Report&)>& holds) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (!holds(report())) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }

  std::deque<Group> m_groups;
  int m_players;
};

}  // namespace bench
