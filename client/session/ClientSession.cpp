#include "client/session/ClientSession.h"

#include "shared/net/stream/Framing.h"

namespace naiad {

ClientSession::ClientSession(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
                             Time now)
    : m_link(std::move(channel), options, m_counters), m_liveness(now), m_picture_wait(now) {}

void ClientSession::receive(std::string_view frame, Time now) {
  if (isOver()) return;
  m_liveness.onReceived(now);
  m_counters.bytes_in += frame.size() + kFrameHeaderSize;
  const std::uint32_t newest = m_inbox.newestFrame();
  auto message = readServerMessage(frame);
  if (!message) return reject("a malformed message");
  std::visit([this, now](auto& m) { handle(std::move(m), now); }, *message);
  ++m_revision;
  if (m_inbox.newestFrame() == newest || isOver()) return;
  if (m_inbox.countFrame(frame.size())) sendPing(now);
}

void ClientSession::handle(WelcomeMessage&& message, Time now) {
  if (m_state != State::kGreeting) return reject("a second welcome");
  if (message.room.empty() && !m_link.options().room.empty()) {
    sendLeave();
    return finish(State::kRefused,
                  "This server has no rooms; cannot enter room \"" + m_link.options().room + "\".");
  }
  m_welcome = std::move(message);
  const bool new_process = m_link.options().new_process;
  if (!new_process) m_welcome.resume_state.reset();
  const ResumeState from = m_welcome.resume_state.value_or(ResumeState{});
  if (new_process && m_welcome.resumed) {
    if (!m_welcome.resume_state) return reject("a resumed session without its state");
    m_inbox.addNotice("Session resumed.", now);
  }
  if (!m_welcome.resumed && m_welcome.name != m_link.options().name)
    m_inbox.addNotice("You play as \"" + m_welcome.name + "\". Names are unique, with at most 16 Latin, " +
                          "Greek or Cyrillic letters.",
                      now);
  m_world.start(m_welcome, from);
  m_inputs.start(from.input, m_welcome.tick);
  m_state = State::kPlaying;
  m_picture_wait.onActivity(now);
  m_liveness.startStream(now);
  m_timing.onAttached(now);
  if (!m_welcome.resumed || m_welcome.resume_state) openDatagrams(now);
  const std::string wanted = m_link.options().stays_in_room ? "" : m_link.options().room;
  if (new_process && m_welcome.resumed && !wanted.empty() && wanted != m_welcome.room) enterRoom(wanted);
  update(now);
}

void ClientSession::handle(RefusedMessage&& message, Time) {
  if (m_state != State::kGreeting) return reject("a refusal after the welcome");
  m_refusal = std::move(message);
  finish(State::kRefused, m_refusal.message.empty() ? "The server refused." : m_refusal.message);
}

void ClientSession::handle(GoodbyeMessage&& message, Time) {
  m_restart_delay = message.restart_time;
  finish(m_restart_delay.count() > 0 ? State::kLost : State::kEnded,
         message.message.empty() ? "The server ended the game." : std::move(message.message));
}

void ClientSession::handle(SnapshotMessage&& message, Time now) {
  if (m_state != State::kPlaying) return reject("a snapshot before the welcome");
  m_timing.onStreamSnapshot(now);
  if (!m_link.second().isDuplicate(message.bytes)) applySnapshot(message.bytes, now);
}

void ClientSession::handle(PlayersMessage&& message, Time) {
  if (m_state != State::kPlaying) return reject("a player list before the welcome");
  m_inbox.handlePlayers(std::move(message));
}

void ClientSession::handle(ChatMessage&& message, Time now) {
  if (m_state != State::kPlaying) return reject("chat before the welcome");
  m_inbox.handleChat(std::move(message), m_welcome, now);
}

void ClientSession::handle(SoundsMessage&& message, Time) {
  if (m_state != State::kPlaying) return reject("sounds before the welcome");
  m_inbox.handleSounds(std::move(message));
}

void ClientSession::handle(const PongMessage& message, Time now) {
  // Refuses it, because a server could otherwise postpone the timeout of its welcome without limit.
  if (m_state != State::kPlaying) return reject("a pong before the welcome");
  m_link.acknowledgeReliable(message.last_frame);
  if (const auto sample = m_liveness.endPing(message.token, now)) m_world.addRttSample(*sample);
}

void ClientSession::handle(const RoomEnteredMessage& message, Time now) {
  if (m_state != State::kPlaying) return reject("another room before the welcome");
  m_inbox.addNotice("You are now in room " + message.room + ", playing " + message.game + ".", now);
  static_cast<PlayerWorld&>(m_welcome) = static_cast<const PlayerWorld&>(message);
  m_world.enter(message.world_epoch, message.tick_now, now);
  m_rooms_due = now;
}

void ClientSession::handle(RoomsMessage&& message, Time) {
  if (m_state != State::kPlaying) return reject("rooms before the welcome");
  m_rooms = std::move(message.rooms);
}

void ClientSession::openDatagrams(Time now) {
  const auto on_snapshot = [this](std::string_view bytes) { receiveDatagram(bytes, m_link.now()); };
  if (m_link.openDatagrams(m_welcome, on_snapshot)) sendProbe(now);
}

void ClientSession::receiveDatagram(std::string_view bytes, Time now) {
  if (m_state != State::kPlaying) return;
  m_liveness.onReceived(now);
  m_timing.onDatagram(now);
  m_counters.bytes_in += bytes.size();
  ++m_counters.datagrams_in;
  if (const auto sample = m_link.popRoundTrip()) {
    m_liveness.addRttSample(*sample, now);
    m_world.addRttSample(*sample);
  }
  applySnapshot(bytes, now);
  ++m_revision;
}

bool ClientSession::shouldOpenSecondStream(Time now) {
  if (m_state != State::kPlaying || !m_link.hasStream() || !m_welcome.second_stream) return false;
  const bool no_datagrams =
      m_link.options().two_streams || (m_link.hasDatagrams() && m_timing.isOnStreamOnly(now));
  return no_datagrams && m_link.second().tryBeginAttempt(now);
}

void ClientSession::startSecond(std::unique_ptr<ReliableChannel> channel) {
  if (m_state != State::kPlaying || !m_link.hasStream()) return;
  m_link.startSecond(std::move(channel), m_welcome.resume_token,
                     [this](std::string_view bytes) { receiveOnSecond(bytes, m_link.now()); });
}

// Does not count as received for m_liveness, so that the death of the first stream is still noticed.
void ClientSession::receiveOnSecond(std::string_view bytes, Time now) {
  if (m_state != State::kPlaying) return;
  m_counters.bytes_in += bytes.size() + kFrameHeaderSize;
  m_timing.onStreamSnapshot(now);
  if (m_link.second().isDuplicate(bytes)) return;
  applySnapshot(bytes, now);
  ++m_revision;
}

void ClientSession::applySnapshot(std::string_view bytes, Time now) {
  using Result = ReceivedWorld::Result;
  const Result result = m_world.applySnapshot(bytes, now, m_inputs, m_before_observer);
  m_counters.resets = m_world.worlds().resets();
  if (result == Result::kMalformed) return reject("a malformed snapshot");
  if (result == Result::kIgnored) return;
  if (result == Result::kStale) {
    ++m_counters.stale_snapshots;
    if (m_world.worlds().shouldRequestReset()) sendUpdate(now);
    return;
  }
  ++m_counters.snapshots;
  if (m_after_observer) m_after_observer(m_world.header(), m_world.acks());
  const bool gap = m_world.hasGap() && m_counters.snapshots > 1;
  if (m_timing.onSnapshotApplied(gap, now)) sendUpdate(now);
}

void ClientSession::adopt(ClientSession& other, Time now) {
  const WelcomeMessage& welcome = other.m_welcome;
  const bool same_id = welcome.connection_id == m_welcome.connection_id;
  m_link.adoptStream(other.m_link);
  other.m_state = State::kLeft;
  m_welcome.resume_token = welcome.resume_token;
  m_welcome.connection_id = welcome.connection_id;
  m_welcome.aead = welcome.aead;
  m_welcome.epoch = welcome.epoch;
  // Needed if the stream broke before the message that the player has entered another room.
  if (welcome.player != m_welcome.player)
    static_cast<PlayerWorld&>(m_welcome) = static_cast<const PlayerWorld&>(welcome);
  m_world.resume(welcome.tick_now);
  m_liveness.onReceived(now);
  m_liveness.startStream(now);  // the stream's first ping tells the server that the new token has arrived
  m_timing.onAttached(now);
  m_inputs.restartStream();
  if (same_id) {
    m_link.renewDatagrams(m_welcome);
  } else {  // another client process had the session in between
    m_link.closeDatagrams();
    openDatagrams(now);
  }
  m_link.acknowledgeReliable(welcome.last_frame);
  m_link.resendReliable();
  ++m_revision;
  sendUpdate(now);
  update(now);
}

void ClientSession::closed(CloseReason reason) {
  if (isOver()) return;
  if (reason == CloseReason::kProtocol) return reject("an invalid frame");
  if (reason == CloseReason::kOverflow) {
    return finish(State::kLost, "The connection to the server is too slow.");
  }
  if (m_state == State::kPlaying && !m_welcome.resume_token.empty()) {
    m_link.dropStream();
    ++m_revision;
    return;
  }
  m_unanswered = m_state == State::kGreeting;
  finish(State::kLost, m_unanswered ? "The server closed the connection before answering."
                                    : "The connection to the server was lost.");
}

void ClientSession::update(Time now) {
  if (isOver()) return;
  m_liveness.poll(now);
  if (m_state == State::kGreeting) {
    if (m_liveness.silence(now) >= kGreetingTimeout) {
      finish(State::kLost, "The server accepted the connection but did not answer.");
    }
    return;
  }
  m_picture_wait.poll(now);
  if (pictureWait(now) >= kPictureTimeout) return failWithoutPicture();
  if (m_timing.popInputResend(now) && !m_inputs.isEmpty() && hasDatagrams(now)) sendUpdate(now);
  if (m_timing.isAckDue(now)) sendUpdate(now);
  if (m_link.hasDatagrams() && m_timing.isProbeDue(now, !m_link.hasStream())) sendProbe(now);
  m_link.second().update(now);
  if (hasDatagrams(now) && !m_timing.isUndecided(now)) m_link.second().close();
  if (m_link.hasStream()) return updateStream(now);
  if (m_liveness.silence(now) >= kDetachedTimeout) {
    finish(State::kLost, "The connection to the server was lost.");
  }
}

// Drops a stream that is dead or has used up its keys; otherwise keeps it alive.
void ClientSession::updateStream(Time now) {
  if (m_liveness.isStreamDead(now, hasDatagrams(now))) {
    m_liveness.forgetPings();
    return closed(CloseReason::kError);  // datagrams survive a change of address, streams do not
  }
  // Keys are derived from a stream, so new keys need another stream. Datagrams continue until then.
  if (!m_welcome.resume_token.empty() && m_link.popNewEpochDue()) return closed(CloseReason::kError);
  if (m_liveness.silence(now) >= kIdleTimeout) {
    if (m_welcome.resume_token.empty()) return finish(State::kLost, "The server stopped responding.");
    return closed(CloseReason::kError);  // the session waits for a new stream
  }
  if (m_liveness.isPingDue(now, hasDatagrams(now))) sendPing(now);
}

IdleTimer::Duration ClientSession::pictureWait(Time now) const {
  const bool waits = m_state == State::kPlaying && !hasPicture(now);
  return waits ? m_picture_wait.idleTime(now) : IdleTimer::Duration::zero();
}

// Leaves, so that the server does not keep a place for a client that will not return.
void ClientSession::failWithoutPicture() {
  sendLeave();
  finish(State::kLost,
         "Joined, but the server sent no picture within " + std::to_string(kPictureTimeout.count()) + " s.");
}

void ClientSession::reject(const std::string& what) {
  ++m_counters.bad_messages;
  finish(State::kEnded, std::string("Protocol error: the server sent ") + what + ". Disconnected.");
}

void ClientSession::finish(State state, std::string message) {
  m_state = state;
  m_message = std::move(message);
  ++m_revision;
  m_link.closeStreams();
}

}  // namespace naiad
