// The operations of a host that commands use.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/admin/AdminPlayer.h"
#include "host/auth/PasswordHash.h"
#include "host/loop/HostPart.h"
#include "host/ops/HostScores.h"
#include "host/session/Session.h"
#include "shared/admin/AdminAnswer.h"

namespace naiad {

/// Selects scores. The game is `game`; if it is empty, that of `room`; if both are, the server's only one.
struct AdminScores {
  std::string table;      ///< empty: all tables of the game
  std::size_t count = 0;  ///< rows of each table
  std::string room;       ///< name of a room; may be empty
  std::string game;       ///< name of a game; may be empty
};

/// Call all functions on the host's thread, between two ticks. None of them blocks.
class HostAdmin {
 public:
  /// The arguments must outlive it.
  HostAdmin(const HostAccess& access, HostScores& scores);

  /// Returns the players, sorted by id.
  std::vector<AdminPlayer> players() const;
  AdminRow status() const;
  /// Calls HostEndpoint::joinCommand().
  std::string joinCommand() const;
  /// Returns a row for each named room.
  std::vector<AdminRow> rooms() const;

  /// Sends the player the sentence and ends their session and its token. Ignores sessions that do not play.
  void kickPlayer(std::uint64_t session, const std::string& sentence);
  /// Sends a line from the server to all players, or to one. Truncates it to the length of a chat line.
  void broadcast(const std::string& text);
  void tell(std::uint64_t session, const std::string& text);
  void setMuted(std::uint64_t session, bool muted);

  // The answer of each of the following, unless noted, has the result or the reason for a failure as text.
  // `done` is called once, on the host's thread: at once, or when files have been read or the round replayed.

  AdminAnswer stop(const std::string& sentence);
  /// `at_round_end`, or after the time `in`; neither: now.
  AdminAnswer restart(bool at_round_end, std::optional<std::chrono::seconds> in);
  /// Calls HostControls::handOverRound().
  void handOverRound(std::function<void(AdminAnswer)> done);
  /// Ends the server when all players have left. `most`: time limit; nullopt: that of --drain-timeout.
  AdminAnswer drain(std::optional<std::chrono::seconds> most);
  AdminAnswer cancel();
  void reload(std::function<void(AdminAnswer)> done);
  /// Sets the password of new players; nullopt: they need none.
  AdminAnswer changePassword(std::optional<PasswordHash> hash);
  /// Answers with rows of the score file, best first.
  void scores(const AdminScores& which, std::function<void(AdminAnswer)> done);
  /// Changes an option, named without dashes. Without `value`, answers with its current value.
  AdminAnswer set(const std::string& option, const std::optional<std::string>& value);
  /// Returns the options that set() can change, with their values.
  AdminRow settings() const;

 private:
  /// The score tables of a game, and the named rooms in which it is played.
  struct Board {
    std::string game;
    std::vector<std::string> rooms;
  };
  std::vector<Board> boards() const;
  /// Returns null, with the reason in `refusal`, if no board matches or more than one could be meant.
  static const Board* findBoard(const std::vector<Board>& boards, const AdminScores& which,
                                AdminAnswer& refusal);
  Session* findPlaying(std::uint64_t session) const;

  HostAccess m_access;
  HostScores& m_scores;
  Session::Clock::time_point m_began;
};

}  // namespace naiad
