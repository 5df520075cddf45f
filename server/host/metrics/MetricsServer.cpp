#include "host/metrics/MetricsServer.h"

#include <pthread.h>
#include <signal.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <limits>
#include <list>
#include <optional>
#include <thread>
#include <utility>

namespace naiad {

namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::milliseconds kRetryDelay{100};
/// Of what comes after a request, so that no reset overtakes the answer.
constexpr std::size_t kMaxDrained = std::size_t{1} << 20;

/// Signals are for the threads that were there before.
std::thread startWithoutSignals(const std::function<void()>& job) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(job);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

std::string headOf(const MetricsServer::Answer& answer) {
  const auto reason = http::obsolete_reason(static_cast<http::status>(answer.status));
  std::string head = "HTTP/1.1 " + std::to_string(answer.status) + " ";
  head.append(reason.data(), reason.size());
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
  Answer answer(const http::request<http::empty_body>& request) const;

  boost::asio::io_context context{1};  // one thread
  tcp::acceptor acceptor{context};
  boost::asio::steady_timer retry{context};
  MetricsHosts hosts;
  Respond respond;
  std::list<std::weak_ptr<Connection>> connections;  ///< oldest first; those that have ended among them
  std::uint16_t port = 0;
  std::thread thread;
  clockid_t cpu_clock = CLOCK_THREAD_CPUTIME_ID;
};

/// One request and its answer. Lives as long as something of it is under way.
class MetricsServer::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Loop& loop, tcp::socket socket) : m_loop(loop), m_stream(std::move(socket)) {}

  void start() {
    m_parser.header_limit(static_cast<std::uint32_t>(kMaxHead));
    m_parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // it is not read
    m_stream.expires_after(kPatience);
    http::async_read_header(
        m_stream, m_buffer, m_parser,
        [self = shared_from_this()](error_code error, std::size_t) { self->onRequest(error); });
  }
  /// No answer is under way: its request has not come yet, or it has been answered and does not go.
  bool isIdle() const { return m_idle; }
  void hangUp() {
    error_code ignored;
    m_stream.socket().close(ignored);
  }

 private:
  void onRequest(error_code error) {
    m_idle = false;
    if (!error) return send(m_loop.answer(m_parser.get()));
    const bool ended = error == http::error::end_of_stream || error == http::error::partial_message;
    const bool is_of_http = error.category() == http::make_error_code(http::error::bad_method).category();
    if (is_of_http && !ended) send({400, "This is no request that is answered here.\n"});
  }

  void send(Answer answer) {
    m_answer = std::move(answer);
    m_head = headOf(m_answer);
    m_stream.expires_after(kPatience);
    const std::array<boost::asio::const_buffer, 2> parts{boost::asio::buffer(m_head),
                                                         boost::asio::buffer(m_answer.body)};
    boost::asio::async_write(m_stream, parts, [self = shared_from_this()](error_code failed, std::size_t) {
      if (failed) return;
      error_code ignored;
      self->m_stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
      self->m_stream.expires_after(kPatience);
      self->m_idle = true;
      self->drain();
    });
  }

  void drain() {
    m_stream.async_read_some(boost::asio::buffer(m_rest),
                             [self = shared_from_this()](error_code error, std::size_t bytes) {
                               self->m_drained += bytes;
                               if (!error && self->m_drained < kMaxDrained) self->drain();
                             });
  }

  Loop& m_loop;
  boost::beast::tcp_stream m_stream;
  boost::beast::flat_buffer m_buffer{kMaxHead + 1};
  http::request_parser<http::empty_body> m_parser;
  Answer m_answer;
  std::string m_head;
  std::array<char, 1024> m_rest;
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
  const tcp::endpoint endpoint(boost::asio::ip::make_address(address.address, error), address.port);
  if (!error) acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error && endpoint.address().is_v6())
    acceptor.set_option(boost::asio::ip::v6_only(!endpoint.address().is_unspecified()), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error)
    throw MetricsError("Metrics cannot be given out on port " + std::to_string(address.port) + " of " +
                       address.address + " (" + error.message() + ").");
  port = acceptor.local_endpoint().port();
}

void MetricsServer::Loop::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == boost::asio::error::operation_aborted) return;
    if (!error) {
      if (makeRoom()) {
        const auto connection = std::make_shared<Connection>(*this, std::move(socket));
        connections.push_back(connection);
        connection->start();
      }
      return accept();
    }
    // Out of descriptors: those that wait, wait on in the kernel.
    retry.expires_after(kRetryDelay);
    retry.async_wait([this](error_code ended) {
      if (!ended) accept();
    });
  });
}

// A scraper sends its request at once and goes with the answer, so the oldest that waits is none.
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

MetricsServer::Answer MetricsServer::Loop::answer(const http::request<http::empty_body>& request) const {
  const auto host = request[http::field::host];
  if (request.count(http::field::host) != 1 || !hosts.allows({host.data(), host.size()}))
    return {403, "This server does not go by that name (--metrics-hosts).\n"};
  if (request.method() != http::verb::get) return {405, "GET only.\n"};
  const auto target = request.target();
  const std::string_view path(target.data(), target.size());
  return respond(path.substr(0, path.find('?')));
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
