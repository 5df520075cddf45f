#include "ClientSession.h"

#include <algorithm>
#include <utility>

#include "Framing.h"
#include "Limits.h"
#include "SafeText.h"
#include "naiad.pb.h"

namespace naiad {
namespace {

constexpr std::size_t kMaxOpenPings = 20;
/// With this much unsent the line is stuck; more inputs would only make the server busy later.
constexpr std::size_t kMaxUnsent = std::size_t{64} * 1024;

std::uint32_t clampedCells(int cells) {
  return static_cast<std::uint32_t>(std::clamp(cells, 0, 9999));
}

}  // namespace

ClientSession::ClientSession(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
                             Time now)
    : m_channel(std::move(channel)), m_options(options), m_last_ping(now), m_last_heard(now) {
  m_channel->setReceiveLimit(kMaxServerFrame);
  wire::ClientMessage message;
  wire::Hello& hello = *message.mutable_hello();
  hello.set_magic(kHelloMagic);
  hello.set_protocol(kProtocolVersion);
  hello.set_player_name(safeName(options.name));
  hello.set_game(safeText(options.game, 64));
  hello.set_program(options.program);
  hello.set_columns(clampedCells(options.columns));
  hello.set_rows(clampedCells(options.rows));
  hello.set_password(options.password);
  hello.set_resume_token(options.resume_token);
  if (options.open_socket) {
    hello.add_aeads(static_cast<std::uint32_t>(AeadId::kAes128Gcm));
    hello.add_aeads(static_cast<std::uint32_t>(AeadId::kChaCha20Poly1305));
  }
  send(message);
}

void ClientSession::receive(std::string_view frame, Time now) {
  if (isOver()) return;
  m_last_heard = now;
  m_counters.bytes_in += frame.size() + kFrameHeaderSize;
  auto message = readServerMessage(frame);
  if (!message) return reject("a malformed message");
  std::visit([this, now](auto& m) { handle(std::move(m), now); }, *message);
  ++m_revision;
}

void ClientSession::handle(WelcomeMessage&& message, Time now) {
  if (m_state != State::kGreeting) return reject("a second welcome");
  m_welcome = std::move(message);
  m_clock = DisplayClock(m_welcome.tick);
  m_replica = Replica(m_welcome.tick_now);
  m_budget.setTick(m_welcome.tick);
  m_state = State::kPlaying;
  m_last_ping = now - kPingInterval;
  m_attached = now;
  if (!m_welcome.resumed) openDatagrams(now);
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
  m_datagrams = std::make_unique<SealedDatagrams>(std::move(socket), *server,
                                                  ConnectionId{m_welcome.connection_id}, m_options.now);
  if (!m_datagrams->startEpoch(exporter(), *aead, m_welcome.epoch)) return m_datagrams.reset();
  m_datagrams->start([this](std::string_view bytes) { onDatagram(bytes, m_options.now()); });
  probe(now);
}

void ClientSession::adopt(ClientSession& other, Time now) {
  m_channel = std::move(other.m_channel);
  other.m_state = State::kLeft;
  m_welcome.resume_token = other.m_welcome.resume_token;
  m_last_heard = m_attached = now;
  m_newest_on_stream = 0;
  m_pings.clear();
  m_last_ping = now - kSeldomPing;  // at once: it proves to the server that the new token has come
  const auto aead = aeadFromWire(other.m_welcome.aead);
  if (m_datagrams && aead) {
    m_datagrams->startEpoch(exporter(), *aead, other.m_welcome.epoch);
    m_datagrams->reopen();
  }
  ++m_revision;
  sendUpdate(now);
  update(now);
}

void ClientSession::onDatagram(std::string_view bytes, Time now) {
  if (m_state != State::kPlaying) return;
  m_last_heard = m_last_datagram = now;
  m_counters.bytes_in += bytes.size();
  ++m_counters.datagrams_in;
  takeSnapshot(bytes, now);
  ++m_revision;
}

void ClientSession::probe(Time now) {
  m_last_probe = now;
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
  m_last_streamed = now;
  takeSnapshot(message.bytes, now);
}

// A snapshot of another epoch belongs to a world that comes anew; the old one is shown until it has come.
Replica* ClientSession::replicaFor(std::string_view bytes, Time now) {
  const auto epoch = peekEpoch(bytes);
  if (!epoch || *epoch == m_epoch) return &m_replica;
  if (*epoch == ((m_epoch + 3) & 3)) return nullptr;  // a late one of the epoch before
  if (!m_next_replica || m_next_epoch != *epoch) {
    m_next_epoch = *epoch;
    m_next_replica = Replica::anew(m_replica.newest());
    m_reset_at = now;
    ++m_counters.resets;
  }
  return &*m_next_replica;
}

void ClientSession::takeSnapshot(std::string_view bytes, Time now) {
  Replica* replica = replicaFor(bytes, now);
  if (replica == nullptr) return;
  Snapshot snapshot;
  switch (replica->read(bytes, snapshot)) {
    case ReadResult::kOk:
      break;
    case ReadResult::kStale:
      ++m_counters.stale_snapshots;
      if (++m_stale_in_a_row % kMostStale == 0) sendUpdate(now);  // asks for the world anew
      return;
    case ReadResult::kMalformed:
      return reject("a malformed snapshot");
  }
  m_stale_in_a_row = 0;
  if (m_observer) m_observer(snapshot.header.tick);
  replica->apply(snapshot);
  if (replica != &m_replica && (snapshot.header.complete || now - m_reset_at >= kResetPatience)) {
    m_replica = std::move(*m_next_replica);
    m_next_replica.reset();
    m_epoch = m_next_epoch;
    m_table_known = m_control_known = 0;
  }
  m_acks.note(snapshot.header.number);
  m_clock.note(snapshot.header.tick, now);
  if (snapshot.header.tells_input) {
    for (; !m_inputs.empty() && !isNewer(m_inputs.front().id, snapshot.header.input); m_inputs.pop_front()) {
      if (m_inputs.front().id == snapshot.header.input) {
        m_take_in.noteTaken(m_inputs.front().tick, snapshot.header.input_tick);
      }
    }
  }
  takeControls();
  ++m_counters.snapshots;
  if (m_after_observer) m_after_observer(snapshot.header, m_acks);
  // Not each of them, unless something is missing.
  ++m_unacknowledged;
  const bool gap = (m_acks.mask & 1) == 0 && m_counters.snapshots > 1;
  if (!hasDatagrams(now) || m_unacknowledged >= kAckEvery || gap) return sendUpdate(now);
  m_acknowledge_at = now + kAckDelay;
}

// What the newest snapshots said of the player's own object.
void ClientSession::takeControls() {
  if (m_replica.controlTableNumber() != m_table_known) {
    m_table_known = m_replica.controlTableNumber();
    m_prediction.setTable(m_replica.controlTable());
  }
  if (m_replica.controlNumber() != m_control_known) {
    m_control_known = m_replica.controlNumber();
    m_prediction.take(m_replica.control());
  }
}

std::uint32_t ClientSession::predictedTick(Time now) const {
  return m_take_in.tickFor(m_clock, m_welcome.tick, now);
}

const Prediction& ClientSession::predict(Time now) {
  m_prediction.run(m_replica, predictedTick(now));
  return m_prediction;
}

std::optional<ClientSession::Time> ClientSession::nextWake() const {
  if (!m_repeat_at || !m_acknowledge_at) return m_repeat_at ? m_repeat_at : m_acknowledge_at;
  return std::min(*m_repeat_at, *m_acknowledge_at);
}

void ClientSession::handle(PlayersMessage&& message, Time) {
  if (m_state != State::kPlaying) return reject("players before the welcome");
  m_players = std::move(message.players);
}

void ClientSession::handle(ChatMessage&& message, Time now) {
  if (m_state != State::kPlaying) return reject("chat before the welcome");
  ChatEntry entry{"", df::COLOR_DEFAULT, std::move(message.text), now};
  if (message.player != 0) {
    entry.name.assign(1, '?');  // somebody who has left already
    for (const PlayerLine& player : m_players) {
      if (player.player != message.player) continue;
      entry.name = player.name;
      entry.color = player.color;
    }
    if (message.player == m_welcome.player) {
      entry.name = m_welcome.name;
      entry.color = m_welcome.color;
    }
  }
  m_chat.push_back(std::move(entry));
  if (m_chat.size() > kMaxChatLog) m_chat.pop_front();
  ++m_counters.chat_lines;
}

void ClientSession::handle(const PongMessage& message, Time now) {
  // Else a server could put off the time-out of the greeting for ever.
  if (m_state != State::kPlaying) return reject("a pong before the welcome");
  const auto ping = m_pings.find(message.token);
  if (ping == m_pings.end()) return;  // answered twice, or made up
  const std::chrono::duration<double, std::milli> sample = now - ping->second;
  m_pings.erase(m_pings.begin(), std::next(ping));
  m_take_in.noteRoundTrip(sample);
  m_clock.setWay(std::chrono::duration_cast<DisplayClock::Duration>(m_take_in.shortestRoundTrip() / 2));
  m_round_trip = m_round_trip.count() == 0 ? sample : m_round_trip + (sample - m_round_trip) / 8;
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
  if (m_state == State::kGreeting) {
    if (now - m_last_heard >= kGreetingTimeout) {
      finish(State::kLost, "The server accepted the connection but did not answer.");
    }
    return;
  }
  if (m_repeat_at && now >= *m_repeat_at) {
    m_repeat_at.reset();
    if (!m_inputs.empty() && hasDatagrams(now)) sendUpdate(now);
  }
  if (m_acknowledge_at && now >= *m_acknowledge_at) sendUpdate(now);
  const bool often = now - m_attached < kPassing || hasDatagrams(now);
  const auto between = often ? kFirstProbes : kProbeEvery;
  if (m_datagrams != nullptr && now - m_last_datagram >= kQuiet && now - m_last_probe >= between) probe(now);
  if (m_channel == nullptr) {
    if (now - m_last_heard >= kDetachedTimeout)
      finish(State::kLost, "The connection to the server was lost.");
    return;
  }
  if (hasDatagrams(now) && !m_pings.empty() && now - m_pings.begin()->second >= kStreamSilence) {
    m_pings.clear();
    return closed(CloseReason::kError);  // an address that changed takes datagrams with it, not a stream
  }
  if (now - m_last_heard >= kIdleTimeout) {
    if (m_welcome.resume_token.empty()) return finish(State::kLost, "The server fell silent.");
    return closed(CloseReason::kError);  // the line may be down for a while; the session waits for another
  }
  if (now - m_last_ping < (hasDatagrams(now) && m_round_trip.count() > 0 ? kSeldomPing : kPingInterval))
    return;
  m_last_ping = now;
  if (m_pings.size() >= kMaxOpenPings) m_pings.erase(m_pings.begin());
  m_pings.emplace(m_next_token, now);
  wire::ClientMessage message;
  message.mutable_ping()->set_token(m_next_token++);
  message.mutable_ping()->set_rtt_millis(static_cast<std::uint32_t>(roundTrip().count()));
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
  const bool stalled = !urgent && m_inputs.size() >= kMaxUnapplied;
  if (stalled || stuck || m_inputs.size() >= kMaxUpdateInputs || !m_budget.spend(now, urgent)) {
    ++m_counters.inputs_dropped;
    return false;
  }
  input.id = m_next_input++;
  input.tick = predictedTick(now);
  input.snapshot = m_acks.newest;
  ++m_counters.inputs;
  m_inputs.push_back(input);
  if (!input.is_mouse) {
    m_prediction.press(input.id, static_cast<df::Keyboard::Key>(input.key),
                       static_cast<df::EventKeyboardAction>(input.action), input.tick);
    ++m_revision;  // its effect may be seen at once
  }
  m_repeat_at = now + kRepeatInput;
  sendUpdate(now);
  return true;
}

ClientUpdate ClientSession::nextUpdate(bool on_stream, Time now) {
  m_unacknowledged = 0;
  m_acknowledge_at.reset();
  ClientUpdate update;
  update.acks = m_acks;
  // What is lost is sent again with everything until it is acknowledged; the stream loses nothing.
  for (const Input& input : m_inputs) {
    if (!on_stream || isNewer(input.id, m_newest_on_stream)) update.inputs.push_back(input);
  }
  if (on_stream && !m_inputs.empty()) m_newest_on_stream = m_inputs.back().id;
  update.wants_reset = m_stale_in_a_row >= kMostStale;
  if (now >= m_next_checksum && m_acks.newest != 0 && !m_next_replica) {
    m_next_checksum = now + kChecksumEvery;
    update.checksum = m_replica.checksum();
  }
  return update;
}

// Datagrams may pass from the server and not to it: while it sends on the stream, it is told there, too.
void ClientSession::sendUpdate(Time now) {
  if (hasDatagrams(now)) {
    probe(now);
    if (now - m_last_streamed >= kUndecided) return;
  }
  if (m_channel == nullptr) return;
  wire::ClientMessage message;
  message.set_update(writeUpdate(nextUpdate(true, now)));
  send(message);
}

void ClientSession::sendChat(const std::string& text) {
  const std::string safe = safeText(text, kMaxChatLength);
  if (m_state != State::kPlaying || safe.find_first_not_of(' ') == std::string::npos) return;
  wire::ClientMessage message;
  message.mutable_chat()->set_text(safe);
  send(message);
}

void ClientSession::sendResize(int columns, int rows) {
  if (m_state != State::kPlaying) return;
  wire::ClientMessage message;
  message.mutable_resize()->set_columns(clampedCells(columns));
  message.mutable_resize()->set_rows(clampedCells(rows));
  send(message);
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

std::chrono::milliseconds ClientSession::roundTrip() const {
  // Less than a millisecond is a measurement too.
  const auto whole = std::chrono::ceil<std::chrono::milliseconds>(m_round_trip);
  return std::min<std::chrono::milliseconds>(whole, std::chrono::milliseconds(99999));
}

void ClientSession::reject(const std::string& what) {
  ++m_counters.bad_messages;
  finish(State::kEnded, std::string("The server sent ") + what + "; the session was ended for safety.");
}

void ClientSession::finish(State state, std::string sentence) {
  m_state = state;
  m_sentence = std::move(sentence);
  ++m_revision;
  if (m_channel != nullptr) m_channel->close();
}

void ClientSession::send(const wire::ClientMessage& message) {
  if (m_channel == nullptr) return;
  const std::string bytes = message.SerializeAsString();
  m_counters.bytes_out += bytes.size() + kFrameHeaderSize;
  m_channel->send(bytes);
}

}  // namespace naiad
