// One session with a server, as the client sees it: the protocol's state machine (proto/STATES.md).
//
//   kGreeting --Welcome--> kPlaying --Goodbye--> kEnded
//       |                     +--channel closed, 15 s of silence--> kLost
//       +--Refused--> kRefused          (a bad message ends any state in kEnded; leave() in kLeft)
//
// The session uses neither sockets nor a clock: its owner passes it each frame and the time (Connection
// for the programs; tests do it by hand). Everything received passes readServerMessage() first.
// Not thread-safe. Memory is bounded whatever the server sends.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/session/InputOutbox.h"
#include "client/session/ReceivedWorld.h"
#include "client/session/ReliableInbox.h"
#include "client/session/ServerLink.h"
#include "client/session/UpdateTiming.h"
#include "shared/net/base/LinkStats.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"

namespace naiad {

class ClientSession {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum class State { kGreeting, kPlaying, kRefused, kEnded, kLost, kLeft };

  static constexpr std::chrono::seconds kGreetingTimeout{5};
  /// Silence after which the stream is given up, and the session, too, if it cannot be resumed.
  static constexpr std::chrono::seconds kIdleTimeout{15};
  /// Silence after which a session without a stream is given up.
  static constexpr std::chrono::seconds kDetachedTimeout{60};
  /// A welcome is followed by a picture within this time, or the session is given up. A world in a process of
  /// its own may take 30 s to begin.
  static constexpr std::chrono::seconds kPictureTimeout{45};

  /// Takes the connected channel and says hello. The owner starts the channel and passes what it delivers
  /// to receive() and closed().
  ClientSession(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options, Time now);
  ClientSession(const ClientSession&) = delete;
  ClientSession& operator=(const ClientSession&) = delete;

  // The stream.
  /// A frame from the server.
  void receive(std::string_view frame, Time now);
  /// The channel has ended by itself.
  void closed(CloseReason reason);
  bool owns(const ReliableChannel* channel) const { return m_link.ownsStream(channel); }
  /// Without a stream, and waiting for another one: adopt().
  bool isDetached() const { return m_state == State::kPlaying && !m_link.hasStream(); }
  /// Number of the newest reliable frame received, for the hello that resumes the session.
  std::uint32_t receivedFrames() const { return m_inbox.newestFrame(); }
  /// The server said that an earlier session goes on here.
  bool isResumed() const { return m_state == State::kPlaying && m_welcome.resumed; }
  /// Continue with the stream on which `other` was welcomed back (welcome().resumed).
  void adopt(ClientSession& other, Time now);
  /// Datagrams do not pass, and it is time to open a second stream: startSecond(). True once for each
  /// attempt.
  bool wantsSecond(Time now);
  void startSecond(std::unique_ptr<ReliableChannel> channel);
  bool hasSecondStream() const { return m_link.hasSecondStream(); }
  /// Do datagrams come from the server?
  bool hasDatagrams(Time now) const { return m_link.hasDatagrams() && m_timing.hasDatagrams(now); }
  /// Did the server send anything lately, on any path?
  bool isHeard(Time now) const {
    return m_state == State::kPlaying && m_liveness.silence(now) < UpdateTiming::kPassing;
  }

  /// Pings and time-outs. Call about ten times a second: time between rarer calls does not count as silence
  /// of the server (IdleTimer).
  void update(Time now);
  /// When update() has something to do before its usual time; nothing if it has not.
  std::optional<Time> nextWake() const { return isOver() ? std::nullopt : m_timing.nextWake(); }

  // What the player does.
  /// Send a key or mouse action of the player immediately. False if it was not sent: not playing, or too
  /// many.
  bool sendKey(df::Keyboard::Key key, df::EventKeyboardAction action, Time now);
  /// `x`, `y`: cell of the view.
  bool sendMouse(df::EventMouseAction action, df::Mouse::Button button, int x, int y, Time now);
  /// Send a line of chat to all players; nothing if no drawable character is left of it. Without a stream it
  /// waits for the next one.
  void sendChat(const std::string& text);
  void sendResize(int columns, int rows);
  /// Ask for the list of rooms, every kRoomsEvery. Call while it is shown.
  void refreshRooms(Time now);
  static constexpr std::chrono::seconds kRoomsEvery{2};
  /// Ask to go on in that room; nothing if it is no name of one.
  void enterRoom(const std::string& room);
  /// Leave on purpose: send a leave message, and close the channel after what is queued.
  void leave();

