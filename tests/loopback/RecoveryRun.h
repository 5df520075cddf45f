// A server of a game whose rounds are journaled is killed again and again, while clients play: does each of
// them come back as the same player, into the same world?
#pragma once

#include <sys/types.h>

#include <asio/io_context.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "GameProgram.h"
#include "Home.h"
#include "shared/values/Keyboard.h"

namespace naiad::test {

/// What came of one kill.
struct KillResult {
  int players = 0;
  int returned = 0;              ///< of them, as the same player
  std::uint32_t ticks_lost = 0;  ///< that a client had seen, and the round that goes on had not
  std::uint64_t cells = 0;       ///< compared: of the last picture that each client had whole
  std::uint64_t wrong_cells = 0;
  std::chrono::milliseconds took{0};   ///< from the kill, or the command, to when the last client is back
  std::chrono::milliseconds pause{0};  ///< of keepRound(): the longest between two pictures of a client
  std::string problem;                 ///< the first, in words
};

/// The server's file of scores, held against those that the round adds when it is executed again.
struct ScoreCheck {
  std::size_t kept = 0;     ///< rows of the file
  std::size_t missing = 0;  ///< that the round adds, and the file does not have
  std::size_t foreign = 0;  ///< of the file, that the round does not add, or that come twice
};

/// A module that adds a score for every key (scores/game.cpp).
inline constexpr const char* kScoresModule = NAIAD_BINARY_DIR "/../lib/scores_module.so";

class RecoveryClient;

class RecoveryRun {
 public:
  /// Starts the server with so many players, who press keys at random. Ticks take `frame`.
  RecoveryRun(const std::string& game, int players, std::uint64_t seed,
              std::chrono::microseconds frame = std::chrono::microseconds(5000));
  ~RecoveryRun();
  RecoveryRun(const RecoveryRun&) = delete;
  RecoveryRun& operator=(const RecoveryRun&) = delete;

  /// Let them play for so long.
  void play(std::chrono::milliseconds time);
  /// Let them play until each of them has had a picture that can be compared. False: they never have.
  bool playUntilPictured();
  /// Kill the server, start it again, and wait until all are back.
  KillResult kill();
  /// The same, but the next server is killed as well, so much later: while it executes the round again, or at
  /// some step of a client's return.
  KillResult killTwice(std::chrono::milliseconds between);
  /// The same, but the world's process is killed just before the server is.
  KillResult killBoth();
  /// Let them play until the world has had so many turns since its first. False: it takes too long.
  bool playUntilTurn(std::uint32_t turn, std::chrono::seconds patience);
  /// Kill the server and start it again when none of its players is waited for any more: `away` later, as its
  /// round's file tells the time. `newcomers` join in their place. How many of them see the game.
  int replacePlayers(std::chrono::seconds away, int newcomers);
  /// The two halves of kill().
  void killServer();
  KillResult comeBack();
  /// dfctl restart --keep, while they play; then wait until all are back.
  KillResult keepRound();
  /// Kill the world's process alone, and wait until its players see more of it, and go on to. How long it
  /// took to the last one's next picture; nothing: they do not go on, or not in the sessions that they had.
  std::optional<std::chrono::milliseconds> killWorld();
  /// The same, but one of the players presses a key by which the world hangs, with the server's own
  /// --hang-time.
  std::optional<std::chrono::milliseconds> hangWorld(df::Keyboard::Key key);
  /// The copies of the world's process that wait.
  std::vector<pid_t> copies() const;
  /// End the server, and execute its round from the beginning. Is it the same, tick by tick? `said`: what
  /// dfreplay --verify prints.
  bool verify(std::string& said);
  /// After verify(). All rows have to be of this round.
  ScoreCheck checkScores() const;
  /// The next server plays this one.
  void setGame(const std::string& game) { m_game = game; }
  /// What the servers logged.
  const std::string& log() const { return m_log; }
  std::filesystem::path round() const;

 private:
  void startServer();
  bool serveUntilJoined();
  void addPlayers(int count);
  /// From what `harm` does to the world to the last player's next picture.
  std::optional<std::chrono::milliseconds> timeToNextPicture(const std::function<void()>& harm);
  /// By which dfreplay finds the game.
  std::string replayedGame() const { return m_game.find('/') != std::string::npos ? m_game : ""; }
  void waitForFirstTick();
  void judge(bool back, KillResult& result);
  void compare(KillResult& result);
  std::uint32_t recoveredTurns() const;
  bool isLogged(const std::string& text);

  Home m_home;
  std::string m_game;
  std::mt19937_64 m_random;
  std::chrono::microseconds m_frame;
  std::filesystem::path m_rounds;
  asio::io_context m_context;
  std::unique_ptr<GameProgram> m_server;
  std::uint16_t m_port = 0;
  std::uint32_t m_first_tick = 0;  ///< what the server calls the world's first one
  std::vector<std::unique_ptr<RecoveryClient>> m_clients;
  int m_names = 0;                       ///< given to players so far
  std::vector<WelcomeMessage> m_before;  ///< of the clients, before the kill
  std::uint32_t m_seen = 0;              ///< the newest tick that one of them had
  std::string m_log;
  std::chrono::steady_clock::time_point m_killed_at;
};

}  // namespace naiad::test
