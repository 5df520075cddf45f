#include "host/admin/ControlSocket.h"

#include <pthread.h>
#include <signal.h>
#include <sys/socket.h>

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "host/admin/ControlConnection.h"
#include "host/admin/ControlFile.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

namespace {

using asio::local::stream_protocol;

/// For answers that are still to be written at the end.
constexpr std::chrono::milliseconds kFarewell{300};
/// As long as descriptors are short.
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
  caller.place = AdminCommand::Place::kSocket;
  caller.name = "user " + std::to_string(peer.uid) + ", process " + std::to_string(peer.pid);
  return caller;
}

}  // namespace

struct ControlSocket::State : std::enable_shared_from_this<ControlSocket::State> {
  State(ControlListening wanted, Execute callback, WatchFeed& with_feed, LogLine with_log)
      : options(std::move(wanted)),
        execute(std::move(callback)),
        feed(with_feed),
        log(std::move(with_log)),
        file(options.path),
        acceptor(context, stream_protocol(), file.takeDescriptor()),
        retry(context) {}

  void run();
  void accept();
  void meet(stream_protocol::socket socket);
  ControlConnection::Events eventsOf();
  void beginWatch();
  void passEvents();
  void forget(ControlConnection& connection);
  void finish();

  ControlListening options;
  Execute execute;
  WatchFeed& feed;
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
      meet(std::move(socket));
      return accept();
    }
    retry.expires_after(kRetry);
    retry.async_wait([this](const std::error_code& cancelled) {
      if (!cancelled && acceptor.is_open()) accept();
    });
  });
}

void ControlSocket::State::meet(stream_protocol::socket socket) {
  const ucred peer = peerOf(socket);
  AdminCaller caller = callerOf(peer);
  if (options.is_refused && options.is_refused(peer.pid)) {
    log("admin: " + caller.name +
        ": refused: a process of the server, or of another namespace, gives no commands");
    return;
  }
  const bool full = connections.size() >= options.max_connections;
  const bool is_short = connections.size() + 1 >= options.max_connections;
  const auto connection =
      std::make_shared<ControlConnection>(std::move(socket), std::move(caller), is_short, eventsOf());
  if (full) return connection->turnAway("Too many connections are open.");
  connections.push_back(connection);
  connection->start(options.short_time);
}

// An answer may come when the socket is gone, and its connection with it: neither is held meanwhile.
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
  feed.begin([this] { asio::post(context, [this] { passEvents(); }); });
}

void ControlSocket::State::passEvents() {
  const WatchFeed::Taken taken = feed.take();
  for (const auto& connection : std::vector(connections)) {
    connection->noteDropped(taken.dropped);
    for (const WatchEvent& event : taken.events) connection->sendEvent(event);
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
  if (connections.empty() && !acceptor.is_open()) context.stop();  // the last answer is written
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

// Signals are for the thread that ticks.
ControlSocket::ControlSocket(ControlListening options, Execute execute, WatchFeed& feed, LogLine log)
    : m_state(std::make_shared<State>(std::move(options), std::move(execute), feed, std::move(log))) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  m_state->thread = std::thread([this] { m_state->run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ControlSocket::~ControlSocket() {
  asio::post(m_state->context, [this] { m_state->finish(); });
  m_state->thread.join();
  m_state->connections.clear();
}

}  // namespace naiad
