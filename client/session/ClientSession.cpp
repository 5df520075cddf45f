#include "client/session/ClientSession.h"

#include <algorithm>
#include <utility>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/Framing.h"
#include "shared/replica/Limits.h"

namespace naiad {
namespace {

/// With this much unsent the line is stuck; more inputs would only make the server busy later.
constexpr std::size_t kMaxUnsent = std::size_t{64} * 1024;

}  // namespace

ClientSession::ClientSession(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
                             Time now)
    : m_channel(std::move(channel)), m_options(options), m_last_ping(now), m_idle(now) {
  m_channel->setReceiveLimit(kMaxServerFrame);
  send(helloOf(options));
}

void ClientSession::receive(std::string_view frame, Time now) {
  if (isOver()) return;
  m_idle.heard(now);
  m_counters.bytes_in += frame.size() + kFrameHeaderSize;
  const std::uint32_t kept = m_kept_heard.newest();
  auto message = readServerMessage(frame);
  if (!message) return reject("a malformed message");
  std::visit([this, now](auto& m) { handle(std::move(m), now); }, *message);
  ++m_revision;
  if (m_kept_heard.newest() == kept || isOver()) return;
  m_kept_unacknowledged += frame.size();
  if (m_kept_unacknowledged >= kMuchKept) ping(now);
}

void ClientSession::handle(WelcomeMessage&& message, Time now) {
  if (m_state != State::kGreeting) return reject("a second welcome");
  m_welcome = std::move(message);
  if (!m_options.fresh) m_welcome.continuation.reset();
  const Continuation from = m_welcome.continuation.value_or(Continuation{});
  if (m_options.fresh && m_welcome.resumed) {
    if (!m_welcome.continuation) return reject("no word of where the session goes on");
    m_chat.say("You are back in your old session.", now);
  }
  m_clock = DisplayClock(m_welcome.tick);
  m_world = WorldFeed({from.snapshot, m_welcome.tick_now, from.input}, from.world_epoch);
  m_inputs.goOnAfter(from.input);
  m_budget.setTick(m_welcome.tick);
  m_state = State::kPlaying;
  m_last_ping = now - kPingInterval;
  m_timing.attached(now);
  if (!m_welcome.resumed || m_welcome.continuation) openDatagrams(now);
  update(now);
}

KeyExporter ClientSession::exporter() const {
  return [this](std::string_view label, std::string_view context, std::size_t bytes) {
    return m_channel != nullptr ? m_channel->exportSecret(label, context, bytes) : std::string();
  };
}

// Datagrams go to the port that the stream goes to.
void ClientSession::openDatagrams(Time now) {
  const auto aead = aeadFromWire(m_welcome.aead);
  const std::string peer = m_channel->peerAddress();
  const auto server = endpointFromText(peer);
  if (!aead || !m_options.open_socket || !server) return;
  std::unique_ptr<DatagramSocket> socket = m_options.open_socket(*server);
  if (socket == nullptr) return;
  m_datagrams =
      std::make_unique<SealedDatagrams>(std::move(socket), *server, ConnectionId{m_welcome.connection_id},
                                        m_options.now, m_options.seal_limits);
  if (!m_datagrams->startEpoch(exporter(), *aead, m_welcome.epoch)) return m_datagrams.reset();
  m_datagrams->start([this](std::string_view bytes) { onDatagram(bytes, m_options.now()); });
  probe(now);
}

bool ClientSession::wantsSecond(Time now) {
  return m_state == State::kPlaying && m_channel != nullptr && m_welcome.second_stream &&
         m_datagrams != nullptr && m_timing.isOnStreamOnly(now) && m_second.takeAttempt(now);
}

void ClientSession::startSecond(std::unique_ptr<ReliableChannel> channel) {
  if (m_state != State::kPlaying || m_channel == nullptr) return;
  SessionOptions options = m_options;
  options.password.clear();
  options.resume_token = m_welcome.resume_token;
  options.fresh = false;
  options.second_stream = true;
  m_second.start(std::move(channel), options,
                 [this](std::string_view bytes) { onSecond(bytes, m_options.now()); });
}

// It keeps nothing alive: if the first stream has died, that is to be noticed.
void ClientSession::onSecond(std::string_view bytes, Time now) {
  if (m_state != State::kPlaying) return;
  m_counters.bytes_in += bytes.size() + kFrameHeaderSize;
  m_timing.streamSnapshotCame(now);
  if (m_second.isRepeat(bytes)) return;
  takeSnapshot(bytes, now);
  ++m_revision;
}

void ClientSession::adopt(ClientSession& other, Time now) {
  m_second.close();
  m_channel = std::move(other.m_channel);
  other.m_state = State::kLeft;
  const WelcomeMessage& welcome = other.m_welcome;
  const bool same_id = welcome.connection_id == m_welcome.connection_id;
  m_welcome.resume_token = welcome.resume_token;
  m_welcome.connection_id = welcome.connection_id;
  m_welcome.aead = welcome.aead;
  m_welcome.epoch = welcome.epoch;
  m_idle.heard(now);
  m_timing.attached(now);
  m_inputs.restartStream();
  m_round_trip.forgetPings();
  m_last_ping = now - kSeldomPing;  // at once: it proves to the server that the new token has come
  const auto aead = aeadFromWire(welcome.aead);
  if (!same_id) {  // another process had the session in between
    m_datagrams.reset();
    openDatagrams(now);
  } else if (m_datagrams && aead) {
    m_datagrams->startEpoch(exporter(), *aead, welcome.epoch);
    m_datagrams->reopen();
  }
  m_kept.acknowledge(welcome.received);
  m_kept.forEach([this](const std::string& frame) { sendFrame(frame); });
  ++m_revision;
  sendUpdate(now);
  update(now);
}

void ClientSession::onDatagram(std::string_view bytes, Time now) {
  if (m_state != State::kPlaying) return;
  m_idle.heard(now);
  m_timing.datagramCame(now);
  m_counters.bytes_in += bytes.size();
  ++m_counters.datagrams_in;
  if (const auto sample = m_datagrams->takeRoundTrip()) {
    m_round_trip.note(*sample, now);
    noteRoundTrip(*sample);
  }
  takeSnapshot(bytes, now);
  ++m_revision;
}

void ClientSession::probe(Time now) {
  if (m_timing.datagramGoes(now)) m_datagrams->ping();
  const std::string bytes = writeUpdate(nextUpdate(false, now));
  m_counters.bytes_out += bytes.size();
  m_datagrams->send(bytes);
}

void ClientSession::handle(RefusedMessage&& message, Time) {
  if (m_state != State::kGreeting) return reject("a refusal in the middle of the game");
  m_refused_for_now = message.for_now;
  finish(State::kRefused, message.sentence.empty() ? "The server refused." : std::move(message.sentence));
}

void ClientSession::handle(GoodbyeMessage&& message, Time) {
  finish(State::kEnded,
         message.sentence.empty() ? "The server ended the game." : std::move(message.sentence));
}

void ClientSession::handle(SnapshotMessage&& message, Time now) {
  if (m_state != State::kPlaying) return reject("a snapshot before the welcome");
  m_timing.streamSnapshotCame(now);
  if (!m_second.isRepeat(message.bytes)) takeSnapshot(message.bytes, now);
}

void ClientSession::takeSnapshot(std::string_view bytes, Time now) {
  SnapshotHeader header;
  const WorldFeed::Taken taken = m_world.take(bytes, now, header, m_observer);
  m_counters.resets = m_world.resets();
  switch (taken) {
    case WorldFeed::Taken::kApplied:
      break;
    case WorldFeed::Taken::kShown:
      m_table_known = m_control_known = 0;
      break;
    case WorldFeed::Taken::kIgnored:
      return;
    case WorldFeed::Taken::kStale:
      ++m_counters.stale_snapshots;
      if (m_world.wantsResetNow()) sendUpdate(now);
      return;
    case WorldFeed::Taken::kMalformed:
      return reject("a malformed snapshot");
  }
  m_acks.note(header.number);
  m_clock.note(header.tick, now);
  if (header.tells_input) {
    const auto input = m_inputs.taken(header.input);
    if (input) m_input_tick_estimator.noteTaken(input->tick, header.input_tick);
  }
  takeControls();
  ++m_counters.snapshots;
  if (m_after_observer) m_after_observer(header, m_acks);
  const bool gap = (m_acks.mask & 1) == 0 && m_counters.snapshots > 1;
  if (m_timing.snapshotApplied(gap, now)) sendUpdate(now);
}

// What the newest snapshots said of the player's own object.
void ClientSession::takeControls() {
  if (replica().controlTableNumber() != m_table_known) {
    m_table_known = replica().controlTableNumber();
    m_prediction.setTable(replica().controlTable());
  }
  if (replica().controlNumber() != m_control_known) {
    m_control_known = replica().controlNumber();
    m_prediction.take(replica().control());
  }
}

std::uint32_t ClientSession::predictedTick(Time now) const {
  return m_input_tick_estimator.tickFor(m_clock, m_welcome.tick, now);
}

const Prediction& ClientSession::predict(Time now) {
  m_prediction.run(replica(), predictedTick(now));
  return m_prediction;
}

bool ClientSession::takeKept(std::uint32_t number) {
  if (m_kept_heard.take(number)) return true;
  ++m_counters.repeated_frames;
  return false;
}

void ClientSession::handle(PlayersMessage&& message, Time) {
  if (m_state != State::kPlaying) return reject("players before the welcome");
  if (!takeKept(message.number)) return;
  m_players = std::move(message.players);
}

void ClientSession::handle(ChatMessage&& message, Time now) {
  if (m_state != State::kPlaying) return reject("chat before the welcome");
  if (!takeKept(message.number)) return;
  m_chat.note(std::move(message), m_players, m_welcome, now);
  ++m_counters.chat_lines;
}

void ClientSession::handle(SoundsMessage&& message, Time) {
  if (m_state != State::kPlaying) return reject("sounds before the welcome");
  if (!takeKept(message.number)) return;
  m_counters.sounds += message.sounds.size();
  for (SoundLine& sound : message.sounds) m_sounds.push_back(std::move(sound));
  if (m_sounds.size() <= kMaxUnheard) return;
  m_sounds.erase(m_sounds.begin(), m_sounds.end() - static_cast<std::ptrdiff_t>(kMaxUnheard));
}

void ClientSession::handle(const PongMessage& message, Time now) {
  // Else a server could put off the time-out of the greeting for ever.
  if (m_state != State::kPlaying) return reject("a pong before the welcome");
  m_kept.acknowledge(message.received);
  if (const auto sample = m_round_trip.pong(message.token, now)) noteRoundTrip(*sample);
}

void ClientSession::noteRoundTrip(RoundTrip::Millis sample) {
  m_input_tick_estimator.noteRoundTrip(sample);
  m_clock.setWay(
      std::chrono::duration_cast<DisplayClock::Duration>(m_input_tick_estimator.shortestRoundTrip() / 2));
}

void ClientSession::closed(CloseReason reason) {
  if (isOver()) return;
  switch (reason) {
    case CloseReason::kProtocol:
      return reject("bytes that are no frame");
    case CloseReason::kOverflow:
      return finish(State::kLost, "The connection to the server is too slow.");
    default:
      break;
  }
  m_second.close();
  if (m_state == State::kPlaying && !m_welcome.resume_token.empty()) {
    m_channel.reset();
    ++m_revision;
    return;
  }
  finish(State::kLost, m_state == State::kGreeting ? "The server hung up before it answered."
                                                   : "The connection to the server was lost.");
}

void ClientSession::update(Time now) {
  if (isOver()) return;
  m_idle.listen(now);
  if (m_state == State::kGreeting) {
    if (m_idle.at(now) >= kGreetingTimeout) {
      finish(State::kLost, "The server accepted the connection but did not answer.");
    }
    return;
  }
  if (m_timing.takeRepeat(now) && !m_inputs.isEmpty() && hasDatagrams(now)) sendUpdate(now);
  if (m_timing.isAckDue(now)) sendUpdate(now);
  if (m_datagrams != nullptr && m_timing.isProbeDue(now, m_channel == nullptr)) probe(now);
  m_second.update(now);
  if (hasDatagrams(now) && !m_timing.isUndecided(now)) m_second.close();
  if (m_channel == nullptr) {
    if (m_idle.at(now) >= kDetachedTimeout) finish(State::kLost, "The connection to the server was lost.");
    return;
  }
  if (hasDatagrams(now) && m_round_trip.waiting(now) >= kStreamSilence) {
    m_round_trip.forgetPings();
    return closed(CloseReason::kError);  // an address that changed takes datagrams with it, not a stream
  }
  // Keys come from a stream, so for new ones it takes another stream. Datagrams go on meanwhile.
  if (m_datagrams != nullptr && !m_welcome.resume_token.empty() && m_datagrams->takeNewEpochDue()) {
    return closed(CloseReason::kError);
  }
  if (m_idle.at(now) >= kIdleTimeout) {
    if (m_welcome.resume_token.empty()) return finish(State::kLost, "The server fell silent.");
    return closed(CloseReason::kError);  // the line may be down for a while; the session waits for another
  }
  const bool seldom = hasDatagrams(now) && m_round_trip.smoothed().count() > 0;
  if (now - m_last_ping >= (seldom ? kSeldomPing : kPingInterval)) ping(now);
}

void ClientSession::ping(Time now) {
  if (m_channel == nullptr) return;
  m_last_ping = now;
  m_kept_unacknowledged = 0;
  wire::ClientMessage message;
  message.mutable_ping()->set_token(m_round_trip.ping(now));
  message.mutable_ping()->set_rtt_millis(static_cast<std::uint32_t>(roundTrip().count()));
  message.mutable_ping()->set_received(m_kept_heard.newest());
  send(message);
}

bool ClientSession::sendKey(df::Keyboard::Key key, df::EventKeyboardAction action, Time now) {
  if (key < 0 || key >= df::Keyboard::kKeyCount || action < 0) return false;
  Input input;
  input.key = static_cast<std::uint8_t>(key);
  input.action = static_cast<std::uint8_t>(action);
  return sendInput(input, action == df::KEY_RELEASED, now);
}

bool ClientSession::sendMouse(df::EventMouseAction action, df::Mouse::Button button, int x, int y, Time now) {
  if (action < 0 || x < 0 || y < 0 || x >= kMaxViewWidth || y >= kMaxViewHeight) return false;
  Input input;
  input.is_mouse = true;
  input.action = static_cast<std::uint8_t>(action);
  input.button = static_cast<std::uint8_t>(button + 1);
  input.x = static_cast<std::uint16_t>(x);
  input.y = static_cast<std::uint16_t>(y);
  return sendInput(input, false, now);
}

bool ClientSession::sendInput(Input input, bool urgent, Time now) {
  if (m_state != State::kPlaying) return false;
  const bool stuck = m_channel != nullptr && m_channel->unsentBytes() > kMaxUnsent;
  if (m_inputs.isFull(urgent) || stuck || !m_budget.spend(now, urgent)) {
    ++m_counters.inputs_dropped;
    return false;
  }
  input.tick = input.is_mouse ? displayTick(now) : predictedTick(now);
  input.snapshot = m_acks.newest;
  ++m_counters.inputs;
  input = m_inputs.add(input);
  if (!input.is_mouse) {
    m_prediction.press(input.id, static_cast<df::Keyboard::Key>(input.key),
                       static_cast<df::EventKeyboardAction>(input.action), input.tick);
    ++m_revision;  // its effect may be seen at once
  }
  m_timing.inputMade(now);
  sendUpdate(now);
  return true;
}

ClientUpdate ClientSession::nextUpdate(bool in_order, Time now) {
  m_timing.updateMade();
  ClientUpdate update;
  update.acks = m_acks;
  // What is lost, or overtaken on the other stream, is sent again with everything until it is acknowledged.
  update.inputs = in_order ? m_inputs.takeForStream() : m_inputs.all();
  update.wants_reset = m_world.wantsReset();
  if (now >= m_next_checksum && m_acks.newest != 0 && !m_world.isChanging()) {
    m_next_checksum = now + kChecksumEvery;
    update.checksum = replica().checksum();
  }
  return update;
}

// Datagrams may pass from the server and not to it: while it sends on the stream, it is told there, too.
void ClientSession::sendUpdate(Time now) {
  if (hasDatagrams(now)) {
    probe(now);
    if (!m_timing.isUndecided(now)) return;
  }
  if (m_channel == nullptr) return;
  wire::ClientMessage message;
  message.set_update(writeUpdate(nextUpdate(!m_second.isOpen(), now)));
  const std::string frame = message.SerializeAsString();
  sendFrame(frame);
  if (!m_second.isOpen()) return;
  m_counters.bytes_out += frame.size() + kFrameHeaderSize;
  m_second.send(frame);
}

void ClientSession::sendChat(const std::string& text) {
  const std::string safe = safeText(text, kMaxChatLength);
  if (m_state != State::kPlaying || safe.find_first_not_of(' ') == std::string::npos) return;
  wire::ClientMessage message;
  message.mutable_chat()->set_text(safe);
  message.set_number(m_kept.next());
  const std::string frame = message.SerializeAsString();
  if (!m_kept.keep(frame)) {
    ++m_counters.chat_dropped;
    return;
  }
  sendFrame(frame);
}

void ClientSession::sendResize(int columns, int rows) {
  if (m_state != State::kPlaying) return;
  send(resizeOf(columns, rows));
}

void ClientSession::leave() {
  if (isOver()) return;
  wire::ClientMessage message;
  message.mutable_leave();
  send(message);
  finish(State::kLeft, "");
}

std::int32_t ClientSession::score() const {
  for (const PlayerLine& player : m_players) {
    if (player.player == m_welcome.player) return player.score;
  }
  return 0;
}

void ClientSession::reject(const std::string& what) {
  ++m_counters.bad_messages;
  finish(State::kEnded, std::string("The server sent ") + what + "; the session was ended for safety.");
}

void ClientSession::finish(State state, std::string sentence) {
  m_state = state;
  m_sentence = std::move(sentence);
  ++m_revision;
  m_second.close();
  if (m_channel != nullptr) m_channel->close();
}

void ClientSession::send(const wire::ClientMessage& message) {
  sendFrame(message.SerializeAsString());
}

void ClientSession::sendFrame(const std::string& frame) {
  if (m_channel == nullptr) return;
  m_counters.bytes_out += frame.size() + kFrameHeaderSize;
  m_channel->send(frame);
}

}  // namespace naiad
