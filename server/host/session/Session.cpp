#include "host/session/Session.h"

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/program/LogText.h"

namespace naiad {

Session::Session(std::unique_ptr<ReliableChannel> channel, Counters& counters, Clock::time_point now)
    : m_counters(counters),
      m_streams(std::move(channel)),
      m_activity(now),
      m_chat(now),
      m_outbox(counters),
      m_delivery(counters, now),
      m_welcome(std::make_unique<wire::Welcome>()) {}

Session::~Session() = default;

const std::string& Session::name() const {
  return m_welcome->name();
}

void Session::start(Events events) {
  m_events = std::move(events);
  m_streams.start(
      {[this](std::string_view frame) { onFrame(frame); }, [this](CloseReason reason) { onClosed(reason); },
       [this](std::string_view frame) { onSecondFrame(frame); },
       [this](CloseReason reason) { onSecondClosed(reason); }},
      kMaxHelloFrame);
}

// ---- welcome and refusal ----------------------------------------------------------------------------------

void Session::refuse(wire::Refused_Reason reason, const std::string& sentence, const std::string& redirect,
                     const std::string& room) {
  if (m_events.on_refused) m_events.on_refused(*this, sentence);
  wire::ServerMessage message;
  message.mutable_refused()->set_reason(reason);
  message.mutable_refused()->set_message(sentence);
  message.mutable_refused()->set_redirect(redirect);
  message.mutable_refused()->set_redirect_room(room);
  send(message);
  end();
}

std::string Session::exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const {
  return stream() != nullptr ? stream()->exportSecret(label, context, bytes) : std::string();
}

void Session::welcome(const wire::Welcome& welcome, std::unique_ptr<SealedChannel> datagrams) {
  beginPlay(welcome);
  sendWelcome(welcome);
  startDatagrams(std::move(datagrams));
}

void Session::beginPlay(const wire::Welcome& welcome) {
  *m_welcome = welcome;
  m_player = welcome.player();
  m_welcome->clear_resume_token();
  m_state = State::kPlaying;
  m_status.begin(now());
}

void Session::startDatagrams(std::unique_ptr<SealedChannel> datagrams) {
  m_delivery.setDatagrams(std::move(datagrams));
  if (m_delivery.datagrams() == nullptr) return;
  m_delivery.datagrams()->start([this](std::string_view bytes) { onDatagram(bytes); });
}

void Session::sendWelcome(const wire::Welcome& welcome) {
  m_streams.setReceiveLimit(kMaxClientFrame);
  wire::ServerMessage message;
  *message.mutable_welcome() = welcome;
  send(message);
  m_delivery.renewTransport(now());
  m_activity.expectConfirmation();
}

void Session::restore(const wire::Welcome& welcome, Events events) {
  m_events = std::move(events);
  beginPlay(welcome);
  m_has_hello = m_restored = true;
  m_supports_rooms = true;  // its client, even an old one, gets a welcome to the room that it is in
  m_activity.onReconnect(now());
}

void Session::replaceRestored(Session& restored) {
  m_restored = true;
  m_status.setMuted(restored.m_status.isMuted());
  m_resumes = restored.m_resumes;
  restored.m_reported_gone = true;
  restored.stream() != nullptr ? restored.end() : static_cast<void>(restored.m_state = State::kGone);
}

// ---- stream changes ---------------------------------------------------------------------------------------

// A refused attempt counts as activity: the grace time starts again.
bool Session::admitResume() {
  if (m_resumes.tryConsume(kResumeRate, now())) return true;
  m_activity.onReconnect(now());
  ++m_counters.resumes_deferred;
  return false;
}

void Session::resumeOn(Session& other, wire::Welcome welcome, std::uint32_t received) {
  adoptStream(other);
  other.m_state = State::kGone;
  m_delivery.onStreamLost();
  m_outbox.acknowledge(received);
  m_outbox.restartStream();
  welcome.set_last_frame(m_reliable_received.newest());
  sendWelcome(welcome);
  sendWaiting();
}

void Session::restart(Session& other, wire::Welcome welcome, std::unique_ptr<SealedChannel> datagrams) {
  adoptStream(other);
  if (other.stream() != nullptr) {
    other.sendGoodbye("This session was resumed in another client.");
  } else {
    other.m_state = State::kGone;
  }
  m_delivery.restart(now());
  startDatagrams(std::move(datagrams));
  m_outbox.clear();
  m_reliable_received = {};
  m_rtt_millis = 0;
  releaseKeys();
  wire::ResumeState& from = *welcome.mutable_resume_state();
  from.set_snapshot(sender().newestNumber());
  from.set_world_epoch(sender().epoch());
  from.set_input(m_inputs.newest());
  sendWelcome(welcome);
  ++m_counters.restarted;
}

bool Session::admitSecondStream() {
  if (m_second_streams.tryConsume(kSecondStreamRate, now())) return true;
  ++m_counters.second_streams_deferred;
  return false;
}

void Session::attachSecondStream(Session& other) {
  m_streams.adoptAsSecond(other.m_streams, kMaxClientFrame);
  other.m_reported_gone = true;
  other.m_state = State::kGone;
  ++m_counters.second_streams;
  wire::ServerMessage message;
  *message.mutable_welcome() = *m_welcome;
  message.mutable_welcome()->set_second_stream(true);
  m_streams.sendSecond(message.SerializeAsString());
}

// Moves the first stream of `other` here. If this session still has one, `other` gets it. `other` does not
// report its end.
void Session::adoptStream(Session& other) {
  m_supports_rooms = other.m_supports_rooms;
  m_streams.adoptFirst(other.m_streams);
  other.m_reported_gone = true;
  const Clock::time_point present = now();
  m_chat.refillAfterSilence(m_activity.lastFrame(), present);
  m_activity.onReconnect(present);
  m_status.changeStream(present);
  m_resize.continueFrom(other.m_resize);
  ++m_counters.resumed;
}

void Session::onClosed(CloseReason reason) {
  if (reason == CloseReason::kProtocol) ++m_counters.malformed_frames;
  const bool lost = reason == CloseReason::kPeer || reason == CloseReason::kError;
  if (m_state == State::kPlaying && lost && m_grace.count() > 0) return detach(now());
  m_state = State::kGone;
  m_streams.dropSecond();
  if (lost) setLeaveReason(&Counters::left_disconnected, "connection lost");
  if (reason == CloseReason::kProtocol) setLeaveReason(&Counters::left_malformed, "invalid message");
  if (reason == CloseReason::kOverflow) setLeaveReason(&Counters::left_stalled, "too many bytes queued");
  setLeaveReason(&Counters::left_dismissed, "connection closed");
  reportGone();
}

void Session::onSecondClosed(CloseReason reason) {
  if (reason == CloseReason::kProtocol) ++m_counters.malformed_frames;
  m_streams.dropSecond();
}

void Session::detach(Clock::time_point now) {
  ++m_counters.detached;
  m_streams.detach();
  m_delivery.onStreamLost();
  if (!m_delivery.usesDatagrams(now)) releaseKeys();
}

void Session::sendGoodbye(const std::string& sentence, std::chrono::seconds again) {
  if (m_state == State::kEnding || m_state == State::kGone) return;
  setLeaveReason(&Counters::left_dismissed, "dismissed with " + inQuotes(sentence));
  wire::ServerMessage message;
  message.mutable_goodbye()->set_message(sentence);
  message.mutable_goodbye()->set_reconnect_seconds(static_cast<std::uint32_t>(again.count()));
  send(message);
  end();
}

void Session::end() {
  if (m_state == State::kGone) return;
  m_state = stream() != nullptr ? State::kEnding : State::kGone;
  m_streams.close();
  reportGone();  // now: the player's object must not stay in the world until the last bytes are sent
}

void Session::reportGone() {
  if (m_reported_gone) return;
  m_reported_gone = true;
  if (m_player != 0) ++(m_counters.*m_leave.counter);
  m_events.on_gone(*this);
}

// ---- ticks ------------------------------------------------------------------------------------------------

void Session::checkDeadlines(Clock::time_point now) {
  m_activity.endTick(now);
  checkSilence(now);
  sendWaiting();
}

void Session::checkGreeting(Clock::time_point now) {
  if (m_activity.silence(now) <= (m_has_hello ? kAdmissionTimeout : kLoginTimeout)) return;
  ++m_counters.login_timeouts;
  if (m_has_hello) return refuse(wire::Refused::BUSY, "The server is busy. Try again in a moment.");
  refuse(wire::Refused::BAD_REQUEST, "The client sent no hello in time.");
}

void Session::checkSilence(Clock::time_point now) {
  const auto silence = m_activity.silence(now);
  if (isDetached() && silence > kKeyReleaseDelay) releaseKeys();
  if (m_state == State::kGreeting) {
    checkGreeting(now);
  } else if (isDetached() && silence > m_grace) {
    ++m_counters.reconnect_timeouts;
    setLeaveReason(&Counters::left_silent, "did not reconnect in time");
    end();
  } else if (m_state == State::kPlaying && !isDetached() && silence > kIdleTimeout) {
    ++m_counters.idle_timeouts;
    // During an outage, neither end may notice that the stream is broken.
    if (m_grace.count() > 0) return detach(now);
    setLeaveReason(&Counters::left_silent, "silent for too long");
    sendGoodbye("Disconnected: no data from your client.");
  } else if (m_state == State::kPlaying && m_streams.isStalled(now) &&
             silence < StallDetector::kStallTimeout) {
    // A client that is also silent has lost its connection: it is detached later and may reconnect.
    ++m_counters.stalled_streams;
    setLeaveReason(&Counters::left_stalled, "connection too slow");
    sendGoodbye("Disconnected: your connection is too slow.");
  }
}

// A dropped input counts as received; otherwise the client would send it again.
void Session::beginWorld() {
  if (const auto dropped = m_inputs.clear()) m_delivery.setNewestInput(*dropped, m_delivery.tick());
  m_delivery.reset();
}

// Snapshots use streams until datagrams are confirmed again, so on the first stream no snapshot of the new
// world arrives before this message.
void Session::enterRoom(const wire::Welcome& welcome) {
  *m_welcome = welcome;
  m_player = welcome.player();
  if (const auto dropped = m_inputs.clear()) m_delivery.setNewestInput(*dropped, m_delivery.tick());
  m_delivery.restart(now());
  wire::ServerMessage message;
  wire::RoomEntered& entered = *message.mutable_entered();
  entered.set_player(welcome.player());
  entered.set_room(welcome.room());
  entered.set_game(welcome.game());
  entered.set_view_width(welcome.view_width());
  entered.set_view_height(welcome.view_height());
  *entered.mutable_help() = welcome.help();
  entered.set_tick(welcome.tick());
  entered.set_world_epoch(sender().epoch());
  send(message);
}

// A click without a remembered snapshot is evaluated in the present.
df::ViewedTick Session::viewedTick(const Input& input) const {
  const auto base = input.is_mouse ? m_delivery.tickOf(input.snapshot) : std::nullopt;
  return base ? df::ViewedTick{true, *base, input.tick} : df::ViewedTick{};
}

void Session::sendTick(const Publisher& publisher, const df::PlayerFacts& player) {
  const Clock::time_point present = now();
  if (const auto size = m_resize.popDue(present)) m_delivery.setTerminal(size->columns, size->rows);
  m_delivery.sendTick(publisher, player, m_streams, present);
}

// ---- messages ---------------------------------------------------------------------------------------------

void Session::send(const wire::ServerMessage& message) {
  if (m_state == State::kGone || stream() == nullptr) return;
  m_streams.sendFirst(message.SerializeAsString());
}

void Session::sendReliable(const wire::ServerMessage& message) {
  if (m_state != State::kPlaying) return;
  m_outbox.add(message);
  sendWaiting();
}

// Sends only while few bytes are unsent, alternating with snapshots: on a slow connection, chat must neither
// delay the game nor fill the stream until it counts as stuck.
void Session::sendWaiting() {
  if (m_state != State::kPlaying || stream() == nullptr) return;
  while (const std::string* p_frame = m_outbox.next()) {
    if (m_delivery.isBlocked() || stream()->unsentBytes() > kMaxUnsentForBestEffort) return;
    m_streams.sendFirst(*p_frame);
    m_outbox.markSent();
  }
}

bool Session::sendBestEffort(const wire::ServerMessage& message) {
  if (m_state != State::kPlaying || stream() == nullptr) return false;
  if (stream()->unsentBytes() > kMaxUnsentForBestEffort) return false;
  send(message);
  return true;
}

}  // namespace naiad
