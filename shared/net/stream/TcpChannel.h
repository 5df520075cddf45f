// A ReliableChannel over TCP: frames (Framing.h) on a connected socket, in TLS (TlsStream.h) or as they are.
//
// The socket has TCP_NODELAY, so that a frame leaves at once, and TCP_NOTSENT_LOWAT of 4 KiB, so that
// what cannot leave yet waits in the channel's queue, where unsentBytes() counts it and a server can skip
// a snapshot instead of piling up old ones. Frames sent in one turn of the event loop share a segment.
//
// TcpConnector.h and TcpListener.h make channels from addresses; this header is for sockets that are
// connected already. What is said here holds for both kinds of channel; the tests run over both.
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

/// What can be set on a TCP channel, whichever of these made it: TcpConnector, TcpListener or
/// makeTcpChannel().
struct TcpOptions {
  /// Bytes (headers included) that may wait in the channel's own queue. One more and the channel ends with
  /// CloseReason::kOverflow. Counts what the kernel did not take yet, not what it holds.
  std::size_t send_cap = 1u << 20;
  /// The largest payload accepted from the peer at first, in bytes; setReceiveLimit() changes it.
  /// The default suits a server's end before login; a client wants kMaxServerFrame.
  std::size_t receive_limit = kMaxHelloFrame;
  /// How long close() goes on sending what is queued before it cuts the connection.
  std::chrono::milliseconds close_timeout{1000};
};

/// A channel on a connected socket.
///
/// Thread: the one that runs the socket's io_context, which must outlive the channel. All callbacks come from
/// that io_context, none from inside a member function.
///
/// Lifetime: the channel may be destroyed at any time, in its own callbacks too; no callback comes after
/// that. Destroyed after close(), it goes on sending what is queued; without close(), it drops it.
/// Callbacks must not throw: what they throw leaves io_context::run(), and nothing more is received.
///
/// How it ends (`on_closed`):
///  - kLocal     after close(): the queue is sent, then the end of the stream, then the channel waits until
///               the peer has closed as well; all within TcpOptions::close_timeout, or the connection is cut.
///               Frames that arrive after close() are dropped.
///  - kPeer      the peer ended the stream between two frames. What was queued here is dropped.
///  - kProtocol  an empty frame, one over the limit, or the stream ended within a frame; with TLS also what
///               is no TLS, or was tampered with.
///  - kError     reset, unreachable; with TLS also an alert from the peer, and a connection that ended
///               between two frames without close_notify (RFC 8446 6.1). Frames that came before it are
///               delivered first.
///  - kOverflow  send() exceeded TcpOptions::send_cap.
///
/// With TLS, unsentBytes() counts payload while it waits here, and whole records (22 bytes more each) in the
/// kernel.
///
/// send() throws std::length_error for an empty frame or one above kMaxFramePayload.
std::unique_ptr<ReliableChannel> makeTcpChannel(asio::ip::tcp::socket socket, TcpOptions options = {});
/// The same on a stream that is ready for bytes both ways: a TlsStream after its handshake.
std::unique_ptr<ReliableChannel> makeTcpChannel(std::unique_ptr<ByteStream> stream, TcpOptions options = {});

/// A channel whose frames are written and read by `framing`, which may have been fed the first bytes already.
/// `options.receive_limit` is not used: the framing has its limit. exportSecret() returns an empty string,
/// because the other end may be a gateway that passes frames on. kPeer and kError as the framing's
/// peerClosed() says, too.
std::unique_ptr<ReliableChannel> makeFramedChannel(std::unique_ptr<ByteStream> stream,
                                                   std::unique_ptr<StreamFraming> framing,
                                                   TcpOptions options = {});

/// True for 127.0.0.0/8, ::1, and 127.0.0.0/8 mapped into IPv6. Without TLS, connector and listener refuse
/// every other address.
bool isLoopback(const asio::ip::address& address);

}  // namespace naiad
