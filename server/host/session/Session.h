// One client on the server's side: its channels, where it is in its life (STATES.md), what it has been told.
//
// A session is more than its stream: when that breaks, the session goes on over datagrams, or waits, until
// the client comes back on another stream and adopt() gives it to the session, or the grace time is over.
//
// Everything the client sends is checked here and counted where it is refused; a session that breaks a rule
// ends alone. Time is passed in. Single-threaded: the host's event loop and tick share a thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "host/net/SealedChannel.h"
#include "host/session/Counters.h"
#include "host/session/PressedKeys.h"
#include "host/session/StallDetector.h"
#include "host/session/TransportSelector.h"
#include "host/snapshot/LagCompensator.h"
#include "host/snapshot/SnapshotSender.h"
#include "naiad.pb.h"
#include "shared/net/base/Channel.h"
#include "shared/net/base/IdleTimer.h"
#include "shared/net/stream/ReliableFrames.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad {

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
  };

  enum class State { kGreeting, kPlaying, kEnding, kGone };

  static constexpr std::chrono::seconds kLoginTimeout{5};
  /// A hello that waits to be judged is answered before its client gives up on an answer (after 5 s).
  static constexpr std::chrono::seconds kJudgeTimeout{4};
  static constexpr std::chrono::seconds kIdleTimeout{15};
  static constexpr std::chrono::seconds kResetEvery{2};
  /// A client sends a checksum once a second; a few may come at once after a stall.
  static constexpr std::chrono::milliseconds kChecksumEvery{250};
  static constexpr std::size_t kMaxQueuedInputs = 64;
  static constexpr int kInputsPerTick = 16;
  /// An input that asks for a tick farther off has asked for nonsense.
  static constexpr std::int32_t kMaxEarly = 8;
  static constexpr int kChatPerSecond = 3;
  /// Lines at once from a client that comes back, if it was away long enough to have said them.
  static constexpr int kChatAtOnce = 30;
  /// Silence after which a player without a stream lets go of his keys.
  static constexpr std::chrono::seconds kSuspend{1};
  /// With more than this unsent on the stream nothing arrives at once.
  static constexpr std::size_t kMaxBeforeFleeting = std::size_t{4} * 1024;
  /// A larger snapshot goes on the first stream only: a world twice would be too much for a thin line, while
  /// what gathered during a wait should not make for another one.
  static constexpr std::size_t kMaxOnSecond = std::size_t{4} * 1024;
  /// More often a terminal's size is not taken over.
  static constexpr std::chrono::milliseconds kResizeEvery{250};
  /// An honest client that catches up after a stall sends fewer: every reply is bounded by what it got.
  static constexpr int kMessagesPerTick = 1024;

  Session(std::unique_ptr<ReliableChannel> channel, Counters& counters, Clock::time_point now);
  /// Names the session for as long as the host runs.
  void setId(std::uint64_t id) { m_id = id; }
  std::uint64_t id() const { return m_id; }
  /// Begin to receive. Not in the constructor, so that callbacks find a finished session.
  void start(Events events);

  /// Answer the hello with a refusal; the connection ends.
  void refuse(wire::Refused::Reason reason, const std::string& sentence);
  /// Answer the hello: the client plays from now on. With `datagrams` if there are to be any.
  void welcome(const wire::Welcome& welcome, std::unique_ptr<SealedChannel> datagrams = nullptr);
  /// The client is back: take over the stream on which `other` heard its hello, and answer that; then comes
  /// what it has missed of the frames that are kept, all after number `received`. `other` is Gone afterwards.
  void adopt(Session& other, wire::Welcome welcome, std::uint32_t received);
  /// Another process of the client, which knows nothing yet, goes on with the session: the same, but it is
  /// told the world from the beginning, and with `datagrams` of its own, if any. Whoever still holds the old
  /// stream is told that he went on elsewhere.
  void restart(Session& other, wire::Welcome welcome, std::unique_ptr<SealedChannel> datagrams);
  /// From now on small snapshots also go on the stream on which `other` heard its hello, beside this one's:
  /// where datagrams do not pass, a packet that one stream waits for does not hold up the other. Updates come
  /// on both. `other` is Gone afterwards; a second stream that was there before ends, and this one ends with
  /// the first.
  void accompany(Session& other);
  bool hasSecondStream() const { return m_second != nullptr; }
  /// Another world begins: the client forgets what it knows, and what it did in the one before is dropped.
  void beginWorld();
  /// Wait this long for a client whose stream broke. 0: do not.
  void setGrace(std::chrono::milliseconds grace) { m_grace = grace; }
  /// The stream is broken; the client may come back.
  bool isDetached() const { return m_state == State::kPlaying && m_channel == nullptr; }
  /// The client has spoken on its newest stream since it was welcomed there, so it knows what the welcome
  /// said. True once for each stream.
  bool takeProof() { return std::exchange(m_proved, false); }
  /// As it was sent.
  const wire::Welcome& welcomed() const { return m_welcome; }
  SealedChannel* datagrams() { return m_datagrams.get(); }
  /// Null while detached.
  const ReliableChannel* stream() const { return m_channel.get(); }
  /// Keying material of the stream (Channel.h).
  std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;
  /// Tell the client why it is over, and end.
  void goodbye(const std::string& sentence);

  /// Enforce deadlines. Once a tick: time in which nobody calls does not count as silence of the client
  /// (IdleTimer.h).
  void checkDeadlines(Clock::time_point now);
  /// Take up to kInputsPerTick inputs out of the queue, in order, each id once, into the world's next tick.
  template <class Apply>
  void takeInputs(std::uint32_t tick, Apply apply) {
    for (int i = 0; i < kInputsPerTick && !m_inputs.empty() && !isTooEarly(m_inputs.front(), tick); ++i) {
      apply(m_inputs.front());
      m_sender.noteInput(m_inputs.front().id, tick);
      m_inputs.pop_front();
    }
  }

  /// The picture that the player clicked in, as far as that is known: for mouse inputs only.
  df::ViewedTick seenWith(const Input& input) const;

  /// The player steers by declared controls (null: does not): the keys in them wait for the tick that they
  /// ask for, since he has seen their effect there already.
  void setControls(const std::shared_ptr<const df::ControlTable>& controls) {
    if (m_controls != controls) m_controls = controls;
  }

  /// Note a published tick, and send what is owed unless the client is still busy with earlier bytes.
  void sendTick(const Publisher& publisher, const df::PlayerFacts& player);
  void send(const wire::ServerMessage& message);
  /// Send it so that it arrives, on this stream or another one: it is kept until the client has it.
  /// `replaces`: it says all that the last one did that was sent with the same.
  void sendKept(wire::ServerMessage message, bool replaces = false);

  /// Send it if that can be at once: it is worth nothing later. Whether it was sent.
  bool sendFleeting(const wire::ServerMessage& message);

  State state() const { return m_state; }
  std::uint32_t player() const { return m_player; }
  const std::string& name() const { return m_name; }
  std::string address() const { return m_channel != nullptr ? m_channel->peerAddress() : m_address; }
  /// Ticks at whose end this client was not up to date, since it was busy with earlier bytes.
  std::uint64_t skippedTicks() const { return m_skipped_ticks; }
  /// The round trip the client measured last, in milliseconds; 0: not yet.
  std::uint32_t rttMillis() const { return m_rtt_millis; }
  const TransportSelector& passage() const { return m_transport; }
  /// What the client has been told.
  const SnapshotSender& sender() const { return m_sender; }

 private:
  /// Where the callbacks of a stream lead: its session may change.
  struct Reception {
    Session* session = nullptr;
    bool second = false;
  };

  void onFrame(std::string_view frame);
  void onSecondFrame(std::string_view frame);
  void onSecondClosed(CloseReason reason);
  void dropSecond();
  void onDatagram(std::string_view bytes);
  void onClosed(CloseReason reason);
  void detach(Clock::time_point now);
  void takeStream(Session& other);
  void answer(const wire::Welcome& welcome);
  void startDatagrams(std::unique_ptr<SealedChannel> datagrams);
  void releaseKeys();
  void checkGreeting(Clock::time_point now);
  void checkSilence(Clock::time_point now);
  void allowSavedChat(Clock::time_point now);
  bool mayHear();
  Clock::time_point now() const { return m_events.now ? m_events.now() : Clock::now(); }
  void sendDatagrams(const Publisher& publisher, Clock::time_point present);
  void sendOnStream(const Publisher& publisher, Clock::time_point present);
  static std::string frameOf(const SnapshotSender::Packet& packet);
  void sendSnapshot(const SnapshotSender::Packet& packet);
  void noteSent(const SnapshotSender::Packet& packet, bool as_datagram, Clock::time_point present);
  void count(const SnapshotSender::Packet& packet);
  bool dispatch(const wire::ClientMessage& message);
  bool takeUpdate(std::string_view bytes, bool by_datagram);
  void takeAcks();
  void compare(const AckWindow& acks, std::uint64_t checksum);
  void reset();
  bool isTooEarly(const Input& input, std::uint32_t tick) const;
  bool takeInput(const Input& input);
  void takeChat(const std::string& text);
  void takeResize(const wire::Resize& size);
  void applyResize(Clock::time_point present);
  void malformed();
  void tellGone();
  void skipTick();
  void end();

  State m_state = State::kGreeting;
  std::uint32_t m_player = 0;
  bool m_told_gone = false;
  bool m_greeted = false;       ///< the hello has come
  bool m_spoke = false;         ///< a frame came since then
  bool m_awaits_proof = false;  ///< see takeProof()
  bool m_proved = false;
  int m_messages = 0;  ///< since the last tick
  int m_chat_budget = kChatPerSecond;
  Clock::time_point m_chat_refill;
  IdleTimer m_idle;  ///< of the client, to a tick
  StallDetector m_stall;
  std::unique_ptr<ReliableChannel> m_channel;  ///< null while detached
  std::unique_ptr<ReliableChannel> m_second;   ///< beside m_channel; null: there is none
  std::unique_ptr<SealedChannel> m_datagrams;
  Counters& m_counters;
  std::uint32_t m_tick = 0;  ///< newest published
  std::uint32_t m_input_received = 0;
  std::optional<AckWindow> m_acks;  ///< heard, and not taken in yet
  std::deque<Input> m_inputs;
  std::uint64_t m_skipped_ticks = 0;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> m_resize;  ///< to be taken over
  std::shared_ptr<const df::ControlTable> m_controls;
  Events m_events;

  std::optional<Clock::time_point> m_last_resize;
  std::optional<Clock::time_point> m_last_reset;
  std::optional<Clock::time_point> m_last_checksum;
  Clock::time_point m_frame_at;  ///< when a frame came last
  std::shared_ptr<Reception> m_reception = std::make_shared<Reception>();
  std::chrono::milliseconds m_grace{0};
  std::string m_address;
  std::uint64_t m_id = 0;
  std::string m_name;
  wire::Welcome m_welcome;
  std::uint32_t m_rtt_millis = 0;
  PressedKeys m_pressed;  ///< once all of m_inputs is taken in
  ReliableFrames m_kept;
  ReliableFramesHeard m_kept_heard;
  SnapshotSender m_sender{Resend::kAhead};
  TransportSelector m_transport;
  SnapshotTicks m_snapshot_ticks;
};

}  // namespace naiad
