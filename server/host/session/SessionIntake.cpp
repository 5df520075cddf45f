// Parses, checks and applies every frame and datagram from the client. Rejected ones are counted.
#include <algorithm>

#include "host/session/NameSanitizer.h"
#include "host/session/Session.h"
#include "naiad.pb.h"
#include "proto/ParseErrors.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Acks.h"

namespace naiad {
namespace {

bool parse(std::string_view frame, wire::ClientMessage& message) {
  silenceParseErrors();  // strangers could fill the host's log; malformed frames are counted instead
  return message.ParseFromArray(frame.data(), static_cast<int>(frame.size()));
}

}  // namespace

// Returns false if the session has ended, or ends now because the message is over the limit.
bool Session::acceptMessage() {
  if (m_state == State::kEnding || m_state == State::kGone) return false;
  if (m_activity.countMessage()) return true;
  ++m_counters.message_floods;
  setLeaveReason(&Counters::left_flood, "too many messages at once");
  sendGoodbye("Disconnected: too many messages at once.");
  return false;
}

void Session::onFrame(std::string_view frame) {
  if (!acceptMessage()) return;
  m_activity.onFrame(now());
  wire::ClientMessage message;
  if (!parse(frame, message)) return endMalformed();
  if (m_state == State::kPlaying && !m_reliable_received.accept(message.number())) {
    ++m_counters.repeated_frames;
    return;
  }
  if (!dispatch(message)) endMalformed();
}

// Only updates are allowed: messages that need order use the first stream. A frame on the second stream
// does not prove that the first one works.
void Session::onSecondFrame(std::string_view frame) {
  if (!acceptMessage()) return;
  wire::ClientMessage message;
  if (!parse(frame, message) || !message.has_update() || !handleUpdate(message.update(), false))
    endMalformed();
}

void Session::onDatagram(std::string_view bytes) {
  if (!acceptMessage()) return;
  m_activity.onDatagram();
  if (!handleUpdate(bytes, true)) endMalformed();
}

// False if the message breaks a rule: then it has no effect, and the caller ends the connection.
bool Session::dispatch(const wire::ClientMessage& message) {
  using What = wire::ClientMessage::PayloadCase;
  const bool greeting = m_state == State::kGreeting;
  if (greeting != (message.payload_case() == What::kHello)) return false;
  switch (message.payload_case()) {
    case What::kHello:
      // Only one hello is allowed, because each hello may cost a password check.
      if (message.hello().magic() != kHelloMagic || m_has_hello) return false;
      handleHello(message.hello());
      return true;
    case What::kUpdate:
      return handleUpdate(message.update(), false);
    case What::kChat:
      handleChat(message.chat().text());
      return true;
    case What::kPing:
      handlePing(message.ping());
      return true;
    case What::kLeave:
      setLeaveReason(&Counters::left_voluntarily, "quit");
      sendGoodbye("You left the game.");
      return true;
    case What::kResize:
      if (m_resize.request({message.resize().columns(), message.resize().rows()}))
        ++m_counters.resizes_deferred;
      return true;
    case What::kListRooms:
    case What::kEnterRoom:
      handleRoomRequest(message);
      return true;
    case What::PAYLOAD_NOT_SET:
      break;
  }
  return false;
}

// A server without rooms may also get these requests, from clients that support rooms.
void Session::handleRoomRequest(const wire::ClientMessage& message) {
  if (!m_supports_rooms || !admitRoomRequest()) {
    ++m_counters.room_requests_dropped;
  } else if (!message.has_enter_room()) {
    if (m_events.on_list_rooms) m_events.on_list_rooms(*this);
  } else {
    m_status.onActivity(now());
    if (m_events.on_enter_room) m_events.on_enter_room(*this, message.enter_room().room());
  }
}

void Session::handleHello(const wire::Hello& hello) {
  m_has_hello = true;
  m_supports_rooms = hello.rooms();
  m_resize.request({hello.columns(), hello.rows()});
  m_events.on_hello(*this, hello);
}

void Session::handlePing(const wire::Ping& ping) {
  m_rtt_millis = std::min<std::uint32_t>(ping.rtt_millis(), 99'999);
  m_outbox.acknowledge(ping.last_frame());
  wire::ServerMessage answer;
  answer.mutable_pong()->set_token(ping.token());
  answer.mutable_pong()->set_last_frame(m_reliable_received.newest());
  send(answer);
  sendWaiting();
}

bool Session::handleUpdate(std::string_view bytes, bool by_datagram) {
  const auto update = readUpdate(bytes, {sender().newestNumber(), m_delivery.tick(), m_inputs.newest()});
  if (!update) return false;
  const Clock::time_point present = now();
  if (update->acks.newest != 0) m_delivery.acknowledge(update->acks, by_datagram, present);
  if (update->checksum) m_delivery.compareChecksum(update->acks, *update->checksum, present);
  if (update->needs_reset) m_delivery.requestReset(present);
  for (const Input& input : update->inputs) handleInput(input);
  return true;
}

// An input beyond ReceivedInputs::kMaxQueued ends the session with a goodbye: the player leaves at once,
// without a time to reconnect.
void Session::handleInput(const Input& input) {
  if (m_state != State::kPlaying) return;
  switch (m_inputs.add(input)) {
    case ReceivedInputs::Result::kQueued:
      ++m_counters.inputs;
      // The world's next tick is at least the one after the newest published tick.
      m_counters.late_inputs += isNewer(input.tick, m_delivery.tick()) ? 0 : 1;
      return m_status.onActivity(now());
    case ReceivedInputs::Result::kRepeated:
      ++m_counters.repeated_inputs;
      return;
    case ReceivedInputs::Result::kTooMany:
      ++m_counters.input_floods;
      setLeaveReason(&Counters::left_flood, "too many keys at once");
      sendGoodbye("Disconnected: too many keys at once.");
  }
}

void Session::handleChat(const std::string& text) {
  const std::string line = cleanChat(text);
  if (line.empty()) return;
  if (!m_chat.tryConsume(now())) {
    ++m_counters.chat_dropped;
    return;
  }
  m_status.onActivity(now());
  m_events.on_chat(*this, line);
}

void Session::endMalformed() {
  ++m_counters.malformed_messages;
  setLeaveReason(&Counters::left_malformed, "invalid message");
  end();
}

}  // namespace naiad
