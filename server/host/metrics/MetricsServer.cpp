#include "host/metrics/MetricsServer.h"

#include <pthread.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/v6_only.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>
#include <list>
#include <thread>
#include <utility>

#include "shared/net/http/HttpHead.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

using asio::ip::tcp;
using std::error_code;

constexpr std::chrono::milliseconds kRetryDelay{100};
/// Maximum bytes read after a request. Reading them prevents a TCP reset that could overtake the answer.
constexpr std::size_t kMaxDrained = std::size_t{1} << 20;

MetricsServer::Response badRequest() {
  return {400, "Invalid request.\n"};
}

/// Returns the reason phrase of a status (RFC 9110, 15). Clients ignore it.
std::string_view reasonOf(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 503:
      return "Service Unavailable";
    default:
      return "Other";
  }
}

std::string headOf(const MetricsServer::Response& answer) {
  std::string head = "HTTP/1.1 " + std::to_string(answer.status) + " ";
  head.append(reasonOf(answer.status));
  head.append("\r\nContent-Type: ").append(answer.type);
  head += "\r\nContent-Length: " + std::to_string(answer.body.size());
  if (answer.status == 405) head += "\r\nAllow: GET";
  return head + "\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n";
}

}  // namespace

struct MetricsServer::Loop {
  Loop(const MetricsAddress& address, MetricsHosts allowed, Respond answers);

  void listen(const MetricsAddress& address);
  void accept();
  bool makeRoom();
  Response answer(const HttpHead& head) const;

  asio::io_context context{1};  // one thread
  tcp::acceptor acceptor{context};
  asio::steady_timer retry{context};
  MetricsHosts hosts;
  Respond respond;
  std::list<std::weak_ptr<Connection>> connections;  ///< oldest first; may include ended ones
  std::uint16_t port = 0;
  std::thread thread;
  clockid_t cpu_clock = CLOCK_THREAD_CPUTIME_ID;
};

/// One request and its answer. Pending operations keep it alive.
class MetricsServer::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Loop& loop, tcp::socket socket)
      : m_loop(loop), m_socket(std::move(socket)), m_deadline(loop.context) {}

  void start() {
    limit();
    read();
  }
  /// True if no answer is being sent: before the request is complete, and after the answer.
  bool isIdle() const { return m_idle; }
  void hangUp() {
    error_code ignored;
    m_socket.close(ignored);
    m_deadline.cancel();
  }

 private:
  void limit() {
    m_deadline.expires_after(kRequestTimeout);
    m_deadline.async_wait([connection = weak_from_this()](error_code error) {
      const auto self = connection.lock();
      if (self && !error) self->hangUp();
    });
  }

  void read() {
    m_socket.async_read_some(asio::buffer(m_piece),
                             [self = shared_from_this()](error_code error, std::size_t bytes) {
                               if (!error) self->onBytes({self->m_piece.data(), bytes});
                             });
  }

  void onBytes(std::string_view bytes) {
    m_request.feed(bytes);
    const bool is_broken = m_request.error() != HttpError::kNone;
    if (!is_broken && !m_request.isDone()) return read();
    m_idle = false;
    send(is_broken ? badRequest() : m_loop.answer(m_request.head()));
  }

  void send(Response answer) {
    m_answer = std::move(answer);
    m_head = headOf(m_answer);
    limit();
    const std::array<asio::const_buffer, 2> parts{asio::buffer(m_head), asio::buffer(m_answer.body)};
    asio::async_write(m_socket, parts, [self = shared_from_this()](error_code failed, std::size_t) {
      if (failed) return;
      error_code ignored;
      self->m_socket.shutdown(tcp::socket::shutdown_send, ignored);
      self->limit();
      self->m_idle = true;
      self->drain();
    });
  }

  void drain() {
    m_socket.async_read_some(asio::buffer(m_piece),
                             [self = shared_from_this()](error_code error, std::size_t bytes) {
                               self->m_drained += bytes;
                               if (!error && self->m_drained < kMaxDrained) self->drain();
                             });
  }

  Loop& m_loop;
  tcp::socket m_socket;
  asio::steady_timer m_deadline;
  HttpHeadReader m_request{kMaxHead};
  Response m_answer;
  std::string m_head;
  std::array<char, 1024> m_piece;
  std::size_t m_drained = 0;
  bool m_idle = true;
};

MetricsServer::Loop::Loop(const MetricsAddress& address, MetricsHosts allowed, Respond answers)
    : hosts(std::move(allowed)), respond(std::move(answers)) {
  listen(address);
  accept();
  thread = startWithoutSignals([this] { context.run(); });
  pthread_getcpuclockid(thread.native_handle(), &cpu_clock);
}

void MetricsServer::Loop::listen(const MetricsAddress& address) {
  error_code error;
  const tcp::endpoint endpoint(asio::ip::make_address(address.address, error), address.port);
  if (!error) acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error && endpoint.address().is_v6())
    acceptor.set_option(asio::ip::v6_only(!endpoint.address().is_unspecified()), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error)
    throw MetricsError("Cannot serve metrics on port " + std::to_string(address.port) + " of " +
                       address.address + " (" + error.message() + ").");
  port = acceptor.local_endpoint().port();
}

void MetricsServer::Loop::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      if (makeRoom()) {
        const auto connection = std::make_shared<Connection>(*this, std::move(socket));
        connections.push_back(connection);
        connection->start();
      }
      return accept();
    }
    // Perhaps no descriptor is free, so accepts again later. Until then, connections wait in the kernel.
    retry.expires_after(kRetryDelay);
    retry.async_wait([this](error_code ended) {
      if (!ended) accept();
    });
  });
}

// Evicts the oldest idle connection. It is not a real scraper, which sends its request at once and closes
// after the answer.
bool MetricsServer::Loop::makeRoom() {
  std::erase_if(connections, [](const auto& connection) { return connection.expired(); });
  if (connections.size() < kMaxConnections) return true;
  const auto idle = std::ranges::find_if(connections, [](const auto& each) {
    const auto connection = each.lock();
    return connection && connection->isIdle();
  });
  if (idle == connections.end()) return false;
  if (const auto connection = idle->lock()) connection->hangUp();
  connections.erase(idle);
  return true;
}

MetricsServer::Response MetricsServer::Loop::answer(const HttpHead& head) const {
  const auto request = HttpRequestLine::parse(head.start_line);
  if (!request) return badRequest();
  if (head.count("host") != 1 || !hosts.allows(head.value("host")))
    return {403, "Unknown host name; --metrics-hosts lists the names of this server.\n"};
  if (request->method != "GET") return {405, "GET only.\n"};
  return respond(request->target.substr(0, request->target.find('?')));
}

MetricsServer::MetricsServer(const MetricsAddress& address, MetricsHosts hosts, Respond respond)
    : m_loop(std::make_unique<Loop>(address, std::move(hosts), std::move(respond))) {}

MetricsServer::~MetricsServer() {
  m_loop->context.stop();
  m_loop->thread.join();
}

std::uint16_t MetricsServer::port() const {
  return m_loop->port;
}

std::chrono::nanoseconds MetricsServer::cpuTime() const {
  timespec spent{};
  clock_gettime(m_loop->cpu_clock, &spent);
  return std::chrono::seconds(spent.tv_sec) + std::chrono::nanoseconds(spent.tv_nsec);
}

}  // namespace naiad
