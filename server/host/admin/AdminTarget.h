// What commands act on: the server, as little of it as they need. Tests have one of their own.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/auth/PasswordHash.h"
#include "shared/admin/AdminAnswer.h"

namespace naiad {

/// A player, with or without a connection.
struct AdminPlayer {
  std::uint64_t session = 0;  ///< names the session for as long as the server runs
  std::uint32_t id = 0;       ///< of the player, as others see it
  std::string name;
  std::string address;                ///< "192.0.2.7:50312"
  std::chrono::seconds connected{0};  ///< since they joined
  std::chrono::seconds idle{0};       ///< since their last key, click or line
  std::uint32_t rtt_millis = 0;       ///< 0: not known yet
  bool detached = false;              ///< their connection broke, and they may come back
  bool muted = false;
  bool admin = false;
  std::string room;  ///< empty: the server has none
};

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
class AdminTarget {
 public:
  virtual ~AdminTarget() = default;

  /// By id.
  virtual std::vector<AdminPlayer> players() const = 0;
  virtual AdminRow status() const = 0;
  /// One of each room that has a name.
  virtual std::vector<AdminRow> rooms() const = 0;

  /// Send them the sentence, and end their session: its token is void. Sessions that are gone are left out.
  virtual void endPlayer(std::uint64_t session, const std::string& sentence) = 0;
  /// A line from the server to all players, or to one. It is cut to the length of a line of chat.
  virtual void say(const std::string& text) = 0;
  virtual void tell(std::uint64_t session, const std::string& text) = 0;
  virtual void setMuted(std::uint64_t session, bool muted) = 0;

  // These say what became of them, in one sentence: it is done, or why it is not.

  virtual AdminAnswer stop(const std::string& sentence) = 0;
  virtual AdminAnswer restart(const AdminRestart& restart) = 0;
  /// Begin again in the program that is installed by now, and go on with the round there, if that can be.
  /// `done` is called once, on the host's thread: now, or when it has been tried out.
  virtual void keepRound(std::function<void(AdminAnswer)> done) = 0;
  /// Nothing: as long as the server's own option says.
  virtual AdminAnswer drain(std::optional<std::chrono::seconds> most) = 0;
  virtual AdminAnswer cancel() = 0;
  /// `done` is called once, on the host's thread: now, or when files have been read.
  virtual void reload(std::function<void(AdminAnswer)> done) = 0;
  /// Nothing: none is needed any more.
  virtual AdminAnswer changePassword(std::optional<PasswordHash> hash) = 0;
  /// Rows of the file of scores, best first. `done` is called once, on the host's thread: now, or when the
  /// file has been read.
  virtual void scores(const AdminScores& which, std::function<void(AdminAnswer)> done) = 0;
  /// `option` without dashes.
  virtual AdminAnswer set(const std::string& option, const std::string& value) = 0;
  /// Those that set() knows, with their values.
  virtual AdminRow settings() const = 0;
};

}  // namespace naiad
