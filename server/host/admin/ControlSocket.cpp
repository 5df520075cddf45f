#include "host/admin/ControlSocket.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "host/admin/AdminPlayer.h"
#include "host/admin/ControlFile.h"
#include "host/process/EventFeed.h"
#include "shared/admin/AdminJson.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

/// A connection to the control socket. Reads a line, has the command executed, writes the answer, and only
/// then reads the next one, so a client that does not read answers has to wait. Runs on the socket's thread.
/// Pending operations keep it alive.
class ControlConnection : public std::enable_shared_from_this<ControlConnection> {
 public:
  using Socket = asio::local::stream_protocol::socket;

  struct Events {
    /// Executes a command. `done` must be called on this thread.
    std::function<void(AdminRequest, AdminCaller, std::function<void(AdminAnswer)>)> execute;
    std::function<void()> on_watch;
    std::function<void(ControlConnection&)> on_closed;  ///< called once
  };

  ControlConnection(Socket socket, AdminCaller caller, bool is_short, Events events)
      : m_socket(std::move(socket)),
        m_timer(m_socket.get_executor()),
        m_caller(std::move(caller)),
        m_short(is_short),
        m_events(std::move(events)) {}
  void start(std::chrono::milliseconds short_time) {
    if (m_short) {
      m_timer.expires_after(short_time);
      m_timer.async_wait([self = shared_from_this()](const std::error_code& error) {
        if (!error) self->close();
      });
    }
    read();
  }
  /// Writes an error and closes the connection.
  void reject(const std::string& sentence) {
    send(answerLines(AdminAnswer::refused(sentence)));
    finish();
  }
  /// Sends an event if this is a watcher. If too many bytes are unsent, drops the event and counts it.
  void sendEvent(const FeedEvent& event) {
    if (!m_watching || m_closed) return;
    if (m_out.size() + m_writing.size() > ControlSocket::kMaxUnread) {
      ++m_dropped;
      return;
    }
    if (m_dropped > 0) send(droppedLine(std::exchange(m_dropped, 0)));
    send(eventLine(event.kind, event.text));
  }
  void countDropped(std::uint64_t count) { m_dropped += m_watching ? count : 0; }
  bool isWatching() const { return m_watching; }
  /// Closes the connection when all output is written.
  void finish() {
    m_finishing = true;
    if (!isWriting()) close();
  }
  void close() {
    if (std::exchange(m_closed, true)) return;
    std::error_code ignored;
    m_timer.cancel();
    m_socket.close(ignored);
    const auto self = shared_from_this();  // the callback releases this connection
    m_events.on_closed(*this);
  }

