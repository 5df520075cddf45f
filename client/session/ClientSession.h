// One session with a server, as the client sees it: the protocol's state machine (proto/STATES.md).
//
//   kGreeting --Welcome--> kPlaying --Goodbye--> kEnded
//       |                     +--channel closed, 15 s of silence--> kLost
//       +--Refused--> kRefused          (a bad message ends any state in kEnded; leave() in kLeft)
//
// The session knows no socket and no clock: the owner hands it every frame and every time (Connection does
// for the programs, the tests do it by hand). Everything received passes readServerMessage() first.
// Not thread-safe. Memory is bounded whatever the server sends.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/session/ChatLog.h"
#include "client/session/InputBudget.h"
#include "client/session/InputOutbox.h"
#include "client/session/RoundTrip.h"
#include "client/session/SealedDatagrams.h"
#include "client/session/SecondStream.h"
#include "client/session/ServerMessages.h"
#include "client/session/SessionOptions.h"
#include "client/session/UpdateTiming.h"
#include "client/world/DisplayClock.h"
#include "client/world/InputTickEstimator.h"
#include "client/world/Prediction.h"
#include "client/world/WorldFeed.h"
#include "shared/net/base/Channel.h"
#include "shared/net/base/IdleTimer.h"
#include "shared/net/stream/ReliableFrames.h"
#include "shared/replica/Acks.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"

namespace naiad {
namespace wire {
class ClientMessage;
}

/// What went over the wire so far. Bytes are frame payloads plus two bytes of header each.
struct SessionCounters {
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t stale_snapshots = 0;  ///< they named what newer ones had replaced: dropped
  std::uint64_t inputs = 0;
  std::uint64_t inputs_dropped = 0;  ///< kept back: too many, or the line is stuck
  std::uint64_t chat_lines = 0;
  std::uint64_t sounds = 0;
  std::uint64_t chat_dropped = 0;     ///< not sent: too much waits to be sent again
  std::uint64_t repeated_frames = 0;  ///< kept frames that had come already: ignored
  std::uint64_t datagrams_in = 0;     ///< with a snapshot; their bytes are in bytes_in, headers not counted
  std::uint64_t resets = 0;           ///< the world came anew
  std::uint64_t bad_messages = 0;
};

class ClientSession {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class State { kGreeting, kPlaying, kRefused, kEnded, kLost, kLeft };

  static constexpr std::chrono::seconds kGreetingTimeout{5};
  /// Silence after which the stream is given up, and the session, too, if it cannot be resumed.
  static constexpr std::chrono::seconds kIdleTimeout{15};
  /// Silence after which a session without a stream is given up.
  static constexpr std::chrono::seconds kDetachedTimeout{60};
  static constexpr std::chrono::seconds kPingInterval{1};
  /// Pings while datagrams pass: these say most of what a ping would.
  static constexpr std::chrono::seconds kSeldomPing{5};
  /// A stream on which a ping stays unanswered for so long is taken to be dead.
  static constexpr std::chrono::seconds kStreamSilence{10};
  static constexpr std::chrono::milliseconds kPassing = UpdateTiming::kPassing;
  static constexpr std::uint32_t kMaxUnapplied = InputOutbox::kMax;
  static constexpr std::size_t kMaxChatLog = ChatLog::kMax;
  static constexpr std::size_t kMaxUnheard = 32;  ///< sounds, if nobody takes them
  static constexpr std::chrono::seconds kChecksumEvery{1};
  /// So many bytes of kept frames are acknowledged at once, not with the next ping.
  static constexpr std::size_t kMuchKept = std::size_t{8} * 1024;

  /// Takes the connected channel and says Hello. The owner starts the channel and passes what it delivers
  /// to receive() and closed().
  ClientSession(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options, Time now);
  ClientSession(const ClientSession&) = delete;
  ClientSession& operator=(const ClientSession&) = delete;

  /// Without a stream, and waiting for another one: adopt().
  bool isDetached() const { return m_state == State::kPlaying && m_channel == nullptr; }
  /// Number of the newest kept frame that came, for who resumes the session.
  std::uint32_t receivedFrames() const { return m_kept_heard.newest(); }
  /// The server said that an earlier session goes on here.
  bool isResumed() const { return m_state == State::kPlaying && m_welcome.resumed; }
  bool owns(const ReliableChannel* channel) const { return m_channel.get() == channel; }
  /// Go on with the stream on which `other` was welcomed back (welcome().resumed).
  void adopt(ClientSession& other, Time now);
  /// Datagrams do not pass, and it is time to open a second stream: startSecond(). Says so once for each
  /// attempt.
  bool wantsSecond(Time now);
  void startSecond(std::unique_ptr<ReliableChannel> channel);
  bool hasSecondStream() const { return m_second.isOpen(); }
  /// Do datagrams come from the server?
  bool hasDatagrams(Time now) const { return m_datagrams != nullptr && m_timing.hasDatagrams(now); }

  /// Has the server been heard lately, on either way?
  bool isHeard(Time now) const { return m_state == State::kPlaying && m_idle.at(now) < kPassing; }

  /// A frame from the server.
  void receive(std::string_view frame, Time now);
  /// The channel ended by itself.
  void closed(CloseReason reason);
  /// Pings and time-outs. Call about ten times a second: time in which nobody calls does not count as silence
  /// of the server (IdleTimer.h).
  void update(Time now);

  /// Send a key or mouse action of the player, at once. False if it was not sent: not playing, or too many.
  bool sendKey(df::Keyboard::Key key, df::EventKeyboardAction action, Time now);
  /// `x`, `y`: cell of the view.
  bool sendMouse(df::EventMouseAction action, df::Mouse::Button button, int x, int y, Time now);
  /// Say something to all players; nothing if no drawable character is left of it. Without a stream it waits
  /// for the next one.
  void sendChat(const std::string& text);
  void sendResize(int columns, int rows);
  /// Leave on purpose: the server is told, the channel closes after what is queued.
  void leave();

