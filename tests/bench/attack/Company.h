// Players during an attack: three honest ones and a newcomer each second.
#pragma once

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "HonestPlayer.h"
#include "Newcomers.h"

namespace bench::attack {

/// Results of the players.
struct Fate {
  std::uint64_t wrong_cells = 0;
  std::uint64_t compared_ticks = 0;
  int thrown_out = 0;  ///< honest players that lost their sessions
  int newcomers = 0;
  int newcomers_out = 0;   ///< newcomers that were refused, disconnected, or gave up
  double newcomer_ms = 0;  ///< longest wait of a newcomer, in ms
  double pause_ms = 0;     ///< longest pause between ticks for the player nearest to the server, in ms
  std::size_t crowd = 0;   ///< maximum number of players with the watched name in the player list
  std::uint64_t chat = 0;  ///< chat lines received by the player nearest to the server
};

class Company {
 public:
  using Clock = std::chrono::steady_clock;
  using Millis = std::chrono::milliseconds;

  /// Also records the largest number of players whose names begin with `watched`.
  Company(Whereabouts server, std::string watched)
      : m_server(std::move(server)),
        m_watched(std::move(watched)),
        m_plain(m_context, m_server, "plain"),
        m_far(m_context, m_server, "far", "127.1.0.2", Millis(100)),
        m_away(m_context, m_server, "away", "127.1.0.3"),
        m_newcomers(m_context, m_server) {}

  /// Lets all honest players join. Throws std::runtime_error if one cannot.
  void join() {
    for (const auto end = Clock::now() + std::chrono::seconds(30); !areHere(); serve()) {
      for (const HonestPlayer* p_player : m_honest) {
        if (p_player->isOver() || Clock::now() > end)
          throw std::runtime_error("an honest player cannot join: " + p_player->message());
      }
    }
  }
  /// Plays for `lead`, then with newcomers for `duration`, and up to ten seconds longer until all honest
  /// players have their streams and all newcomers have succeeded or failed. The player `away` is disconnected
  /// for the middle five sixths of the duration, for example 50 s of 60 s.
  void play(Millis lead, Millis duration) {
    for (const auto end = Clock::now() + lead; Clock::now() < end;) serve();
    const Clock::time_point begin = Clock::now();
    m_plain.watchPauses(begin);
    m_newcomers.begin(begin);
    bool cut = false;
    for (Clock::time_point now = begin; now < begin + duration; now = Clock::now()) {
      if (!cut && now >= begin + duration / 12) {
        cut = true;
        m_away.setOpen(false);
      }
      if (now >= begin + duration * 11 / 12) m_away.setOpen(true);
      serve();
    }
    m_away.setOpen(true);
    m_newcomers.end();
    const auto end = Clock::now() + std::chrono::seconds(10);
    while (Clock::now() < end && (m_newcomers.isBusy() || !areHere())) serve();
  }
  /// Lets all players leave. Returns the results, except those of compare().
  Fate leave() {
    Fate fate;
    fate.pause_ms = m_plain.pauseMillis(Clock::now());
    fate.newcomers = m_newcomers.count();
    fate.newcomers_out = m_newcomers.failed();
    fate.newcomer_ms = m_newcomers.slowestMillis();
    fate.crowd = m_crowd;
    if (m_plain.session() != nullptr) fate.chat = m_plain.session()->counters().chat_lines;
    for (HonestPlayer* p_player : m_honest) {
      fate.thrown_out += p_player->isInItsSession() ? 0 : 1;
      p_player->leave();
    }
    m_context.restart();
    m_context.run_for(Millis(500));
    return fate;
  }
  /// Compares the players' pictures with the server's. Call after the server has ended, when its truth file
  /// is complete.
  void compare(const std::string& truth_file, Fate& fate) const {
    for (const HonestPlayer* p_player : m_honest) {
      const naiad::TruthRecorder::Comparison compared = p_player->compare(truth_file);
      fate.wrong_cells += compared.wrong;
      fate.compared_ticks += compared.ticks;
    }
  }

 private:
  void serve() {
    m_context.restart();
    m_context.run_one_for(Millis(5));
    for (const auto enough = Clock::now() + Millis(20); Clock::now() < enough && m_context.poll_one() > 0;) {
    }
    const Clock::time_point now = Clock::now();
    for (HonestPlayer* p_player : m_honest) p_player->update(now);
    m_newcomers.update(now);
    if (m_watched.empty() || !m_plain.isInItsSession()) return;
    const auto count = std::ranges::count_if(m_plain.session()->players(), [this](const auto& player) {
      return player.name.starts_with(m_watched);
    });
    m_crowd = std::max(m_crowd, static_cast<std::size_t>(count));
  }
  bool areHere() {
    return std::ranges::all_of(m_honest, [](HonestPlayer* p_player) { return p_player->isInItsSession(); });
  }

  asio::io_context m_context{1};
  Whereabouts m_server;
  std::string m_watched;
  HonestPlayer m_plain;
  HonestPlayer m_far;
  HonestPlayer m_away;
  HonestPlayer* const m_honest[3] = {&m_plain, &m_far, &m_away};
  Newcomers m_newcomers;
  std::size_t m_crowd = 0;
};

}  // namespace bench::attack
