// One client on the server's side: its streams, its state (STATES.md), its inputs and its snapshots.
//
// A session is more than its stream: when that breaks, the session goes on over datagrams, or waits, until
// the client comes back on another stream and adopt() gives it to the session, or the grace time is over.
//
// Everything the client sends is checked here and counted where it is refused; a session that breaks a rule
// ends alone. Time is passed in. Single-threaded: the host's event loop and tick share a thread.
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

/// How many lines of chat a client may send now.
/// One for a session, whatever becomes of its streams: only time refills it. Time is passed in.
class ChatAllowance {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr double kPerSecond = 3;
  static constexpr double kAtOnce = 3;
  /// Lines at once from a client that comes back, if it was silent long enough to have typed them.
  static constexpr double kSaved = 30;

  explicit ChatAllowance(Time now) : m_refilled(now) {}

  /// False if the line is one too many.
  bool takeLine(Time now) {
    refill(now, kAtOnce);
    if (m_lines < 1) return false;
    m_lines -= 1;
    return true;
  }
  /// The client is back, on another stream, and nothing had come since `silent_since`: what was typed
  /// meanwhile comes all at once.
  void refillAfterSilence(Time silent_since, Time now) {
    refill(silent_since, kAtOnce);
    refill(now, kSaved);
  }

 private:
  /// Up to `most` lines; if there are more, they stay.
  void refill(Time now, double most) {
    if (now <= m_refilled) return;
    const double seconds = std::chrono::duration<double>(now - m_refilled).count();
    m_refilled = now;
    if (m_lines < most) m_lines = std::min(most, m_lines + seconds * kPerSecond);
  }

  double m_lines = kAtOnce;
  Time m_refilled;
};

/// The terminal size that a client asked for last, applied at most four times a second: each new size may
/// cost half a world.
class ResizeRequest {
 public:
  using Time = std::chrono::steady_clock::time_point;
  struct Size {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
  };

  static constexpr std::chrono::milliseconds kEvery{250};

  /// True if this replaces a size that was not applied.
  bool request(Size size) { return std::exchange(m_wanted, size).has_value(); }
  /// Go on with what was requested from `other`.
  void continueFrom(const ResizeRequest& other) { m_wanted = other.m_wanted; }
  /// The size to apply now, if any.
  std::optional<Size> takeDue(Time now) {
    if (!m_wanted || (m_applied && now - *m_applied < kEvery)) return std::nullopt;
    m_applied = now;
    return std::exchange(m_wanted, std::nullopt);
  }

 private:
  std::optional<Size> m_wanted;
  std::optional<Time> m_applied;  ///< when a size was applied last
};

/// What a host knows of a player beside the game: since when they play, and what they may do.
/// Time is passed in.
class SessionStanding {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The client was welcomed.
  void begin(Time now) { m_joined = m_acted = now; }
  /// A key, a click or a line of chat came.
  void noteAction(Time now) { m_acted = now; }
  /// The session goes on with another stream, which is a sign of life. An admin's rights end, since a resume
  /// token must not give them.
  void changeStream(Time now) {
    m_acted = now;
    m_admin = false;
    ++m_streams;
  }

  Time joined() const { return m_joined; }
  Time acted() const { return m_acted; }
  bool isAdmin() const { return m_admin; }
  void setAdmin() { m_admin = true; }
  bool isMuted() const { return m_muted; }
  void setMuted(bool muted) { m_muted = muted; }
  /// How many streams the session has had before the present one.
  std::uint32_t streams() const { return m_streams; }

 private:
  Time m_joined{};
  Time m_acted{};
  std::uint32_t m_streams = 0;
  bool m_admin = false;
  bool m_muted = false;
};

class Session {
 public:
  using Clock = std::chrono::steady_clock;

  /// What a session asks of the host. Called from the event loop; the callee may refuse() or welcome(), at
  /// once or within kJudgeTimeout.
  struct Events {
    std::function<void(Session&, const wire::Hello&)> on_hello;
    std::function<void(Session&, const std::string& text)> on_chat;
    std::function<void(Session&)> on_gone;   ///< the session is ending; called once
    std::function<Clock::time_point()> now;  ///< empty: std::chrono::steady_clock
    /// The client is being refused, with this sentence.
    std::function<void(Session&, const std::string& sentence)> on_refused = {};
    std::function<void(Session&)> on_list_rooms = {};
    std::function<void(Session&, const std::string& room)> on_enter_room = {};
  };

  enum class State { kGreeting, kPlaying, kEnding, kGone };

  static constexpr std::chrono::seconds kLoginTimeout{5};
  /// A hello is judged before its client stops waiting for an answer (after 5 s).
  static constexpr std::chrono::seconds kJudgeTimeout{4};
  static constexpr std::chrono::seconds kIdleTimeout{15};
  /// After this silence the keys of a player without a stream are released.
  static constexpr std::chrono::seconds kSuspend{1};
  /// How often a session may go on with another stream, or another process. A line that breaks every second
  /// is not noticed; each return may cost a world that is sent from the beginning.
  static constexpr BucketRate kResumeRate{.per_second = 1, .burst = 3};
  /// How often it may have another second stream. Clients ask every two seconds at most.
  static constexpr BucketRate kSecondRate{.per_second = 0.5, .burst = 4};
  /// With more than this unsent on the stream, a message arrives too late for sendFleeting(), and kept ones
  /// wait for their turn.
  static constexpr std::size_t kMaxBeforeFleeting = std::size_t{4} * 1024;

