// Kills the server of a journaled game repeatedly while clients play, and checks that each client returns as
// the same player to the same world.
#pragma once

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

/// The result of one kill.
struct KillResult {
  int players = 0;
  int returned = 0;              ///< players that returned as the same player
  std::uint32_t ticks_lost = 0;  ///< ticks that a client had seen and the recovered round does not have
  std::uint64_t cells = 0;       ///< compared cells of each client's last complete picture
  std::uint64_t wrong_cells = 0;
  std::chrono::milliseconds took{0};  ///< time until the last client is back
  std::string problem;                ///< text of the first problem
};

/// Compares the server's score file with the scores that a replay of the round adds.
struct ScoreCheck {
  std::size_t kept = 0;     ///< rows in the file
  std::size_t missing = 0;  ///< rows added by the round that are missing in the file
  std::size_t foreign = 0;  ///< rows in the file that the round does not add, or duplicates
};

/// A game module that adds a score for each key (scores/game.cpp).
inline constexpr const char* kScoresModule = NAIAD_BINARY_DIR "/../lib/scores_module.so";

class RecoveryClient;

class RecoveryRun {
 public:
  /// Starts the server and this many players that press keys at random. Ticks take `frame`.
  RecoveryRun(const std::string& game, int players, std::uint64_t seed,
              std::chrono::microseconds frame = std::chrono::microseconds(5000));
  ~RecoveryRun();
  RecoveryRun(const RecoveryRun&) = delete;
  RecoveryRun& operator=(const RecoveryRun&) = delete;

  /// Lets the players play for this time.
  void play(std::chrono::milliseconds time);
  /// Plays until each player has had a complete picture. False after a timeout.
  bool playUntilPictured();
  /// Kills the server, starts it again, and waits until all players are back.
  KillResult kill();
  /// Like kill(), but also kills the next server `between` later: during the replay of the round, or at some
  /// step of a client's return.
  KillResult killTwice(std::chrono::milliseconds between);
  /// Like kill(), but kills the world's process just before the server.
  KillResult killBoth();
  /// Plays until the world has had this many turns in all. False after `patience`.
  bool playUntilTurn(std::uint32_t turn, std::chrono::seconds patience);
  /// Kills only the world's process. Returns the time until the last player's next picture; nullopt if a
  /// player gets no further pictures, or only in another session.
  std::optional<std::chrono::milliseconds> killWorld();
  /// Like killWorld(), but kills all child processes of the server at once, in the order of their ids or in
  /// reverse.
  std::optional<std::chrono::milliseconds> killChildren(bool reversed);
  /// Like killWorld(), but a player presses a key that makes the world hang until --tick-timeout of the
  /// server.
  std::optional<std::chrono::milliseconds> hangWorld(df::Keyboard::Key key);
  /// Ends the server and replays its round. True if all ticks are equal; `said` is the output of dfreplay
  /// --verify.
  bool verify(std::string& said);
  /// Compares the scores. Call after verify(). All rows of the file must be from this round.
  ScoreCheck checkScores() const;
  /// Returns the log of the ended servers.
  const std::string& log() const { return m_log; }
  /// Returns the log of the server that runs.
  std::string serverLog() const { return m_server->log(); }

 private:
  std::filesystem::path round() const;
  void startServer();
  void killServer();
  /// Starts the server again and waits for the players.
  KillResult comeBack();
  /// Lets the players play until `done` returns true. False after `patience`.
  bool playUntil(const std::function<bool()>& done, std::chrono::milliseconds patience = kPatience);
  bool serveUntilJoined();
  /// Calls `harm` and returns the time until the last player's next picture.
  std::optional<std::chrono::milliseconds> timeToNextPicture(const std::function<void()>& harm);
  /// Returns the game argument for dfreplay; empty for a game that it finds by itself.
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
  mutable std::filesystem::path m_round;  ///< the first round's file
  asio::io_context m_context;
  std::unique_ptr<GameProgram> m_server;
  std::uint16_t m_port = 0;
  std::uint32_t m_first_tick = 0;  ///< number of the world's first tick in the server's count
  std::vector<std::unique_ptr<RecoveryClient>> m_clients;
  std::vector<WelcomeMessage> m_before;  ///< welcomes of the clients before the kill
  std::uint32_t m_seen = 0;              ///< newest tick that any client had before the kill
  std::string m_log;
  std::chrono::steady_clock::time_point m_killed_at;
};

}  // namespace naiad::test
