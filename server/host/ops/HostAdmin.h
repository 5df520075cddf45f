// A host as commands see it.
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

/// When a server begins again.
struct AdminRestart {
  enum class When { kNow, kAtRoundEnd, kIn } when = When::kNow;
  std::chrono::seconds in{0};  ///< for kIn
};

/// Which scores.
struct AdminScores {
  std::string table;      ///< empty: of all tables of the game
  std::size_t count = 0;  ///< of each table
  std::string room;       ///< that of its game; empty: not said
  std::string game;       ///< the same
};

/// All of it on the host's thread, between two ticks; nothing of it waits.
class HostAdmin {
 public:
  /// What it works with outlives it.
  HostAdmin(const HostAccess& access, HostScores& scores);

  /// By id.
  std::vector<AdminPlayer> players() const;
  AdminRow status() const;
  /// One of each room that has a name.
  std::vector<AdminRow> rooms() const;

  /// Sends them the sentence, and ends their session: its token is void. Sessions that are gone are left out.
  void endPlayer(std::uint64_t session, const std::string& sentence);
  /// A line from the server to all players, or to one. It is cut to the length of a line of chat.
  void say(const std::string& text);
  void tell(std::uint64_t session, const std::string& text);
  void setMuted(std::uint64_t session, bool muted);

  // These say what became of them, in one sentence: it is done, or why it is not. `done` is called once, on
  // the host's thread: now, or when files have been read.

  AdminAnswer stop(const std::string& sentence);
  AdminAnswer restart(const AdminRestart& restart);
  /// HostControls::keepRound().
  void keepRound(std::function<void(AdminAnswer)> done);
  /// Nothing: as long as the server's own option says.
  AdminAnswer drain(std::optional<std::chrono::seconds> most);
  AdminAnswer cancel();
  void reload(std::function<void(AdminAnswer)> done);
  /// Nothing: none is needed any more.
  AdminAnswer changePassword(std::optional<PasswordHash> hash);
  /// Rows of the file of scores, best first.
  void scores(const AdminScores& which, std::function<void(AdminAnswer)> done);
  /// `option` without dashes.
  AdminAnswer set(const std::string& option, const std::string& value);
  /// Those that set() knows, with their values.
  AdminRow settings() const;

 private:
  /// The tables of a game, and the rooms that play it; without rooms those of the one game.
  struct Board {
    std::string game;
    std::vector<std::string> rooms;
  };
  std::vector<Board> boards() const;
  /// Null: `refusal` says why there is none, or that there are several.
  static const Board* findBoard(const std::vector<Board>& boards, const AdminScores& which,
                                AdminAnswer& refusal);
  Session* findPlaying(std::uint64_t session) const;

  HostAccess m_access;
  HostScores& m_scores;
  Session::Clock::time_point m_began;
};

}  // namespace naiad
