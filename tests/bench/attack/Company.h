// Players during an attack: three honest ones and a newcomer each second.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

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
  /// Times since the end of the lead between which the player `away` has no stream and no datagrams.
  struct Absence {
    std::chrono::milliseconds from;
    std::chrono::milliseconds until;
  };

  /// Also records the largest number of players whose names begin with `watched`.
  Company(Whereabouts server, std::string watched);

  /// Lets all honest players join. Throws std::runtime_error if one cannot.
  void join();
  /// Plays for `lead`, then with newcomers for `duration`, and up to ten seconds longer until all honest
  /// players have their streams and all newcomers have succeeded or failed.
  void play(std::chrono::milliseconds lead, std::chrono::milliseconds duration, Absence absence);
  /// Lets all players leave. Returns the results, except those of compare().
  Fate leave();
  /// Compares the players' pictures with the server's. Call after the server has ended, when its truth file
  /// is complete.
  void compare(const std::string& truth_file, Fate& fate) const;

 private:
  void serve();
  bool areHere();
  void noteCrowd();

  asio::io_context m_context{1};
  Whereabouts m_server;
  std::string m_watched;
  HonestPlayer m_plain;
  HonestPlayer m_far;
  HonestPlayer m_away;
  Newcomers m_newcomers;
  std::size_t m_crowd = 0;
};

}  // namespace bench::attack
