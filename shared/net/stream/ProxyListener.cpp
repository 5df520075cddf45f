#include "shared/net/stream/ProxyListener.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <array>
#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "shared/net/stream/AcceptLoop.h"
#include "shared/net/stream/ProxyHeader.h"
#include "shared/net/stream/StallTolerantTimer.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {
namespace {

using asio::local::stream_protocol;
using Socket = stream_protocol::socket;
namespace fs = std::filesystem;

constexpr mode_t kMode = 0660;

[[noreturn]] void fail(const fs::path& path, const std::string& why, std::error_code code) {
  throw ListenError("Cannot listen for visitors on " + path.string() + ": " + why + ".", code);
}

[[noreturn]] void fail(const fs::path& path, std::error_code code) {
  code.assign(code.value(), std::generic_category());  // Asio's codes never equal std::errc
  fail(path, code.message(), code);
}

/// True if no process listens on the socket: its server was killed.
bool isStale(asio::io_context& context, const fs::path& path) {
  Socket socket(context);
  std::error_code error;
  socket.connect(stream_protocol::endpoint(path.string()), error);
  return error == asio::error::connection_refused;
}

void makePlace(asio::io_context& context, const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (!fs::exists(status)) return;
  if (status.type() != fs::file_type::socket)
    fail(path, "the path exists and is not a socket", std::make_error_code(std::errc::file_exists));
  if (!isStale(context, path))
    fail(path, "another program is listening", std::make_error_code(std::errc::address_in_use));
  fs::remove(path, error);
}

std::pair<dev_t, ino_t> identityOf(const fs::path& path) {
  struct stat facts {};
  return ::lstat(path.c_str(), &facts) == 0 ? std::pair(facts.st_dev, facts.st_ino)
                                            : std::pair<dev_t, ino_t>();
}

pid_t peerOf(Socket& socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return ::getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 ? peer.pid : 0;
}

/// A connection whose header is incomplete. Reads the header in parts and no byte beyond it, because the
/// visitor's bytes follow. Keeps itself alive while it runs.
class Arrival : public std::enable_shared_from_this<Arrival> {
 public:
  enum class End { kVisitor, kBad, kLate };
  using Done = std::function<void(End end, Socket socket, const asio::ip::tcp::endpoint& visitor)>;

  explicit Arrival(Socket socket) : m_socket(std::move(socket)), m_timer(m_socket.get_executor()) {
    std::error_code ignored;
    m_socket.non_blocking(true, ignored);
  }

  /// Reads the waiting bytes; `done` may be called before this returns.
  void run(std::chrono::milliseconds timeout, Done done) {
    m_done = std::move(done);
    m_timer.start(timeout, [self = shared_from_this()] { self->finish(End::kLate, {}); });
    read();
  }
  bool isOver() const { return !m_done; }
  void cancel() {
    m_done = nullptr;
    m_timer.cancel();
    std::error_code ignored;
    m_socket.close(ignored);
  }

 private:
  void await() {
    m_socket.async_wait(Socket::wait_read, [self = shared_from_this()](const std::error_code& error) {
      if (!error) self->read();
    });
  }

  void read() {
    while (m_done) {
      std::error_code error;
      const std::size_t size =
          m_socket.read_some(asio::buffer(m_header.data() + m_size, m_wanted - m_size), error);
      if (error == asio::error::would_block || error == asio::error::interrupted) return await();
      if (error) return finish(End::kBad, {});
      m_size += size;
      if (m_size == m_wanted) handleBytes();
    }
  }

  void handleBytes() {
    const std::string_view header(m_header.data(), m_size);
    if (m_size == kProxyHeaderBegin) {
      const auto rest = proxyHeaderRest(header);
      if (!rest) return finish(End::kBad, {});
      m_wanted += *rest;
      return;
    }
    const auto visitor = readProxyHeader(header);
    visitor ? finish(End::kVisitor, *visitor) : finish(End::kBad, {});
  }

  void finish(End end, const asio::ip::tcp::endpoint& visitor) {
    if (!m_done) return;
    const Done call = std::exchange(m_done, nullptr);
    m_timer.cancel();
    call(end, std::move(m_socket), visitor);
  }

