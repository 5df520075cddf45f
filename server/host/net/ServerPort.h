// The listening sockets of a server: a listener for streams, and datagrams on the same port number.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <memory>
#include <string>

#include "host/net/DatagramService.h"
#include "host/net/InheritedSockets.h"
#include "shared/net/stream/ProxyListener.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

class UdpSocket;

struct ServerPort {
  std::unique_ptr<TcpListener> streams;
  std::unique_ptr<ProxyListener> visitors;     ///< null without a visitors' socket
  std::unique_ptr<DatagramService> datagrams;  ///< null without encryption
  const UdpSocket* p_socket = nullptr;         ///< the socket of `datagrams`
};

/// Listens on a numeric address ("::" includes IPv4, and means 0.0.0.0 on systems without IPv6). `port` 0
/// chooses a port that is free for both. Without `tls`: loopback and streams only. Connections of the
/// visitors' socket are treated like connections to the port. Throws ListenError.
ServerPort openServerPort(asio::io_context& context, const std::string& address, std::uint16_t port,
                          TcpListener::OnChannel on_channel, TcpOptions options, TlsListenerOptions tls,
                          ProxyListenerOptions visitors = {});

/// Like openServerPort(), with open sockets, which now belong to the port. Throws ListenError without `tls`.
ServerPort adoptServerPort(asio::io_context& context, const InheritedSockets& sockets,
                           TcpListener::OnChannel on_channel, TcpOptions options, TlsListenerOptions tls,
                           ProxyListenerOptions visitors = {});

}  // namespace naiad
