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
    : m_channel(std::move(channel)), m_last_ping(now), m_last_heard(now) {
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
  update(now);
}

void ClientSession::handle(RefusedMessage&& message, Time) {
  if (m_state != State::kGreeting) return reject("a refusal in the middle of the game");
  finish(State::kRefused, message.sentence.empty() ? "The server refused." : std::move(message.sentence));
}

void ClientSession::handle(GoodbyeMessage&& message, Time) {
  finish(State::kEnded,
         message.sentence.empty() ? "The server ended the game." : std::move(message.sentence));
}

void ClientSession::handle(SnapshotMessage&& message, Time now) {
  if (m_state != State::kPlaying) return reject("a snapshot before the welcome");
  takeSnapshot(message.bytes, now);
}

void ClientSession::takeSnapshot(std::string_view bytes, Time now) {
  Snapshot snapshot;
  switch (m_replica.read(bytes, snapshot)) {
    case ReadResult::kOk:
      break;
    case ReadResult::kStale:
      ++m_counters.stale_snapshots;
      return;
    case ReadResult::kMalformed:
      return reject("a malformed snapshot");
  }
  if (m_observer) m_observer(snapshot.header.tick);
  m_replica.apply(snapshot);
  m_acks.note(snapshot.header.number);
  m_clock.note(snapshot.header.tick, now);
  ++m_counters.snapshots;
  sendUpdate();
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
  if (now - m_last_heard >= kIdleTimeout) return finish(State::kLost, "The server fell silent.");
  if (now - m_last_ping < kPingInterval) return;
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
  const bool stalled = !urgent && m_next_input - 1 - m_replica.newest().input >= kMaxUnapplied;
  if (stalled || !m_budget.spend(now, urgent) || m_channel->unsentBytes() > kMaxUnsent) {
    ++m_counters.inputs_dropped;
    return false;
  }
  input.id = m_next_input++;
  input.tick = m_clock.displayTick(now);
  input.snapshot = m_acks.newest;
  ++m_counters.inputs;
  m_unsent_inputs.push_back(input);
  sendUpdate();
  return true;
}

void ClientSession::sendUpdate() {
  ClientUpdate update;
  update.acks = m_acks;
  update.inputs.assign(m_unsent_inputs.begin(), m_unsent_inputs.end());
  m_unsent_inputs.clear();
  wire::ClientMessage message;
  message.set_update(writeUpdate(update));
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
  m_channel->close();
}

void ClientSession::send(const wire::ClientMessage& message) {
  const std::string bytes = message.SerializeAsString();
  m_counters.bytes_out += bytes.size() + kFrameHeaderSize;
  m_channel->send(bytes);
}

}  // namespace naiad