  Socket m_socket;
  StallTolerantTimer m_timer;
  Done m_done;  ///< empty: the arrival is over
  std::array<char, kProxyHeaderBegin + kMaxProxyHeaderRest> m_header{};
  std::size_t m_size = 0;
  std::size_t m_wanted = kProxyHeaderBegin;
};

}  // namespace

struct ProxyListener::State : AcceptLoop<State, stream_protocol> {
  State(asio::io_context& context, ProxyListenerOptions wanted, PeerHandler callback)
      : AcceptLoop(context), options(std::move(wanted)), on_peer(std::move(callback)) {}

  void listen(asio::io_context& context);
  void onConnection(Socket socket);
  void onArrival(Arrival::End end, Socket socket, const asio::ip::tcp::endpoint& visitor);
  void close();

  ProxyListenerOptions options;
  PeerHandler on_peer;
  std::pair<dev_t, ino_t> file;
  std::set<std::shared_ptr<Arrival>> arrivals;
  Counters counters;
};

// No process can connect before the mode is set, because connecting needs write permission and listen().
void ProxyListener::State::listen(asio::io_context& context) {
  const fs::path& path = options.path;
  if (path.string().size() >= sizeof(sockaddr_un::sun_path))
    fail(path, "the path is longer than 107 bytes", std::make_error_code(std::errc::filename_too_long));
  makePlace(context, path);
  std::error_code error;
  acceptor.open(stream_protocol(), error);
  if (!error) acceptor.bind(stream_protocol::endpoint(path.string()), error);
  if (error) fail(path, error);
  file = identityOf(path);
  if (::chmod(path.c_str(), kMode) != 0) error = std::error_code(errno, std::generic_category());
  if (!error) acceptor.listen(stream_protocol::acceptor::max_listen_connections, error);
  if (!error) return;
  close();
  fail(path, error);
}

void ProxyListener::State::onConnection(Socket socket) {
  if (options.is_refused && options.is_refused(peerOf(socket))) {
    ++counters.refused_peers;
    return;
  }
  const auto arrival = std::make_shared<Arrival>(std::move(socket));
  arrival->run(options.header_timeout, [self = shared_from_this(), p_arrival = std::weak_ptr(arrival)](
                                           Arrival::End end, Socket taken, const auto& visitor) {
    self->arrivals.erase(p_arrival.lock());
    self->onArrival(end, std::move(taken), visitor);
  });
  // Most headers arrive with the connection. Only incomplete ones take a place.
  if (arrival->isOver()) return;
  if (arrivals.size() < options.max_waiting) {
    arrivals.insert(arrival);
  } else {
    ++counters.crowded;
    arrival->cancel();
  }
}

void ProxyListener::State::onArrival(Arrival::End end, Socket socket,
                                     const asio::ip::tcp::endpoint& visitor) {
  ++(end == Arrival::End::kLate  ? counters.late_headers
     : end == Arrival::End::kBad ? counters.bad_headers
                                 : counters.visitors);
  if (end == Arrival::End::kVisitor) on_peer(std::move(socket), visitor);
}

// Removes the file unless another server has replaced it.
void ProxyListener::State::close() {
  if (!acceptor.is_open()) return;
  stopAccepting();
  for (const auto& arrival : std::exchange(arrivals, {})) arrival->cancel();
  std::error_code ignored;
  if (identityOf(options.path) == file) fs::remove(options.path, ignored);
}

ProxyListener::ProxyListener(asio::io_context& context, ProxyListenerOptions options, PeerHandler on_peer)
    : state_(std::make_shared<State>(context, std::move(options), std::move(on_peer))) {
  state_->listen(context);
  state_->accept();
}

ProxyListener::~ProxyListener() {
  close();
}

const ProxyListener::Counters& ProxyListener::counters() const {
  return state_->counters;
}

std::size_t ProxyListener::waiting() const {
  return state_->arrivals.size();
}

void ProxyListener::close() {
  state_->close();
}

}  // namespace naiad