  Session(std::unique_ptr<ReliableChannel> channel, Counters& counters, Clock::time_point now);
  ~Session();
  /// Names the session for as long as the host runs.
  void setId(std::uint64_t id) { m_id = id; }
  std::uint64_t id() const { return m_id; }
  /// Begin to receive. Not in the constructor: callbacks need a finished session.
  void start(Events events);

  /// Answer the hello with a refusal; the connection ends. `redirect`: a link to where there is a place,
  /// `room`: in which of its rooms.
  void refuse(wire::Refused_Reason reason, const std::string& sentence, const std::string& redirect = "",
              const std::string& room = "");
  /// Answer the hello: the client plays from now on. With `datagrams` if there are to be any.
  void welcome(const wire::Welcome& welcome, std::unique_ptr<SealedChannel> datagrams = nullptr);
  /// Instead of start(): it has no stream, and its client knows nothing of it but a token. So are sessions of
  /// a server that was killed. It waits for the client, who goes on with another session (retire()).
  void restore(const wire::Welcome& welcome, Events events);
  /// The client cannot go on with it as it is, since it has not proved that it knows it (takeProof()), and it
  /// was restored, or took over from one that was.
  bool isRestored() const { return m_restored; }
  /// Its client goes on with this session, which was welcomed, in the place of one that was restored.
  void takeOver(Session& restored);
  /// The client has proved that it knows it.
  void confirm() { m_restored = false; }
  /// The client is back: may it go on now (kResumeRate)? If not, nothing changes, and its session waits on.
  bool admitResume();
  /// The client is back: take over the stream on which `other` heard its hello, answer the hello, and send
  /// again all reliable frames after number `received`. `other` is Gone afterwards.
  void adopt(Session& other, wire::Welcome welcome, std::uint32_t received);
  /// Another process of the client, which knows nothing yet, goes on with the session: as adopt(), but the
  /// world is sent from the beginning, and with `datagrams` of its own, if any. A process that still holds
  /// the old stream gets a goodbye.
  void restart(Session& other, wire::Welcome welcome, std::unique_ptr<SealedChannel> datagrams);
  /// May it have another second stream now (kSecondRate)? If not, nothing changes.
  bool admitSecond();
  /// From now on small snapshots also go on the stream on which `other` heard its hello, beside this one's:
  /// where datagrams do not pass, a packet that one stream waits for does not hold up the other. Updates come
  /// on both. `other` is Gone afterwards; a second stream that was there before ends, and this one ends with
  /// the first.
  void accompany(Session& other);
  bool hasSecondStream() const { return m_streams.hasSecond(); }
  /// How often the client may ask for the list of rooms, or for another room.
  static constexpr BucketRate kRoomRate{.per_second = 2, .burst = 4};
  /// May the client, or its game, ask once more? If not, nothing changes.
  bool admitRoomRequest() { return m_room_requests.takeToken(kRoomRate, now()); }
  /// Can the client be led to another room?
  bool knowsRooms() const { return m_knows_rooms; }
  /// The session, which has a stream, goes on in another room's world, as this welcome says: its client hears
  /// of it before it is sent that world from the beginning.
  void enterRoom(const wire::Welcome& welcome);
  /// Another world begins: the client forgets what it knows, and its inputs to the one before are dropped.
  void beginWorld();
  /// How long to wait for the client after its stream broke; 0: not at all.
  void setGrace(std::chrono::milliseconds grace) { m_grace = grace; }
  /// The stream is broken; the client may come back.
  bool isDetached() const { return m_state == State::kPlaying && m_streams.first() == nullptr; }
  /// The client has sent a frame on its newest stream since it was welcomed there, so it has read the
  /// welcome. True once for each stream.
  bool takeProof() { return m_activity.takeProof(); }
  /// As it was sent, but without the resume token, of which only the hash is kept (ResumeTokens).
  const wire::Welcome& welcomed() const { return *m_welcome; }
  SealedChannel* datagrams() { return m_delivery.datagrams(); }
  /// Null while detached.
  const ReliableChannel* stream() const { return m_streams.first(); }
  /// Keying material of the stream (Channel.h).
  std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;
  /// Send the client the reason, and end. `again`: the server is back within this time; 0: it is not.
  void goodbye(const std::string& sentence, std::chrono::seconds again = std::chrono::seconds(0));

  /// Enforce deadlines. Once a tick: time between two calls that are far apart does not count as silence of
  /// the client (IdleTimer).
  void checkDeadlines(Clock::time_point now);
  /// Call `apply(input)` for the inputs that are due in the world's next tick, `tick`.
  template <class Apply>
  void takeInputs(std::uint32_t tick, Apply apply) {
    m_inputs.takeDue(tick, [&](const Input& input) {
      apply(input);
      m_delivery.noteInput(input.id, tick);
    });
  }

