// Judges hellos: which client plays, which one goes on with its session, which one is refused and why.
#pragma once

#include <algorithm>
#include <asio/ip/address.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/world/World.h"
#include "host/admission/RoomDoor.h"
#include "host/auth/PasswordCheck.h"
#include "host/auth/ResumeTokens.h"
#include "host/net/PlayerPrefixes.h"
#include "host/net/SealedChannel.h"
#include "host/rooms/Rooms.h"
#include "host/rooms/SessionTable.h"
#include "shared/net/base/PrefixAllowance.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// A hello passes in this order: protocol version and game; bans of its name and address; then the token of a
/// session, which needs no password; then the password; then the limits on players, and the name. Every
/// refusal has a counter. Not thread-safe.
class Admission {
 public:
  /// What it works with; all of it outlives the Admission.
  struct Setup {
    HostContext& context;
    SessionTable& sessions;
    Rooms& rooms;
    PlayerNews& news;
    PlayerPrefixes& prefixes;
    /// A channel for datagrams, with keys from this stream; null if there are none.
    std::function<std::unique_ptr<SealedChannel>(const ReliableChannel& stream, AeadId aead)> open_datagrams;
    /// A session without a stream, waiting for its client. Null: there are none.
    std::function<Session&(const wire::Welcome& welcome)> restore_session = {};
  };
  explicit Admission(Setup setup);

  /// Why a client with this address and name may not play: a sentence; empty if it may.
  using FindBan = std::function<std::string(const asio::ip::address& address, const std::string& name)>;
  void setBans(FindBan find_ban) { m_find_ban = std::move(find_ban); }
  /// A link to another server that has places, or to a room of it; nothing: none is known.
  using FindOther = std::function<std::optional<JoinLink>()>;
  void setOthers(FindOther find_other) { m_find_other = std::move(find_other); }

  /// The world whose window and help go into welcomes. Before the first hello.
  void setWorld(const df::World& world) { m_p_world = &world; }

  /// While a round is executed again, a hello waits for so long before the client hears how far that is, …
  static constexpr std::chrono::milliseconds kRecoveryWait{1000};
  /// … or for so long if more than half is done by then: who was sent away would look again only after the
  /// end. Less than Session::kJudgeTimeout.
  static constexpr std::chrono::milliseconds kNearEndWait{3000};

  /// Refuse or welcome the session that heard this hello: now, or once its password has been checked, or the
  /// round of a server that was killed has been executed again.
  void judgeHello(Session& session, const wire::Hello& hello);
  /// New players have higher ids than this one.
  void reservePlayers(std::uint32_t highest) { m_next_player = std::max(m_next_player, highest + 1); }
  /// Once a tick: judge the hellos that wait for a round.
  void judgeWaiting();
  /// The client has the token that it was sent last (Session::takeProof).
  void confirmToken(Session& session);
  /// The players of a server that was killed are in this room, and may come back.
  void restoreSessions(Room& room, const std::vector<KeptSession>& sessions);
  /// The room's world is a new one: its journal is to have the sessions of those who play.
  void noteSessions(const Room& room) const;
  /// The session has changed: its world's journal is to have it, before the client knows.
  void noteSession(const Session& session) const;
  /// The session, which plays, goes on in the room of this name, if it can; else return why not, for its
  /// player. `led`: by the server, so that it does not count.
  std::string moveSession(Session& session, const std::string& room, bool led);
  /// The session is over: its token is void.
  void forgetSession(const Session& session);
  /// Whoever joins from now on needs this password; nothing: none.
  void changePassword(std::optional<PasswordHash> hash);
  bool needsPassword() const { return m_needs_password; }
  /// What became of passwords; all zero if none is needed.
  PasswordCheck::Counters passwordCounters() const;

 private:
  bool isBanned(Session& session, const std::string& name);
  bool checkHello(Session& session, const wire::Hello& hello);
  bool waitsForRound(const wire::Hello& hello) const;
  void checkPassword(Session& session, const wire::Hello& hello);
  void applyPasswordAnswer(Session& session, const wire::Hello& hello, PasswordCheck::Answer answer);
  bool resumeSession(Session& session, const wire::Hello& hello);
  void restartSession(Session& before, Session& session, const wire::Hello& hello, wire::Welcome& welcome);
  void continueSession(Session& before, Session& session, const wire::Hello& hello, wire::Welcome& welcome);
  void addSecondStream(Session& session, const wire::Hello& hello);
  void takeOverSession(Session& before, Session& session, const wire::Hello& hello);
  struct WaitingHello {
    std::uint64_t session = 0;
    std::shared_ptr<const wire::Hello> hello;
    std::chrono::steady_clock::time_point since;
  };
  std::chrono::milliseconds graceTime() const;
  KeptSession keptSession(const Session& session) const;
  wire::Welcome welcomeOf(const Room& room, std::uint32_t player, const std::string& name,
                          df::Color color) const;
  void admitPlayer(Session& session, const wire::Hello& hello);
  bool checkLimits(Session& session);
  void refuseFull(Session& session, const std::string& sentence);
  void describeRoom(const Room& room, wire::Welcome& welcome) const;
  Room* roomFor(Session& session, const wire::Hello& hello);
  Room* namedRoomFor(Session& session, const wire::Hello& hello);
  void refuseRoom(Session& session, const RoomDoor::Refusal& refusal);
  void refuseBusy(Session& session, const std::string& sentence);
  std::string freeName(const std::string& wanted) const;
  wire::Welcome welcomeTo(Room& room, const std::string& name);
  std::unique_ptr<SealedChannel> openDatagrams(const Session& session, const wire::Hello& hello) const;

  void log(const Session& session, LogEvent event) const;

  Setup m_setup;
  const HostOptions& m_options;
  Counters& m_counters;
  FindBan m_find_ban;      ///< null: nobody is banned
  FindOther m_find_other;  ///< null: there are no others
  const df::World* m_p_world = nullptr;
  ResumeTokens m_tokens;
  PrefixAllowance m_joins;
  PrefixAllowance m_new_worlds;
  RoomDoor m_door;
  std::unique_ptr<PasswordCheck> m_password;  ///< null: none was needed yet
  bool m_needs_password = false;
  std::uint32_t m_next_player = 1;
  std::vector<WaitingHello> m_waiting;  ///< for a round; one of a session at most
};

}  // namespace naiad
