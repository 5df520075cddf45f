#include "Connection.h"

#include <algorithm>
#include <utility>

#include "Limits.h"

namespace naiad {

Connection::Connection(asio::io_context& context, ServerAddress address, SessionOptions options, bool rejoin)
    : m_connector(context, TcpOptions{.receive_limit = kMaxServerFrame}),
      m_address(std::move(address)),
      m_options(std::move(options)),
      m_rejoin(rejoin) {}

void Connection::start() {
  attempt();
}

void Connection::attempt() {
  m_next_attempt = Time::max();
  m_connector.connect(m_address.host, m_address.port, kConnectTimeout,
                      [this](std::unique_ptr<ReliableChannel> channel, const std::string& error) {
                        if (channel) {
                          attach(std::move(channel));
                        } else {
                          attemptFailed(error);
                        }
                      });
}

void Connection::attach(std::unique_ptr<ReliableChannel> channel) {
  ReliableChannel& started = *channel;
  m_pending = std::make_unique<ClientSession>(std::move(channel), m_options, Clock::now());
  if (m_observer) m_observer(*m_pending);
  // The session owns the channel, so it outlives every callback of the channel.
  ClientSession* session = m_pending.get();
  started.start({[session](std::string_view frame) { session->receive(frame, Clock::now()); },
                 [session](CloseReason reason) { session->closed(reason); }});
}

void Connection::attemptFailed(const std::string& sentence) {
  const Time now = Clock::now();
  if (m_state == State::kJoining) return finish(State::kUnreachable, sentence);
  if (now - m_lost_at >= kGiveUp) return finish(State::kLost, m_sentence);
  m_next_attempt = now + m_backoff;
  m_backoff = std::min(m_backoff * 2, kLastBackoff);
}

void Connection::update(Time now) {
  if (isOver()) return;
  if (m_session) m_session->update(now);
  if (m_pending) {
    m_pending->update(now);
    checkPending();
  }
  if (m_state == State::kJoined && m_session->isOver()) {
    using S = ClientSession::State;
    if (m_session->state() != S::kLost) return finish(State::kEnded, m_session->sentence());
    if (!m_rejoin) return finish(State::kLost, m_session->sentence());
    m_state = State::kSearching;
    m_sentence = m_session->sentence();
    m_lost_at = now;
    m_backoff = kFirstBackoff;
    m_next_attempt = now + m_backoff;
    ++m_revision;
  }
  if (now >= m_next_attempt) attempt();
}

void Connection::checkPending() {
  using S = ClientSession::State;
  if (m_pending->state() == S::kPlaying && m_pending->hasPicture()) {
    m_session = std::move(m_pending);
    m_state = State::kJoined;
    m_sentence.clear();
    if (std::exchange(m_resized, false)) m_session->sendResize(m_options.columns, m_options.rows);
    ++m_revision;
    return;
  }
  if (!m_pending->isOver()) return;
  const std::unique_ptr<ClientSession> over = std::move(m_pending);
  if (over->state() == S::kRefused) return finish(State::kRefused, over->sentence());
  if (over->state() == S::kEnded) return finish(State::kEnded, over->sentence());
  attemptFailed(over->sentence());
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
  return m_state != State::kJoining && m_state != State::kJoined && m_state != State::kSearching;
}

void Connection::finish(State state, const std::string& sentence) {
  m_connector.cancel();
  m_state = state;
  m_sentence = sentence;
  m_next_attempt = Time::max();
  ++m_revision;
}

}  // namespace naiad