  // How the session stands.
  State state() const { return m_state; }
  /// Once refused: why, and where else to go. Its link is as a stranger wrote it.
  const RefusedMessage& refusal() const { return m_refusal; }
  /// A session that was lost: the server has said that it is back within this time; 0: it has not.
  std::chrono::seconds returnsIn() const { return m_returns_in; }
  /// Neither waiting for the server nor playing any more.
  bool isOver() const { return m_state != State::kGreeting && m_state != State::kPlaying; }
  /// Why the session is over, for people. Empty while it is not, or after leave().
  const std::string& sentence() const { return m_sentence; }
  const WelcomeMessage& welcome() const { return m_welcome; }
  const SessionCounters& counters() const { return m_counters; }
  /// Smoothed round trip; zero before the first measurement.
  std::chrono::milliseconds roundTrip() const { return m_liveness.roundTrip(); }
  /// Counts up with every change that can be seen on a screen.
  std::uint64_t revision() const { return m_revision; }

  // What the server says.
  const std::vector<PlayerLine>& players() const { return m_inbox.players(); }
  const std::deque<ChatEntry>& chat() const { return m_inbox.chat(); }
  /// As of the last refreshRooms(); empty: not known, or the server has none.
  const std::vector<RoomLine>& rooms() const { return m_rooms; }
  /// Sounds since the last call, oldest first; the newest ReliableInbox::kMaxSounds of them.
  std::vector<SoundLine> takeSounds() { return m_inbox.fetchSounds(); }
  /// Points of this player, from the newest player list.
  std::int32_t score() const { return m_inbox.scoreOf(m_welcome.player); }

  // The world.
  /// There is a picture to show: all of the world has come, or as much as came in half a second.
  bool hasPicture(Time now) const { return m_world.feed().hasPicture(now); }
  /// How long the welcome has not been followed by a picture; zero once it was.
  IdleTimer::Duration pictureWait(Time now) const;
  const Replica& replica() const { return m_world.replica(); }
  const DisplayClock& clock() const { return m_world.clock(); }
  /// The tick to draw now.
  std::uint32_t displayTick(Time now) { return m_world.clock().displayTick(now); }
  bool isSilent(Time now) const { return m_state == State::kPlaying && m_world.clock().isSilent(now); }
  /// Where the player's own object is by now, if the game declared how keys move it. Call before drawing.
  const Prediction& predict(Time now) { return m_world.predict(now); }
  /// The tick that predict() runs to: the server applies a key pressed now in it, so that the key shows in
  /// the next frame.
  std::uint32_t predictedTick(Time now) const { return m_world.predictedTick(now); }
  bool isPredicting() const { return m_world.isPredicting(); }
  const InputTickEstimator& inputTickEstimator() const { return m_world.inputTicks(); }

  /// Called before a snapshot of `tick` is applied: the replica is still as it was. For recorders.
  void onBeforeSnapshot(std::function<void(std::uint32_t tick)> observer) {
    m_before_observer = std::move(observer);
  }
  /// Called after a snapshot was applied, with its header and what has arrived by now. For checks that
  /// compare the picture with the server's.
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
  void handle(EnteredMessage&& message, Time now);
  void handle(RoomsMessage&& message, Time now);
  void takeRoom(const WelcomeMessage& welcome);
  void reject(const std::string& what);
  void finish(State state, std::string sentence);
  void openDatagrams(Time now);
  void receiveDatagram(std::string_view bytes, Time now);
  void receiveOnSecond(std::string_view bytes, Time now);
  void applySnapshot(std::string_view bytes, Time now);
  bool sendInput(Input input, bool urgent, Time now);
  void sendUpdate(Time now);
  void sendProbe(Time now);
  void sendPing(Time now);
  void sendLeave();
  void giveUpPicture();
  void updateStream(Time now);
  std::string nextUpdate(bool in_order, Time now);

  SessionCounters m_counters;
  ServerLink m_link;
  StreamLiveness m_liveness;
  IdleTimer m_picture_wait;  ///< since the welcome
  UpdateTiming m_timing;
  ReceivedWorld m_world;
  ReliableInbox m_inbox{m_counters};
  InputOutbox m_inputs;
  WelcomeMessage m_welcome;
  std::vector<RoomLine> m_rooms;
  Time m_rooms_due{};
  State m_state = State::kGreeting;
  RefusedMessage m_refusal;
  std::string m_sentence;
  std::chrono::seconds m_returns_in{0};
  std::uint64_t m_revision = 0;
  std::function<void(std::uint32_t)> m_before_observer;
  std::function<void(const SnapshotHeader&, const AckWindow&)> m_after_observer;
};

}  // namespace naiad
