// What a session takes in of its client: every frame and datagram is parsed, checked and taken over, or
// refused and counted, in this file.
#include <google/protobuf/stubs/logging.h>

#include <algorithm>

#include "host/session/Names.h"
#include "host/session/Session.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

bool parse(std::string_view frame, wire::ClientMessage& message) {
  // protobuf reports malformed text on stderr: a stranger could fill the host's log. It is counted instead.
  static const auto previous_handler = google::protobuf::SetLogHandler(nullptr);
  (void)previous_handler;
  return message.ParseFromArray(frame.data(), static_cast<int>(frame.size()));
}

}  // namespace

// Within what a client may send between two ticks? If not, the session has ended.
bool Session::mayHear() {
  if (m_state == State::kEnding || m_state == State::kGone) return false;
  if (++m_messages <= kMessagesPerTick) return true;
  ++m_counters.message_floods;
  goodbye("Too many messages at once.");
  return false;
}

void Session::onFrame(std::string_view frame) {
  if (!mayHear()) return;
  m_spoke = true;
  if (std::exchange(m_awaits_proof, false)) m_proved = true;
  m_frame_at = now();
  wire::ClientMessage message;
  if (!parse(frame, message)) return malformed();
  if (m_state == State::kPlaying && !m_kept_heard.take(message.number())) {
    ++m_counters.repeated_frames;
    return;
  }
  if (!dispatch(message)) malformed();
}

// What needs order and certainty goes on the first stream only; and a first one that has died is to be
// noticed.
void Session::onSecondFrame(std::string_view frame) {
  if (!mayHear()) return;
  wire::ClientMessage message;
  if (!parse(frame, message) || !message.has_update() || !takeUpdate(message.update(), false)) malformed();
}

void Session::onDatagram(std::string_view bytes) {
  if (!mayHear()) return;
  m_spoke = true;
  if (!takeUpdate(bytes, true)) malformed();
}

// False if the message breaks a rule: then the connection ends, and nothing else happens.
bool Session::dispatch(const wire::ClientMessage& message) {
  using What = wire::ClientMessage::WhatCase;
  const bool greeting = m_state == State::kGreeting;
  if (greeting != (message.what_case() == What::kHello)) return false;
  switch (message.what_case()) {
    case What::kHello:
      // Once: a password is being checked, perhaps, and that must not begin again and again.
      if (message.hello().magic() != kHelloMagic || m_greeted) return false;
      m_greeted = true;
      m_resize.emplace(message.hello().columns(), message.hello().rows());
      m_events.on_hello(*this, message.hello());
      return true;
    case What::kUpdate:
      return takeUpdate(message.update(), false);
    case What::kChat:
      takeChat(message.chat().text());
      return true;
    case What::kPing: {
      m_rtt_millis = std::min<std::uint32_t>(message.ping().rtt_millis(), 99'999);
      m_kept.acknowledge(message.ping().received());
      wire::ServerMessage answer;
      answer.mutable_pong()->set_token(message.ping().token());
      answer.mutable_pong()->set_received(m_kept_heard.newest());
      send(answer);
      return true;
    }
    case What::kLeave:
      goodbye("You left the game.");
      return true;
    case What::kResize:
      takeResize(message.resize());
      return true;
    case What::WHAT_NOT_SET:
      break;
  }
  return false;
}

bool Session::takeUpdate(std::string_view bytes, bool by_datagram) {
  const auto update = readUpdate(bytes, {m_sender.newestNumber(), m_tick, m_input_received});
  if (!update) return false;
  if (update->acks.newest != 0) {
    takeAcks();
    m_acks = update->acks;
    m_transport.acknowledged(update->acks, by_datagram, now());
  }
  if (update->checksum) compare(update->acks, *update->checksum);
  if (update->wants_reset) reset();
  return std::all_of(update->inputs.begin(), update->inputs.end(),
                     [this](const Input& input) { return takeInput(input); });
}

// What they settle is spread over memory that the session's turn in the tick needs anyway: they wait for
// that.
void Session::takeAcks() {
  if (m_acks) m_sender.acknowledge(*m_acks);
  m_acks.reset();
}

bool Session::isTooEarly(const Input& input, std::uint32_t tick) const {
  const auto early = static_cast<std::int32_t>(input.tick - tick);
  if (m_controls == nullptr || input.is_mouse || early <= 0 || early > kMaxEarly) return false;
  return std::any_of(m_controls->rows.begin(), m_controls->rows.end(),
                     [&input](const df::ControlRow& row) { return row.key == input.key; });
}

// Does the client hold what it was sent?
void Session::compare(const AckWindow& acks, std::uint64_t checksum) {
  const Clock::time_point present = now();
  if (m_last_checksum && present - *m_last_checksum < kChecksumEvery) {
    ++m_counters.checksums_dropped;
    return;
  }
  m_last_checksum = present;
  takeAcks();
  if (m_sender.isRight(acks, checksum) != false) return;
  ++m_counters.divergences;
  reset();
}

// The client's world comes anew, though not more often than a line can carry.
void Session::reset() {
  const Clock::time_point present = now();
  if (m_last_reset && present - *m_last_reset < kResetEvery) {
    ++m_counters.resets_dropped;
    return;
  }
  m_last_reset = present;
  ++m_counters.resets;
  m_acks.reset();
  m_sender.reset();
}

// False if the session has ended of it.
bool Session::takeInput(const Input& input) {
  if (m_state != State::kPlaying) return true;
  if (!isNewer(input.id, m_input_received)) {
    ++m_counters.repeated_inputs;
    return true;
  }
  if (m_inputs.size() >= kMaxQueuedInputs) {
    ++m_counters.input_floods;
    goodbye("Too many keys at once.");
    return true;
  }
  m_input_received = input.id;
  m_inputs.push_back(input);
  m_pressed.note(input);
  return true;
}

// The newest size counts, but not at once if it changes all the time: each may owe the client half a world.
void Session::takeResize(const wire::Resize& size) {
  if (m_resize) ++m_counters.resizes_deferred;
  m_resize.emplace(size.columns(), size.rows());
}

void Session::takeChat(const std::string& text) {
  const std::string line = cleanChat(text);
  if (line.empty()) return;
  if (m_chat_budget <= 0) {
    ++m_counters.chat_dropped;
    return;
  }
  --m_chat_budget;
  m_events.on_chat(*this, line);
}

void Session::malformed() {
  ++m_counters.malformed_messages;
  end();
}

}  // namespace naiad
