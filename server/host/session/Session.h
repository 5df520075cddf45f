// The server's side of one client: its streams, its state (STATES.md), its inputs and its snapshots.
//
// A session outlives its stream. When the stream breaks, the session continues over datagrams, or waits until
// the client reconnects and resumeOn() moves the new stream to it, or until the grace time ends.
//
// All input from the client is checked here; each rejection is counted. A client that breaks a rule ends only
// its own session. Single-threaded: the host's event loop and tick share a thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "host/net/SealedChannel.h"
#include "host/session/ClientActivity.h"
#include "host/session/Counters.h"
#include "host/session/ReceivedInputs.h"
#include "host/session/ReliableOutbox.h"
#include "host/session/SnapshotDelivery.h"
#include "host/session/StreamPair.h"
#include "shared/net/base/Channel.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/stream/ReliableFrames.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad {

namespace wire {
class ClientMessage;
class Hello;
class Ping;
enum Refused_Reason : int;
class ServerMessage;
class Welcome;
}  // namespace wire

/// Rate limit of a client's chat lines. It lasts for the whole session: only time refills it, not a new
/// stream. Reads no clock: callers pass the time.
class ChatRateLimiter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr double kPerSecond = 3;
  static constexpr double kBurst = 3;
  /// Maximum number of lines after a reconnect: the client may have queued these during its silence.
  static constexpr double kMaxSaved = 30;

  explicit ChatRateLimiter(Time now) : m_refilled(now) {}

  /// Counts a line. False if it is over the limit.
  bool tryConsume(Time now) {
    refill(now, kBurst);
    if (m_lines < 1) return false;
    m_lines -= 1;
    return true;
  }
  /// Call after a reconnect. Refills up to kMaxSaved for the time since `silent_since`, because the lines
  /// typed during the silence arrive at once.
  void refillAfterSilence(Time silent_since, Time now) {
    refill(silent_since, kBurst);
    refill(now, kMaxSaved);
  }

 private:
  /// Adds the lines allowed for the time since the last call, up to `most` in all. Never takes lines away.
  void refill(Time now, double most) {
    if (now <= m_refilled) return;
    const double seconds = std::chrono::duration<double>(now - m_refilled).count();
    m_refilled = now;
    if (m_lines < most) m_lines = std::min(most, m_lines + seconds * kPerSecond);
  }

  double m_lines = kBurst;
  Time m_refilled;
};

/// The terminal size that a client requested last. At most one size per kInterval is applied, because a new
/// size may cause half a world to be sent.
class ResizeRequest {
 public:
  using Time = std::chrono::steady_clock::time_point;
  struct Size {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
  };

  static constexpr std::chrono::milliseconds kInterval{250};

  /// Replaces the pending size. True if there was one.
  bool request(Size size) { return std::exchange(m_wanted, size).has_value(); }
  /// Copies the pending size of `other`.
  void continueFrom(const ResizeRequest& other) { m_wanted = other.m_wanted; }
  /// Removes and returns the size to apply now; nullopt if none is due.
  std::optional<Size> popDue(Time now) {
    if (!m_wanted || (m_applied && now - *m_applied < kInterval)) return std::nullopt;
    m_applied = now;
    return std::exchange(m_wanted, std::nullopt);
  }

 private:
  std::optional<Size> m_wanted;
  std::optional<Time> m_applied;  ///< time at which a size was last applied
};

/// A player's join time, last activity and rights, which the game does not need. Callers pass the time.
class SessionStatus {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Call when the client was welcomed.
  void begin(Time now) { m_joined = m_last_activity = m_idle_since = m_checked = now; }
  /// Call for each key, click or line of chat.
  void onActivity(Time now) {
    m_last_activity = m_idle_since = now;
    m_excused = true;
  }
  /// Call when the session continues on another stream; counts as activity. Ends admin rights, because a
  /// resume token must not grant them.
  void changeStream(Time now) {
    onActivity(now);
    m_admin = false;
    ++m_streams;
  }
  /// Call once a tick. `watches`: the game lets the player only watch or wait. That time is not idle, unless
  /// the player was inactive while the game last let them act.
  void setWatching(bool watches, Time now) {
    if (watches && m_excused) m_idle_since = std::min(now, m_idle_since + (now - m_checked));
    if (!watches && m_watches) m_excused = false;
    m_watches = watches;
    m_checked = now;
  }
  Time::duration idle(Time now) const { return now - m_idle_since; }

