#include "server/gateway/Gateway.h"

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/basic_waitable_timer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <csignal>
#include <utility>

#include "server/gateway/GatewayState.h"
#include "server/gateway/WebConnection.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {
namespace {

using boost::asio::ip::tcp;
using Acceptor = boost::asio::basic_socket_acceptor<tcp, GatewayExecutor>;
using Peer = boost::asio::basic_stream_socket<tcp, GatewayExecutor>;
using Timer =
    boost::asio::basic_waitable_timer<std::chrono::steady_clock,
                                      boost::asio::wait_traits<std::chrono::steady_clock>, GatewayExecutor>;

constexpr std::chrono::milliseconds kAcceptRetryDelay{100};
constexpr std::chrono::milliseconds kSweepTime{100};
constexpr std::size_t kMaxPem = std::size_t{1} << 20;

tcp::endpoint endpointOf(const GatewaySettings& settings) {
  error_code error;
  const auto address = boost::asio::ip::make_address(settings.address, error);
  if (error) throw GatewayError("\"" + settings.address + "\" is not a numeric IPv4 or IPv6 address.");
  if (settings.certificate.empty() && !address.is_loopback())
    throw GatewayError(
        "Cannot listen on " + settings.address +
        ": without a certificate there is no encryption, so only loopback addresses are allowed.");
  return {address, settings.port};
}

std::string urlHost(const boost::asio::ip::address& address) {
  return address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
}

/// Returns the origins of the listening address itself. They are safe: numeric names need no name server, and
/// localhost never leaves the machine.
std::vector<WebOrigin> ownOrigins(const tcp::endpoint& endpoint, bool has_tls) {
  std::vector<WebOrigin> origins;
  if (!endpoint.address().is_unspecified())
    origins.push_back({has_tls, urlHost(endpoint.address()), endpoint.port()});
  if (!endpoint.address().is_loopback()) return origins;
  for (const char* const host : {"localhost", "127.0.0.1", "[::1]"}) {
    if (origins.front().host != host) origins.push_back({has_tls, host, endpoint.port()});
  }
  return origins;
}

std::string readPem(const std::string& path) {
  try {
    if (auto text = readTrusted(path, kMaxPem, Links::kFollowed)) return *std::move(text);
  } catch (const std::system_error& error) {
    throw TlsError(path + " cannot be read: " + error.what());
  }
  throw TlsError("No such file: " + path + ".");
}

std::shared_ptr<const TlsContext> webTls(const GatewaySettings& settings) {
  if (settings.certificate.empty()) return nullptr;
  return TlsContext::forWebServer(readPem(settings.certificate), readPem(settings.key));
}

AddressPrefix::Bytes bytesOf(const boost::asio::ip::address& address) {
  return address.is_v6()
             ? address.to_v6().to_bytes()
             : boost::asio::ip::make_address_v6(boost::asio::ip::v4_mapped, address.to_v4()).to_bytes();
}

}  // namespace

struct Gateway::Loop {
  Loop(GatewaySettings settings, LogLine log);
  ~Loop();

  void listen(tcp::endpoint& endpoint);
  void accept();
  void onAccepted(error_code error, Peer peer);
  void onConnection(Peer peer);
  void sweep();
  void installSignalHandlers();
  void reloadCertificate();
  void stop();
  void logCounters() const;

  boost::asio::io_context context{1};  // one thread
  Acceptor acceptor{context.get_executor()};
  Timer retry{context.get_executor()};
  Timer sweeper{context.get_executor()};
  boost::asio::signal_set signals{context};
  LogLine log;
  std::shared_ptr<GatewayState> state;
  bool is_stopping = false;
};

Gateway::Loop::Loop(GatewaySettings settings, LogLine line) : log(std::move(line)) {
  tcp::endpoint endpoint = endpointOf(settings);
  const bool has_tls = !settings.certificate.empty();
  std::shared_ptr<const TlsContext> tls;
  try {
    tls = webTls(settings);
  } catch (const TlsError& error) {
    throw GatewayError(error.what());
  }
  listen(endpoint);
  AllowedOrigins names;
  for (const WebOrigin& origin : settings.origins) names.add(origin);
  for (const WebOrigin& origin : ownOrigins(endpoint, has_tls)) names.add(origin);
  if (names.isEmpty())
    throw GatewayError("--origin is required: https://NAME, where players reach " + settings.address + ".");
  state = std::make_shared<GatewayState>(std::move(settings), names, log);
  state->tls = std::move(tls);
  accept();
  sweep();
}

Gateway::Loop::~Loop() {
  if (state) state->connections.disconnect();
}

void Gateway::Loop::listen(tcp::endpoint& endpoint) {
  error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error && endpoint.address().is_v6())
    acceptor.set_option(boost::asio::ip::v6_only(!endpoint.address().is_unspecified()), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error)
    throw GatewayError("Cannot listen on port " + std::to_string(endpoint.port()) + " of " +
                       endpoint.address().to_string() + " (" + error.message() + ").");
  endpoint = acceptor.local_endpoint();
}

void Gateway::Loop::accept() {
  acceptor.async_accept([this](error_code error, Peer peer) {
    if (!is_stopping) onAccepted(error, std::move(peer));
  });
}

void Gateway::Loop::onAccepted(error_code error, Peer peer) {
  if (!error) {
    onConnection(std::move(peer));
    return accept();
  }
  ++state->counters.failed_accepts;
  retry.expires_after(kAcceptRetryDelay);
  retry.async_wait([this](error_code) {
    if (!is_stopping) accept();
  });
}

