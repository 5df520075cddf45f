// What a server listens with: a listener for streams, and datagrams on the same port number.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <memory>
#include <string>

#include "host/net/DatagramService.h"
#include "host/net/InheritedSockets.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/net/stream/VisitorsListener.h"

namespace naiad {

class UdpSocket;

struct ServerPort {
  std::unique_ptr<TcpListener> streams;
  std::unique_ptr<VisitorsListener> visitors;  ///< null: there is no visitors' socket
  std::unique_ptr<DatagramService> datagrams;  ///< null without encryption
  const UdpSocket* p_socket = nullptr;         ///< the socket of `datagrams`
};

/// Listen on a numeric address ("::" hears IPv4 as well, and is 0.0.0.0 where there is no IPv6). `port` 0
/// takes one that is free for both. Without `tls`: loopback, streams only. What comes to the visitors' socket
/// goes on as a stream that came to the port. Throws ListenError.
ServerPort openServerPort(asio::io_context& context, const std::string& address, std::uint16_t port,
                          TcpListener::OnChannel on_channel, TcpOptions options, TlsListening tls,
                          VisitorsListening visitors = {});

/// The same with sockets that the service manager has opened, which are the port's from now on. Throws
/// ListenError without `tls`.
ServerPort adoptServerPort(asio::io_context& context, const InheritedSockets& sockets,
                           TcpListener::OnChannel on_channel, TcpOptions options, TlsListening tls,
                           VisitorsListening visitors = {});

}  // namespace naiad