  /// The picture that the player clicked in, as far as that is known: for mouse inputs only.
  df::ViewedTick viewedTick(const Input& input) const;

  /// The controls that the player steers by (ReceivedInputs::setControls).
  void setControls(const std::shared_ptr<const df::ControlTable>& controls) {
    m_inputs.setControls(controls);
  }

  /// Audit the client's pictures (PictureAudit.h) from the next world on that it is sent from the beginning,
  /// or do no longer.
  void setAudit(bool audit) { m_delivery.setAudit(audit); }
  bool isAudited() { return m_delivery.audit() != nullptr; }
  /// While it is audited: what the world shows its player in the tick that sendTick() is about to send.
  void recordTruth(std::uint32_t tick, df::Canvas picture) {
    m_delivery.audit()->recordTruth(tick, std::move(picture));
  }

  /// Note a published tick, and send what is pending unless the client is still busy with earlier bytes.
  void sendTick(const Publisher& publisher, const df::PlayerFacts& player);
  void send(const wire::ServerMessage& message);
  /// Send it so that it arrives, on this stream or another one: it is kept until the client has it, or left
  /// out if there is too much (ReliableOutbox.h). For chat, players and sounds.
  void sendKept(const wire::ServerMessage& message);

  /// Send it if it can arrive at once; late, it is worthless. Return whether it was sent.
  bool sendFleeting(const wire::ServerMessage& message);

  State state() const { return m_state; }
  /// The host's time (Events::now).
  Clock::time_point now() const { return m_events.now ? m_events.now() : Clock::now(); }
  /// The hello has come.
  bool isGreeted() const { return m_greeted; }
  std::uint32_t player() const { return m_player; }
  const std::string& name() const;
  std::string address() const { return m_streams.peerAddress(); }
  /// Ticks at whose end this client was not up to date, since it or its line was busy with earlier bytes.
  std::uint64_t skippedTicks() const { return m_delivery.skippedTicks(); }
  /// The round trip the client measured last, in milliseconds; 0: not yet.
  std::uint32_t rttMillis() const { return m_rtt_millis; }
  /// Since when the player is here, and what they may do.
  SessionStanding& standing() { return m_standing; }
  const SessionStanding& standing() const { return m_standing; }
  const TransportSelector& transport() const { return m_delivery.transport(); }
  /// What the client has been sent.
  const SnapshotSender& sender() const { return m_delivery.sender(); }

 private:
  /// Why its player leaves.
  using Leave = std::uint64_t Counters::*;
  /// It ends for this reason, unless it had one before.
  void setLeave(Leave leave) {
    if (m_leave == &Counters::left_dismissed) m_leave = leave;
  }
  void onFrame(std::string_view frame);
  void onSecondFrame(std::string_view frame);
  void onSecondClosed(CloseReason reason);
  void onDatagram(std::string_view bytes);
  void onClosed(CloseReason reason);
  void detach(Clock::time_point now);
  void takeStream(Session& other);
  void sendWelcome(const wire::Welcome& welcome);
  void sendWaiting();
  void startDatagrams(std::unique_ptr<SealedChannel> datagrams);
  void releaseKeys() { m_inputs.releaseKeys(m_delivery.tick()); }
  void checkGreeting(Clock::time_point now);
  void checkSilence(Clock::time_point now);
  bool acceptMessage();
  bool dispatch(const wire::ClientMessage& message);
  bool takeUpdate(std::string_view bytes, bool by_datagram);
  void takeInput(const Input& input);
  void takeHello(const wire::Hello& hello);
  void takeChat(const std::string& text);
  void takeRoomRequest(const wire::ClientMessage& message);
  void takePing(const wire::Ping& ping);
  void endMalformed();
  void reportGone();
  void end();

  State m_state = State::kGreeting;
  std::uint32_t m_player = 0;  ///< of m_welcome, which is seldom in the cache
  bool m_reported_gone = false;
  Leave m_leave = &Counters::left_dismissed;
  bool m_greeted = false;  ///< the hello has come
  bool m_restored = false;
  bool m_knows_rooms = false;
  std::uint32_t m_rtt_millis = 0;
  Counters& m_counters;
  Events m_events;
  StreamPair m_streams;
  ClientActivity m_activity;
  ChatAllowance m_chat;
  SessionStanding m_standing;
  ResizeRequest m_resize;
  ReceivedInputs m_inputs;
  TokenBucket m_resumes;
  TokenBucket m_seconds;
  TokenBucket m_room_requests;
  ReliableOutbox m_outbox;
  ReliableFramesHeard m_kept_heard;
  SnapshotDelivery m_delivery;
  std::chrono::milliseconds m_grace{0};
  std::uint64_t m_id = 0;
  std::unique_ptr<wire::Welcome> m_welcome;
};

}  // namespace naiad
