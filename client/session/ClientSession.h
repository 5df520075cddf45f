// Client side of a session with a server: the protocol's state machine (proto/STATES.md).
//
//   kGreeting --Welcome--> kPlaying --Goodbye--> kEnded
//       |                     +--channel closed, 15 s of silence--> kLost
//       +--Refused--> kRefused          (a bad message ends any state in kEnded; leave() in kLeft)
//
// kLost also follows a Goodbye that announces a restart, silence or a closed channel in kGreeting, and a
// missing picture. With a token from the server, a session in kPlaying outlives its stream (isDetached()).
//
// For streams, the session uses neither sockets nor a clock: its owner passes each frame and the time to it
// (Connection in the programs; the tests themselves). Datagrams use SessionOptions::open_socket and ::now.
// Everything received but snapshots, which the replica checks, passes readServerMessage() first.
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
  /// Silence of the server after which the stream is closed, and the session ended if it cannot be resumed.
  static constexpr std::chrono::seconds kIdleTimeout{15};
  /// Silence of the server after which a session without a stream ends.
  static constexpr std::chrono::seconds kDetachedTimeout{60};
  /// Time limit from welcome to picture; then the session ends. A world's own process may need 30 s to start.
  static constexpr std::chrono::seconds kPictureTimeout{45};

  /// Sends the hello. The owner starts the connected channel and passes its events to receive() and closed().
  ClientSession(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options, Time now);
  ClientSession(const ClientSession&) = delete;
  ClientSession& operator=(const ClientSession&) = delete;

  // The stream.
  /// Handles a frame from the server.
  void receive(std::string_view frame, Time now);
  /// Call when the channel has ended, unless this session closed it.
  void closed(CloseReason reason);
  bool owns(const ReliableChannel* channel) const { return m_link.ownsStream(channel); }
  /// True if the session has no stream and waits for another one (see adopt()).
  bool isDetached() const { return m_state == State::kPlaying && !m_link.hasStream(); }
  /// Number of the newest reliable frame received, for the hello that resumes the session.
  std::uint32_t receivedFrames() const { return m_inbox.newestFrame(); }
  /// True if the server has resumed an earlier session on this stream.
  bool isResumed() const { return m_state == State::kPlaying && m_welcome.resumed; }
  /// Continues with the stream of `other`, on which the server resumed this session (welcome().resumed).
  void adopt(ClientSession& other, Time now);
  /// True, once per attempt, if datagrams do not pass and it is time for a second stream (startSecond()).
  bool shouldOpenSecondStream(Time now);
  void startSecond(std::unique_ptr<ReliableChannel> channel);
  bool hasSecondStream() const { return m_link.hasSecondStream(); }
  bool hasDatagrams(Time now) const { return m_link.hasDatagrams() && m_timing.hasDatagrams(now); }
  /// True if the session is playing, and something has arrived in the last UpdateTiming::kDatagramTimeout, on
  /// the first stream or by datagram.
  bool isReceiving(Time now) const {
    return m_state == State::kPlaying && m_liveness.silence(now) < UpdateTiming::kDatagramTimeout;
  }

  /// Handles pings and timeouts. Call about ten times a second, because longer pauses between calls do not
  /// count as silence of the server (IdleTimer).
  void update(Time now);
  /// Returns when update() should be called earlier than usual; nullopt if it need not.
  std::optional<Time> nextWake() const { return isOver() ? std::nullopt : m_timing.nextWake(); }

  // Actions of the player.
  /// Sends a key or mouse action of the player at once or, without a stream and datagrams, later. Returns
  /// false if it is not sent: not playing, invalid action, too many inputs, or a stuck stream.
  bool sendKey(df::Keyboard::Key key, df::EventKeyboardAction action, Time now);
  /// `x`, `y`: cell of the view.
  bool sendMouse(df::EventMouseAction action, df::Mouse::Button button, int x, int y, Time now);
  /// Sends a line of chat to all players, unless it is blank or too much chat is unacknowledged. Without a
  /// stream, the line waits for the next stream.
  void sendChat(const std::string& text);
  void sendResize(int columns, int rows);
  /// Requests the list of rooms, at most every kRoomListInterval, but at once after a change of the room.
  /// Call often while the list is shown.
  void refreshRooms(Time now);
  static constexpr std::chrono::seconds kRoomListInterval{2};
  /// Asks the server to move the player to that room. Ignores invalid names, and all if it has no rooms.
  void enterRoom(const std::string& room);
  /// Leaves on purpose: sends a leave message, and closes the channel after everything queued is sent.
  void leave();

  // Status of the session.
  State state() const { return m_state; }
  /// After a refusal: the reason, and perhaps a link to another server. The link is unchecked.
  const RefusedMessage& refusal() const { return m_refusal; }
  /// After a loss: time within which the server has said that it will be back; 0 if it has not said so.
  std::chrono::seconds restartDelay() const { return m_restart_delay; }
  /// True if the session neither waits for the server nor plays any more.
  bool isOver() const { return m_state != State::kGreeting && m_state != State::kPlaying; }
  /// True if the server closed the stream before it answered the hello, as one that restarts does.
  bool isUnanswered() const { return m_unanswered; }
  /// Returns why the session is over, for people. Empty before its end and after leave().
  const std::string& message() const { return m_message; }
  const WelcomeMessage& welcome() const { return m_welcome; }
  const SessionCounters& counters() const { return m_counters; }
  /// Smoothed round trip; zero before the first measurement.
  std::chrono::milliseconds roundTrip() const { return m_liveness.roundTrip(); }
  /// Increases with every change that may be visible on a screen.
  std::uint64_t revision() const { return m_revision; }

  // Data from the server.
  const std::vector<PlayerLine>& players() const { return m_inbox.players(); }
  const std::deque<ChatEntry>& chat() const { return m_inbox.chat(); }
  /// Newest answer to refreshRooms(); empty if there was none, or the server has no rooms.
  const std::vector<RoomLine>& rooms() const { return m_rooms; }
  /// Returns the sounds since the last call, oldest first, at most the newest ReliableInbox::kMaxSounds.
  std::vector<SoundLine> popSounds() { return m_inbox.popSounds(); }
  /// Returns the points of this player in the newest player list.
  std::int32_t score() const { return m_inbox.scoreOf(m_welcome.player); }

  // The world.
  /// True if there is a picture to show: the whole world or, after half a second, the part that has arrived.
  bool hasPicture(Time now) const { return m_world.worlds().hasPicture(now); }
  /// Returns the time since the welcome without a picture; zero with one, or if the session is not playing.
  IdleTimer::Duration pictureWait(Time now) const;
  const Replica& replica() const { return m_world.replica(); }
  const DisplayClock& clock() const { return m_world.clock(); }
  /// Returns the tick to draw now.
  std::uint32_t displayTick(Time now) { return m_world.clock().displayTick(now); }
  bool isSilent(Time now) const { return m_state == State::kPlaying && m_world.clock().isSilent(now); }
  /// Predicts the player's own object, if the game declared how keys move it. Call before drawing.
  const Prediction& predict(Time now) { return m_world.predict(now); }
  /// Returns the tick that predict() runs to. The server will apply a key pressed now in that tick, so the
  /// key shows in the next frame.
  std::uint32_t predictedTick(Time now) const { return m_world.predictedTick(now); }
  bool isPredicting() const { return m_world.isPredicting(); }
  const InputTickEstimator& inputTickEstimator() const { return m_world.inputTicks(); }

  /// Sets a function to be called before a snapshot of `tick` changes the replica. For recorders.
  void onBeforeSnapshot(std::function<void(std::uint32_t tick)> observer) {
    m_before_observer = std::move(observer);
  }
  /// Sets a function to be called after a snapshot was applied, with its header and the snapshots received so
  /// far. For checks that compare the picture with the server's.
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
  void handle(const RoomEnteredMessage& message, Time now);
  void handle(RoomsMessage&& message, Time now);
  void reject(const std::string& what);
  void finish(State state, std::string message);
  void openDatagrams(Time now);
  void receiveDatagram(std::string_view bytes, Time now);
  void receiveOnSecond(std::string_view bytes, Time now);
  void applySnapshot(std::string_view bytes, Time now);
  bool sendInput(Input input, bool urgent, Time now);
  void sendUpdate(Time now);
  void sendProbe(Time now);
  void sendPing(Time now);
  void sendLeave();
  void failWithoutPicture();
  void updateStream(Time now);
  std::string nextUpdate(bool in_order, Time now);

  SessionCounters m_counters;
  ServerLink m_link;
  StreamLiveness m_liveness;
  IdleTimer m_picture_wait;  ///< time since the welcome
  UpdateTiming m_timing;
  ReceivedWorld m_world;
  ReliableInbox m_inbox{m_counters};
  InputOutbox m_inputs;
  WelcomeMessage m_welcome;
  std::vector<RoomLine> m_rooms;
  Time m_rooms_due{};
  State m_state = State::kGreeting;
  bool m_unanswered = false;
  RefusedMessage m_refusal;
  std::string m_message;
  std::chrono::seconds m_restart_delay{0};
  std::uint64_t m_revision = 0;
  std::function<void(std::uint32_t)> m_before_observer;
  std::function<void(const SnapshotHeader&, const AckWindow&)> m_after_observer;
};

}  // namespace naiad
