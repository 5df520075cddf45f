#include "host/session/Session.h"

#include <algorithm>

#include "shared/net/base/Limits.h"
#include "shared/replica/Limits.h"

namespace naiad {

namespace {

constexpr SnapshotSender::Room kStreamRoom{64, kMaxSnapshot, false};
constexpr SnapshotSender::Room kSecondRoom{1, Session::kMaxOnSecond, false};
/// At 30 Hz more than a megabit per second.
constexpr std::size_t kDatagramsPerTick = 4;

/// Sessions of a thread send one after the other, so that one place does for their packets.
SnapshotSender::Packets& packetsOfThread() {
  thread_local SnapshotSender::Packets packets;
  return packets;
}

}  // namespace

Session::Session(std::unique_ptr<ReliableChannel> channel, Counters& counters, Clock::time_point now)
    : m_chat_refill(now),
      m_idle(now),
      m_channel(std::move(channel)),
      m_counters(counters),
      m_frame_at(now),
      m_transport(now) {
  m_reception->session = this;
}

void Session::start(Events events) {
  m_events = std::move(events);
  m_channel->setReceiveLimit(kMaxHelloFrame);
  m_channel->start({[to = m_reception](std::string_view frame) {
                      to->second ? to->session->onSecondFrame(frame) : to->session->onFrame(frame);
                    },
                    [to = m_reception](CloseReason reason) {
                      to->second ? to->session->onSecondClosed(reason) : to->session->onClosed(reason);
                    }});
}

void Session::onClosed(CloseReason reason) {
  if (reason == CloseReason::kProtocol) ++m_counters.malformed_frames;
  const bool lost = reason == CloseReason::kPeer || reason == CloseReason::kError;
  if (m_state == State::kPlaying && lost && m_grace.count() > 0) return detach(now());
  m_state = State::kGone;
  dropSecond();
  tellGone();
}

// Go on without the stream.
void Session::detach(Clock::time_point now) {
  ++m_counters.detached;
  m_address = m_channel->peerAddress();
  m_channel.reset();
  dropSecond();
  takeAcks();
  m_sender.loseLarge();
  if (m_datagrams == nullptr || !m_transport.isOpen(now)) releaseKeys();
}

// Nobody holds them any more, as far as one can hear.
void Session::releaseKeys() {
  m_pressed.releaseAll([this](Input input) {
    input.id = m_input_received;  // it is part of what came with that one
    input.tick = m_tick;
    m_inputs.push_back(input);
  });
}

// A click without a snapshot that is remembered is judged in the present.
df::ViewedTick Session::seenWith(const Input& input) const {
  const auto base = input.is_mouse ? m_snapshot_ticks.tickOf(input.snapshot) : std::nullopt;
  return base ? df::ViewedTick{true, *base, input.tick} : df::ViewedTick{};
}

void Session::applyResize(Clock::time_point present) {
  if (!m_resize || (m_last_resize && present - *m_last_resize < kResizeEvery)) return;
  m_sender.setTerminal(m_resize->first, m_resize->second);
  m_resize.reset();
  m_last_resize = present;
}

void Session::tellGone() {
  if (m_told_gone) return;
  m_told_gone = true;
  m_events.on_gone(*this);
}

void Session::end() {
  if (m_state == State::kGone) return;
  m_state = m_channel != nullptr ? State::kEnding : State::kGone;
  dropSecond();
  if (m_channel != nullptr) m_channel->close();
  tellGone();  // the ship must not wait for the last bytes to get through
}

void Session::refuse(wire::Refused::Reason reason, const std::string& sentence) {
  wire::ServerMessage message;
  message.mutable_refused()->set_reason(reason);
  message.mutable_refused()->set_sentence(sentence);
  send(message);
  end();
}

std::string Session::exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const {
  return m_channel != nullptr ? m_channel->exportSecret(label, context, bytes) : std::string();
}

void Session::welcome(const wire::Welcome& welcome, std::unique_ptr<SealedChannel> datagrams) {
  m_welcome = welcome;
  m_welcome.clear_resume_token();  // only its hash is kept (ResumeTokens)
  m_player = welcome.player();
  m_name = welcome.name();
  m_state = State::kPlaying;
  answer(welcome);
  startDatagrams(std::move(datagrams));
}

void Session::startDatagrams(std::unique_ptr<SealedChannel> datagrams) {
  m_datagrams = std::move(datagrams);
  if (m_datagrams == nullptr) return;
  m_datagrams->start([this](std::string_view bytes) { onDatagram(bytes); });
}

void Session::answer(const wire::Welcome& welcome) {
  m_channel->setReceiveLimit(kMaxClientFrame);
  wire::ServerMessage message;
  *message.mutable_welcome() = welcome;
  send(message);
  m_transport.renewed(now());
  m_awaits_proof = true;
}

void Session::adopt(Session& other, wire::Welcome welcome, std::uint32_t received) {
  takeStream(other);
  other.m_state = State::kGone;
  takeAcks();
  m_sender.loseLarge();
  m_kept.acknowledge(received);
  welcome.set_received(m_kept_heard.newest());
  answer(welcome);
  m_kept.forEach([this](const std::string& frame) { m_channel->send(frame); });
}

void Session::restart(Session& other, wire::Welcome welcome, std::unique_ptr<SealedChannel> datagrams) {
  takeStream(other);
  if (other.m_channel != nullptr) {
    other.goodbye("You went on playing in another terminal.");
  } else {
    other.m_state = State::kGone;
  }
  m_acks.reset();
  m_sender.reset();
  m_transport = TransportSelector(now());
  startDatagrams(std::move(datagrams));
  m_kept.clear();
  m_kept_heard = {};
  m_rtt_millis = 0;
  releaseKeys();
  wire::Continuation& from = *welcome.mutable_continuation();
  from.set_snapshot(m_sender.newestNumber());
  from.set_world_epoch(m_sender.epoch());
  from.set_input(m_input_received);
  answer(welcome);
  ++m_counters.restarted;
}

// An input that nobody waits for any more counts as heard, or the client would repeat it.
void Session::beginWorld() {
  m_acks.reset();
  if (!m_inputs.empty()) m_sender.noteInput(m_inputs.back().id, m_tick);
  m_inputs.clear();
  m_pressed = {};
  m_controls.reset();
  m_sender.reset();
}

void Session::accompany(Session& other) {
  dropSecond();
  m_second = std::move(other.m_channel);
  const auto reception = std::exchange(other.m_reception, std::make_shared<Reception>());
  reception->session = this;
  reception->second = true;
  other.m_reception->session = &other;
  other.m_told_gone = true;
  other.m_state = State::kGone;
  ++m_counters.second_streams;
  m_second->setReceiveLimit(kMaxClientFrame);
  wire::ServerMessage message;
  *message.mutable_welcome() = m_welcome;
  message.mutable_welcome()->set_second_stream(true);
  m_second->send(message.SerializeAsString());
}

void Session::onSecondClosed(CloseReason reason) {
  if (reason == CloseReason::kProtocol) ++m_counters.malformed_frames;
  dropSecond();
}

void Session::dropSecond() {
  if (m_second == nullptr) return;
  m_second->close();
  m_second.reset();
}

// `other` has the old one afterwards, if there was one, and tells nobody of its end.
void Session::takeStream(Session& other) {
  dropSecond();
  if (m_channel != nullptr) {  // the old stream has not noticed yet that nobody is there
    m_reception->session = &other;
    std::swap(m_reception, other.m_reception);
    std::swap(m_channel, other.m_channel);
  } else {
    m_reception = std::move(other.m_reception);
    m_channel = std::move(other.m_channel);
    other.m_reception = std::make_shared<Reception>();
  }
  m_reception->session = this;
  other.m_reception->session = &other;
  other.m_told_gone = true;
  const Clock::time_point present = now();
  m_idle.heard(present);
  m_resize = other.m_resize;
  m_stall.restart();
  allowSavedChat(present);
  ++m_counters.resumed;
}

void Session::goodbye(const std::string& sentence) {
  if (m_state == State::kEnding || m_state == State::kGone) return;
  wire::ServerMessage message;
  message.mutable_goodbye()->set_sentence(sentence);
  send(message);
  end();
}

void Session::checkDeadlines(Clock::time_point now) {
  if (m_spoke) m_idle.heard(now);
  m_idle.listen(now);
  m_spoke = false;
  m_messages = 0;
  if (now - m_chat_refill >= std::chrono::seconds(1)) {
    m_chat_refill = now;
    m_chat_budget = std::max(m_chat_budget, kChatPerSecond);
  }
  checkSilence(now);
}

// What he said while nothing came by stream comes all at once.
void Session::allowSavedChat(Clock::time_point now) {
  const auto away = std::chrono::floor<std::chrono::seconds>(now - m_frame_at).count();
  m_chat_budget = static_cast<int>(std::min<std::int64_t>(kChatPerSecond * (away + 1), kChatAtOnce));
}

void Session::checkGreeting(Clock::time_point now) {
  if (m_idle.at(now) <= (m_greeted ? kJudgeTimeout : kLoginTimeout)) return;
  ++m_counters.login_timeouts;
  if (m_greeted) return refuse(wire::Refused::BUSY, "The server is busy. Try again in a moment.");
  refuse(wire::Refused::BAD_REQUEST, "The server heard no greeting in time.");
}

void Session::checkSilence(Clock::time_point now) {
  if (isDetached() && m_idle.at(now) > kSuspend) releaseKeys();
  if (m_state == State::kGreeting) {
    checkGreeting(now);
  } else if (isDetached() && m_idle.at(now) > m_grace) {
    ++m_counters.graces_expired;
    end();
  } else if (m_state == State::kPlaying && !isDetached() && m_idle.at(now) > kIdleTimeout) {
    ++m_counters.idle_timeouts;
    // A line that is down for a while often takes neither end's stream with it.
    if (m_grace.count() > 0) return detach(now);
    goodbye("The server has not heard from you for a while.");
  } else if (m_state == State::kPlaying && m_channel != nullptr &&
             m_stall.note(m_channel->unsentBytes(), now) && m_idle.at(now) < StallDetector::kPatience) {
    // Who is silent as well is cut off, and may come back.
    ++m_counters.stuck_streams;
    goodbye("Your end takes in too little of what the server sends.");
  }
}

void Session::sendTick(const Publisher& publisher, const df::PlayerFacts& player) {
  m_tick = publisher.tick();
  const Clock::time_point present = now();
  applyResize(present);
  takeAcks();
  m_sender.note(publisher, player);
  if (m_datagrams != nullptr && m_transport.isOpen(present)) return sendDatagrams(publisher, present);
  if (m_datagrams != nullptr && m_datagrams->room() &&
      m_transport.wantsProbe(present, m_channel == nullptr)) {
    const SnapshotSender::Packet probe = m_sender.probe(publisher);
    noteSent(probe, true, present);
    m_datagrams->send(probe.bytes);
  }
  sendOnStream(publisher, present);
}

void Session::sendDatagrams(const Publisher& publisher, Clock::time_point present) {
  const std::uint32_t interval = m_transport.interval(m_sender.loss(), present);
  const auto room = m_datagrams->room();
  if (publisher.tick() % interval != 0 || !room) return;
  const bool stream_idle = m_channel != nullptr && m_channel->unsentBytes() == 0;
  const std::size_t bytes = std::min(*room, kMaxDatagramSnapshot);
  SnapshotSender::Packets& packets = packetsOfThread();
  m_sender.build(publisher, {kDatagramsPerTick, bytes, stream_idle}, packets);
  for (const auto& packet : packets) {
    noteSent(packet, !packet.large, present);
    count(packet);
    if (packet.large) {
      sendSnapshot(packet);
    } else {
      m_datagrams->send(packet.bytes);
    }
  }
  if (m_sender.isThrottled()) skipTick();
}

void Session::sendOnStream(const Publisher& publisher, Clock::time_point present) {
  if (m_channel == nullptr) return;
  // If the first stream only waits for a packet to be sent again, the second goes on alone. What is large
  // goes on the first, and is not overtaken.
  const bool first = m_channel->unsentBytes() == 0;
  const bool second = m_second != nullptr && m_second->unsentBytes() == 0 && !m_sender.awaitsLarge();
  if (!first && !second) return skipTick();
  SnapshotSender::Packets& packets = packetsOfThread();
  m_sender.build(publisher, first ? kStreamRoom : kSecondRoom, packets);
  const bool small = packets.size() == 1 && packets.back().bytes.size() <= kMaxOnSecond;
  for (const SnapshotSender::Packet& packet : packets) {
    noteSent(packet, false, present);
    count(packet);
    const std::string frame = frameOf(packet);
    if (first) m_channel->send(frame);
    if (second && small) m_second->send(frame);
    if (m_second != nullptr && !small) m_sender.wentByStream(packet.number);
  }
  if (m_sender.isThrottled()) skipTick();
}

std::string Session::frameOf(const SnapshotSender::Packet& packet) {
  wire::ServerMessage message;
  message.set_snapshot(packet.bytes);
  return message.SerializeAsString();
}

void Session::sendSnapshot(const SnapshotSender::Packet& packet) {
  if (m_channel != nullptr) m_channel->send(frameOf(packet));
}

void Session::noteSent(const SnapshotSender::Packet& packet, bool as_datagram, Clock::time_point present) {
  m_transport.sent(packet.number, as_datagram, present);
  m_snapshot_ticks.note(packet.number, packet.tick);
}

void Session::count(const SnapshotSender::Packet& packet) {
  ++m_counters.snapshots;
  m_counters.snapshot_bytes += packet.bytes.size();
}

void Session::skipTick() {
  ++m_skipped_ticks;
  ++m_counters.skipped_ticks;
}

void Session::sendKept(wire::ServerMessage message, bool replaces) {
  if (m_state != State::kPlaying) return;
  message.set_number(m_kept.next());
  const std::string frame = message.SerializeAsString();
  if (m_kept.keep(frame, replaces)) {
    if (m_channel != nullptr) m_channel->send(frame);
    return;
  }
  ++m_counters.kept_overflows;
  goodbye("More was said than your connection could take in.");
}

bool Session::sendFleeting(const wire::ServerMessage& message) {
  if (m_state != State::kPlaying || m_channel == nullptr) return false;
  if (m_channel->unsentBytes() > kMaxBeforeFleeting) return false;
  send(message);
  return true;
}

void Session::send(const wire::ServerMessage& message) {
  if (m_state == State::kGone || m_channel == nullptr) return;
  m_channel->send(message.SerializeAsString());
}

}  // namespace naiad
