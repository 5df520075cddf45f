#include "host/admin/ControlConnection.h"

#include <asio/write.hpp>
#include <utility>

#include "host/admin/ControlSocket.h"

namespace naiad {

ControlConnection::ControlConnection(Socket socket, AdminCaller caller, bool is_short, Events events)
    : m_socket(std::move(socket)),
      m_timer(m_socket.get_executor()),
      m_caller(std::move(caller)),
      m_short(is_short),
      m_events(std::move(events)) {}

void ControlConnection::start(std::chrono::milliseconds short_time) {
  if (m_short) {
    m_timer.expires_after(short_time);
    m_timer.async_wait([self = shared_from_this()](const std::error_code& error) {
      if (!error) self->close();
    });
  }
  read();
}

void ControlConnection::turnAway(const std::string& sentence) {
  send(answerLines(AdminAnswer::refused(sentence)));
  finish();
}

void ControlConnection::read() {
  if (m_reading || m_busy || m_ended || m_finishing || m_closed || isWriting()) return;
  m_reading = true;
  m_socket.async_read_some(asio::buffer(m_piece),
                           [self = shared_from_this()](const std::error_code& error, std::size_t size) {
                             self->onRead(error, size);
                           });
}

void ControlConnection::onRead(const std::error_code& error, std::size_t size) {
  m_reading = false;
  if (m_closed) return;
  if (error) m_ended = true;
  m_in.append(m_piece.data(), size);
  serveLines();
}

// One line at a time; the next when its answer is written, so that what is read from here is bounded.
void ControlConnection::serveLines() {
  while (!m_busy && !m_finishing && !m_closed && !isWriting()) {
    const std::size_t end = m_in.find('\n');
    if (end == std::string::npos) break;
    const std::string line = m_in.substr(0, end);
    m_in.erase(0, end + 1);
    if (std::exchange(m_too_long, false) || line.size() > kMaxControlLine) {
      answer(AdminAnswer::refused("A line has " + std::to_string(kMaxControlLine) + " bytes at most."));
    } else {
      serveLine(line);
    }
  }
  if (m_in.find('\n') == std::string::npos) {
    if (m_in.size() > kMaxControlLine) {
      m_too_long = true;
      m_in.clear();
    }
    if (m_ended && !m_busy) return finish();
  }
  read();
}

void ControlConnection::serveLine(std::string_view line) {
  AdminRequest request;
  try {
    request = readRequestLine(line);
  } catch (const AdminUsageError& error) {
    return answer(AdminAnswer::refused(error.what()));
  }
  const bool watches = request.command->name == "watch";
  if (watches && m_short)
    return answer(AdminAnswer::refused("Too many connections are open: this place is for short commands."));
  m_busy = true;
  m_events.execute(std::move(request), m_caller,
                   [weak = weak_from_this(), watches](const AdminAnswer& given) {
                     if (const auto self = weak.lock()) self->onAnswer(given, watches);
                   });
}

void ControlConnection::onAnswer(const AdminAnswer& given, bool watches) {
  m_busy = false;
  if (m_closed) return;
  answer(given);
  if (watches) {
    m_watching = true;
    m_events.on_watch();
  }
  serveLines();
}

void ControlConnection::answer(const AdminAnswer& given) {
  send(answerLines(given));
}

void ControlConnection::sendEvent(const WatchEvent& event) {
  if (!m_watching || m_closed) return;
  if (m_out.size() + m_writing.size() > ControlSocket::kMaxUnread) {
    ++m_dropped;
    return;
  }
  if (m_dropped > 0) send(droppedLine(std::exchange(m_dropped, 0)));
  send(eventLine(event.kind, event.text));
}

void ControlConnection::send(const std::string& bytes) {
  m_out += bytes;
  write();
}

void ControlConnection::write() {
  if (!m_writing.empty() || m_out.empty() || m_closed) return;
  m_writing.swap(m_out);
  asio::async_write(
      m_socket, asio::buffer(m_writing),
      [self = shared_from_this()](const std::error_code& error, std::size_t) { self->onWritten(error); });
}

void ControlConnection::onWritten(const std::error_code& error) {
  m_writing.clear();
  if (error) return close();
  if (m_dropped > 0 && m_watching && m_out.empty()) m_out = droppedLine(std::exchange(m_dropped, 0));
  write();
  if (m_writing.empty() && m_finishing) return close();
  serveLines();
}

void ControlConnection::finish() {
  m_finishing = true;
  if (!isWriting()) close();
}

void ControlConnection::close() {
  if (std::exchange(m_closed, true)) return;
  std::error_code ignored;
  m_timer.cancel();
  m_socket.close(ignored);
  const auto self = shared_from_this();  // the callback forgets this
  m_events.on_closed(*this);
}

}  // namespace naiad