 private:
  bool isWriting() const { return !m_writing.empty() || !m_out.empty(); }
  void read() {
    if (m_reading || m_busy || m_ended || m_finishing || m_closed || isWriting()) return;
    m_reading = true;
    m_socket.async_read_some(asio::buffer(m_piece),
                             [self = shared_from_this()](const std::error_code& error, std::size_t size) {
                               self->onRead(error, size);
                             });
  }
  void onRead(const std::error_code& error, std::size_t size) {
    m_reading = false;
    if (m_closed) return;
    if (error) m_ended = true;
    m_in.append(m_piece.data(), size);
    serveLines();
  }
  void serveLines() {
    // Serves a line only when the answer to the previous one is written, so the input buffer stays bounded.
    while (!m_busy && !m_finishing && !m_closed && !isWriting()) {
      const std::size_t end = m_in.find('\n');
      if (end == std::string::npos) break;
      const std::string line = m_in.substr(0, end);
      m_in.erase(0, end + 1);
      if (std::exchange(m_too_long, false) || line.size() > kMaxControlLine) {
        answer(AdminAnswer::refused("Line too long: the limit is " + std::to_string(kMaxControlLine) +
                                    " bytes."));
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
  void serveLine(std::string_view line) {
    AdminRequest request;
    try {
      request = readRequestLine(line);
    } catch (const AdminUsageError& error) {
      return answer(AdminAnswer::refused(error.what()));
    }
    const bool watches = request.command->name == "watch";
    if (watches && m_short)
      return answer(AdminAnswer::refused(
          "Too many connections are open; the last one is reserved for short commands."));
    m_busy = true;
    m_events.execute(std::move(request), m_caller,
                     [weak = weak_from_this(), watches](const AdminAnswer& given) {
                       if (const auto self = weak.lock()) self->onAnswer(given, watches);
                     });
  }
  void onAnswer(const AdminAnswer& given, bool watches) {
    m_busy = false;
    if (m_closed) return;
    answer(given);
    if (watches) {
      m_watching = true;
      m_events.on_watch();
    }
    serveLines();
  }
  void answer(const AdminAnswer& given) { send(answerLines(given)); }
  void send(const std::string& bytes) {
    m_out += bytes;
    write();
  }
  void write() {
    if (!m_writing.empty() || m_out.empty() || m_closed) return;
    m_writing.swap(m_out);
    asio::async_write(
        m_socket, asio::buffer(m_writing),
        [self = shared_from_this()](const std::error_code& error, std::size_t) { self->onWritten(error); });
  }
  void onWritten(const std::error_code& error) {
    m_writing.clear();
    if (error) return close();
    if (m_dropped > 0 && m_watching && m_out.empty()) m_out = droppedLine(std::exchange(m_dropped, 0));
    write();
    if (m_writing.empty() && m_finishing) return close();
    serveLines();
  }

  Socket m_socket;
  asio::steady_timer m_timer;
  AdminCaller m_caller;
  bool m_short;
  Events m_events;
  std::array<char, kMaxControlLine> m_piece{};
  std::string m_in;         ///< input that is not served yet
  bool m_too_long = false;  ///< true while the rest of a line that is too long is skipped
  std::string m_out;        ///< output that is not being written yet
  std::string m_writing;
  bool m_busy = false;  ///< true while a command is executed
  bool m_reading = false;
  bool m_ended = false;  ///< true if the client has closed its side, or reading failed
  bool m_finishing = false;
  bool m_closed = false;
  bool m_watching = false;
  std::uint64_t m_dropped = 0;
};

using asio::local::stream_protocol;

/// Time limit for writing the remaining answers at the end.
constexpr std::chrono::milliseconds kFarewell{300};
/// Pause after a failed accept, for example when no descriptors are free.
constexpr std::chrono::milliseconds kRetry{100};

ucred peerOf(stream_protocol::socket& socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) peer = {};
  return peer;
}

AdminCaller callerOf(const ucred& peer) {
  AdminCaller caller;
  caller.level = AdminCommand::Level::kAdmin;
  caller.place = AdminCommand::Frontend::kSocket;
  caller.name = "user " + std::to_string(peer.uid) + ", process " + std::to_string(peer.pid);
  return caller;
}

}  // namespace

struct ControlSocket::State : std::enable_shared_from_this<ControlSocket::State> {
  State(ControlSocketOptions wanted, Execute callback, EventFeed& with_feed, LogLine with_log)
      : options(std::move(wanted)),
        execute(std::move(callback)),
        feed(with_feed),
        log(std::move(with_log)),
        file(options.path),
        acceptor(context, stream_protocol(), file.releaseDescriptor()),
        retry(context) {}

  void run();
  void accept();
  void onConnection(stream_protocol::socket socket);
  ControlConnection::Events eventsOf();
  void beginWatch();
  void sendEvents();
  void forget(ControlConnection& connection);
  void finish();