  Time joined() const { return m_joined; }
  Time lastActivity() const { return m_last_activity; }
  bool isAdmin() const { return m_admin; }
  void setAdmin() { m_admin = true; }
  bool isMuted() const { return m_muted; }
  void setMuted(bool muted) { m_muted = muted; }
  /// Number of earlier streams of this session.
  std::uint32_t streams() const { return m_streams; }

 private:
  Time m_joined{};
  Time m_last_activity{};
  Time m_idle_since{};
  Time m_checked{};       ///< time of the last setWatching()
  bool m_watches = true;  ///< argument of the last setWatching()
  bool m_excused = true;  ///< active since the game last began to let the player act
  std::uint32_t m_streams = 0;
  bool m_admin = false;
  bool m_muted = false;
};

class Session {
 public:
  using Clock = std::chrono::steady_clock;

  /// Callbacks to the host, called from the event loop. The host must answer a hello by refuse(), welcome(),
  /// or another session's resumeOn(), restart() or attachSecondStream(). After kAdmissionTimeout without an
  /// answer, the session refuses the hello itself.
  struct Events {
    std::function<void(Session&, const wire::Hello&)> on_hello;
    std::function<void(Session&, const std::string& text)> on_chat;
    std::function<void(Session&)> on_gone;   ///< the session is ending; called at most once
    std::function<Clock::time_point()> now;  ///< the time; if empty, std::chrono::steady_clock is used
    /// The client is being refused; `sentence` is the reason that is sent to the client.
    std::function<void(Session&, const std::string& sentence)> on_refused = {};
    std::function<void(Session&)> on_list_rooms = {};
    std::function<void(Session&, const std::string& room)> on_enter_room = {};
  };

  enum class State { kGreeting, kPlaying, kEnding, kGone };

  static constexpr std::chrono::seconds kLoginTimeout{5};
  /// Time limit for the answer to a hello; less than the 5 s that a client waits for it.
  static constexpr std::chrono::seconds kAdmissionTimeout{4};
  static constexpr std::chrono::seconds kIdleTimeout{15};
  /// Silence after which the keys of a detached player are released, if datagrams passed when the stream
  /// broke. Otherwise detach() releases them at once.
  static constexpr std::chrono::seconds kKeyReleaseDelay{1};
  /// Rate limit of resumes, on another stream or by another process. Players do not notice a connection that
  /// breaks once a second, but each resume may send a world from the beginning.
  static constexpr BucketRate kResumeRate{.per_second = 1, .burst = 3};
  /// Rate limit of new second streams. Clients ask at most every two seconds.
  static constexpr BucketRate kSecondStreamRate{.per_second = 0.5, .burst = 4};
  /// Unsent bytes above which sendBestEffort() drops its message and messages of sendReliable() wait.
  static constexpr std::size_t kMaxUnsentForBestEffort = std::size_t{4} * 1024;

  Session(std::unique_ptr<ReliableChannel> channel, Counters& counters, Clock::time_point now);
  ~Session();
  /// Sets the session's id, unique while the host runs.
  void setId(std::uint64_t id) { m_id = id; }
  std::uint64_t id() const { return m_id; }
  /// Starts to receive. Not part of the constructor, because callbacks need a finished session.
  void start(Events events);

