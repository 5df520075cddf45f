// Those who want to play while a server is attacked: three honest players and a newcomer each second.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "HonestPlayer.h"
#include "Newcomers.h"

namespace bench::attack {

/// What became of them.
struct Fate {
  std::uint64_t wrong_cells = 0;
  std::uint64_t compared_ticks = 0;
  int thrown_out = 0;  ///< of the honest players
  int newcomers = 0;
  int newcomers_out = 0;   ///< of these, refused, hung up on, or out of patience
  double newcomer_ms = 0;  ///< the slowest one's wait
  double pause_ms = 0;     ///< the longest time that the world stood still for the player beside the server
  std::size_t crowd = 0;   ///< the most players of the watched name that the list of players had
  std::uint64_t chat = 0;  ///< lines of chat that the player beside the server read
};

class Company {
 public:
  /// The player who is away loses its stream and datagrams `from` after the beginning, `until` then.
  struct Absence {
    std::chrono::milliseconds from;
    std::chrono::milliseconds until;
  };

  /// `watched`: of players whose names begin so, the number is noted.
  Company(Whereabouts server, std::string watched);

  /// All honest players join. Throws std::runtime_error.
  void join();
  /// Play for so long, and until all honest players have their streams and newcomers know their fate, if that
  /// takes no more than ten seconds.
  void play(std::chrono::milliseconds duration, Absence absence);
  /// Leave. The fate, but for what compare() finds.
  Fate leave();
  /// After the server has ended: the truth is whole.
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
