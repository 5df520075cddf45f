// Evaluates hellos: which clients join, which resume their session, and which are refused and why.
#pragma once

#include <asio/ip/address.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/world/World.h"
#include "host/admission/RoomAdmission.h"
#include "host/auth/PasswordCheck.h"
#include "host/auth/ResumeTokens.h"
#include "host/net/PlayerPrefixes.h"
#include "host/net/SealedChannel.h"
#include "host/rooms/RoomManager.h"
#include "host/rooms/SessionTable.h"
#include "shared/net/base/PrefixRateLimiter.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// Checks a hello in this order: protocol version and game; bans; the resume token, which needs no password;
/// the password; the limits on players; the name. Every refusal has a counter. Not thread-safe.
class Admission {
 public:
  /// The objects that the Admission works with. All of them must outlive it.
  struct Setup {
    HostContext& context;
    SessionTable& sessions;
    RoomManager& rooms;
    PlayerListBroadcaster& player_list;
    PlayerPrefixes& prefixes;
    /// Opens a datagram channel with keys from this stream; returns null if the server has no datagrams.
    std::function<std::unique_ptr<SealedChannel>(const ReliableChannel& stream, AeadId aead)> open_datagrams;
    /// Creates a session without a stream, which waits for its client. Null: sessions are not restored.
    std::function<Session&(const wire::Welcome& welcome)> restore_session = {};
  };
  explicit Admission(Setup setup);

  /// Returns why a client with this address and name is banned, as a sentence; empty if it is not.
  using FindBan = std::function<std::string(const asio::ip::address& address, const std::string& name)>;
  void setBanCheck(FindBan find_ban) { m_find_ban = std::move(find_ban); }
  /// Returns a link to another server with free places, or to a room of it; nullopt if none is known.
  using FindRedirect = std::function<std::optional<JoinLink>()>;
  void setFindRedirect(FindRedirect find_redirect) { m_find_redirect = std::move(find_redirect); }

  /// Sets the world whose view size and help are sent in welcomes, except to named rooms. Call this before
  /// the first hello.
  void setWorld(const df::World& world) { m_p_world = &world; }

  /// Time that a hello waits for a round in recovery; then its client is refused and told the progress.
  static constexpr std::chrono::milliseconds kRecoveryWait{1000};
  /// Time that a hello waits once more than half of the round is replayed. It is longer, because a refused
  /// client might retry only after the end of the recovery. Less than Session::kAdmissionTimeout.
  static constexpr std::chrono::milliseconds kNearEndWait{3000};

  /// Refuses or welcomes the session that received this hello, or resumes an earlier session on its stream:
  /// at once, after its password check, or after the recovery of a killed server's round.
  void evaluateHello(Session& session, const wire::Hello& hello);
  /// Call once a tick: evaluates the hellos that wait for a round in recovery.
  void evaluateWaiting();
  /// Call when the client has received its newest token (Session::popWelcomeConfirmed).
  void confirmToken(Session& session);
  /// Creates sessions for the players of a killed server, who were in this room and may return.
  void restoreSessions(Room& room, const std::vector<PersistedSession>& sessions);
  /// Records the sessions of all players in the journal of the room's world. Call when that world is new.
  void recordSessions(const Room& room) const;
  /// Records a changed session in the journal of its world. Call before its client is told of the change.
  void recordSession(const Session& session) const;
  /// Moves a playing session to the room of this name. Returns a refusal for its player, or "" on success.
  /// `led`: moved by the server, so it does not count for the rate limit.
  std::string moveSession(Session& session, const std::string& room, bool led);
  /// Call when the session is over: its token becomes void.
  void forgetSession(const Session& session);
  /// Sets the password of new players; nullopt: they need none.
  void changePassword(std::optional<PasswordHash> hash);
  bool needsPassword() const { return m_needs_password; }
  /// Results of password checks; all zero if no password was ever needed.
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
  void replaceRestoredSession(Session& before, Session& session, const wire::Hello& hello);
  struct WaitingHello {
    std::uint64_t session = 0;
    std::shared_ptr<const wire::Hello> hello;
    std::chrono::steady_clock::time_point since;
  };
  std::chrono::milliseconds graceTime() const;
  PersistedSession persistedSession(const Session& session) const;
  wire::Welcome welcomeOf(const Room& room, std::uint32_t player, const std::string& name,
                          df::Color color) const;
  void admitPlayer(Session& session, const wire::Hello& hello);
  bool checkLimits(Session& session);
  void refuseFull(Session& session, const std::string& sentence);
  void describeRoom(const Room& room, wire::Welcome& welcome) const;
  Room* roomFor(Session& session, const wire::Hello& hello);
  Room* namedRoomFor(Session& session, const wire::Hello& hello);
  void refuseRoom(Session& session, const RoomAdmission::Refusal& refusal);
  void refuseBusy(Session& session, const std::string& sentence);
  template <class Visit>
  void forEachPlayer(Visit visit) const;
  std::string freeName(const std::string& wanted) const;
  df::Color freeColor(std::uint32_t player) const;
  std::uint32_t newPlayerId();
  wire::Welcome welcomeTo(Room& room, const std::string& name);
  std::unique_ptr<SealedChannel> openDatagrams(const Session& session, const wire::Hello& hello) const;

  void log(const Session& session, LogEvent event) const;

  Setup m_setup;
  const HostOptions& m_options;
  Counters& m_counters;
  FindBan m_find_ban;            ///< null: no bans
  FindRedirect m_find_redirect;  ///< null: no other servers
  const df::World* m_p_world = nullptr;
  ResumeTokens m_tokens;
  PrefixRateLimiter m_joins;
  PrefixRateLimiter m_new_worlds;
  RoomAdmission m_room_admission;
  std::unique_ptr<PasswordCheck> m_password;  ///< null: no password was needed yet
  bool m_needs_password = false;
  std::uint32_t m_newest_player = 0;    ///< highest player id that was given to a player
  std::vector<WaitingHello> m_waiting;  ///< hellos that wait for a round in recovery; at most one per session
};

}  // namespace naiad