void Gateway::Loop::onConnection(Peer peer) {
  error_code gone;
  const tcp::endpoint endpoint = peer.remote_endpoint(gone);
  if (gone) return;
  ++state->counters.connections;
  ProxiedPeer visitor = ProxiedPeer::of(bytesOf(endpoint.address()), endpoint.port());
  if (!state->arrivals.tryConsume(visitor.prefix, std::chrono::steady_clock::now())) {
    ++state->counters.rate_limited;
    return;
  }
  // The slot is acquired first, so that no memory is used for a connection that gets no slot.
  const auto slot = std::make_shared<std::weak_ptr<WebConnection>>();
  auto place = state->pending.acquire(visitor.prefix, [slot] {
    if (const auto connection = slot->lock()) connection->disconnect();
  });
  if (!place) {
    ++state->counters.no_slot;
    return;
  }
  const auto connection =
      std::make_shared<WebConnection>(*state, SecureSocket(std::move(peer)), std::move(visitor));
  *slot = connection;
  connection->start(std::move(place));
}

void Gateway::Loop::sweep() {
  const auto now = std::chrono::steady_clock::now();
  state->connections.sweep(now);
  state->log.update(now);
  if (is_stopping && state->connections.count() == 0) return signals.clear();
  sweeper.expires_after(kSweepTime);
  sweeper.async_wait([this](error_code) { sweep(); });
}

void Gateway::Loop::installSignalHandlers() {
  signals.async_wait([this](error_code error, int signal) {
    if (error) return;
    if (signal != SIGHUP) {
      signals.clear();  // the next signal has its default effect
      return stop();
    }
    LineLog::reopenAll();
    reloadCertificate();
    installSignalHandlers();
  });
}

void Gateway::Loop::reloadCertificate() {
  if (!state->tls) return;
  try {
    state->tls = webTls(state->settings);
    log("certificate reloaded");
  } catch (const TlsError& error) {
    log(std::string("cannot reload the certificate, keeping the old one: ") + error.what());
  }
}

void Gateway::Loop::stop() {
  if (std::exchange(is_stopping, true)) return;
  error_code ignored;
  acceptor.close(ignored);
  retry.cancel();
  state->connections.shutDown();
  state->log.finish();
  logCounters();
}

void Gateway::Loop::logCounters() const {
  const GatewayCounters& c = state->counters;
  const std::pair<const char*, std::uint64_t> all[] = {{"connections", c.connections},
                                                       {"requests", c.requests},
                                                       {"refused_requests", c.refused_requests},
                                                       {"bad_requests", c.bad_requests},
                                                       {"refused_upgrades", c.refused_upgrades},
                                                       {"timeouts", c.timeouts},
                                                       {"rate_limited", c.rate_limited},
                                                       {"no_slot", c.no_slot},
                                                       {"evicted", state->pending.evicted()},
                                                       {"failed_handshakes", c.failed_handshakes},
                                                       {"failed_accepts", c.failed_accepts},
                                                       {"websockets", c.websockets},
                                                       {"played", c.played},
                                                       {"full", c.full},
                                                       {"unreachable", c.unreachable},
                                                       {"wrong_keys", c.wrong_keys},
                                                       {"ping_timeouts", c.ping_timeouts},
                                                       {"stalled", c.stalled},
                                                       {"bad_messages", c.bad_messages},
                                                       {"control_floods", c.control_floods},
                                                       {"messages_up", c.messages_up},
                                                       {"messages_down", c.messages_down},
                                                       {"writes_up", c.writes_up},
                                                       {"writes_down", c.writes_down}};
  std::string line = "counters:";
  for (const auto& [name, value] : all) {
    if (value > 0) line += " " + std::string(name) + "=" + std::to_string(value);
  }
  log(line);
}

Gateway::Gateway(GatewaySettings settings, LogLine log)
    : m_loop(std::make_unique<Loop>(std::move(settings), std::move(log))) {}

Gateway::~Gateway() = default;

bool Gateway::parseListen(std::string_view text, GatewaySettings& settings) {
  const auto endpoint = NumericEndpoint::parse(text);
  if (!endpoint) return false;
  settings.address = endpoint->address.to_string();
  settings.port = endpoint->port;
  return true;
}

std::uint16_t Gateway::port() const {
  return m_loop->acceptor.local_endpoint().port();
}

std::vector<std::string> Gateway::addresses() const {
  const GatewayState& state = *m_loop->state;
  const std::string key = "/#" + state.settings.link->key.text();
  std::vector<std::string> result;
  for (const WebOrigin& origin : state.settings.origins) result.push_back(origin.text() + key);
  const auto own = ownOrigins(m_loop->acceptor.local_endpoint(), state.tls != nullptr);
  if (!own.empty()) result.push_back(own.front().text() + key);
  return result;
}

const GatewayCounters& Gateway::counters() const {
  return m_loop->state->counters;
}

std::size_t Gateway::connections() const {
  return m_loop->state->connections.count();
}

void Gateway::installSignalHandlers() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) m_loop->signals.add(signal);
  m_loop->installSignalHandlers();
}

void Gateway::run() {
  m_loop->context.run();
}

void Gateway::post(std::function<void()> job) {
  boost::asio::post(m_loop->context, std::move(job));
}

void Gateway::reloadCertificate() {
  m_loop->reloadCertificate();
}

void Gateway::stop() {
  m_loop->stop();
}

}  // namespace naiad