  State state() const { return m_state; }
  /// Refused, but another try in a moment may do.
  bool isRefusedForNow() const { return m_refused_for_now; }
  /// Neither waiting for the server nor playing any more.
  bool isOver() const { return m_state != State::kGreeting && m_state != State::kPlaying; }
  /// Why the session is over, for people. Empty while it is not, or after leave().
  const std::string& sentence() const { return m_sentence; }
  /// There is a picture to show: all of the world has come, or as much as came in half a second.
  bool hasPicture(Time now) const { return m_world.hasPicture(now); }

  const WelcomeMessage& welcome() const { return m_welcome; }
  const Replica& replica() const { return m_world.shown(); }
  const std::vector<PlayerLine>& players() const { return m_players; }
  const std::deque<ChatEntry>& chat() const { return m_chat.entries(); }
  const SessionCounters& counters() const { return m_counters; }
  /// What the game sounded since this was asked last, oldest first; the newest kMaxUnheard of it.
  std::vector<SoundLine> takeSounds() { return std::exchange(m_sounds, {}); }
  /// Points of this player, from the newest player list.
  std::int32_t score() const;

  /// Work out where the player's own object is by now, if the game declared how keys move it. Before drawing.
  const Prediction& predict(Time now);
  /// The tick that predict() runs to: the one that takes in a key pressed now, so that it shows in the next
  /// frame.
  std::uint32_t predictedTick(Time now) const;
  bool isPredicting() const { return m_prediction.isActive(); }
  const InputTickEstimator& takeInClock() const { return m_input_tick_estimator; }

  /// The tick to draw now, whether the line is silent, the newest tick known.
  std::uint32_t displayTick(Time now) { return m_clock.displayTick(now); }
  const DisplayClock& clock() const { return m_clock; }
  bool isSilent(Time now) const { return m_state == State::kPlaying && m_clock.isSilent(now); }
  /// Smoothed round trip; zero before the first measurement.
  std::chrono::milliseconds roundTrip() const { return m_round_trip.shown(); }
  /// Counts up with every change that can be seen on a screen.
  std::uint64_t revision() const { return m_revision; }

  /// When update() has something to do before its usual time; nothing if it has not.
  std::optional<Time> nextWake() const { return m_timing.nextWake(); }

  /// Called before a snapshot of `tick` is applied: the replica is still as it was. For recorders.
  void onBeforeSnapshot(std::function<void(std::uint32_t tick)> observer) {
    m_observer = std::move(observer);
  }
  /// Called after a snapshot was applied, with what it said of itself and what has arrived by now. For checks
  /// that hold the picture against the server's.
  void onAfterSnapshot(std::function<void(const SnapshotHeader& header, const AckWindow& acks)> observer) {
    m_after_observer = std::move(observer);
  }

 private:
  void handle(WelcomeMessage&& message, Time now);
  void handle(RefusedMessage&& message, Time now);
  void handle(GoodbyeMessage&& message, Time now);
  void handle(SnapshotMessage&& message, Time now);
  void handle(PlayersMessage&& message, Time now);
  void handle(ChatMessage&& message, Time now);
  void handle(SoundsMessage&& message, Time now);
  void handle(const PongMessage& message, Time now);
  void reject(const std::string& what);
  void finish(State state, std::string sentence);
  void send(const wire::ClientMessage& message);
  void sendFrame(const std::string& frame);
  void noteRoundTrip(RoundTrip::Millis sample);
  bool sendInput(Input input, bool urgent, Time now);
  void sendUpdate(Time now);
  void takeSnapshot(std::string_view bytes, Time now);
  void onSecond(std::string_view bytes, Time now);
  void takeControls();
  bool takeKept(std::uint32_t number);
  void openDatagrams(Time now);
  void onDatagram(std::string_view bytes, Time now);
  ClientUpdate nextUpdate(bool in_order, Time now);
  void probe(Time now);
  void ping(Time now);
  KeyExporter exporter() const;

  std::unique_ptr<ReliableChannel> m_channel;
  SecondStream m_second;
  State m_state = State::kGreeting;
  std::string m_sentence;
  bool m_refused_for_now = false;
  WelcomeMessage m_welcome;
  WorldFeed m_world;
  AckWindow m_acks;
  DisplayClock m_clock{std::chrono::microseconds(33333)};
  InputBudget m_budget;
  Prediction m_prediction;
  InputTickEstimator m_input_tick_estimator;
  std::uint32_t m_table_known = 0;    ///< snapshot that told the newest controls taken over
  std::uint32_t m_control_known = 0;  ///< … and state
  std::vector<PlayerLine> m_players;
  ChatLog m_chat;
  std::vector<SoundLine> m_sounds;
  SessionCounters m_counters;
  std::function<void(std::uint32_t)> m_observer;
  std::function<void(const SnapshotHeader&, const AckWindow&)> m_after_observer;
  InputOutbox m_inputs;
  ReliableFrames m_kept;
  ReliableFramesHeard m_kept_heard;
  std::size_t m_kept_unacknowledged = 0;  ///< bytes of kept frames since the last ping
  UpdateTiming m_timing;
  Time m_next_checksum{};
  std::unique_ptr<SealedDatagrams> m_datagrams;
  SessionOptions m_options;
  RoundTrip m_round_trip;
  Time m_last_ping;
  IdleTimer m_idle;
  std::uint64_t m_revision = 0;
};

}  // namespace naiad