  /// Answers the hello with a refusal and ends the connection. `redirect`: link to a server with a free
  /// place, `room`: the room to join there; both may be empty.
  void refuse(wire::Refused_Reason reason, const std::string& sentence, const std::string& redirect = "",
              const std::string& room = "");
  /// Answers the hello; the client now plays. `datagrams`: null if snapshots may use only the stream.
  void welcome(const wire::Welcome& welcome, std::unique_ptr<SealedChannel> datagrams = nullptr);
  /// Call instead of start(), for a session of a killed server. It has no stream, and its client knows only
  /// the resume token. It waits until the client's new session replaces it: replaceRestored().
  void restore(const wire::Welcome& welcome, Events events);
  /// True for a restored session, and for a session that replaced one until confirm(). Such a session cannot
  /// be resumed by resumeOn() or restart(), because its client may not have read its welcome.
  bool isRestored() const { return m_restored; }
  /// Call after welcome(): this session replaces `restored`, which ends. Keeps its mute and resume limit.
  void replaceRestored(Session& restored);
  /// Call once the client has proved that it read the welcome (popWelcomeConfirmed()).
  void confirm() { m_restored = false; }
  /// Counts a resume. False if it is over the limit (kResumeRate): then the session keeps waiting, and its
  /// grace time starts again.
  bool admitResume();
  /// Resumes after a reconnect: takes the stream on which `other` received its hello, answers the hello, and
  /// sends all reliable frames after number `received` again. `other` is kGone afterwards.
  void resumeOn(Session& other, wire::Welcome welcome, std::uint32_t received);
  /// Resumes in another client process, which has no state. Like resumeOn(), but the world is sent from the
  /// beginning, with `datagrams` for the new process (may be null). An old process that is still connected
  /// gets a goodbye through `other`, which is kEnding then.
  void restart(Session& other, wire::Welcome welcome, std::unique_ptr<SealedChannel> datagrams);
  /// Counts a second stream. False if it is over the limit (kSecondStreamRate).
  bool admitSecondStream();
  /// Adds the stream on which `other` received its hello as second stream, for small snapshots and for
  /// updates from the client. Without datagrams, a lost packet then delays only one of the two streams.
  /// `other` is kGone afterwards. An earlier second stream is closed; this one ends with the first stream.
  void attachSecondStream(Session& other);
  bool hasSecondStream() const { return m_streams.hasSecond(); }
  /// Rate limit of requests for the room list or for another room.
  static constexpr BucketRate kRoomRate{.per_second = 2, .burst = 4};
  /// Counts a request by the client or its game. False if it is over the limit.
  bool admitRoomRequest() { return m_room_requests.tryConsume(kRoomRate, now()); }
  /// True if the client supports rooms, so it can be moved to another one.
  bool supportsRooms() const { return m_supports_rooms; }
  /// Moves the session to another room's world, described by `welcome`. The client gets a message about the
  /// room, then its world from the beginning; if detached, a welcome with the new room when it resumes.
  void enterRoom(const wire::Welcome& welcome);
  /// Call when another world begins: sends it from the beginning, and drops the inputs to the previous one.
  void beginWorld();
  /// Sets how long to wait for the client after its stream broke; 0: the session ends at once.
  void setGrace(std::chrono::milliseconds grace) { m_grace = grace; }
  /// True while the stream is broken and the client may reconnect.
  bool isDetached() const { return m_state == State::kPlaying && m_streams.first() == nullptr; }
  /// True once per welcome: the client has read it, because it has sent a frame on the first stream since.
  bool popWelcomeConfirmed() { return m_state == State::kPlaying && m_activity.popWelcomeConfirmed(); }
  /// The welcome without its resume token, because only the hash is stored (ResumeTokens).
  const wire::Welcome& welcomed() const { return *m_welcome; }
  SealedChannel* datagrams() { return m_delivery.datagrams(); }
  /// Returns the first stream; null while detached.
  const ReliableChannel* stream() const { return m_streams.first(); }
  /// Returns keying material of the stream (Channel.h); empty while detached.
  std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;
  /// Sends the reason and ends the session. `again`: the server will be back within this time; 0: never.
  void sendGoodbye(const std::string& sentence, std::chrono::seconds again = std::chrono::seconds(0));

  /// Enforces deadlines. Call once a tick. A long gap between calls is not silence of the client (IdleTimer).
  void checkDeadlines(Clock::time_point now);
  /// Calls `apply(input)` for the inputs that are due in `tick`, the world's next tick.
  template <class Apply>
  void drainInputs(std::uint32_t tick, Apply apply) {
    m_inputs.popDue(tick, [&](const Input& input) {
      apply(input);
      m_delivery.setNewestInput(input.id, tick);
    });
  }

  /// Returns which ticks the client showed when the player clicked; unknown for keys and forgotten snapshots.
  df::ViewedTick viewedTick(const Input& input) const;

  /// Sets the controls that the player steers with (ReceivedInputs::setControls).
  void setControls(const std::shared_ptr<const df::ControlTable>& controls) {
    m_inputs.setControls(controls);
  }

  /// Starts or stops the audit of the client's pictures (ReplicaAudit.h). It starts when a world is next sent
  /// from the beginning.
  void setAudit(bool audit) { m_delivery.setAudit(audit); }
  bool isAudited() { return m_delivery.audit() != nullptr; }
  /// Call only while audited. Records the picture of the tick that the next sendTick() sends.
  void recordTruth(std::uint32_t tick, df::Canvas picture) {
    m_delivery.audit()->recordTruth(tick, std::move(picture));
  }

