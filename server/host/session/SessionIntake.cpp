// Parses, checks and applies every frame and datagram from the client. Rejected ones are counted.
#include <algorithm>

#include "host/session/Names.h"
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

// False if the session has ended, or ends now because the message is over the limit.
bool Session::acceptMessage() {
  if (m_state == State::kEnding || m_state == State::kGone) return false;
  if (m_activity.countMessage()) return true;
  ++m_counters.message_floods;
  setLeave(&Counters::left_flood);
  goodbye("Disconnected: too many messages at once.");
  return false;
}

void Session::onFrame(std::string_view frame) {
  if (!acceptMessage()) return;
  m_activity.noteFrame(now());
  wire::ClientMessage message;
  if (!parse(frame, message)) return endMalformed();
  if (m_state == State::kPlaying && !m_kept_heard.take(message.number())) {
    ++m_counters.repeated_frames;
    return;
  }
  if (!dispatch(message)) endMalformed();
}

// Only updates are allowed: messages that need order use the first stream. A frame here does not prove that
// the first stream works.
void Session::onSecondFrame(std::string_view frame) {
  if (!acceptMessage()) return;
  wire::ClientMessage message;
  if (!parse(frame, message) || !message.has_update() || !takeUpdate(message.update(), false)) endMalformed();
}

void Session::onDatagram(std::string_view bytes) {
  if (!acceptMessage()) return;
  m_activity.noteDatagram();
  if (!takeUpdate(bytes, true)) endMalformed();
}

// False if the message breaks a rule: then it has no effect, and the caller ends the connection.
bool Session::dispatch(const wire::ClientMessage& message) {
  using What = wire::ClientMessage::WhatCase;
  const bool greeting = m_state == State::kGreeting;
  if (greeting != (message.what_case() == What::kHello)) return false;
  switch (message.what_case()) {
    case What::kHello:
      // Only one hello is allowed, because each hello may cost a password check
      if (message.hello().magic() != kHelloMagic || m_greeted) return false;
      takeHello(message.hello());
      return true;
    case What::kUpdate:
      return takeUpdate(message.update(), false);
    case What::kChat:
      takeChat(message.chat().text());
      return true;
    case What::kPing:
      takePing(message.ping());
      return true;
    case What::kLeave:
      setLeave(&Counters::left_asked);
      goodbye("You left the game.");
      return true;
    case What::kResize:
      if (m_resize.request({message.resize().columns(), message.resize().rows()}))
        ++m_counters.resizes_deferred;
      return true;
    case What::kListRooms:
    case What::kEnter:
      takeRoomRequest(message);
      return true;
    case What::WHAT_NOT_SET:
      break;
  }
  return false;
}

// A server without rooms may also get these requests, from clients that support rooms.
void Session::takeRoomRequest(const wire::ClientMessage& message) {
  if (!m_knows_rooms || !admitRoomRequest()) {
    ++m_counters.room_requests_dropped;
  } else if (!message.has_enter()) {
    if (m_events.on_list_rooms) m_events.on_list_rooms(*this);
  } else {
    m_standing.noteAction(now());
    if (m_events.on_enter_room) m_events.on_enter_room(*this, message.enter().room());
  }
}

void Session::takeHello(const wire::Hello& hello) {
  m_greeted = true;
  m_knows_rooms = hello.rooms();
  m_resize.request({hello.columns(), hello.rows()});
  m_events.on_hello(*this, hello);
}

void Session::takePing(const wire::Ping& ping) {
  m_rtt_millis = std::min<std::uint32_t>(ping.rtt_millis(), 99'999);
  m_outbox.acknowledge(ping.received());
  wire::ServerMessage answer;
  answer.mutable_pong()->set_token(ping.token());
  answer.mutable_pong()->set_received(m_kept_heard.newest());
  send(answer);
  sendWaiting();
}

bool Session::takeUpdate(std::string_view bytes, bool by_datagram) {
  const auto update = readUpdate(bytes, {sender().newestNumber(), m_delivery.tick(), m_inputs.newest()});
  if (!update) return false;
  const Clock::time_point present = now();
  if (update->acks.newest != 0) m_delivery.acknowledge(update->acks, by_datagram, present);
  if (update->checksum) m_delivery.compareChecksum(update->acks, *update->checksum, present);
  if (update->wants_reset) m_delivery.requestReset(present);
  for (const Input& input : update->inputs) takeInput(input);
  return true;
}

void Session::takeInput(const Input& input) {
  if (m_state != State::kPlaying) return;
  switch (m_inputs.add(input)) {
    case ReceivedInputs::Verdict::kQueued:
      ++m_counters.inputs;
      // The world's next tick is at least the one after the newest published tick.
      m_counters.late_inputs += isNewer(input.tick, m_delivery.tick()) ? 0 : 1;
      return m_standing.noteAction(now());
    case ReceivedInputs::Verdict::kRepeated:
      ++m_counters.repeated_inputs;
      return;
    case ReceivedInputs::Verdict::kTooMany:
      ++m_counters.input_floods;
      setLeave(&Counters::left_flood);
      goodbye("Disconnected: too many keys at once.");
  }
}

void Session::takeChat(const std::string& text) {
  const std::string line = cleanChat(text);
  if (line.empty()) return;
  if (!m_chat.takeLine(now())) {
    ++m_counters.chat_dropped;
    return;
  }
  m_standing.noteAction(now());
  m_events.on_chat(*this, line);
}

void Session::endMalformed() {
  ++m_counters.malformed_messages;
  setLeave(&Counters::left_malformed);
  end();
}

}  // namespace naiad
