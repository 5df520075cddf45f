// Bytes over a connected socket, without blocking: as they are (PlainStream) or in TLS (TlsStream.h).
//
// What a channel (TcpChannel.h) needs to know about the difference, and no more. All calls on the thread that
// runs the socket's io_context. No call blocks or calls back; the caller waits for the socket and tries
// again.
#pragma once

#include <asio/generic/stream_protocol.hpp>
#include <asio/ip/tcp.hpp>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace naiad {

class ByteStream {
 public:
  enum class Outcome {
    kDone,
    kWantsRead,       ///< Try again when the socket is readable.
    kWantsWrite,      ///< Try again when the socket is writable.
    kWantsJudgement,  ///< Try again if that is wanted (TlsStream::handshake).
    kEnd,             ///< The peer said that this was all.
    kTruncated,       ///< The connection ended, but the peer had not said that this was all.
    kBroken,   ///< The connection failed (reset, unreachable), or the peer gave up on it with an alert.
    kGarbage,  ///< The peer sent what is no TLS, or was tampered with.
  };
  struct Progress {
    Outcome outcome;
    std::size_t bytes = 0;  ///< with kDone: how many were read or written, at least one
  };

  /// TCP, or a socket of the file system.
  using Socket = asio::generic::stream_protocol::socket;

  /// Takes a connected socket; makes it non-blocking, TCP with TCP_NODELAY and TCP_NOTSENT_LOWAT of 4 KiB.
  /// `peer`: "192.0.2.7:40000", the address of the other end; empty: the socket's own peer address.
  explicit ByteStream(Socket socket, std::string peer = {});
  virtual ~ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  virtual Progress read(std::span<char> into) = 0;
  /// `bytes`: not empty. After kWantsRead or kWantsWrite the next call must begin with the same bytes (which
  /// may lie elsewhere by then, with more behind them).
  virtual Progress write(std::string_view bytes) = 0;
  /// Tell the peer that nothing more comes. What it still sends can be read. May be called again.
  virtual Outcome end() = 0;
  /// True if read() may yield something although the socket is not readable.
  virtual bool holdsInput() const { return false; }
  /// See ReliableChannel::exportSecret().
  virtual std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;

  /// For waiting and closing; the bytes belong to read() and write().
  Socket& socket() { return socket_; }
  /// "127.0.0.1:40000", "[::1]:40000"; IPv4 mapped into IPv6 is shown as IPv4. "unknown" if that is not
  /// known.
  const std::string& peer() const { return peer_; }

 private:
  Socket socket_;
  std::string peer_;
};

/// An address as ByteStream::peer() writes it.
std::string peerName(const asio::ip::tcp::endpoint& endpoint);

/// Bytes as they are.
class PlainStream : public ByteStream {
 public:
  using ByteStream::ByteStream;

  Progress read(std::span<char> into) override;
  Progress write(std::string_view bytes) override;
  Outcome end() override;
};

}  // namespace naiad