  /// Sends the published tick's pending changes, unless the client or connection is busy with earlier bytes.
  void sendTick(const Publisher& publisher, const df::PlayerFacts& player);
  void send(const wire::ServerMessage& message);
  /// Sends the message reliably, if needed on a later stream. Kept until the client acknowledges it, or
  /// dropped if too much is kept (ReliableOutbox.h). For chat, player lists and sounds.
  void sendReliable(const wire::ServerMessage& message);

  /// Sends if the first stream has at most kMaxUnsentForBestEffort unsent bytes. Returns whether it was sent.
  bool sendBestEffort(const wire::ServerMessage& message);

  State state() const { return m_state; }
  /// The host's time (Events::now).
  Clock::time_point now() const { return m_events.now ? m_events.now() : Clock::now(); }
  bool hasHello() const { return m_has_hello; }
  std::uint32_t player() const { return m_player; }
  const std::string& name() const;
  /// Returns how the player left, for the log; valid from Events::on_gone on.
  const std::string& leaveReason() const { return m_leave.reason; }
  std::string address() const { return m_streams.peerAddress(); }
  /// Ticks after which the client was not up to date: it or its connection was busy with earlier bytes.
  std::uint64_t skippedTicks() const { return m_delivery.skippedTicks(); }
  /// Newest round-trip time measured by the client, in milliseconds; 0 before the first.
  std::uint32_t rttMillis() const { return m_rtt_millis; }
  /// Join time, last activity and rights of the player.
  SessionStatus& status() { return m_status; }
  const SessionStatus& status() const { return m_status; }
  const TransportSelector& transport() const { return m_delivery.transport(); }
  /// State of the client's snapshots.
  const SnapshotSender& sender() const { return m_delivery.sender(); }

 private:
  /// The reason for which the player leaves: its counter, and its words in the log.
  struct Leave {
    std::uint64_t Counters::*counter = &Counters::left_dismissed;
    std::string reason;
  };
  /// Sets the reason unless one was set before.
  void setLeaveReason(std::uint64_t Counters::*counter, const std::string& reason) {
    if (m_leave.reason.empty()) m_leave = {counter, reason};
  }
  void onFrame(std::string_view frame);
  void onSecondFrame(std::string_view frame);
  void onSecondClosed(CloseReason reason);
  void onDatagram(std::string_view bytes);
  void onClosed(CloseReason reason);
  /// Continues without a stream: over datagrams if they pass; otherwise releases the player's keys now.
  void detach(Clock::time_point now);
  void adoptStream(Session& other);
  void sendWelcome(const wire::Welcome& welcome);
  void sendWaiting();
  void beginPlay(const wire::Welcome& welcome);
  void startDatagrams(std::unique_ptr<SealedChannel> datagrams);
  void releaseKeys() { m_inputs.releaseKeys(m_delivery.tick()); }
  void checkGreeting(Clock::time_point now);
  void checkSilence(Clock::time_point now);
  bool acceptMessage();
  bool dispatch(const wire::ClientMessage& message);
  bool handleUpdate(std::string_view bytes, bool by_datagram);
  void handleInput(const Input& input);
  void handleHello(const wire::Hello& hello);
  void handleChat(const std::string& text);
  void handleRoomRequest(const wire::ClientMessage& message);
  void handlePing(const wire::Ping& ping);
  void endMalformed();
  void reportGone();
  void end();

  State m_state = State::kGreeting;
  std::uint32_t m_player = 0;  ///< copy of the id in m_welcome, which is rarely in the cache
  bool m_reported_gone = false;
  Leave m_leave;
  bool m_has_hello = false;  ///< the hello was received
  bool m_restored = false;
  bool m_supports_rooms = false;
  std::uint32_t m_rtt_millis = 0;
  Counters& m_counters;
  Events m_events;
  StreamPair m_streams;
  ClientActivity m_activity;
  ChatRateLimiter m_chat;
  SessionStatus m_status;
  ResizeRequest m_resize;
  ReceivedInputs m_inputs;
  TokenBucket m_resumes;
  TokenBucket m_second_streams;
  TokenBucket m_room_requests;
  ReliableOutbox m_outbox;
  ReliableFrameReceiver m_reliable_received;
  SnapshotDelivery m_delivery;
  std::chrono::milliseconds m_grace{0};
  std::uint64_t m_id = 0;
  std::unique_ptr<wire::Welcome> m_welcome;
};

}  // namespace naiad
