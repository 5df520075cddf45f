// A ReliableChannel over TCP: frames (Framing.h) on a connected socket, plain or in TLS (TlsStream.h).
//
// The socket has TCP_NODELAY, so that a frame leaves at once, and TCP_NOTSENT_LOWAT of 4 KiB, so that further
// bytes wait in the channel's queue. unsentBytes() counts them there, and a server can skip a snapshot
// instead of queueing old ones. Frames sent in one turn of the event loop share a segment.
//
// TcpConnector.h and TcpListener.h make channels from addresses, this header from connected sockets. Its
// comments apply to plain and TLS channels; the tests run with both.
#pragma once

#include <asio/ip/address.hpp>
#include <asio/ip/tcp.hpp>
#include <chrono>
#include <cstddef>
#include <memory>

#include "shared/net/base/Channel.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/Framing.h"

namespace naiad {

/// Options of the TCP channels of TcpConnector, TcpListener and makeTcpChannel().
struct TcpOptions {
  /// Limit in bytes (headers included) of the channel's own queue; the kernel's does not count. Beyond it the
  /// channel ends with CloseReason::kOverflow.
  std::size_t send_cap = 1u << 20;
  /// The initial largest payload accepted from the peer, in bytes; see setReceiveLimit(). The default suits a
  /// server before login; clients need kMaxServerFrame.
  std::size_t receive_limit = kMaxHelloFrame;
  /// Time limit of close() for sending the queue and waiting until the peer has closed.
  std::chrono::milliseconds close_timeout{1000};
};

/// Makes a channel on a connected socket.
///
/// Thread: the one that runs the socket's io_context, which must outlive the channel. All callbacks come from
/// that io_context, none from inside a member function.
///
/// Lifetime: the channel may be destroyed at any time, even in its own callbacks; afterwards no callback
/// runs. If close() was called before, it still sends its queue; otherwise the queue is dropped. Exceptions
/// from callbacks leave io_context::run(), and nothing more is received: callbacks must not throw.
///
/// How it ends (`on_closed`):
///  - kLocal     after close(): the queue is sent, then the end of the stream, then the channel waits until
///               the peer has closed as well. After TcpOptions::close_timeout the connection is closed, by
///               a reset if frames are left in the queue. Frames that arrive after close() are dropped.
///  - kPeer      the peer ended the stream between two frames. The queue is dropped.
///  - kProtocol  an empty frame, one over the limit, or the stream ended within a frame; with TLS also bytes
///               that are not TLS or were modified.
///  - kError     reset, unreachable; with TLS also an alert from the peer, or an end of the connection
///               between two frames without close_notify (RFC 8446 6.1). Earlier frames are
///               delivered first.
///  - kOverflow  send(), or the framing's replies, exceeded TcpOptions::send_cap.
///
/// With TLS, unsentBytes() counts payload in this queue, and whole records (22 more bytes each) in the
/// kernel.
///
/// send() throws std::length_error for an empty frame or one above kMaxFramePayload.
std::unique_ptr<ReliableChannel> makeTcpChannel(asio::ip::tcp::socket socket, TcpOptions options = {});
/// Makes a channel on a stream that is ready for bytes in both directions: a TlsStream after its handshake.
std::unique_ptr<ReliableChannel> makeTcpChannel(std::unique_ptr<ByteStream> stream, TcpOptions options = {});

/// Makes a channel whose frames `framing` writes and reads. `framing` may have been fed the first bytes and
/// has its own limit: `options.receive_limit` is not used. exportSecret() returns "", because the other end
/// may be a gateway that forwards frames. The framing's peerClosed() may also cause kPeer and kError.
std::unique_ptr<ReliableChannel> makeFramedChannel(std::unique_ptr<ByteStream> stream,
                                                   std::unique_ptr<StreamFraming> framing,
                                                   TcpOptions options = {});

/// True for 127.0.0.0/8 (also mapped into IPv6) and ::1, the only addresses allowed without TLS.
bool isLoopback(const asio::ip::address& address);

}  // namespace naiad
