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
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "Acks.h"
#include "Channel.h"
#include "DisplayClock.h"
#include "InputBudget.h"
#include "Keyboard.h"
#include "Prediction.h"
#include "Replica.h"
#include "SealedDatagrams.h"
#include "ServerMessages.h"
#include "TakeInClock.h"
#include "UpdateCodec.h"

namespace naiad {
namespace wire {
class ClientMessage;
}

/// What the Hello says.
struct SessionOptions {
  std::string name = "player";  ///< wanted name, 1 to 16 characters
  std::string game;             ///< game to play; empty: whatever runs
  std::string program;          ///< "dfclient 0.1.0", for the server's log
  int columns = 80;             ///< terminal size in cells
  int rows = 24;
  std::string password;      ///< of the server, if it wants one
  std::string resume_token;  ///< of an earlier welcome: go on with that session
  /// Makes a socket for datagrams to an endpoint; empty: no datagrams (a Connection that encrypts puts UDP
  /// there). May return null.
  std::function<std::unique_ptr<DatagramSocket>(const Endpoint& server)> open_socket;
  /// For what comes as a datagram; another clock is for tests in virtual time.
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

/// A line of chat and when it came.
struct ChatEntry {
  std::string name;  ///< of the speaker; empty: the server
  df::Color color = df::COLOR_DEFAULT;
  std::string text;
  std::chrono::steady_clock::time_point at;
};

/// What went over the wire so far. Bytes are frame payloads plus two bytes of header each.
struct SessionCounters {
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t stale_snapshots = 0;  ///< they named what newer ones had replaced: dropped
  std::uint64_t inputs = 0;
  std::uint64_t inputs_dropped = 0;  ///< kept back: too many, or the line is stuck
  std::uint64_t chat_lines = 0;
  std::uint64_t datagrams_in = 0;  ///< with a snapshot; their bytes are in bytes_in, headers not counted
  std::uint64_t resets = 0;        ///< the world came anew
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
  static constexpr std::chrono::milliseconds kPassing{1000};     ///< without a datagram: they do not pass
  static constexpr std::chrono::milliseconds kProbeEvery{1000};  ///< then
  /// So long without a datagram is odd: the server may not know our address any more.
  static constexpr std::chrono::milliseconds kQuiet{400};
  /// After a snapshot on the stream it is open for so long whether the server hears datagrams.
  static constexpr std::chrono::milliseconds kUndecided{500};
  static constexpr std::chrono::milliseconds kFirstProbes{100};  ///< in the first second
  static constexpr std::chrono::milliseconds kRepeatInput{10};   ///< a new input is sent again after this
  static constexpr int kAckEvery = 3;                            ///< snapshots that come as datagrams
  static constexpr std::chrono::milliseconds kAckDelay{50};      ///< of the last one, at most
  static constexpr int kMostStale =
      30;  ///< snapshots in a row that mean what is gone: then the world is to come anew
  static constexpr std::chrono::seconds kChecksumEvery{1};
  static constexpr std::chrono::milliseconds kResetPatience{
      500};  ///< then a world that is not complete is shown
  static constexpr std::size_t kMaxChatLog = 100;
  /// Inputs that the game has not heard of yet, at most; more are dropped here, but for keys that go up.
  /// Below the 64 that a server lets wait, so that who holds a key through a stall is not thrown out as a
  /// flooder afterwards, and below kMaxUpdateInputs.
  static constexpr std::uint32_t kMaxUnapplied = 40;

  /// Takes the connected channel and says Hello. The owner starts the channel and passes what it delivers
  /// to receive() and closed().
  ClientSession(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options, Time now);
  ClientSession(const ClientSession&) = delete;
  ClientSession& operator=(const ClientSession&) = delete;

  /// Without a stream, and waiting for another one: adopt().
  bool isDetached() const { return m_state == State::kPlaying && m_channel == nullptr; }
  /// The server said that an earlier session goes on here.
  bool isResumed() const { return m_state == State::kPlaying && m_welcome.resumed; }
  bool owns(const ReliableChannel* channel) const { return m_channel.get() == channel; }
  /// Go on with the stream on which `other` was welcomed back (welcome().resumed).
  void adopt(ClientSession& other, Time now);
  /// Do datagrams come from the server?
  bool hasDatagrams(Time now) const { return m_datagrams != nullptr && now - m_last_datagram < kPassing; }

  /// A frame from the server.
  void receive(std::string_view frame, Time now);
  /// The channel ended by itself.
  void closed(CloseReason reason);
  /// Pings and time-outs. Call about ten times a second.
  void update(Time now);

