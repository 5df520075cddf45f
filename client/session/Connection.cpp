#include "client/session/Connection.h"

#include <algorithm>
#include <utility>

namespace naiad {

Connection::Connection(std::unique_ptr<StreamOpener> opener, ServerAddress address, SessionOptions options,
                       bool rejoin)
    : m_opener(std::move(opener)),
      m_address(std::move(address)),
      m_options(std::move(options)),
      m_rejoin(rejoin) {}

void Connection::start() {
  attempt();
}

void Connection::attempt() {
  m_next_attempt = Time::max();
  m_opener->open([this](std::unique_ptr<ReliableChannel> channel, const std::string& error) {
    if (!channel) return onAttemptFailed(error, Clock::now(), m_opener->closedDuringHandshake());
    const std::string refusal = m_opener->trustError();
    if (refusal.empty()) return attach(std::move(channel));
    finish(State::kRefused, refusal);
  });
}

// A failure is harmless, because the attempt is repeated. The token is sent only to the server that gave it.
void Connection::openSecond() {
  m_opener->openSecond([this](std::unique_ptr<ReliableChannel> channel, const std::string&) {
    if (!channel || !m_session || m_opener->keyOfSecond() != m_token_key) return;
    m_session->startSecond(std::move(channel));
  });
}

void Connection::attach(std::unique_ptr<ReliableChannel> channel) {
  ReliableChannel& started = *channel;
  const ReliableChannel* p_channel = channel.get();
  m_key = m_opener->key();
  SessionOptions options = m_options;
  // Another server has other rooms, so the room is kept only if this is the server of the last session.
  if (m_session && m_address == m_joined && !m_session->welcome().room.empty())
    options.room = m_session->welcome().room;
  chooseToken(options);
  m_pending = std::make_unique<ClientSession>(std::move(channel), options, Clock::now());
  if (m_observer) m_observer(*m_pending);
  // Another session may adopt the stream, so each frame goes to the session that owns it at that moment.
  const auto owner = [this, p_channel]() -> ClientSession* {
    if (m_pending && m_pending->owns(p_channel)) return m_pending.get();
    return m_session && m_session->owns(p_channel) ? m_session.get() : nullptr;
  };
  started.start({[this, owner](std::string_view frame) {
                   ClientSession* session = owner();
                   if (session == nullptr) return;
                   session->receive(frame, Clock::now());
                   saveToken(*session);
                   // A resumed session must adopt the stream before the next frame.
                   if (session == m_pending.get() && session->isResumed()) checkPending(Clock::now());
                 },
                 [owner](CloseReason reason) {
                   if (ClientSession* session = owner()) session->closed(reason);
                 }});
}

// A token is sent only to the server that gave it. A session that has ended for this client may still exist
// on the server: for example, a server that replays a long round starts the players' grace time after that.
void Connection::chooseToken(SessionOptions& options) const {
  if (m_session && m_session->isDetached()) {
    if (m_token_key != m_key) return;
    options.resume_token = m_token;
    options.last_frame = m_session->receivedFrames();
  } else if (m_session && m_session->state() == ClientSession::State::kLost && m_token_key == m_key) {
    options.resume_token = m_token;
    options.new_process = !m_token.empty();
  } else if (!m_session && m_p_tokens != nullptr && m_key && options.resume_token.empty()) {
    options.resume_token = m_p_tokens->tokenFor(*m_key);
    options.new_process = !options.resume_token.empty();
  }
}

void Connection::saveToken(const ClientSession& session) {
  if (session.state() != ClientSession::State::kPlaying || session.welcome().resume_token == m_token) return;
  m_token = session.welcome().resume_token;
  m_token_key = m_key;
  if (m_p_tokens == nullptr || !m_key) return;
  m_p_tokens->save({.server = {},
                    .key = *m_key,
                    .name = m_options.name,
                    .token = m_token,
                    .grace = session.welcome().grace},
                   std::chrono::system_clock::now());
}

// `was_closed`: the server closed the connection in the handshake or before it answered the hello.
void Connection::onAttemptFailed(const std::string& message, Time now, bool was_closed) {
  if (m_state == State::kJoining && !m_busy) {
    if (shouldRetryHandshake(now, was_closed)) return scheduleAttempt(now);
    if (!retryOriginal()) finish(State::kUnreachable, message);
    return;
  }
  if (m_state == State::kReconnecting && m_other && (m_trying_original || isOriginalRetryDue(now))) {
    swapServers();
    m_original_retry_at = now + m_original_retry_delay;
  }
  m_deferred = false;
  retryLater(now);
}

/// True if a lost redirect target did not answer for m_original_retry_delay, and the original server was not
/// asked for as long: the original server may know another target.
bool Connection::isOriginalRetryDue(Time now) const {
  return m_redirected && now - m_lost_at >= m_original_retry_delay && now >= m_original_retry_at;
}

/// True if a failed join should be retried: the server closed the connection, or it is a redirect target,
/// which was reachable a moment ago. Only for a limited time after the first such failure; in it, other
/// failures are retried, too: a server that restarts does not listen for a moment.
bool Connection::shouldRetryHandshake(Time now, bool was_closed) {
  const bool was_there = m_redirected && !m_original_retried;
  if (!was_closed && !was_there && m_handshake_closed_at == Time::max()) return false;
  m_handshake_closed_at = std::min(m_handshake_closed_at, now);
  return now - m_handshake_closed_at <
         (was_there ? std::min<Clock::duration>(kHandshakeRetryTimeout, m_original_retry_delay)
                    : Clock::duration(kHandshakeRetryTimeout));
}

void Connection::retryLater(Time now) {
  if (isOver()) return;
  if (now - m_lost_at >= m_reconnect_timeout)
    return finish(m_state == State::kJoining ? State::kRefused : State::kLost, m_message);
  scheduleAttempt(now);
}

void Connection::scheduleAttempt(Time now) {
  m_next_attempt = now + m_backoff;
  m_backoff = std::min(m_backoff * 2, kMaxBackoff);
}

void Connection::update(Time now) {
  if (isOver()) return;
  if (m_session) m_session->update(now);
  if (m_session && m_session->shouldOpenSecondStream(now)) openSecond();
  if (m_p_tokens != nullptr && m_session && m_session->isReceiving(now)) {
    m_p_tokens->refresh(std::chrono::system_clock::now());
  }
  if (m_pending) {
    m_pending->update(now);
    checkPending(now);
  }
  if (m_state == State::kJoined && m_session->isDetached() && m_rejoin)
    search("The connection to the server was lost.", kReconnectTimeout, now, now);
  if (m_state == State::kJoined && m_session->isOver()) {
    using S = ClientSession::State;
    if (m_session->state() != S::kLost) return finish(State::kEnded, m_session->message());
    if (!m_rejoin) return finish(State::kLost, m_session->message());
    search(m_session->message(), std::max(kReconnectTimeout, m_session->restartDelay()), now,
           now + kFirstBackoff);
  }
  if (now >= m_next_attempt) attempt();
}

void Connection::search(const std::string& why, std::chrono::seconds reconnect_timeout, Time now,
                        Time first_attempt) {
  m_state = State::kReconnecting;
  m_message = why;
  m_reconnect_timeout = reconnect_timeout;
  m_lost_at = now;
  m_deferred = false;
  m_backoff = kFirstBackoff;
  m_next_attempt = first_attempt;
  ++m_revision;
}

void Connection::checkPending(Time now) {
  using S = ClientSession::State;
  if (m_pending->state() == S::kPlaying && m_pending->welcome().resumed && m_session &&
      m_session->isDetached()) {
    m_session->adopt(*m_pending, now);
    m_pending.reset();
    return onJoined();
  }
  if (m_pending->state() == S::kPlaying && m_pending->hasPicture(now)) {
    m_session = std::move(m_pending);
    m_joined = m_address;
    return onJoined();
  }
  if (m_pending->isDetached() && !m_pending->isReceiving(now)) {
    m_pending.reset();
    return onAttemptFailed("The connection to the server was lost before its first picture.", now);
  }
  if (!m_pending->isOver()) return;
  const std::unique_ptr<ClientSession> over = std::move(m_pending);
  if (over->state() == S::kRefused) return checkRefusal(*over, now);
  if (over->state() == S::kEnded) return finish(State::kEnded, over->message());
  onAttemptFailed(over->message(), now, over->isUnanswered());
}

void Connection::onJoined() {
  m_state = State::kJoined;
  m_deferred = false;
  m_message.clear();
  m_busy = false;
  m_original_retried = false;
  if (std::exchange(m_resized, false)) m_session->sendResize(m_options.columns, m_options.rows);
  ++m_revision;
}

void Connection::checkRefusal(const ClientSession& refused, Time now) {
  const RefusedMessage& why = refused.refusal();
  if (!why.redirect.empty() && followRedirect(why.redirect, why.redirect_room)) return;
  if (m_trying_original && m_state == State::kReconnecting) return onAttemptFailed(refused.message(), now);
  if (why.is_temporary) return waitForServer(refused.message());
  if (why.full && retryOriginal()) return;
  // The player is asked for the password only of the server that they named.
  m_password_refused = why.password && !m_redirected;
  finish(State::kRefused, refused.message());
}

// A redirect may be malicious: the target gets the player's name, but no password or token.
bool Connection::followRedirect(const std::string& link, const std::string& room) {
  if (m_state != State::kJoining && !m_trying_original) return false;
  StreamOpener::RedirectTarget next = m_opener->follow(link);
  if (!next.opener) return false;
  m_opener->cancel();
  m_other = std::make_unique<ServerTarget>(
      ServerTarget{std::move(m_opener), m_address, m_options.password, m_options.room});
  m_opener = std::move(next.opener);
  m_address = std::move(next.address);
  m_redirected = true;
  m_trying_original = false;
  m_options.password.clear();
  m_options.resume_token.clear();
  m_options.new_process = false;
  m_options.room = room;  // the target has rooms of its own
  m_p_tokens = nullptr;
  m_key.reset();
  m_deferred = m_busy = false;
  m_handshake_closed_at = Time::max();
  m_backoff = kFirstBackoff;
  m_next_attempt = Clock::now() + next.wait;
  ++m_revision;
  return true;
}

// Tries the original server again when the redirect target is full or unreachable: the original server may
// know another target. Only once until the client has joined, because the original server may be malicious.
bool Connection::retryOriginal() {
  if (!m_redirected || std::exchange(m_original_retried, true)) return false;
  swapServers();
  m_deferred = m_busy = false;
  m_handshake_closed_at = Time::max();
  m_backoff = kFirstBackoff;
  scheduleAttempt(Clock::now());
  ++m_revision;
  return true;
}

void Connection::swapServers() {
  m_opener->cancel();
  std::swap(m_opener, m_other->opener);
  std::swap(m_address, m_other->address);
  std::swap(m_options.password, m_other->password);
  std::swap(m_options.room, m_other->room);
  m_trying_original = m_redirected;
  m_redirected = !m_redirected;
  m_key.reset();
}

// Retries later: the server is busy, or this client has reconnected too often.
void Connection::waitForServer(const std::string& message) {
  const Time now = Clock::now();
  if (m_state == State::kJoining && !std::exchange(m_busy, true)) m_lost_at = now;
  if (m_state == State::kReconnecting) m_lost_at = now;  // the server answers, so the time limit restarts
  m_deferred = true;
  m_message = message;
  ++m_revision;
  retryLater(now);
}

void Connection::leave() {
  if (isOver()) return;
  if (m_session) m_session->leave();
  if (m_pending) m_pending->leave();
  finish(State::kLeft, "");
}

void Connection::resize(int columns, int rows) {
  m_options.columns = columns;
  m_options.rows = rows;
  if (m_session) m_session->sendResize(columns, rows);
  m_resized = m_pending != nullptr;
}

bool Connection::isOver() const {
  return m_state != State::kJoining && m_state != State::kJoined && m_state != State::kReconnecting;
}

void Connection::finish(State state, const std::string& message) {
  // Other final states keep the token: a lost server, or one that refused, may still have the session.
  const bool ended = state == State::kEnded || state == State::kLeft;
  if (m_p_tokens != nullptr && ended) m_p_tokens->remove();
  m_opener->cancel();
  m_state = state;
  m_message = message;
  m_deferred = false;
  m_next_attempt = Time::max();
  ++m_revision;
}

}  // namespace naiad
