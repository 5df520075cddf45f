// The constructor of a Connection that opens its streams by TCP or through a gateway. Not built for browsers.
#include <asio/io_context.hpp>

#include "client/session/Connection.h"
#include "client/session/GatewayStreamOpener.h"
#include "client/session/TcpStreamOpener.h"
#include "shared/net/datagram/UdpSocket.h"

namespace naiad {
namespace {

SessionOptions withDatagrams(asio::io_context& context, const SessionOptions& given,
                             const ServerTrust& trust) {
  SessionOptions options = given;
  options.two_streams = trust.gateway.has_value();
  if (trust.insecure || trust.gateway || options.open_socket || options.proxy) return options;
  options.open_socket = [&context](const Endpoint& server) -> std::unique_ptr<DatagramSocket> {
    UdpOptions udp;
    udp.address = server.isIPv4() ? "0.0.0.0" : "::";
    try {
      return std::make_unique<UdpSocket>(context, udp);
    } catch (const ListenError&) {
      return nullptr;  // play without datagrams
    }
  };
  return options;
}

std::unique_ptr<StreamOpener> openerOf(asio::io_context& context, const ServerAddress& address,
                                       const SessionOptions& options, const ServerTrust& trust) {
  if (trust.gateway) return std::make_unique<GatewayStreamOpener>(context, *trust.gateway);
  return std::make_unique<TcpStreamOpener>(context, address, trust, options.proxy);
}

}  // namespace

Connection::Connection(asio::io_context& context, const ServerAddress& address, const SessionOptions& options,
                       bool rejoin, const ServerTrust& trust)
    : Connection(openerOf(context, address, options, trust), address, withDatagrams(context, options, trust),
                 rejoin) {}

}  // namespace naiad