  ControlSocketOptions options;
  Execute execute;
  EventFeed& feed;
  LogLine log;
  asio::io_context context{1};
  asio::executor_work_guard<asio::io_context::executor_type> work{context.get_executor()};
  ControlFile file;
  stream_protocol::acceptor acceptor;
  asio::steady_timer retry;
  std::vector<std::shared_ptr<ControlConnection>> connections;
  bool feeding = false;
  std::thread thread;
};

void ControlSocket::State::run() {
  accept();
  context.run();
}

void ControlSocket::State::accept() {
  acceptor.async_accept([this](const std::error_code& error, stream_protocol::socket socket) {
    if (!acceptor.is_open()) return;
    if (!error) {
      onConnection(std::move(socket));
      return accept();
    }
    retry.expires_after(kRetry);
    retry.async_wait([this](const std::error_code& cancelled) {
      if (!cancelled && acceptor.is_open()) accept();
    });
  });
}

void ControlSocket::State::onConnection(stream_protocol::socket socket) {
  const ucred peer = peerOf(socket);
  AdminCaller caller = callerOf(peer);
  if (options.is_refused && options.is_refused(peer.pid)) {
    log("admin: " + caller.name +
        ": refused: commands from game processes or other PID namespaces are not accepted");
    return;
  }
  const bool full = connections.size() >= options.max_connections;
  const bool is_short = connections.size() + 1 >= options.max_connections;
  const auto connection =
      std::make_shared<ControlConnection>(std::move(socket), std::move(caller), is_short, eventsOf());
  if (full) return connection->reject("Too many connections are open.");
  connections.push_back(connection);
  connection->start(options.short_time);
}

// An answer may arrive after socket and connection are gone, so its callbacks have only weak pointers.
ControlConnection::Events ControlSocket::State::eventsOf() {
  return {[this](AdminRequest request, AdminCaller caller, std::function<void(AdminAnswer)> done) {
            if (request.command->name == "watch") return done(AdminAnswer::done("The log follows."));
            execute(std::move(request), std::move(caller),
                    [weak = weak_from_this(), done = std::move(done)](AdminAnswer answer) {
                      const auto state = weak.lock();
                      if (!state) return;
                      asio::post(state->context,
                                 [done, answer = std::move(answer)]() mutable { done(std::move(answer)); });
                    });
          },
          [this] { beginWatch(); }, [this](ControlConnection& connection) { forget(connection); }};
}

void ControlSocket::State::beginWatch() {
  if (std::exchange(feeding, true)) return;
  feed.begin([this] { asio::post(context, [this] { sendEvents(); }); });
}

void ControlSocket::State::sendEvents() {
  const EventFeed::EventBatch batch = feed.popAll();
  for (const auto& connection : std::vector(connections)) {
    connection->countDropped(batch.dropped);
    for (const FeedEvent& event : batch.events) connection->sendEvent(event);
  }
}

void ControlSocket::State::forget(ControlConnection& connection) {
  std::erase_if(connections, [&connection](const auto& one) { return one.get() == &connection; });
  const bool watched =
      std::any_of(connections.begin(), connections.end(), [](const auto& one) { return one->isWatching(); });
  if (feeding && !watched) {
    feed.end();
    feeding = false;
  }
  if (connections.empty() && !acceptor.is_open()) context.stop();  // finish() need not wait any more
}

void ControlSocket::State::finish() {
  std::error_code ignored;
  acceptor.close(ignored);
  feed.end();
  work.reset();
  for (const auto& connection : std::vector(connections)) connection->finish();
  retry.expires_after(kFarewell);
  retry.async_wait([this](const std::error_code&) { context.stop(); });
  if (connections.empty()) context.stop();
}

ControlSocket::ControlSocket(ControlSocketOptions options, Execute execute, EventFeed& feed, LogLine log)
    : m_state(std::make_shared<State>(std::move(options), std::move(execute), feed, std::move(log))) {
  m_state->thread = startWithoutSignals([this] { m_state->run(); });
}

ControlSocket::~ControlSocket() {
  asio::post(m_state->context, [this] { m_state->finish(); });
  m_state->thread.join();
  m_state->connections.clear();
}

}  // namespace naiad
