#include "host/net/ServerPort.h"

#include <asio/io_context.hpp>
#include <chrono>
#include <utility>

#include "host/auth/ResumeTokens.h"
#include "shared/net/datagram/UdpSocket.h"

namespace naiad {

namespace {

/// Number of ports to try, because a port that is free for streams may be in use for datagrams.
constexpr int kPortsToTry = 50;

void addDatagrams(ServerPort& opened, asio::io_context& context, UdpOptions udp) {
  udp.v6_only = false;
  auto socket = std::make_unique<UdpSocket>(context, udp);
  opened.p_socket = socket.get();
  opened.datagrams = std::make_unique<DatagramService>(
      std::move(socket), [] { return std::chrono::steady_clock::now(); }, randomBits);
}

ServerPort open(asio::io_context& context, const std::string& address, std::uint16_t port,
                const TcpListener::OnChannel& on_channel, const TcpOptions& options,
                const TlsListenerOptions& tls) {
  ServerPort opened;
  opened.streams = std::make_unique<TcpListener>(context, address, port, on_channel, options, tls);
  if (!tls.context) return opened;
  addDatagrams(opened, context, {.address = address, .port = opened.streams->port()});
  return opened;
}

ServerPort openAny(asio::io_context& context, const std::string& address,
                   const TcpListener::OnChannel& on_channel, const TcpOptions& options,
                   const TlsListenerOptions& tls) {
  for (int i = 1; i < kPortsToTry; ++i) {
    try {
      return open(context, address, 0, on_channel, options, tls);
    } catch (const ListenError& error) {
      if (error.code() != std::errc::address_in_use) throw;
    }
  }
  return open(context, address, 0, on_channel, options, tls);
}

bool lacksIPv6(const std::error_code& code) {
  return code == std::errc::address_family_not_supported || code == std::errc::address_not_available;
}

ServerPort openAddress(asio::io_context& context, const std::string& address, std::uint16_t port,
                       const TcpListener::OnChannel& on_channel, const TcpOptions& options,
                       const TlsListenerOptions& tls) {
  const auto attempt = [&](const std::string& where) {
    return port == 0 ? openAny(context, where, on_channel, options, tls)
                     : open(context, where, port, on_channel, options, tls);
  };
  try {
    return attempt(address);
  } catch (const ListenError& error) {
    if (address != "::" || !lacksIPv6(error.code())) throw;
  }
  return attempt("0.0.0.0");
}

void addVisitors(ServerPort& opened, asio::io_context& context, ProxyListenerOptions visitors) {
  if (visitors.path.empty()) return;
  opened.visitors = std::make_unique<ProxyListener>(
      context, std::move(visitors),
      [p_streams = opened.streams.get()](asio::generic::stream_protocol::socket socket, const auto& visitor) {
        p_streams->adopt(std::move(socket), visitor);
      });
}

}  // namespace

ServerPort openServerPort(asio::io_context& context, const std::string& address, std::uint16_t port,
                          TcpListener::OnChannel on_channel, TcpOptions options, TlsListenerOptions tls,
                          ProxyListenerOptions visitors) {
  ServerPort opened = openAddress(context, address, port, on_channel, options, tls);
  addVisitors(opened, context, std::move(visitors));
  return opened;
}

ServerPort adoptServerPort(asio::io_context& context, const InheritedSockets& sockets,
                           TcpListener::OnChannel on_channel, TcpOptions options, TlsListenerOptions tls,
                           ProxyListenerOptions visitors) {
  if (!tls.context) {
    throw ListenError("Sockets from the service manager require encryption: remove --insecure.",
                      std::make_error_code(std::errc::invalid_argument));
  }
  ServerPort opened;
  opened.streams =
      std::make_unique<TcpListener>(context, sockets.streams, std::move(on_channel), options, tls);
  addDatagrams(opened, context,
               {.address = sockets.address, .port = sockets.port, .inherited = sockets.datagrams});
  addVisitors(opened, context, std::move(visitors));
  return opened;
}

}  // namespace naiad
