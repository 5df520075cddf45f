// The messages that a session sends.
#include "client/session/ClientSession.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/replica/Limits.h"

namespace naiad {

void ClientSession::sendPing(Time now) {
  if (!m_link.hasStream()) return;
  m_inbox.onAcknowledged();
  wire::ClientMessage message;
  message.mutable_ping()->set_token(m_liveness.startPing(now));
  message.mutable_ping()->set_rtt_millis(static_cast<std::uint32_t>(roundTrip().count()));
  message.mutable_ping()->set_last_frame(m_inbox.newestFrame());
  m_link.send(message);
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
  if (m_link.isStalled() || !m_inputs.admitInput(urgent, now)) {
    ++m_counters.inputs_dropped;
    return false;
  }
  input.tick = input.is_mouse ? displayTick(now) : predictedTick(now);
  input.snapshot = m_world.acks().newest;
  ++m_counters.inputs;
  input = m_inputs.add(input);
  if (!input.is_mouse) {
    m_world.predictInput(input);
    ++m_revision;
  }
  m_timing.onInput(now);
  sendUpdate(now);
  return true;
}

std::string ClientSession::nextUpdate(bool in_order, Time now) {
  m_timing.onUpdateSent();
  ClientUpdate update;
  update.acks = m_world.acks();
  // If updates may be lost or overtake one another, each carries all unacknowledged inputs.
  update.inputs = in_order ? m_inputs.popForStream() : m_inputs.all();
  update.needs_reset = m_world.worlds().needsReset();
  update.checksum = m_world.pollChecksum(now);
  return writeUpdate(update);
}

void ClientSession::sendProbe(Time now) {
  const bool ping = m_timing.onDatagramSent(now);
  m_link.sendDatagram(nextUpdate(false, now), ping);
}

// Datagrams may pass in one direction only, so updates also use the stream while the server sends on it.
void ClientSession::sendUpdate(Time now) {
  if (hasDatagrams(now)) {
    sendProbe(now);
    if (!m_timing.isUndecided(now)) return;
  }
  if (!m_link.hasStream()) return m_timing.onUpdateSent();  // no path: wait for the next snapshot
  m_link.sendUpdate(nextUpdate(!m_link.hasSecondStream(), now));
}

void ClientSession::sendChat(const std::string& text) {
  const std::string safe = safeText(text, kMaxChatLength);
  if (m_state != State::kPlaying || safe.find_first_not_of(' ') == std::string::npos) return;
  wire::ClientMessage message;
  message.mutable_chat()->set_text(safe);
  if (!m_link.sendReliable(message)) ++m_counters.chat_dropped;
}

void ClientSession::sendResize(int columns, int rows) {
  if (m_state == State::kPlaying) m_link.send(resizeOf(columns, rows));
}

void ClientSession::refreshRooms(Time now) {
  if (m_state != State::kPlaying || m_welcome.room.empty() || now < m_rooms_due) return;
  m_rooms_due = now + kRoomListInterval;
  wire::ClientMessage message;
  message.mutable_list_rooms();
  m_link.send(message);
}

void ClientSession::enterRoom(const std::string& room) {
  if (m_state != State::kPlaying || m_welcome.room.empty() || !isRoomName(room)) return;
  wire::ClientMessage message;
  message.mutable_enter_room()->set_room(room);
  m_link.sendReliable(message);
}

void ClientSession::leave() {
  if (isOver()) return;
  sendLeave();
  finish(State::kLeft, "");
}

void ClientSession::sendLeave() {
  wire::ClientMessage message;
  message.mutable_leave();
  m_link.send(message);
}

}  // namespace naiad