  /// Send a key or mouse action of the player, at once. False if it was not sent: not playing, or too many.
  bool sendKey(df::Keyboard::Key key, df::EventKeyboardAction action, Time now);
  /// `x`, `y`: cell of the view.
  bool sendMouse(df::EventMouseAction action, df::Mouse::Button button, int x, int y, Time now);
  /// Say something to all players; nothing if no drawable character is left of it.
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
  /// Playing, and at least one snapshot came: there is something to show.
  bool hasPicture() const { return m_counters.snapshots > 0; }

  const WelcomeMessage& welcome() const { return m_welcome; }
  const Replica& replica() const { return m_replica; }
  const std::vector<PlayerLine>& players() const { return m_players; }
  const std::deque<ChatEntry>& chat() const { return m_chat; }
  const SessionCounters& counters() const { return m_counters; }
  /// Points of this player, from the newest player list.
  std::int32_t score() const;

  /// Work out where the player's own object is by now, if the game declared how keys move it. Before drawing.
  const Prediction& predict(Time now);
  /// The tick that predict() runs to: the one that takes in a key pressed now, so that it shows in the next
  /// frame.
  std::uint32_t predictedTick(Time now) const;
  bool isPredicting() const { return m_prediction.isActive(); }
  const TakeInClock& takeInClock() const { return m_take_in; }

  /// The tick to draw now, whether the line is silent, the newest tick known.
  std::uint32_t displayTick(Time now) { return m_clock.displayTick(now); }
  const DisplayClock& clock() const { return m_clock; }
  bool isSilent(Time now) const { return m_state == State::kPlaying && m_clock.isSilent(now); }
  /// Smoothed round trip; zero before the first measurement.
  std::chrono::milliseconds roundTrip() const;
  /// Counts up with every change that can be seen on a screen.
  std::uint64_t revision() const { return m_revision; }

  /// When update() has something to do before its usual time; nothing if it has not.
  std::optional<Time> nextWake() const;

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
  void handle(const PongMessage& message, Time now);
  void reject(const std::string& what);
  void finish(State state, std::string sentence);
  void send(const wire::ClientMessage& message);
  bool sendInput(Input input, bool urgent, Time now);
  void sendUpdate(Time now);
  void takeSnapshot(std::string_view bytes, Time now);
  void takeControls();
  Replica* replicaFor(std::string_view bytes, Time now);
  void openDatagrams(Time now);
  void onDatagram(std::string_view bytes, Time now);
  ClientUpdate nextUpdate(bool on_stream, Time now);
  void probe(Time now);
  KeyExporter exporter() const;

  std::unique_ptr<ReliableChannel> m_channel;
  State m_state = State::kGreeting;
  std::string m_sentence;
  bool m_refused_for_now = false;
  WelcomeMessage m_welcome;
  Replica m_replica;
  AckWindow m_acks;
  DisplayClock m_clock{std::chrono::microseconds(33333)};
  InputBudget m_budget;
  Prediction m_prediction;
  TakeInClock m_take_in;
  std::uint32_t m_table_known = 0;    ///< snapshot that told the newest controls taken over
  std::uint32_t m_control_known = 0;  ///< … and state
  std::vector<PlayerLine> m_players;
  std::deque<ChatEntry> m_chat;
  SessionCounters m_counters;
  std::function<void(std::uint32_t)> m_observer;
  std::function<void(const SnapshotHeader&, const AckWindow&)> m_after_observer;
  std::uint32_t m_next_input = 1;
  std::deque<Input> m_inputs;            ///< that no snapshot has acknowledged
  std::uint32_t m_newest_on_stream = 0;  ///< newest input sent on this stream
  std::optional<Time> m_repeat_at;
  Time m_next_checksum{};
  std::unique_ptr<SealedDatagrams> m_datagrams;
  SessionOptions m_options;
  Time m_last_datagram{};
  Time m_last_streamed{};  ///< snapshot on the stream
  Time m_last_probe{};
  Time m_attached{};
  std::optional<Replica> m_next_replica;  ///< of the next epoch, until it is complete
  Time m_reset_at{};
  std::uint8_t m_epoch = 0;
  std::uint8_t m_next_epoch = 0;
  int m_stale_in_a_row = 0;
  int m_unacknowledged = 0;  ///< snapshots that no update has acknowledged
  std::optional<Time> m_acknowledge_at;
  std::map<std::uint64_t, Time> m_pings;  ///< unanswered, by token
  std::uint64_t m_next_token = 1;
  Time m_last_ping;
  Time m_last_heard;
  std::chrono::duration<double, std::milli> m_round_trip{0};
  std::uint64_t m_revision = 0;
};

}  // namespace naiad
